// The scene's arrays. Small scenes keep them in uniform buffers, the rest in storage buffers; the plan says which.

// Primitives, three vec4 each (src/flat/primitive.rs):
//   (first point, kind and material), (second, light or NONE), (third, attributes or NONE)
// Tables, vec4s: materials, then lights, then textures (src/flat/tables.rs).
#if UNIFORM_PRIMITIVES
@group(0) @binding(4) var<uniform> primitives: array<vec4<f32>, PRIMITIVE_WORDS>;
#else
@group(0) @binding(4) var<storage, read> primitives: array<vec4<f32>>;
#endif
#if UNIFORM_TABLES
@group(0) @binding(5) var<uniform> tables: array<vec4<f32>, TABLE_WORDS>;
#else
@group(0) @binding(5) var<storage, read> tables: array<vec4<f32>>;
#endif
#if BVH
#if UNIFORM_NODES
@group(0) @binding(6) var<uniform> nodes: array<vec4<u32>, NODE_WORDS>;
#else
@group(0) @binding(6) var<storage, read> nodes: array<vec4<u32>>;
#endif
#endif
#if ATTRIBUTES
// Normals and texture coordinates of triangles, four vec4 each:
//   (n0, u0), (n1, v0), (n2, u1), (v1, u2, v2, motion or NONE)
@group(0) @binding(7) var<storage, read> attributes: array<vec4<f32>>;
#endif
#if TEXELS
@group(0) @binding(8) var<storage, read> texels: array<f32>;
#endif

// A material's words in the tables.
const MATERIAL_WORDS: u32 = 5u;

const KIND_TRIANGLE: u32 = 0u;
const KIND_QUAD: u32 = 1u;
const KIND_SPHERE: u32 = 2u;
const KIND_DISK: u32 = 3u;
const KIND_PLANE: u32 = 4u;

fn primitive_kind(word: f32) -> u32 {
#if MOTION
    return (bitcast<u32>(word) >> 28u) & 7u;
#else
    return bitcast<u32>(word) >> 28u;
#endif
}

fn primitive_material(word: f32) -> u32 {
    return bitcast<u32>(word) & 0x0fffffffu;
}
