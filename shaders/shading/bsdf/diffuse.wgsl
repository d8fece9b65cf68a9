// The diffuse lobe.
#import core/math.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn diffuse_is_non_delta(lobe: Lobe) -> bool {
    return max_component(lobe.color0) > 0.0;
}

fn diffuse_sampling_weight(lobe: Lobe) -> f32 {
    return max_component(lobe.color0);
}

fn evaluate_diffuse(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    return evaluate_lambert(lobe.color0, surface, wi);
}

fn sample_diffuse(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    return sample_lambert(lobe.color0, surface, u, v);
}

// The diffuse lobe by its reflectance: those of a mixture are evaluated together.
fn evaluate_lambert(reflectance: Spectrum, surface: Surface, wi: vec3<f32>) -> BsdfValue {
    if !on_wo_side(surface, wi) {
        return no_value();
    }
    let cosine = dot(wi, surface.shading_normal);
    return BsdfValue(reflectance * (cosine * INVERSE_PI), hemisphere_pdf(cosine));
}

fn sample_lambert(reflectance: Spectrum, surface: Surface, u: f32, v: f32) -> BsdfSample {
    let direction = sample_hemisphere(surface, u, v);
    let wi = direction.xyz;
    let cosine = direction.w;
    if cosine <= 0.0 || dot(wi, surface.facing_normal) <= 0.0 {
        return no_sample();
    }
    let weight = reflectance * hemisphere_weight(cosine);
    return BsdfSample(wi, weight, hemisphere_pdf(cosine), 1.0, false);
}
