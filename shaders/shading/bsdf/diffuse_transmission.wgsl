// A sheet that Lambert's law holds for on both sides; color0 is scattered back and color1 on.
#import core/math.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

// The colours of a sheet, which together are at most 1, and the probability of sampling wo's side.
struct DiffuseSides {
    back: Spectrum,
    on: Spectrum,
    choose_back: f32,
}

fn diffuse_sides(lobe: Lobe) -> DiffuseSides {
    let sum = max(lobe.color0 + lobe.color1, WHITE);
    let back = lobe.color0 / sum;
    let on = lobe.color1 / sum;
    return DiffuseSides(back, on, max_component(back) / max(max_component(back) + max_component(on), 1.0e-30));
}

fn diffuse_transmission_is_non_delta(lobe: Lobe) -> bool {
    return max(max_component(lobe.color0), max_component(lobe.color1)) > 0.0;
}

fn diffuse_transmission_sampling_weight(lobe: Lobe) -> f32 {
    let sides = diffuse_sides(lobe);
    return max_component(sides.back + sides.on);
}

fn evaluate_diffuse_transmission(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let is_back = on_wo_side(surface, wi);
    if !is_back && !on_far_side(surface, wi) {
        return no_value();
    }
    let sides = diffuse_sides(lobe);
    let cosine = abs(dot(wi, surface.shading_normal));
    let probability = select(1.0 - sides.choose_back, sides.choose_back, is_back);
    return BsdfValue(select(sides.on, sides.back, is_back) * (cosine * INVERSE_PI), probability * hemisphere_pdf(cosine));
}

fn sample_diffuse_transmission(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let sides = diffuse_sides(lobe);
    let direction = sample_hemisphere(surface, u, v);
    let cosine = direction.w;
    let is_back = choice < sides.choose_back;
    let wi = select(direction.xyz - 2.0 * cosine * surface.shading_normal, direction.xyz, is_back);
    if cosine <= 0.0 || (dot(wi, surface.facing_normal) > 0.0) != is_back {
        return no_sample();
    }
    let probability = select(1.0 - sides.choose_back, sides.choose_back, is_back);
    let weight = select(sides.on, sides.back, is_back) * (hemisphere_weight(cosine) / probability);
    return BsdfSample(wi, weight, probability * hemisphere_pdf(cosine), 1.0, false);
}
