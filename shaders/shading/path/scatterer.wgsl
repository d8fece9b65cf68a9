// Scattering at a surface: its BSDF, and the guide where paths are guided; with the shadowing term of mapped
// normals.
#import shading/material/bsdf.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl
#import shading/path/guide.wgsl
#import shading/path/guided.wgsl
#import shading/texture/normal_shadowing.wgsl

struct Scatterer {
    bsdf: Bsdf,
#if GUIDE
    guide: GuideCell,
#endif
}

// `choice` picks a part of a blend where one is picked.
fn load_scatterer(surface: Surface, wo: vec3<f32>, choice: f32) -> Scatterer {
    let bsdf = load_bsdf(surface, wo, choice);
    if HAS_GUIDE {
        return Scatterer(bsdf, guide_at(surface, guided_probability(bsdf)));
    } else {
        return Scatterer(bsdf);
    }
}

// The non-delta lobes' f |cos|, and the density with which wi is drawn.
fn evaluate_scatterer(scatterer: Scatterer, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
#if GUIDE
    var value = evaluate_guided(scatterer.guide, scatterer.bsdf, surface, wo, wi);
#else
    var value = evaluate_bsdf(scatterer.bsdf, surface, wo, wi);
#endif
    if HAS_NORMAL_SHADOWING {
        value.value *= normal_shadowing(surface.unbent_normal, surface.shading_normal, wi);
    }
    return value;
}

// The value towards a light, if one is sampled, and a drawn direction: `choice` chooses the lobe, `u` and `v` the direction.
fn scatter_by(
    scatterer: Scatterer, surface: Surface, wo: vec3<f32>, samples_light: bool, light_wi: vec3<f32>, choice: f32, u: f32, v: f32
) -> Scattering {
    if HAS_GUIDE {
        return scatter_guided(scatterer.guide, scatterer.bsdf, surface, wo, samples_light, light_wi, choice, u, v);
    } else {
        return scatter(scatterer.bsdf, surface, wo, samples_light, light_wi, choice, u, v);
    }
}
