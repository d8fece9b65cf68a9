// Fujii's form of Oren and Nayar's model, with the light given back that it loses: src/reference/bsdf/energy_preserving_oren_nayar.rs is the same in f64.
#import core/math.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/microfacet/rough_diffuse.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl

fn energy_preserving_oren_nayar_is_non_delta(lobe: Lobe) -> bool {
    return max_component(lobe.color0) > 0.0;
}

fn energy_preserving_oren_nayar_sampling_weight(lobe: Lobe) -> f32 {
    return max_component(lobe.color0);
}

// ½ − 2/(3π) and 2/3 − 28/(15π).
const LOST_AT_NORMAL: f32 = 0.28779340921080645;
const LESS_ON_AVERAGE: f32 = 0.07248821249692462;

// The light that white facets lose, seen from an angle, over A·σ.
fn lost_by_facets(cosine: f32) -> f32 {
    let sine = sine_of_cosine(cosine);
    let angle = TWO_PI * atan2_turns(sine, cosine);
    let gain = sine * (angle - sine * cosine)
        + 0.6666667 * sine * (cosine * (1.0 + sine + sine * sine) / (1.0 + sine) - 1.0);
    return LOST_AT_NORMAL - gain * INVERSE_PI;
}

fn energy_preserving_oren_nayar_f(lobe: Lobe, directions: Directions) -> Spectrum {
    let sigma = lobe.roughness;
    let a = 1.0 / (1.0 + LOST_AT_NORMAL * sigma);
    let s = directions.side_by_side;
    let once = a * (1.0 + sigma * select(s, sine_times_tangent(directions), s > 0.0));
    let lost_on_average = a * sigma * (LOST_AT_NORMAL - LESS_ON_AVERAGE);
    let again = lobe.color0 * (1.0 - lost_on_average) / (WHITE - lobe.color0 * lost_on_average);
    let both = lost_by_facets(directions.cos_o) * lost_by_facets(directions.cos_i) / (LOST_AT_NORMAL - LESS_ON_AVERAGE);
    return lobe.color0 * ((once + again * (a * sigma * both)) * INVERSE_PI);
}

fn evaluate_energy_preserving_oren_nayar(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let directions = directions_above(surface, wo, wi);
    if !directions.reflects {
        return no_value();
    }
    return rough_diffuse_value(directions, energy_preserving_oren_nayar_f(lobe, directions));
}

fn sample_energy_preserving_oren_nayar(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let wi = sample_hemisphere(surface, u, v).xyz;
    return from_value(wi, evaluate_energy_preserving_oren_nayar(lobe, surface, wo, wi), 1.0);
}
