// The arrays of primitives, nodes and attributes, and how a record of each is loaded: from one binding, or, where the array is larger than
// a binding may be, from the one of several that holds it (src/plan/chunks.rs writes those loads).

// (first point, kind and material), (second, light or NONE), (third, attributes or NONE); src/packed/primitive.rs.
struct PrimitiveWords {
    w0: vec4<f32>,
    w1: vec4<f32>,
    w2: vec4<f32>,
}

#if PRIMITIVE_CHUNKS
#import geometry/primitive_chunks.wgsl
#else
#if UNIFORM_PRIMITIVES
@group(0) @binding(4) var<uniform> primitives: array<vec4<f32>, PRIMITIVE_WORDS>;
#else
@group(0) @binding(4) var<storage, read> primitives: array<vec4<f32>>;
#endif

fn primitive_words(index: u32) -> PrimitiveWords {
    return PrimitiveWords(primitives[index * 3u], primitives[index * 3u + 1u], primitives[index * 3u + 2u]);
}

// One of a record's words.
fn primitive_word(index: u32, word: u32) -> vec4<f32> {
    return primitives[index * 3u + word];
}
#endif

#if BVH
// src/packed/bvh4.rs.
struct NodeWords {
    w0: vec4<u32>,
    w1: vec4<u32>,
    w2: vec4<u32>,
}

#if NODE_CHUNKS
#import geometry/node_chunks.wgsl
#else
#if UNIFORM_NODES
@group(0) @binding(6) var<uniform> nodes: array<vec4<u32>, NODE_WORDS>;
#else
@group(0) @binding(6) var<storage, read> nodes: array<vec4<u32>>;
#endif

fn node_words(index: u32) -> NodeWords {
    let first = index * 3u;
    return NodeWords(nodes[first], nodes[first + 1u], nodes[first + 2u]);
}
#endif

#if PACKETS
// Where a node's words stand, so that nothing is left to multiply when the way leads there; and one of them.
#if NODE_CHUNKS
fn node_place(index: u32) -> u32 {
    return index;
}

fn node_word_at(place: u32, word: u32) -> vec4<u32> {
    return node_word(place, word);
}
#else
fn node_place(index: u32) -> u32 {
    return index * 3u;
}

fn node_word_at(place: u32, word: u32) -> vec4<u32> {
    return nodes[place + word];
}
#endif
#endif
#endif

#if ATTRIBUTES
// Normals and texture coordinates of triangles: (n0, u0), (n1, v0), (n2, u1), (v1, u2, v2, motion or NONE).
struct AttributeWords {
    w0: vec4<f32>,
    w1: vec4<f32>,
    w2: vec4<f32>,
    w3: vec4<f32>,
}

#if ATTRIBUTE_CHUNKS
#import geometry/attribute_chunks.wgsl
#else
@group(0) @binding(7) var<storage, read> attributes: array<vec4<f32>>;

fn attribute_words(index: u32) -> AttributeWords {
    return AttributeWords(
        attributes[index * 4u], attributes[index * 4u + 1u], attributes[index * 4u + 2u], attributes[index * 4u + 3u]
    );
}
#endif
#endif
