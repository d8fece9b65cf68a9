// The scene's arrays. Small scenes keep them in uniform buffers, the rest in storage buffers; the plan says which.

// Tables, vec4s: materials, then lights, then textures (src/packed/tables.rs).
#if UNIFORM_TABLES
@group(0) @binding(5) var<uniform> tables: array<vec4<f32>, TABLE_WORDS>;
#else
@group(0) @binding(5) var<storage, read> tables: array<vec4<f32>>;
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
