// A thin plate of glass whose microfacets lie alike on both sides: light that one lets through goes in the
// direction of its reflection, mirrored in the surface.
#import core/math.wgsl
#import shading/microfacet/dielectric.wgsl
#import shading/material/lobe.wgsl
#import shading/material/parameters.wgsl
#import shading/microfacet/microfacet.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn rough_thin_glass_facets(lobe: Lobe) -> Facets {
    return lobe_facets(lobe, rough_thin_glass_parameters(lobe).width_across);
}

fn rough_thin_glass_is_non_delta(lobe: Lobe) -> bool {
    return !facets_are_smooth(rough_thin_glass_facets(lobe));
}

fn rough_thin_glass_sampling_weight(lobe: Lobe) -> f32 {
    return dielectric_sampling_weight(lobe);
}

fn evaluate_rough_thin_glass(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let facets = rough_thin_glass_facets(lobe);
    let reflects = on_wo_side(surface, wi);
    if facets_are_smooth(facets) || (!reflects && !on_far_side(surface, wi)) {
        return no_value();
    }
    let frame = facet_frame(facets, surface);
    let o = to_local(frame, wo);
    let local = to_local(frame, wi);
    let i = vec3<f32>(local.xy, abs(local.z));
    return rough_thin_glass_value(lobe, facets, o, i, normalize(o + i), reflects);
}

// `i` is on wo's side, whether light comes from there or from the other one.
fn rough_thin_glass_value(lobe: Lobe, facets: Facets, o: vec3<f32>, i: vec3<f32>, m: vec3<f32>, reflects: bool) -> BsdfValue {
    let split = dielectric_split(lobe, fresnel_plate(lobe, clamp(dot(o, m), 0.0, 1.0)));
    let lambda_o = facet_lambda(facets, o);
    let common_factor = facet_distribution(facets, m) / (4.0 * o.z);
    let shadowed = common_factor * facet_shadowing(facets, lambda_o, facet_lambda(facets, i));
    let pdf = common_factor / (1.0 + lambda_o);
    if reflects {
        return BsdfValue(lobe.color0 * (split.fresnel.reflected * shadowed), split.choose_reflection * pdf);
    }
    return BsdfValue(lobe.color1 * (split.fresnel.transmitted * shadowed), split.choose_transmission * pdf);
}

fn sample_rough_thin_glass(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let facets = rough_thin_glass_facets(lobe);
    if facets_are_smooth(facets) {
        return sample_delta_plate(lobe, surface, wo, choice);
    }
    let frame = facet_frame(facets, surface);
    let o = to_local(frame, wo);
    let m = sample_visible_normal(facets, o, u, v);
    let split = dielectric_split(lobe, fresnel_plate(lobe, clamp(dot(o, m), 0.0, 1.0)));
    let reflects = choice < split.choose_reflection;
    let i = 2.0 * dot(o, m) * m - o;
    let wi = frame_to_world(frame, vec3<f32>(i.xy, select(-i.z, i.z, reflects)));
    if i.z <= 0.0 || reflects != (dot(wi, surface.facing_normal) > 0.0) {
        return no_sample();
    }
    let value = rough_thin_glass_value(lobe, facets, o, i, m, reflects);
    if value.pdf_solid_angle <= 0.0 {
        return no_sample();
    }
    let masking = facet_shadowing_of_visible(facets, facet_lambda(facets, o), facet_lambda(facets, i));
    if reflects {
        let weight = split.fresnel.reflected / split.choose_reflection * masking;
        return BsdfSample(wi, lobe.color0 * weight, value.pdf_solid_angle, 1.0, false);
    }
    let weight = split.fresnel.transmitted / split.choose_transmission * masking;
    return BsdfSample(wi, lobe.color1 * weight, value.pdf_solid_angle, 1.0, false);
}
