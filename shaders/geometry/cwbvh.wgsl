// obvhs's eight-wide compressed hierarchy (Ylitie, Karras and Laine 2017), five vec4<u32> a node (src/packed/cwbvh.rs):
//   (origin x, y, z; exponents x, y, z and which slots hold inner nodes (8 bits))
//   (first inner child; first primitive; a byte a slot, eight)
//   (low x of 8 children; low y)
//   (low z; high x)
//   (high y; high z)
// A slot's byte: inner node, 001 and 24 + slot; leaf, a bit for each of its primitives and the place of the first; 0, empty.

// Inner children of one node that wait to be visited.
struct NodeGroup {
    // They are consecutive from here.
    first: u32,
    // Bits 24 to 31: those that wait, the first to visit highest. Bits 0 to 7: which of the node's slots hold inner nodes.
    bits: u32,
}

struct PrimitiveGroup {
    first: u32,
    // Those to be tested, counted from the first.
    bits: u32,
}

alias StackEntry = vec2<u32>;

struct Pending {
    nodes: NodeGroup,
    // How many groups of nodes wait on the stack.
    depth: u32,
    // Primitives that are being tested, and those of the node visited since. While there are any of these, no other node is visited.
    tested: PrimitiveGroup,
    held: PrimitiveGroup,
}

const NODE_BITS: u32 = 0xff000000u;

fn nothing_pending() -> Pending {
    return Pending(NodeGroup(0u, 0u), 0u, PrimitiveGroup(0u, 0u), PrimitiveGroup(0u, 0u));
}

// A group of the root alone.
fn pending_root() -> Pending {
    return Pending(NodeGroup(0u, 0x80000000u), 0u, PrimitiveGroup(0u, 0u), PrimitiveGroup(0u, 0u));
}

// The stack is empty when the group at hand is.
fn is_pending(pending: Pending) -> bool {
    return ((pending.nodes.bits & NODE_BITS) | pending.tested.bits | pending.held.bits) != 0u;
}

// Distance along one axis to a plane of four children.
fn plane(word: u32, scale: f32, offset: f32) -> vec4<f32> {
    return unpack_bytes(word) * scale + offset;
}

// Bits of the four children that are met, and where they go: nodes by the ray's octant, primitives by their place.
fn child_bits(met: vec4<bool>, meta_word: u32, inner: u32, octant: u32) -> u32 {
    let bytes = (vec4<u32>(meta_word) >> vec4<u32>(0u, 8u, 16u, 24u)) & vec4<u32>(255u);
    let is_inner = (vec4<u32>(inner) & vec4<u32>(1u, 2u, 4u, 8u)) != vec4<u32>(0u);
    let place = (bytes & vec4<u32>(31u)) ^ select(vec4<u32>(0u), vec4<u32>(octant), is_inner);
    let bits = select(vec4<u32>(0u), (bytes >> vec4<u32>(5u)) << place, met);
    return bits.x | bits.y | bits.z | bits.w;
}

// Goes on with the children of a node that are met.
fn visit(node: u32, octant: u32, traversal: ptr<function, Traversal>) {
    let words = node_words(node);
    let n0 = words.w0;
    let n1 = words.w1;
    let n2 = words.w2;
    let n3 = words.w3;
    let n4 = words.w4;
    let inverse_direction = (*traversal).inverse_direction;
    let exponents = vec3<u32>(n0.w, n0.w >> 8u, n0.w >> 16u) & vec3<u32>(255u);
    let scale = bitcast<vec3<f32>>(exponents << vec3<u32>(23u)) * inverse_direction;
    let offset = (bitcast<vec3<f32>>(n0.xyz) - (*traversal).ray.origin) * inverse_direction;

    // The ray's direction says which planes it meets first, for all eight children at once.
    let backward = inverse_direction < vec3<f32>(0.0);
    let near_x = select(n2.xy, n3.zw, backward.x);
    let near_y = select(n2.zw, n4.xy, backward.y);
    let near_z = select(n3.xy, n4.zw, backward.z);
    let far_x = select(n3.zw, n2.xy, backward.x);
    let far_y = select(n4.xy, n2.zw, backward.y);
    let far_z = select(n4.zw, n3.xy, backward.z);
    let t_max = vec4<f32>((*traversal).hit.t);
    let zero = vec4<f32>(0.0);
    let near_0 = larger(
        larger(plane(near_x.x, scale.x, offset.x), plane(near_y.x, scale.y, offset.y)),
        larger(plane(near_z.x, scale.z, offset.z), zero)
    );
    let far_0 = smaller(
        smaller(plane(far_x.x, scale.x, offset.x), plane(far_y.x, scale.y, offset.y)),
        smaller(plane(far_z.x, scale.z, offset.z), t_max)
    );
    let near_1 = larger(
        larger(plane(near_x.y, scale.x, offset.x), plane(near_y.y, scale.y, offset.y)),
        larger(plane(near_z.y, scale.z, offset.z), zero)
    );
    let far_1 = smaller(
        smaller(plane(far_x.y, scale.x, offset.x), plane(far_y.y, scale.y, offset.y)),
        smaller(plane(far_z.y, scale.z, offset.z), t_max)
    );
    let inner = n0.w >> 24u;
    let bits = child_bits(near_0 <= far_0 * WIDER, n1.z, inner, octant) |
        child_bits(near_1 <= far_1 * WIDER, n1.w, inner >> 4u, octant);
    (*traversal).pending.nodes = NodeGroup(n1.x, (bits & NODE_BITS) | inner);
    (*traversal).pending.held = PrimitiveGroup(n1.y, bits & ~NODE_BITS);
}

// Visits one node, in the order of the ray's octant, and tests one primitive of a node visited before. Lanes that run together pay for
// both anyway.
fn step_closest(traversal: ptr<function, Traversal>, stack: ptr<function, array<StackEntry, STACK_SIZE>>) {
    let group = (*traversal).pending.nodes;
    if (*traversal).pending.held.bits == 0u && (group.bits & NODE_BITS) != 0u {
        let backward = (*traversal).inverse_direction < vec3<f32>(0.0);
        let octant = select(4u, 0u, backward.x) | select(2u, 0u, backward.y) | select(1u, 0u, backward.z);
        let next = firstLeadingBit(group.bits);
        let slot = (next - 24u) ^ octant;
        let node = group.first + countOneBits(group.bits & ((1u << slot) - 1u));
        let others = group.bits & ~(1u << next);
        // Written and then kept where there are others: that costs less than a branch that depends on the ray.
        var depth = (*traversal).pending.depth;
        (*stack)[depth] = vec2<u32>(group.first, others);
        depth += select(0u, 1u, (others & NODE_BITS) != 0u);
        visit(node, octant, traversal);
        if ((*traversal).pending.nodes.bits & NODE_BITS) == 0u && depth != 0u {
            depth--;
            let waiting = (*stack)[depth];
            (*traversal).pending.nodes = NodeGroup(waiting.x, waiting.y);
        }
        (*traversal).pending.depth = depth;
    }
    if (*traversal).pending.tested.bits == 0u {
        (*traversal).pending.tested = (*traversal).pending.held;
        (*traversal).pending.held.bits = 0u;
    }
    let tested = (*traversal).pending.tested;
    if tested.bits != 0u {
        test_primitive(traversal, tested.first + firstTrailingBit(tested.bits));
        (*traversal).pending.tested.bits = tested.bits & (tested.bits - 1u);
    }
}
