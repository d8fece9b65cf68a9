// Rough glass of microfacets whose channels are not refracted or reflected alike.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/microfacet/dielectric.wgsl
#import shading/microfacet/spectral_dielectric.wgsl
#import shading/microfacet/thin_film.wgsl
#import shading/material/channels.wgsl
#import shading/material/lobe.wgsl
#import shading/material/parameters.wgsl
#import shading/microfacet/microfacet.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn rough_spectral_glass_facets(lobe: Lobe) -> Facets {
    return lobe_facets(lobe, rough_spectral_glass_parameters(lobe).width_across);
}

fn rough_spectral_glass_dielectric(lobe: Lobe) -> SpectralDielectric {
    let parameters = rough_spectral_glass_parameters(lobe);
    return SpectralDielectric(parameters.iors, thin_film_of(parameters.thin_film_thickness, parameters.thin_film));
}

// The facets are too narrow to be told from a smooth surface, or bend no light.
fn rough_spectral_glass_is_delta(lobe: Lobe) -> bool {
    let bends = abs(rough_spectral_glass_parameters(lobe).iors - WHITE) >= Spectrum(SMALLEST_BEND);
    return facets_are_smooth(rough_spectral_glass_facets(lobe)) || !any(bends);
}

fn rough_spectral_glass_is_non_delta(lobe: Lobe) -> bool {
    return !rough_spectral_glass_is_delta(lobe);
}

fn rough_spectral_glass_sampling_weight(lobe: Lobe) -> f32 {
    return dielectric_sampling_weight(lobe);
}

fn evaluate_rough_spectral_glass(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let reflects = on_wo_side(surface, wi);
    if rough_spectral_glass_is_delta(lobe) || (!reflects && !on_far_side(surface, wi)) {
        return no_value();
    }
    let facets = rough_spectral_glass_facets(lobe);
    let dielectric = rough_spectral_glass_dielectric(lobe);
    let frame = facet_frame(facets, surface);
    let o = to_local(frame, wo);
    let i = to_local(frame, wi);
    let lambda_o = facet_lambda(facets, o);
    let shadowing = facet_shadowing(facets, lambda_o, facet_lambda(facets, i));
    if reflects {
        let m = normalize(o + i);
        let ways = spectral_ways(lobe, dielectric, surface, clamp(dot(o, m), 0.0, 1.0));
        let unshadowed = facet_distribution(facets, m) / (4.0 * o.z);
        return BsdfValue(lobe.color0 * ways.reflected * (unshadowed * shadowing), ways.reflection * unshadowed / (1.0 + lambda_o));
    }
    var value = no_value();
    let etas = spectral_etas(dielectric, surface);
    for (var channel = 0u; channel < 3u; channel++) {
        let eta = etas[channel];
        var m = normalize(o + eta * i);
        m = select(-m, m, m.z > 0.0);
        let o_m = dot(o, m);
        let i_m = dot(i, m);
        if o_m > 0.0 && i_m < 0.0 {
            let ways = spectral_ways(lobe, dielectric, surface, min(o_m, 1.0));
            let refraction = i_m + o_m / eta;
            let density = facet_distribution(facets, m) * o_m / o.z * (-i_m / (refraction * refraction));
            value.value[channel] = lobe.color1[channel] * ways.transmitted[channel] * density * shadowing / (eta * eta);
            value.pdf_solid_angle += ways.transmission[channel] * density / (1.0 + lambda_o);
        }
    }
    return value;
}

fn sample_rough_spectral_glass(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let dielectric = rough_spectral_glass_dielectric(lobe);
    if rough_spectral_glass_is_delta(lobe) {
        return sample_delta_spectral(lobe, dielectric, surface, wo, choice);
    }
    let facets = rough_spectral_glass_facets(lobe);
    let frame = facet_frame(facets, surface);
    let o = to_local(frame, wo);
    let m = sample_visible_normal(facets, o, u, v);
    let ways = spectral_ways(lobe, dielectric, surface, clamp(dot(o, m), 0.0, 1.0));
    let reflects = choice < ways.reflection;
    var eta = 1.0;
    var i = 2.0 * dot(o, m) * m - o;
    if !reflects {
        let channel = choose_channel(ways.transmission, choice - ways.reflection).channel;
        if channel > 2u {
            return no_sample();
        }
        let etas = spectral_etas(dielectric, surface);
        eta = etas[channel];
        i = refracted(m, o, eta);
    }
    let wi = frame_to_world(frame, i);
    if reflects != (i.z > 0.0) || reflects != (dot(wi, surface.facing_normal) > 0.0) {
        return no_sample();
    }
    return from_value(wi, evaluate_rough_spectral_glass(lobe, surface, wo, wi), eta * eta);
}
