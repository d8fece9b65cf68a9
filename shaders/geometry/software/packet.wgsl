// Closest hit and occlusion for the rays of a whole subgroup at once: a packet (Wald et al. 2001) visits the nodes that any of its rays
// meets, in one order for all. A record is loaded once, a word a lane, and handed round. Rays of one pixel share most of their way.
//
// The files of this folder earn their keep on software devices alone. There a load costs most of a step through the hierarchy, because each lane's
// words are fetched one by one, and what another lane has costs next to nothing: lavapipe takes 1.25 to 1.35 times as many samples a second by
// packets as lane by lane. Hardware loads for all lanes at once, and does not use them.
//
// Every lane of the subgroup has to call these functions; one without a ray gives a negative t_max, and meets nothing.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/bvh4.wgsl
#import geometry/constants.wgsl
#import geometry/instance.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/records.wgsl
#import geometry/software/lanes.wgsl
#import geometry/software/packet_stack.wgsl
#import geometry/stored.wgsl
#import geometry/traversal.wgsl
#import shading/path/shadow.wgsl

// The key of a child that no ray meets: the bits of INFINITY_DISTANCE but for the last two.
const MISSED: u32 = 0x7f61b1e4u;

// A record of three words, loaded by as many lanes.
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

// An instance's six words, likewise.
fn shared_instance(instance: u32) -> InstanceWords {
    var first = vec4<f32>(0.0);
    if lane < 4u {
        first = instance_word(instance, lane);
    }
    var second = vec4<f32>(0.0);
    if lane < 2u {
        second = instance_word(instance, 4u + lane);
    }
    let bits = bitcast<vec4<u32>>(first);
    let more_bits = bitcast<vec4<u32>>(second);
    return InstanceWords(
        bitcast<vec4<f32>>(from_lane(bits, 0u)), bitcast<vec4<f32>>(from_lane(bits, 1u)), bitcast<vec4<f32>>(from_lane(bits, 2u)),
        bitcast<vec4<f32>>(from_lane(bits, 3u)), bitcast<vec4<f32>>(from_lane(more_bits, 0u)),
        bitcast<vec4<f32>>(from_lane(more_bits, 1u))
    );
}

// A node, whose words begin at `first`, likewise.
fn shared_node(first: u32) -> NodeWords {
    var word = vec4<u32>(0u);
    if lane < 3u {
        word = node_word_at(first, lane);
    }
    return NodeWords(from_lane(word, 0u), from_lane(word, 1u), from_lane(word, 2u));
}

// Visits the current node: the nearest of the children that any ray meets becomes current, the others go onto the stack, the farthest
// deepest.
fn descend_together(ray: PreparedRay, inverse_direction: vec3<f32>, t_max: f32, stack: ptr<function, PacketStack>) {
    let words = shared_node((*stack).current);
    let least = least_of_lanes(bitcast<vec4<u32>>(entry_distances(words, ray.origin, inverse_direction, t_max)));
    // Each lane looks after a child. Distances are not negative, so their bits sort as they do; the last two say which child it is.
    let child = lane & 3u;
    let exists = ((existing_children(words) >> child) & 1u) != 0u;
    let key = select(MISSED, least & 0xfffffffcu, exists) | child;
    let entry = child_entry(words, child);
    let nearest = lesser(lesser(key, 1u), 2u);
    let count = count_of_four(key < MISSED);
    go_on(stack, subgroupShuffle(entry, nearest & 3u), subgroupShuffle(entry, sorted_four(key) & 3u), count);
}

// Goes through the hierarchy. With `any_hit`, each ray is a shadow ray, done with the first surface that leaves no light, and the packet is done when all are.
fn traverse_together(
    world_ray: PreparedRay, world_inverse: vec3<f32>, first_hit: Hit, any_hit: bool, shadow: ptr<function, Shadow>
) -> Hit {
    var hit = first_hit;
#if INSTANCES
    // In the space of the instance at hand, the same one for all lanes.
    var ray = world_ray;
    var inverse_direction = world_inverse;
#else
    let ray = world_ray;
    let inverse_direction = world_inverse;
#endif
    var stack = packet_at_root();
    // All lanes are at the same place. Nodes have a loop, up to the next leaf, and its primitives have one: in a single loop both would be run at
    // every turn, with all lanes masked in one of them.
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
#if INSTANCES
            let leaves = stack.current == LEAVE_INSTANCE;
            let exists = stack.current != FINISHED && !leaves;
#else
            let exists = stack.current != FINISHED;
#endif
            let words = shared_primitive(primitive, exists);
            var candidate = hit;
            candidate.t = select(-1.0, hit.t, exists);
            intersect_stored(ray, primitive, words, &candidate);
            if candidate.primitive == primitive && exists {
                hit = candidate;
            }
            if any_hit && hit.primitive != NONE && hit.t > 0.0 {
                if is_blocked_by(shadow, Ray(world_ray.origin, world_ray.direction), hit) {
                    hit.t = -1.0;
                } else {
                    hit = first_hit;
                }
            }
#if INSTANCES
            let enters = exists && is_instance(words);
            let rest_of_leaf = LEAF | ((last - primitive - 1u) << 24u) | (primitive + 1u);
            let has_rest = primitive != last;
            // A loop, because it ends where a branch would run with all lanes masked.
            for (var entering = enters; entering; entering = false) {
                let instance = instance_number(words);
                let record = shared_instance(instance);
                let local = ray_in_instance(Ray(world_ray.origin, world_ray.direction), record);
                ray = prepare_ray_in_instance(local, instance);
                inverse_direction = safe_inverse(local.direction);
                let root = first_word_of_node(instance_root(record));
                let entry = select(select(rest_of_leaf, LEAVE_INSTANCE, lane == 1u), root, lane == 0u);
                go_on(&stack, root, entry, select(2u, 3u, has_rest));
            }
            for (var leaving = leaves; leaving; leaving = false) {
                ray = world_ray;
                inverse_direction = world_inverse;
            }
            let leaf_done = primitive == last || enters || leaves;
            if !enters && leaf_done && (exists || leaves) {
                pop(&stack);
            }
#else
            let leaf_done = primitive == last;
            if leaf_done && exists {
                pop(&stack);
            }
#endif
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

// `closest_hit` for the rays of all lanes.
fn closest_hit_together(traced: Ray, t_max: f32) -> Hit {
    let ray = prepare_ray(traced);
    var hit = no_hit(t_max);
    closest_of_constants(ray, &hit);
    var shadow = begin_shadow(t_max);
    return traverse_together(ray, safe_inverse(traced.direction), hit, false, &shadow);
}

// `shadow_transmittance` for the rays of all lanes.
fn shadow_transmittance_together(traced: Ray, t_max: f32) -> Spectrum {
    let ray = prepare_ray(traced);
    var shadow = begin_shadow(t_max);
    var blocked = false;
    if t_max > 0.0 {
        blocked = is_blocked_by_constants(&shadow, ray);
    }
    let hit = world_hit(select(t_max, -1.0, blocked), select(NONE, 0u, blocked), 0.0, 0.0);
    let found = traverse_together(ray, safe_inverse(traced.direction), hit, true, &shadow);
    return light_through(shadow, found.primitive != NONE);
}
