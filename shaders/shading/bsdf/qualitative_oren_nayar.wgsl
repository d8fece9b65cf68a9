// Oren and Nayar's simpler model: src/reference/bsdf/qualitative_oren_nayar.rs is the same in f64.
#import core/math.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/microfacet/rough_diffuse.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl

fn qualitative_oren_nayar_is_non_delta(lobe: Lobe) -> bool {
    return max_component(lobe.color0) > 0.0;
}

fn qualitative_oren_nayar_sampling_weight(lobe: Lobe) -> f32 {
    return max_component(lobe.color0);
}

fn qualitative_oren_nayar_f(lobe: Lobe, directions: Directions) -> Spectrum {
    let sigma2 = lobe.roughness * lobe.roughness;
    let a = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
    let b = 0.45 * sigma2 / (sigma2 + 0.09);
    return lobe.color0 * (INVERSE_PI * (a + b * max(sine_times_tangent(directions), 0.0)));
}

fn evaluate_qualitative_oren_nayar(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let directions = directions_above(surface, wo, wi);
    if !directions.reflects {
        return no_value();
    }
    return rough_diffuse_value(directions, qualitative_oren_nayar_f(lobe, directions));
}

fn sample_qualitative_oren_nayar(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let wi = sample_hemisphere(surface, u, v).xyz;
    return from_value(wi, evaluate_qualitative_oren_nayar(lobe, surface, wo, wi), 1.0);
}
