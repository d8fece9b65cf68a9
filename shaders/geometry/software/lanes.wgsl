// Exchange of values between the lanes of a subgroup. Every lane of the subgroup has to take part in these
// calls.

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

// Least of all lanes' values with number lane % 4, of four: each exchange halves the number of values that a
// lane handles.
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

// The less of this lane's value and that of the lane `distance` away.
fn lesser(value: u32, distance: u32) -> u32 {
    return min(value, subgroupShuffle(value, lane ^ distance));
}

// Number of lanes, among four neighbours, for which the condition holds.
fn count_of_four(condition: bool) -> u32 {
    let one = select(0u, 1u, condition);
    let two = one + subgroupShuffle(one, lane ^ 1u);
    return two + subgroupShuffle(two, lane ^ 2u);
}

// Compares with the lane `distance` away: the lower one of the two keeps the less where `rises`, else the other one does.
fn exchanged(value: u32, distance: u32, rises: bool) -> u32 {
    let other = subgroupShuffle(value, lane ^ distance);
    return select(max(value, other), min(value, other), ((lane & distance) == 0u) == rises);
}

// The values of four lanes that stand together, in rising order (Batcher's bitonic sort).
fn sorted_four(value: u32) -> u32 {
    let pairs = exchanged(value, 1u, (lane & 2u) == 0u);
    return exchanged(exchanged(pairs, 2u, true), 1u, true);
}
