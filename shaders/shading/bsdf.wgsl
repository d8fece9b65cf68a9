// What a surface does to light, whatever its material is made of: load, evaluate, sample.
#if BLENDS
#import shading/blend.wgsl
#else
#import shading/leaf.wgsl

// Every material of the scene is a single leaf.
struct Bsdf {
    leaf: Leaf,
}

fn load_bsdf(surface: Surface, wo: vec3<f32>, choice: f32) -> Bsdf {
    return Bsdf(load_leaf(surface.material, surface.uv));
}

// Radiance that a material sends out at an angle of the given cosine with its normal.
fn material_emission(material: u32, cosine: f32, front: bool, uv: vec2<f32>) -> vec3<f32> {
    return leaf_emission(material, front, uv);
}

// Whether light sampling can contribute: some lobe is not a delta, and not black.
fn has_smooth_lobe(bsdf: Bsdf) -> bool {
    return leaf_is_smooth(bsdf.leaf);
}

fn evaluate_bsdf(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    return evaluate_leaf(bsdf.leaf, surface, wo, wi);
}

fn sample_bsdf(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, lobe: f32, u: f32, v: f32) -> BsdfSample {
    return sample_leaf(bsdf.leaf, surface, wo, lobe, u, v);
}
#endif
