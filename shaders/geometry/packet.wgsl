// Closest hit and occlusion for the rays of a whole subgroup at once: a packet (Wald et al. 2001) visits the nodes that any of its rays
// meets, in one order for all. A record is loaded once, a word a lane, and handed round: on software devices loads cost the most, and
// what another lane has costs next to nothing. The stack lies in registers, an entry a lane. Rays of one pixel share most of their way.
// Every lane of the subgroup has to call these functions; one without a ray gives a negative t_max, and meets nothing.
#import core/lanes.wgsl
#import geometry/traversal.wgsl

// The key of a child that no ray meets: the bits of INFINITY_DISTANCE but for the last two.
const MISSED: u32 = 0x7f61b1e4u;
// Registers that hold the stack.
const STACK_REGISTERS: u32 = (STACK_SIZE + LANES - 1u) / LANES;

// The same in all lanes, but for the registers: register r of a lane is slot r * LANES + lane. They are an array whose every index is a
// constant once loops are unrolled.
struct PacketStack {
    // The entry to visit next, and how many wait.
    current: u32,
    depth: u32,
    registers: array<u32, STACK_REGISTERS>,
}

// Makes the entry on top of the stack the current one; FINISHED where none is left.
fn pop(stack: ptr<function, PacketStack>) {
    let depth = (*stack).depth;
    let slot = depth - 1u;
    var top = FINISHED;
    for (var number = 0u; number < STACK_REGISTERS; number++) {
        let entry = subgroupShuffle((*stack).registers[number], slot & (LANES - 1u));
        top = select(top, entry, slot / LANES == number);
    }
    (*stack).current = top;
    (*stack).depth = max(depth, 1u) - 1u;
}

// Puts each lane's entry into its slot among the LANES slots from the top of the stack on.
fn write_above_top(stack: ptr<function, PacketStack>, entry: u32) {
    for (var number = 0u; number < STACK_REGISTERS; number++) {
        let above = number * LANES + lane - (*stack).depth;
        (*stack).registers[number] = select((*stack).registers[number], entry, above < LANES);
    }
}

// The keys of lanes 0 to 3, least first, by a network of five exchanges.
fn sorted_keys(key: u32) -> vec4<u32> {
    let first = vec2<u32>(subgroupShuffle(key, 0u), subgroupShuffle(key, 2u));
    let second = vec2<u32>(subgroupShuffle(key, 1u), subgroupShuffle(key, 3u));
    let low = min(first, second);
    let high = max(first, second);
    let inner = vec2<u32>(max(low.x, low.y), min(high.x, high.y));
    return vec4<u32>(min(low.x, low.y), min(inner.x, inner.y), max(inner.x, inner.y), max(high.x, high.y));
}

// A record of three words, loaded by as many lanes.
fn shared_node(node: u32) -> NodeWords {
    var word = vec4<u32>(0u);
    if lane < 3u {
        word = node_word(node, lane);
    }
    return NodeWords(from_lane(word, 0u), from_lane(word, 1u), from_lane(word, 2u));
}

fn shared_primitive(primitive: u32, exists: bool) -> PrimitiveWords {
    var word = vec4<f32>(0.0);
    if exists && lane < 3u {
        word = primitive_word(primitive, lane);
    }
    let bits = bitcast<vec4<u32>>(word);
    return PrimitiveWords(
        bitcast<vec4<f32>>(from_lane(bits, 0u)), bitcast<vec4<f32>>(from_lane(bits, 1u)), bitcast<vec4<f32>>(from_lane(bits, 2u))
    );
}

// Visits the current node: the children that any ray meets go onto the stack, the farthest deepest, and the nearest becomes current.
fn descend_together(ray: PreparedRay, inverse_direction: vec3<f32>, t_max: f32, stack: ptr<function, PacketStack>) {
    let words = shared_node((*stack).current);
    let t = entry_distances(words, ray.origin, inverse_direction, t_max);
    // Distances are not negative, so their bits sort as they do. The last two say which child it is.
    let keys = sorted_keys(least_of_lanes((bitcast<vec4<u32>>(t) & vec4<u32>(0xfffffffcu)) | vec4<u32>(0u, 1u, 2u, 3u)));
    let is_met = select(vec4<u32>(0u), vec4<u32>(1u), keys < vec4<u32>(MISSED));
    let met = is_met.x + is_met.y + is_met.z + is_met.w;
    // Slots from the top on get the children of rank met - 1 to 0. What is written above them does not count.
    let rank = met - 1u - ((lane - (*stack).depth) & (LANES - 1u));
    let key = select(select(keys.x, keys.y, rank == 1u), select(keys.z, keys.w, rank == 3u), rank >= 2u);
    write_above_top(stack, subgroupShuffle(child_entry(words, lane & 3u), key & 3u));
    (*stack).depth += met;
    pop(stack);
}

// Goes through the hierarchy. With `any_hit`, each ray is done with its first hit, and the packet when all are.
fn traverse_together(ray: PreparedRay, inverse_direction: vec3<f32>, first_hit: Hit, any_hit: bool) -> Hit {
    var hit = first_hit;
    var stack: PacketStack;
    // Software devices run what a branch leaves out, with all lanes masked; only loops end. So nodes have one, and primitives have one.
    loop {
        loop {
            descend_together(ray, inverse_direction, hit.t, &stack);
            continuing {
                break if (stack.current & LEAF) != 0u;
            }
        }
        var primitive = stack.current & 0x00ffffffu;
        var last = primitive + ((stack.current >> 24u) & 3u);
        loop {
            let exists = stack.current != FINISHED;
            let words = shared_primitive(primitive, exists);
            var candidate = hit;
            candidate.t = select(-1.0, hit.t, exists);
            intersect_stored(ray, primitive, words, &candidate);
            if candidate.primitive == primitive && exists {
                hit = candidate;
            }
            if any_hit && hit.primitive != NONE {
                hit.t = -1.0;
            }
            let leaf_done = primitive == last;
            if leaf_done && exists {
                pop(&stack);
            }
            if any_hit && !any_lane(hit.t > 0.0) {
                stack.current = FINISHED;
            }
            primitive = select(primitive + 1u, stack.current & 0x00ffffffu, leaf_done);
            last = select(last, primitive + ((stack.current >> 24u) & 3u), leaf_done);
            continuing {
                break if (stack.current & LEAF) == 0u || stack.current == FINISHED;
            }
        }
        continuing {
            break if stack.current == FINISHED;
        }
    }
    return hit;
}

// As closest_hit, for all lanes.
fn closest_hit_together(traced: Ray, t_max: f32) -> Hit {
    let ray = prepare_ray(traced);
    var hit = Hit(t_max, NONE, 0.0, 0.0);
    closest_of_constants(ray, &hit);
    return traverse_together(ray, safe_inverse(traced.direction), hit, false);
}

// As occluded, for all lanes.
fn occluded_together(traced: Ray, t_max: f32) -> bool {
    let ray = prepare_ray(traced);
    let blocked = any_of_constants(ray, t_max);
    let hit = Hit(select(t_max, -1.0, blocked), select(NONE, 0u, blocked), 0.0, 0.0);
    return traverse_together(ray, safe_inverse(traced.direction), hit, true).primitive != NONE;
}
