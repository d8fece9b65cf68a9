// The texels of images and maps, as words of 32 bits; the plan cuts what is larger than a binding may be (src/plan/chunks.rs).
#import core/layout.wgsl

#if TEXEL_CHUNKS
#export geometry/texel_chunks.wgsl
#else
@group(0) @binding(BINDING_TEXELS) var<storage, read> texels: array<u32>;

fn texel_word(index: u32) -> u32 {
    return texels[index];
}
#endif

fn texel_float(index: u32) -> f32 {
    return bitcast<f32>(texel_word(index));
}
