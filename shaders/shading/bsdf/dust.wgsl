// A thin layer of dust above a Lambert surface: src/reference/bsdf/dust.rs is the same in f64.
#import core/math.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/microfacet/rough_diffuse.wgsl
#import shading/material/lobe.wgsl
#import shading/material/parameters.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl

fn dust_is_non_delta(lobe: Lobe) -> bool {
    return dust_sampling_weight(lobe) > 0.0;
}

fn dust_sampling_weight(lobe: Lobe) -> f32 {
    let through = exp(-2.0 * lobe.roughness);
    return max_component(lobe.color0 * (0.5 * (1.0 - through)) + lobe.color1 * through);
}

fn dust_f(lobe: Lobe, directions: Directions) -> Spectrum {
    let g = dust_parameters(lobe).anisotropy;
    let cos_o = directions.cos_o;
    let cos_i = directions.cos_i;
    let narrow = 1.0 - abs(g);
    let squared = narrow * narrow + 2.0 * abs(g) * (1.0 + sign(g) * (directions.side_by_side + cos_o * cos_i));
    let phase = narrow * (1.0 + abs(g)) * 0.25 * INVERSE_PI / (squared * sqrt(squared));
    let through = exp(-lobe.roughness * (1.0 / cos_o + 1.0 / cos_i));
    return lobe.color0 * (phase * (1.0 - through) / (cos_o + cos_i)) + lobe.color1 * (INVERSE_PI * through);
}

fn evaluate_dust(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let directions = directions_above(surface, wo, wi);
    if !directions.reflects {
        return no_value();
    }
    return rough_diffuse_value(directions, dust_f(lobe, directions));
}

fn sample_dust(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let wi = sample_hemisphere(surface, u, v).xyz;
    return from_value(wi, evaluate_dust(lobe, surface, wo, wi), 1.0);
}
