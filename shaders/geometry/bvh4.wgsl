// A four-wide hierarchy with 8-bit boxes, three vec4<u32> a node (src/packed/bvh4.rs):
//   (origin x, y, z; exponents x, y, z and which children are inner nodes (4 bits) and exist (4 bits))
//   (first inner child; first primitive (24 bits) and leaf sizes less one (2 bits each); low x of 4 children; low y)
//   (low z; high x; high y; high z)
#import core/math.wgsl
#import geometry/records.wgsl

// Entry of a traversal's stack for one child.
// Inner child: node index. Leaf: LEAF | (size - 1) << 24 | first primitive.
const LEAF: u32 = 0x80000000u;
// No entry is left. No leaf has this entry: its size would be above any.
const FINISHED: u32 = 0xffffffffu;

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

// Distances at which the ray enters the children's boxes; INFINITY_DISTANCE where it misses one. Those of children that do not exist
// mean nothing.
fn entry_distances(words: NodeWords, origin: vec3<f32>, inverse_direction: vec3<f32>, t_max: f32) -> vec4<f32> {
    let n0 = words.w0;
    let n1 = words.w1;
    let n2 = words.w2;
    let exponents = vec3<u32>(n0.w, n0.w >> 8u, n0.w >> 16u) & vec3<u32>(255u);
    let scale = bitcast<vec3<f32>>(exponents << vec3<u32>(23u)) * inverse_direction;
    let offset = (bitcast<vec3<f32>>(n0.xyz) - origin) * inverse_direction;

    // The ray's direction says which planes it meets first, for all four children at once.
    let backward = inverse_direction < vec3<f32>(0.0);
    let low = vec3<u32>(n1.z, n1.w, n2.x);
    let near_words = select(low, n2.yzw, backward);
    let far_words = select(n2.yzw, low, backward);
    let limit = t_max * WIDER;
    let far_scale = scale * WIDER;
    let far_offset = offset * WIDER;
    let plane = larger(
        larger(unpack_bytes(near_words.x) * scale.x + offset.x, unpack_bytes(near_words.y) * scale.y + offset.y),
        unpack_bytes(near_words.z) * scale.z + offset.z
    );
    // Not below 0, by the bits: of a comparison with the constant 0 compilers make operations on masks, which take longer than a maximum.
    let near = bitcast<vec4<f32>>(max(bitcast<vec4<i32>>(plane), vec4<i32>(0)));
    let far = smaller(
        smaller(unpack_bytes(far_words.x) * far_scale.x + far_offset.x, unpack_bytes(far_words.y) * far_scale.y + far_offset.y),
        smaller(vec4<f32>(limit), unpack_bytes(far_words.z) * far_scale.z + far_offset.z)
    );
    return select(vec4<f32>(INFINITY_DISTANCE), near, near <= far);
}

// Which children there are, a bit each.
fn existing_children(words: NodeWords) -> u32 {
    return words.w0.w >> 28u;
}

// Entries of a traversal's stack for the four children.
fn child_entries(words: NodeWords) -> vec4<u32> {
    let flags = words.w0.w >> 24u;
    let inner = (vec4<u32>(flags) & vec4<u32>(1u, 2u, 4u, 8u)) != vec4<u32>(0u);
    let inner_rank = vec4<u32>(0u, flags & 1u, countOneBits(flags & 3u), countOneBits(flags & 7u));
    let sizes = (vec4<u32>(words.w1.y >> 24u) >> vec4<u32>(0u, 2u, 4u, 6u)) & vec4<u32>(3u);
    let counts = select(sizes + 1u, vec4<u32>(0u), inner);
    let starts = vec4<u32>(0u, counts.x, counts.x + counts.y, counts.x + counts.y + counts.z) + (words.w1.y & 0x00ffffffu);
    let leaf_entry = starts | (sizes << vec4<u32>(24u)) | vec4<u32>(LEAF);
    return select(leaf_entry, inner_rank + words.w1.x, inner);
}

// One of them, an inner child as the index of its first word. An inner child's leaf size is 0, and counts no primitive.
fn child_entry(words: NodeWords, child: u32) -> u32 {
    let flags = words.w0.w >> 24u;
    let inner_before = countOneBits(flags & ((1u << child) - 1u));
    let sizes = words.w1.y >> 24u;
    let before = sizes & ((1u << (2u * child)) - 1u);
    let start = (words.w1.y & 0x00ffffffu) + (child - inner_before) + (before & 3u) + ((before >> 2u) & 3u) + (before >> 4u);
    let leaf_entry = start | (((sizes >> (2u * child)) & 3u) << 24u) | LEAF;
    return select(leaf_entry, first_word_of_node(inner_before + words.w1.x), ((flags >> child) & 1u) != 0u);
}
