// What a surface does to light, whatever its material is made of: load, evaluate, sample.
#if MIXTURE
#import shading/mixture.wgsl
#else
#if BLENDS
#import shading/blend.wgsl
#endif
#import shading/leaf.wgsl

// The material is a single leaf, by itself or because one was picked.
struct Bsdf {
    leaf: Leaf,
}

#if PICK
// One leaf per hit, chosen with its weight as probability; from then on it is the whole material.
fn pick_leaf(surface: Surface, wo: vec3<f32>, choice: f32) -> u32 {
    let cosine = clamp(dot(wo, surface.shading_normal), 0.0, 1.0);
    let run = leaf_run(surface.material);
    var below = 0.0;
    var chosen = run.material;
    for (var index = 0u; index < run.count; index++) {
        let leaf = weighted_leaf(run, index, cosine, surface.uv);
        if leaf.weight > 0.0 {
            // The last leaf of any weight takes what rounding leaves over.
            chosen = leaf.material;
            below += leaf.weight;
            if choice < below {
                break;
            }
        }
    }
    return chosen;
}

fn load_bsdf(surface: Surface, wo: vec3<f32>, choice: f32) -> Bsdf {
    return Bsdf(load_leaf(pick_leaf(surface, wo, choice), surface.uv));
}
#else
fn load_bsdf(surface: Surface, wo: vec3<f32>, choice: f32) -> Bsdf {
    return Bsdf(load_leaf(surface.material, surface.uv));
}
#endif

#if !BLENDS
// Radiance that a material sends out at an angle of the given cosine with its normal.
fn material_emission(material: u32, cosine: f32, front: bool, uv: vec2<f32>) -> vec3<f32> {
    return leaf_emission(material, front, uv);
}
#endif

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
