// Rough glass after Honsdorf: cosine-power lobes about the mirrored and the refracted direction.
#import shading/microfacet/cosine_power.wgsl
#import shading/microfacet/dielectric.wgsl
#import shading/microfacet/fresnel.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn phong_glass_is_non_delta(lobe: Lobe) -> bool {
    return true;
}

fn phong_glass_sampling_weight(lobe: Lobe) -> f32 {
    return dielectric_sampling_weight(lobe);
}

fn evaluate_phong_glass(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let n = surface.shading_normal;
    let eta = relative_ior(lobe, surface);
    let split = dielectric_split(lobe, fresnel_dielectric(min(dot(wo, n), 1.0), eta));
    if on_wo_side(surface, wi) {
        let spread = cosine_power_pdf(mirrored(surface, wo), lobe.roughness, wi);
        return BsdfValue(lobe.color0 * (split.fresnel.reflected * spread), split.choose_reflection * spread);
    }
    if split.fresnel.transmitted > 0.0 && on_far_side(surface, wi) {
        let spread = cosine_power_pdf(refracted(n, wo, eta), lobe.roughness, wi);
        return BsdfValue(lobe.color1 * (split.fresnel.transmitted * spread / (eta * eta)), split.choose_transmission * spread);
    }
    return no_value();
}

fn sample_phong_glass(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let eta = relative_ior(lobe, surface);
    let split = dielectric_split(lobe, fresnel_dielectric(min(dot(wo, surface.shading_normal), 1.0), eta));
    let reflects = choice < split.choose_reflection;
    var axis = mirrored(surface, wo);
    if !reflects {
        axis = refracted(surface.shading_normal, wo, eta);
    }
    let wi = sample_cosine_power(axis, lobe.roughness, u, v);
    // A direction that strays to the other side would be taken for the other lobe's.
    if reflects != (dot(wi, surface.shading_normal) > 0.0) {
        return no_sample();
    }
    return from_value(wi, evaluate_phong_glass(lobe, surface, wo, wi), select(eta * eta, 1.0, reflects));
}
