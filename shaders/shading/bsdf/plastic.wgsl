// Plastic with a smooth surface: a direction that the boundary reflects, and a diffuse base.
#import shading/microfacet/fresnel.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/material/lobe.wgsl
#import shading/material/parameters.wgsl
#import shading/microfacet/plastic.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn plastic_is_non_delta(lobe: Lobe) -> bool {
    return plastic_is_bright(lobe);
}

fn plastic_sampling_weight(lobe: Lobe) -> f32 {
    return plastic_weight(lobe);
}

// The base alone: the mirror direction is the boundary's.
fn evaluate_plastic(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    if !on_wo_side(surface, wi) {
        return no_value();
    }
    let cosine = dot(wi, surface.shading_normal);
    let fresnel_o = fresnel_dielectric(min(dot(wo, surface.shading_normal), 1.0), lobe.ior);
    let fresnel_i = fresnel_dielectric(min(cosine, 1.0), lobe.ior);
    let internal_reflectance = plastic_parameters(lobe).internal_reflectance;
    return BsdfValue(
        plastic_base(lobe, internal_reflectance, fresnel_o.transmitted, fresnel_i.transmitted) * cosine,
        (1.0 - plastic_specular_share(lobe, fresnel_o.reflected)) * hemisphere_pdf(cosine)
    );
}

fn sample_plastic(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let reflected = fresnel_dielectric(min(dot(wo, surface.shading_normal), 1.0), lobe.ior).reflected;
    let probability = plastic_specular_share(lobe, reflected);
    if choice < probability {
        let wi = mirrored(surface, wo);
        if dot(wi, surface.facing_normal) <= 0.0 {
            return no_sample();
        }
        return BsdfSample(wi, lobe.color1 * (reflected / probability), -1.0, 1.0, false);
    }
    let wi = sample_hemisphere(surface, u, v).xyz;
    return from_value(wi, evaluate_plastic(lobe, surface, wo, wi), 1.0);
}
