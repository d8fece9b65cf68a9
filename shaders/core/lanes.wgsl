// What the lanes of a subgroup tell each other. Every lane of the subgroup has to take part in these calls.
#import core/math.wgsl

// This invocation's place in its subgroup of LANES; to be set before anything else here is called.
var<private> lane: u32;

fn any_lane(condition: bool) -> bool {
    var found = select(0u, 1u, condition);
    for (var distance = 1u; distance < LANES; distance *= 2u) {
        found |= subgroupShuffle(found, lane ^ distance);
    }
    return found != 0u;
}

// The value of lane number `other`.
fn from_lane(value: vec4<u32>, other: u32) -> vec4<u32> {
    return vec4<u32>(
        subgroupShuffle(value.x, other), subgroupShuffle(value.y, other), subgroupShuffle(value.z, other), subgroupShuffle(value.w, other)
    );
}

// Of four values, the least that any lane has of value number lane % 4: lanes halve what they look after at each exchange.
fn least_of_lanes(values: vec4<u32>) -> u32 {
    let odd = (lane & 1u) != 0u;
    let first = min(select(values.x, values.y, odd), subgroupShuffle(select(values.y, values.x, odd), lane ^ 1u));
    let second = min(select(values.z, values.w, odd), subgroupShuffle(select(values.w, values.z, odd), lane ^ 1u));
    let upper = (lane & 2u) != 0u;
    var least = min(select(first, second, upper), subgroupShuffle(select(second, first, upper), lane ^ 2u));
    for (var distance = 4u; distance < LANES; distance *= 2u) {
        least = min(least, subgroupShuffle(least, lane ^ distance));
    }
    return least;
}
