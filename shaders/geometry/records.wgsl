// The arrays of primitives, nodes, attributes and instances, and how a record of each is loaded: from one binding, or, where the array is larger than
// a binding may be, from the one of several that holds it (src/plan/chunks.rs writes those loads).
#import core/layout.wgsl
#export geometry/words.wgsl

#if PRIMITIVE_CHUNKS
#export geometry/primitive_chunks.wgsl
#else
#if UNIFORM_PRIMITIVES
@group(0) @binding(BINDING_PRIMITIVES) var<uniform> primitives: array<vec4<f32>, PRIMITIVE_WORDS>;
#else
@group(0) @binding(BINDING_PRIMITIVES) var<storage, read> primitives: array<vec4<f32>>;
#endif

fn primitive_words(index: u32) -> PrimitiveWords {
    let first = index * PRIMITIVE_RECORD_WORDS;
    return PrimitiveWords(primitives[first], primitives[first + 1u], primitives[first + 2u]);
}

// One of a record's words.
fn primitive_word(index: u32, word: u32) -> vec4<f32> {
    return primitives[index * PRIMITIVE_RECORD_WORDS + word];
}
#endif

#if BVH
#if NODE_CHUNKS
#export geometry/node_chunks.wgsl
#else
#if UNIFORM_NODES
@group(0) @binding(BINDING_NODES) var<uniform> nodes: array<vec4<u32>, NODE_WORDS>;
#else
@group(0) @binding(BINDING_NODES) var<storage, read> nodes: array<vec4<u32>>;
#endif

fn node_words(index: u32) -> NodeWords {
    let first = index * NODE_RECORD_WORDS;
    return NodeWords(nodes[first], nodes[first + 1u], nodes[first + 2u]);
}
#endif

#if PACKETS
// Index of a node's first word, computed early so that the traversal multiplies nothing; and one of its
// words.
#if NODE_CHUNKS
fn first_word_of_node(index: u32) -> u32 {
    return index;
}

fn node_word_at(first: u32, word: u32) -> vec4<u32> {
    return node_word(first, word);
}
#else
fn first_word_of_node(index: u32) -> u32 {
    return index * NODE_RECORD_WORDS;
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
@group(0) @binding(BINDING_ATTRIBUTES) var<storage, read> attributes: array<vec4<f32>>;

fn attribute_words(index: u32) -> AttributeWords {
    let first = index * ATTRIBUTE_RECORD_WORDS;
    return AttributeWords(attributes[first], attributes[first + 1u], attributes[first + 2u], attributes[first + 3u]);
}
#endif
#endif

#if INSTANCES
#if INSTANCE_CHUNKS
#export geometry/instance_chunks.wgsl
#else
@group(0) @binding(BINDING_INSTANCES) var<storage, read> instances: array<vec4<f32>>;

fn instance_words(index: u32) -> InstanceWords {
    let first = index * INSTANCE_RECORD_WORDS;
    return InstanceWords(
        instances[first], instances[first + 1u], instances[first + 2u], instances[first + 3u], instances[first + 4u], instances[first + 5u]
    );
}

// One of a record's words.
fn instance_word(index: u32, word: u32) -> vec4<f32> {
    return instances[index * INSTANCE_RECORD_WORDS + word];
}
#endif
#endif
