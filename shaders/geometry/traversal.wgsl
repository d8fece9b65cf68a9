// Closest hit and occlusion through the hierarchy: nodes sort their children by distance, and each child that waits is an entry of one word.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/bvh4.wgsl
#import geometry/instance.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/records.wgsl
#import geometry/stored.wgsl
#import geometry/constants.wgsl
#import shading/path/shadow.wgsl

alias StackEntry = u32;

struct Pending {
    // The entry to visit next, and how many wait on the stack.
    current: u32,
    depth: u32,
    // Primitives of the leaf entered last that are still to be tested.
    primitive: u32,
    primitive_end: u32,
}

fn nothing_pending() -> Pending {
    return Pending(FINISHED, 0u, 0u, 0u);
}

fn pending_root() -> Pending {
    return Pending(0u, 0u, 0u, 0u);
}

fn is_pending(pending: Pending) -> bool {
    return pending.current != FINISHED || pending.primitive != pending.primitive_end;
}

// A ray on its way through the hierarchy. Its stack is a variable beside it, because arrays in structs are copied.
struct Traversal {
    ray: PreparedRay,
    inverse_direction: vec3<f32>,
    hit: Hit,
    pending: Pending,
    // Result of a shadow ray.
    shadow: Shadow,
#if INSTANCES
    // The ray in the world; `ray` may be in an instance.
    world: Ray,
#endif
}

// A direction whose components are never 0, for reciprocals that stay finite. The change is far below rounding.
fn safe_inverse(direction: vec3<f32>) -> vec3<f32> {
    let tiny = vec3<f32>(1.0e-18);
    let signed_tiny = select(tiny, -tiny, direction < vec3<f32>(0.0));
    return 1.0 / select(direction, signed_tiny, abs(direction) < tiny);
}

fn begin_traversal(traced: Ray, t_max: f32) -> Traversal {
    return Traversal(
        prepare_ray(traced), safe_inverse(traced.direction), no_hit(t_max), pending_root(), begin_shadow(t_max)
#if INSTANCES
        , traced
#endif
    );
}

// A traversal that has nothing to do.
fn no_traversal() -> Traversal {
    var traversal: Traversal;
    traversal.pending = nothing_pending();
    return traversal;
}

fn is_finished(traversal: Traversal) -> bool {
    return !is_pending(traversal.pending);
}

// Goes on in the tree of an instance's group. What would have come next waits below the mark of the way back.
fn enter_instance(traversal: ptr<function, Traversal>, stack: ptr<function, array<StackEntry, STACK_SIZE>>, instance: u32) {
    let pending = (*traversal).pending;
    var depth = pending.depth;
    if pending.current != FINISHED {
        (*stack)[depth] = pending.current;
        depth++;
    }
    if pending.primitive != pending.primitive_end {
        (*stack)[depth] = LEAF | ((pending.primitive_end - pending.primitive - 1u) << 24u) | pending.primitive;
        depth++;
    }
    (*stack)[depth] = LEAVE_INSTANCE;
    let words = instance_words(instance);
    let ray = ray_in_instance((*traversal).world, words);
    (*traversal).ray = prepare_ray_in_instance(ray, instance);
    (*traversal).inverse_direction = safe_inverse(ray.direction);
    (*traversal).pending = Pending(instance_root(words), depth + 1u, 0u, 0u);
}

fn leave_instance(traversal: ptr<function, Traversal>) {
    (*traversal).ray = prepare_ray((*traversal).world);
    (*traversal).inverse_direction = safe_inverse((*traversal).world.direction);
}

// Tests one primitive.
fn test_primitive(traversal: ptr<function, Traversal>, stack: ptr<function, array<StackEntry, STACK_SIZE>>, primitive: u32) {
    let words = primitive_words(primitive);
    if HAS_INSTANCES && is_instance(words) {
        enter_instance(traversal, stack, instance_number(words));
        return;
    }
    var hit = (*traversal).hit;
    intersect_stored((*traversal).ray, primitive, words, &hit);
    (*traversal).hit = hit;
}

// Visits a node: puts the children met onto the stack but for the nearest, and returns that; FINISHED where there is none.
fn descend(node: u32, traversal: ptr<function, Traversal>, stack: ptr<function, array<StackEntry, STACK_SIZE>>) -> u32 {
    let words = node_words(node);
    // Sorted by distance with a network of five exchanges; the nearest is visited next, the others wait, farthest deepest.
    let distances = entry_distances(words, (*traversal).ray.origin, (*traversal).inverse_direction, (*traversal).hit.t);
    let exists = (vec4<u32>(existing_children(words)) & vec4<u32>(1u, 2u, 4u, 8u)) != vec4<u32>(0u);
    var t = select(vec4<f32>(INFINITY_DISTANCE), distances, exists);
    var e = child_entries(words);
    if t.y < t.x { t = t.yxzw; e = e.yxzw; }
    if t.w < t.z { t = t.xywz; e = e.xywz; }
    if t.z < t.x { t = t.zyxw; e = e.zyxw; }
    if t.w < t.y { t = t.xwzy; e = e.xwzy; }
    if t.z < t.y { t = t.xzyw; e = e.xzyw; }
    // All are written and those met are kept: that costs less than branches that depend on the ray.
    var depth = (*traversal).pending.depth;
    (*stack)[depth] = e.w;
    depth += select(0u, 1u, t.w < INFINITY_DISTANCE);
    (*stack)[depth] = e.z;
    depth += select(0u, 1u, t.z < INFINITY_DISTANCE);
    (*stack)[depth] = e.y;
    depth += select(0u, 1u, t.y < INFINITY_DISTANCE);
    (*traversal).pending.depth = depth;
    return select(e.x, FINISHED, t.x == INFINITY_DISTANCE);
}

