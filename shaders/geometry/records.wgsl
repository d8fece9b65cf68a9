// The arrays of primitives, nodes and attributes, and how a record of each is loaded: from one binding, or, where the array is larger than
// a binding may be, from the one of several that holds it (src/plan/chunks.rs writes those loads).
#export geometry/words.wgsl

#if PRIMITIVE_CHUNKS
#export geometry/primitive_chunks.wgsl
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
#if NODE_CHUNKS
#export geometry/node_chunks.wgsl
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
// Where a node's words begin, so that nothing is left to multiply when the way leads there; and one of them.
#if NODE_CHUNKS
fn first_word_of_node(index: u32) -> u32 {
    return index;
}

fn node_word_at(first: u32, word: u32) -> vec4<u32> {
    return node_word(first, word);
}
#else
fn first_word_of_node(index: u32) -> u32 {
    return index * 3u;
}

fn node_word_at(first: u32, word: u32) -> vec4<u32> {
    return nodes[first + word];
}
#endif
#endif
#endif

#if ATTRIBUTES
#if ATTRIBUTE_CHUNKS
#export geometry/attribute_chunks.wgsl
#else
@group(0) @binding(7) var<storage, read> attributes: array<vec4<f32>>;

fn attribute_words(index: u32) -> AttributeWords {
    return AttributeWords(
        attributes[index * 4u], attributes[index * 4u + 1u], attributes[index * 4u + 2u], attributes[index * 4u + 3u]
    );
}
#endif
#endif
