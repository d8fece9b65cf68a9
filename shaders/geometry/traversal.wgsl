// Closest hit and occlusion through the hierarchy, whatever its form. A form's file has
//   StackEntry, Pending: what waits to be visited; nothing_pending, pending_root, is_pending
//   step_closest: visits one node and tests one primitive
#import geometry/stored.wgsl
#import geometry/constants.wgsl
#if BVH2
#import geometry/bvh2.wgsl
#endif
#if BVH4
#import geometry/bvh4.wgsl
#endif
#if CWBVH
#import geometry/cwbvh.wgsl
#endif

// A ray on its way through the hierarchy. Its stack is a variable beside it, because arrays in structs are copied.
struct Traversal {
    ray: PreparedRay,
    inverse_direction: vec3<f32>,
    hit: Hit,
    pending: Pending,
}

// A direction whose components are never 0, for reciprocals that stay finite. The change is far below rounding.
fn safe_inverse(direction: vec3<f32>) -> vec3<f32> {
    let tiny = vec3<f32>(1.0e-18);
    let signed_tiny = select(tiny, -tiny, direction < vec3<f32>(0.0));
    return 1.0 / select(direction, signed_tiny, abs(direction) < tiny);
}

fn begin_traversal(traced: Ray, t_max: f32) -> Traversal {
    return Traversal(prepare_ray(traced), safe_inverse(traced.direction), Hit(t_max, NONE, 0.0, 0.0), pending_root());
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

// As step_closest, for a ray that only asks whether it meets anything: it is finished at the first primitive met.
fn step_any(traversal: ptr<function, Traversal>, stack: ptr<function, array<StackEntry, STACK_SIZE>>) {
    step_closest(traversal, stack);
    if (*traversal).hit.primitive != NONE {
        (*traversal).pending = nothing_pending();
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
    if any_of_constants(traversal.ray, t_max) {
        traversal.hit.primitive = 0u;
        traversal.pending = nothing_pending();
    }
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

// Whether anything lies between the origin and t_max.
fn occluded(traced: Ray, t_max: f32) -> bool {
    var stack: array<StackEntry, STACK_SIZE>;
    var traversal = begin_any(traced, t_max);
    while !is_finished(traversal) {
        step_any(&traversal, &stack);
    }
    return traversal.hit.primitive != NONE;
}

// Widening the far side covers the rounding of both distances (Ize 2013).
const WIDER: f32 = 1.000001;

// Without the care for NaN that min and max take: there is none here, because reciprocals are finite.
fn smaller(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    return select(a, b, b < a);
}

fn larger(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    return select(a, b, b > a);
}

// The bytes go through i32: software drivers convert signed integers in one instruction, unsigned ones in seven.
fn unpack_bytes(word: u32) -> vec4<f32> {
    return vec4<f32>(vec4<i32>((vec4<u32>(word) >> vec4<u32>(0u, 8u, 16u, 24u)) & vec4<u32>(255u)));
}

// Tests one primitive.
fn test_primitive(traversal: ptr<function, Traversal>, primitive: u32) {
    var hit = (*traversal).hit;
    intersect_stored((*traversal).ray, primitive, primitive_words(primitive), &hit);
    (*traversal).hit = hit;
}