// Visits one node, nearest first, and tests one primitive of a leaf met before. Lanes that run together pay for both anyway, so a
// leaf's primitives are tested while the way goes on, not before it does.
fn step_closest(traversal: ptr<function, Traversal>, stack: ptr<function, array<StackEntry, STACK_SIZE>>) {
    var current = (*traversal).pending.current;
    var leads_nowhere = false;
    if (current & LEAF) == 0u {
        current = descend(current, traversal, stack);
        leads_nowhere = current == FINISHED;
    }
#if INSTANCES
    if current == LEAVE_INSTANCE && (*traversal).pending.primitive == (*traversal).pending.primitive_end {
        leave_instance(traversal);
        leads_nowhere = true;
    }
    let is_leaf = (current & LEAF) != 0u && current != FINISHED && current != LEAVE_INSTANCE;
#else
    let is_leaf = (current & LEAF) != 0u && current != FINISHED;
#endif
    if !leads_nowhere && is_leaf && (*traversal).pending.primitive == (*traversal).pending.primitive_end {
        (*traversal).pending.primitive = current & 0x00ffffffu;
        (*traversal).pending.primitive_end = (*traversal).pending.primitive + ((current >> 24u) & 3u) + 1u;
        leads_nowhere = true;
    }
    if leads_nowhere {
        current = FINISHED;
        if (*traversal).pending.depth != 0u {
            (*traversal).pending.depth--;
            current = (*stack)[(*traversal).pending.depth];
        }
    }
    (*traversal).pending.current = current;
    if (*traversal).pending.primitive != (*traversal).pending.primitive_end {
        let primitive = (*traversal).pending.primitive;
        (*traversal).pending.primitive = primitive + 1u;
        test_primitive(traversal, stack, primitive);
    }
}

// The traversal's ray as it was begun.
fn ray_in_world(traversal: ptr<function, Traversal>) -> Ray {
    if HAS_INSTANCES {
        return (*traversal).world;
    } else {
        return Ray((*traversal).ray.origin, (*traversal).ray.direction);
    }
}

// One step of a shadow ray's traversal, which ends at the first surface that leaves no light.
fn step_any(traversal: ptr<function, Traversal>, stack: ptr<function, array<StackEntry, STACK_SIZE>>) {
    step_closest(traversal, stack);
    if (*traversal).hit.primitive != NONE {
        var shadow = (*traversal).shadow;
        let blocked = is_blocked_by(&shadow, ray_in_world(traversal), (*traversal).hit);
        (*traversal).shadow = shadow;
        if blocked {
            (*traversal).pending = nothing_pending();
        } else {
            // A transparent surface is behind the ray then, which goes on to its end.
            (*traversal).hit = no_hit(shadow.limit);
        }
    }
}

// The constants first: what they meet shortens the way through the hierarchy.
fn begin_closest(traced: Ray, t_max: f32) -> Traversal {
    var traversal = begin_traversal(traced, t_max);
    var hit = traversal.hit;
    closest_of_constants(traversal.ray, &hit);
    traversal.hit = hit;
    return traversal;
}

fn begin_any(traced: Ray, t_max: f32) -> Traversal {
    var traversal = begin_traversal(traced, t_max);
    var shadow = traversal.shadow;
    if is_blocked_by_constants(&shadow, traversal.ray) {
        traversal.hit.primitive = 0u;
        traversal.pending = nothing_pending();
    }
    traversal.shadow = shadow;
    return traversal;
}

fn closest_hit(traced: Ray, t_max: f32) -> Hit {
    var stack: array<StackEntry, STACK_SIZE>;
    var traversal = begin_closest(traced, t_max);
    while !is_finished(traversal) {
        step_closest(&traversal, &stack);
    }
    return traversal.hit;
}

// The share of light that comes through all that lies between the origin and t_max.
fn shadow_transmittance(traced: Ray, t_max: f32) -> Spectrum {
    var stack: array<StackEntry, STACK_SIZE>;
    var traversal = begin_any(traced, t_max);
    while !is_finished(traversal) {
        step_any(&traversal, &stack);
    }
    return traversed_light(traversal);
}

// The share of light that comes to the end of a shadow ray whose traversal is finished.
fn traversed_light(traversal: Traversal) -> Spectrum {
    return light_through(traversal.shadow, traversal.hit.primitive != NONE);
}
