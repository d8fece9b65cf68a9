// The words, 16 bytes each, that one load of a record brings. src/plan/chunks.rs writes loads of the same
// kind.

// (first point, kind and material), (second, light or NONE), (third, attributes or NONE); src/packed/primitive.rs.
struct PrimitiveWords {
    w0: vec4<f32>,
    w1: vec4<f32>,
    w2: vec4<f32>,
}

// src/packed/bvh4.rs.
struct NodeWords {
    w0: vec4<u32>,
    w1: vec4<u32>,
    w2: vec4<u32>,
}

// Normals and texture coordinates of triangles: (n0, u0), (n1, v0), (n2, u1), (v1, u2, v2, motion or NONE).
struct AttributeWords {
    w0: vec4<f32>,
    w1: vec4<f32>,
    w2: vec4<f32>,
    w3: vec4<f32>,
}

// A group in a place: (row of the inverse, root and whether it is mirrored), (row, material or NONE), (row, motion or NONE), then rows of the
// linear part, each with a coordinate of the place; src/packed/instance.rs.
struct InstanceWords {
    w0: vec4<f32>,
    w1: vec4<f32>,
    w2: vec4<f32>,
    w3: vec4<f32>,
    w4: vec4<f32>,
    w5: vec4<f32>,
}
