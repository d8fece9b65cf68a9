// Rough glass of microfacets.
#import core/math.wgsl
#import shading/microfacet/dielectric.wgsl
#import shading/microfacet/fresnel.wgsl
#import shading/material/lobe.wgsl
#import shading/material/parameters.wgsl
#import shading/microfacet/microfacet.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn rough_glass_facets(lobe: Lobe) -> Facets {
    return lobe_facets(lobe, rough_glass_parameters(lobe).width_across);
}

fn rough_glass_is_non_delta(lobe: Lobe) -> bool {
    return !facets_are_smooth(rough_glass_facets(lobe));
}

fn rough_glass_sampling_weight(lobe: Lobe) -> f32 {
    return dielectric_sampling_weight(lobe);
}

// Both lobes by the side of wi. The refraction's half vector lies along wo + eta wi; its Jacobian is Walter
// et al. 2007, equation 17 with eta = transmitted over incident: |wi·m| / (wi·m + wo·m / eta)². Radiance is
// scaled by 1 / eta².
fn evaluate_rough_glass(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let facets = rough_glass_facets(lobe);
    if facets_are_smooth(facets) {
        return no_value();
    }
    let reflects = on_wo_side(surface, wi);
    if !reflects && !on_far_side(surface, wi) {
        return no_value();
    }
    let frame = facet_frame(facets, surface);
    let o = to_local(frame, wo);
    let i = to_local(frame, wi);
    let eta = relative_ior(lobe, surface);
    var m = normalize(o + select(eta, 1.0, reflects) * i);
    m = select(-m, m, m.z > 0.0);
    return rough_glass_value(lobe, facets, o, i, m, eta, reflects);
}

fn rough_glass_value(lobe: Lobe, facets: Facets, o: vec3<f32>, i: vec3<f32>, m: vec3<f32>, eta: f32, reflects: bool) -> BsdfValue {
    let o_m = dot(o, m);
    let i_m = dot(i, m);
    // Facets that wo or wi sees from behind do not connect them.
    if o_m <= 0.0 || (i_m > 0.0) != reflects {
        return no_value();
    }
    let split = dielectric_split(lobe, fresnel_dielectric(min(o_m, 1.0), eta));
    let lambda_o = facet_lambda(facets, o);
    let visible = facet_distribution(facets, m) * o_m / o.z;
    let shadowing = facet_shadowing(facets, lambda_o, facet_lambda(facets, i));
    let pdf_m = visible / (1.0 + lambda_o);
    if reflects {
        let jacobian = 1.0 / (4.0 * o_m);
        return BsdfValue(lobe.color0 * (split.fresnel.reflected * visible * shadowing * jacobian), split.choose_reflection * pdf_m * jacobian);
    }
    let refraction = i_m + o_m / eta;
    let jacobian = -i_m / (refraction * refraction);
    return BsdfValue(
        lobe.color1 * (split.fresnel.transmitted * visible * shadowing * jacobian / (eta * eta)),
        split.choose_transmission * pdf_m * jacobian
    );
}

fn sample_rough_glass(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let facets = rough_glass_facets(lobe);
    if facets_are_smooth(facets) {
        return sample_delta_dielectric(lobe, surface, wo, choice);
    }
    let frame = facet_frame(facets, surface);
    let o = to_local(frame, wo);
    let m = sample_visible_normal(facets, o, u, v);
    let eta = relative_ior(lobe, surface);
    let split = dielectric_split(lobe, fresnel_dielectric(clamp(dot(o, m), 0.0, 1.0), eta));
    let reflects = choice < split.choose_reflection;
    var i = 2.0 * dot(o, m) * m - o;
    if !reflects {
        i = refracted(m, o, eta);
    }
    let wi = frame_to_world(frame, i);
    if reflects != (i.z > 0.0) || reflects != (dot(wi, surface.facing_normal) > 0.0) {
        return no_sample();
    }
    let value = rough_glass_value(lobe, facets, o, i, m, eta, reflects);
    if value.pdf_solid_angle <= 0.0 {
        return no_sample();
    }
    let lambda_o = facet_lambda(facets, o);
    let masking = facet_shadowing_of_visible(facets, lambda_o, facet_lambda(facets, i));
    if reflects {
        let weight = split.fresnel.reflected / split.choose_reflection * masking;
        return BsdfSample(wi, lobe.color0 * weight, value.pdf_solid_angle, 1.0, false);
    }
    let weight = split.fresnel.transmitted / (split.choose_transmission * eta * eta) * masking;
    return BsdfSample(wi, lobe.color1 * weight, value.pdf_solid_angle, eta * eta, false);
}
