// Closest hit and occlusion through a four-wide hierarchy with 8-bit boxes, three vec4<u32> a node (src/flat/bvh4.rs):
//   (origin x, y, z; exponents x, y, z and which children are inner nodes (4 bits) and exist (4 bits))
//   (first inner child; first primitive (24 bits) and leaf sizes less one (2 bits each); low x of 4 children; low y)
//   (low z; high x; high y; high z)
#import geometry/stored.wgsl
#import geometry/constants.wgsl

const LEAF: u32 = 0x80000000u;

struct NodeHits {
    // Entry distance per child; INFINITY_DISTANCE where the ray misses it.
    t: vec4<f32>,
    // Inner child: node index. Leaf: LEAF | (size - 1) << 24 | first primitive.
    entry: vec4<u32>,
}

// The bytes go through i32: software drivers convert signed integers in one instruction, unsigned ones in seven.
fn unpack_bytes(word: u32) -> vec4<f32> {
    return vec4<f32>(vec4<i32>((vec4<u32>(word) >> vec4<u32>(0u, 8u, 16u, 24u)) & vec4<u32>(255u)));
}

// Without the care for NaN that min and max take: there is none here, because reciprocals are finite.
fn smaller(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    return select(a, b, b < a);
}

fn larger(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    return select(a, b, b > a);
}

fn intersect_node(node: u32, origin: vec3<f32>, inverse_direction: vec3<f32>, t_max: f32) -> NodeHits {
    let n0 = nodes[node * 3u];
    let n1 = nodes[node * 3u + 1u];
    let n2 = nodes[node * 3u + 2u];
    let exponents = vec3<u32>(n0.w, n0.w >> 8u, n0.w >> 16u) & vec3<u32>(255u);
    let scale = bitcast<vec3<f32>>(exponents << vec3<u32>(23u)) * inverse_direction;
    let offset = (bitcast<vec3<f32>>(n0.xyz) - origin) * inverse_direction;

    // The ray's direction says which planes it meets first, for all four children at once.
    let backward = inverse_direction < vec3<f32>(0.0);
    let low = vec3<u32>(n1.z, n1.w, n2.x);
    let near_words = select(low, n2.yzw, backward);
    let far_words = select(n2.yzw, low, backward);
    let near = larger(
        larger(unpack_bytes(near_words.x) * scale.x + offset.x, unpack_bytes(near_words.y) * scale.y + offset.y),
        larger(unpack_bytes(near_words.z) * scale.z + offset.z, vec4<f32>(0.0))
    );
    let far = smaller(
        smaller(unpack_bytes(far_words.x) * scale.x + offset.x, unpack_bytes(far_words.y) * scale.y + offset.y),
        smaller(unpack_bytes(far_words.z) * scale.z + offset.z, vec4<f32>(t_max))
    );

    let flags = n0.w >> 24u;
    let child_bit = vec4<u32>(1u, 2u, 4u, 8u);
    let exists = (vec4<u32>(flags >> 4u) & child_bit) != vec4<u32>(0u);
    // Widening the far side covers the rounding of both distances (Ize 2013).
    let met = exists & (near <= far * 1.000001);

    let inner = (vec4<u32>(flags) & child_bit) != vec4<u32>(0u);
    let inner_rank = vec4<u32>(0u, flags & 1u, countOneBits(flags & 3u), countOneBits(flags & 7u));
    let sizes = (vec4<u32>(n1.y >> 24u) >> vec4<u32>(0u, 2u, 4u, 6u)) & vec4<u32>(3u);
    let counts = select(sizes + 1u, vec4<u32>(0u), inner);
    let starts = vec4<u32>(0u, counts.x, counts.x + counts.y, counts.x + counts.y + counts.z) + (n1.y & 0x00ffffffu);
    let leaf_entry = starts | (sizes << vec4<u32>(24u)) | vec4<u32>(LEAF);

    return NodeHits(select(vec4<f32>(INFINITY_DISTANCE), near, met), select(leaf_entry, inner_rank + n1.x, inner));
}

// A direction whose components are never 0, for reciprocals that stay finite. The change is far below rounding.
fn safe_inverse(direction: vec3<f32>) -> vec3<f32> {
    let tiny = vec3<f32>(1.0e-18);
    let signed_tiny = select(tiny, -tiny, direction < vec3<f32>(0.0));
    return 1.0 / select(direction, signed_tiny, abs(direction) < tiny);
}

