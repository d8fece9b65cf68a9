// Oren and Nayar's whole model: src/reference/bsdf/oren_nayar.rs is the same in f64.
#import core/math.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/microfacet/rough_diffuse.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl

fn oren_nayar_is_non_delta(lobe: Lobe) -> bool {
    return max_component(lobe.color0) > 0.0;
}

fn oren_nayar_sampling_weight(lobe: Lobe) -> f32 {
    return max_component(lobe.color0);
}

fn oren_nayar_f(lobe: Lobe, directions: Directions) -> Spectrum {
    let sigma2 = lobe.roughness * lobe.roughness;
    // α and β, the larger and the smaller of both angles.
    let cos_a = min(directions.cos_o, directions.cos_i);
    let cos_b = max(directions.cos_o, directions.cos_i);
    let sin_a = sine_of_cosine(cos_a);
    let sin_b = sine_of_cosine(cos_b);
    let product = sin_a * sin_b;
    let cos_phi = select(0.0, clamp(directions.side_by_side / product, -1.0, 1.0), product > 0.0);
    let alpha = 4.0 * atan2_turns(sin_a, cos_a);
    let beta = 4.0 * atan2_turns(sin_b, cos_b);
    let away = select(0.0, beta * beta * beta, cos_phi < 0.0);
    let spread = sigma2 / (sigma2 + 0.09);
    let c1 = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
    let c2 = 0.45 * spread * (sin_a - away);
    let c3 = 0.125 * spread * (alpha * beta) * (alpha * beta);
    let tangent_of_half = (sin_a + sin_b) / (cos_a + cos_b);
    let once = c1 + cos_phi * c2 * sin_b / cos_b + (1.0 - abs(cos_phi)) * c3 * tangent_of_half;
    let twice = 0.17 * sigma2 / (sigma2 + 0.13) * (1.0 - cos_phi * beta * beta);
    return lobe.color0 * ((once + lobe.color0 * twice) * INVERSE_PI);
}

fn evaluate_oren_nayar(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let directions = directions_above(surface, wo, wi);
    if !directions.reflects {
        return no_value();
    }
    return rough_diffuse_value(directions, oren_nayar_f(lobe, directions));
}

fn sample_oren_nayar(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let wi = sample_hemisphere(surface, u, v).xyz;
    return from_value(wi, evaluate_oren_nayar(lobe, surface, wo, wi), 1.0);
}
