// A cosine-power lobe about the mirror direction.
#import core/math.wgsl
#import shading/microfacet/phong_lobe.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn glossy_is_non_delta(lobe: Lobe) -> bool {
    return true;
}

fn glossy_sampling_weight(lobe: Lobe) -> f32 {
    return max_component(lobe.color0);
}

// f = ρ (n+2)/(2π) cosⁿα
fn evaluate_glossy(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    if !on_wo_side(surface, wi) {
        return no_value();
    }
    let about = phong_lobe(surface, wo, lobe.roughness, wi);
    return BsdfValue(lobe.color0 * about.value, about.pdf);
}

fn sample_glossy(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let wi = sample_phong_lobe(surface, wo, lobe.roughness, u, v);
    return from_value(wi, evaluate_glossy(lobe, surface, wo, wi), 1.0);
}