// A ray on its way through the hierarchy. Its stack is a variable beside it, because arrays in structs are copied.
struct Traversal {
    ray: PreparedRay,
    inverse_direction: vec3<f32>,
    hit: Hit,
    // The entry to visit next, and how many wait on the stack.
    current: u32,
    depth: u32,
    // Primitives of the leaf entered last that are still to be tested.
    primitive: u32,
    primitive_end: u32,
}

// No entry is left. No leaf has this entry: its size would be above any.
const FINISHED: u32 = 0xffffffffu;

fn begin_traversal(traced: Ray, t_max: f32) -> Traversal {
    return Traversal(prepare_ray(traced), safe_inverse(traced.direction), Hit(t_max, NONE, 0.0, 0.0), 0u, 0u, 0u, 0u);
}

// A traversal that has nothing to do.
fn no_traversal() -> Traversal {
    var traversal: Traversal;
    traversal.current = FINISHED;
    return traversal;
}

fn is_finished(traversal: Traversal) -> bool {
    return traversal.current == FINISHED && traversal.primitive == traversal.primitive_end;
}

// Visits one node, nearest first, and tests one primitive of a leaf met before. Lanes that run together pay for both anyway, so a
// leaf's primitives are tested while the way goes on, not before it does.
fn step_closest(traversal: ptr<function, Traversal>, stack: ptr<function, array<u32, STACK_SIZE>>) {
    var current = (*traversal).current;
    var leads_nowhere = false;
    if (current & LEAF) == 0u {
        let children = intersect_node(
            current, (*traversal).ray.origin, (*traversal).inverse_direction, (*traversal).hit.t
        );
        // Sorted by distance with a network of five exchanges; the nearest is visited next, the others wait, farthest deepest.
        var t = children.t;
        var e = children.entry;
        if t.y < t.x { t = t.yxzw; e = e.yxzw; }
        if t.w < t.z { t = t.xywz; e = e.xywz; }
        if t.z < t.x { t = t.zyxw; e = e.zyxw; }
        if t.w < t.y { t = t.xwzy; e = e.xwzy; }
        if t.z < t.y { t = t.xzyw; e = e.xzyw; }
        // All are written and those met are kept: that costs less than branches that depend on the ray.
        var depth = (*traversal).depth;
        (*stack)[depth] = e.w;
        depth += select(0u, 1u, t.w < INFINITY_DISTANCE);
        (*stack)[depth] = e.z;
        depth += select(0u, 1u, t.z < INFINITY_DISTANCE);
        (*stack)[depth] = e.y;
        depth += select(0u, 1u, t.y < INFINITY_DISTANCE);
        (*traversal).depth = depth;
        current = e.x;
        leads_nowhere = t.x == INFINITY_DISTANCE;
    }
    let is_leaf = (current & LEAF) != 0u && current != FINISHED;
    if !leads_nowhere && is_leaf && (*traversal).primitive == (*traversal).primitive_end {
        (*traversal).primitive = current & 0x00ffffffu;
        (*traversal).primitive_end = (*traversal).primitive + ((current >> 24u) & 3u) + 1u;
        leads_nowhere = true;
    }
    if leads_nowhere {
        current = FINISHED;
        if (*traversal).depth != 0u {
            (*traversal).depth--;
            current = (*stack)[(*traversal).depth];
        }
    }
    (*traversal).current = current;
    if (*traversal).primitive != (*traversal).primitive_end {
        var hit = (*traversal).hit;
        intersect_stored((*traversal).ray, (*traversal).primitive, &hit);
        (*traversal).hit = hit;
        (*traversal).primitive++;
    }
}

// The same for a ray that only asks whether it meets anything: it is finished at the first primitive met.
fn step_any(traversal: ptr<function, Traversal>, stack: ptr<function, array<u32, STACK_SIZE>>) {
    step_closest(traversal, stack);
    if (*traversal).hit.primitive != NONE {
        (*traversal).current = FINISHED;
        (*traversal).primitive = (*traversal).primitive_end;
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
        traversal.current = FINISHED;
    }
    return traversal;
}

fn closest_hit(traced: Ray, t_max: f32) -> Hit {
    var stack: array<u32, STACK_SIZE>;
    var traversal = begin_closest(traced, t_max);
    while !is_finished(traversal) {
        step_closest(&traversal, &stack);
    }
    return traversal.hit;
}

// Whether anything lies between the origin and t_max.
fn occluded(traced: Ray, t_max: f32) -> bool {
    var stack: array<u32, STACK_SIZE>;
    var traversal = begin_any(traced, t_max);
    while !is_finished(traversal) {
        step_any(&traversal, &stack);
    }
    return traversal.hit.primitive != NONE;
}
