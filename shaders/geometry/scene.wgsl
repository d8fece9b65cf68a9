// The scene's arrays. Small scenes keep them in uniform buffers, the rest in storage buffers; the plan says which.
#import core/layout.wgsl

// Tables, vec4s: materials, then lights, then textures (src/packed/tables.rs).
#if UNIFORM_TABLES
@group(0) @binding(BINDING_TABLES) var<uniform> tables: array<vec4<f32>, TABLE_WORDS>;
#else
@group(0) @binding(BINDING_TABLES) var<storage, read> tables: array<vec4<f32>>;
#endif

fn primitive_kind(word: f32) -> u32 {
    if HAS_MOTION {
        return (bitcast<u32>(word) >> 28u) & 7u;
    } else {
        return bitcast<u32>(word) >> 28u;
    }
}

fn primitive_material(word: f32) -> u32 {
    return bitcast<u32>(word) & 0x0fffffffu;
}
