// Metals, rough or smooth.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/material/lobe.wgsl
#import shading/material/parameters.wgsl
#import shading/microfacet/microfacet.wgsl
#if THIN_FILM
#import shading/microfacet/thin_film.wgsl
#endif
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn conductor_is_non_delta(lobe: Lobe) -> bool {
    return !facets_are_smooth(conductor_facets(lobe));
}

fn conductor_sampling_weight(lobe: Lobe) -> f32 {
    return max_component(conductor_reflectance(lobe, 1.0));
}

fn conductor_facets(lobe: Lobe) -> Facets {
    return lobe_facets(lobe, conductor_parameters(lobe).width_across);
}

// The reflectance of a microfacet.
fn conductor_reflectance(lobe: Lobe, cosine: f32) -> Spectrum {
    return conductor_fresnel(lobe, cosine) * conductor_parameters(lobe).specular_reflectance;
}

// The reflectance of a metal: the exact equations for a complex index of refraction, or Schlick's
// approximation.
fn conductor_fresnel(lobe: Lobe, cosine: f32) -> Spectrum {
#if THIN_FILM
    let parameters = conductor_parameters(lobe);
    let film = thin_film_of(parameters.thin_film_thickness, parameters.thin_film);
    if film.thickness > 0.0 {
        if (lobe.kind & COMPLEX_FRESNEL) == 0u {
            return film_reflectance_over(film, cosine, lobe.color0);
        }
        return film_reflectances(film, cosine, lobe.color0, lobe.color1);
    }
#endif
    let c2 = cosine * cosine;
    if (lobe.kind & COMPLEX_FRESNEL) == 0u {
        let away = 1.0 - cosine;
        let away2 = away * away;
        return lobe.color0 + (1.0 - lobe.color0) * (away2 * away2 * away);
    }
    let s2 = (1.0 - cosine) * (1.0 + cosine);
    let eta2 = lobe.color0 * lobe.color0;
    let k2 = lobe.color1 * lobe.color1;
    let t0 = eta2 - k2 - s2;
    let a2_plus_b2 = sqrt(t0 * t0 + 4.0 * eta2 * k2);
    let t1 = a2_plus_b2 + c2;
    let a = sqrt(max(0.5 * (a2_plus_b2 + t0), BLACK));
    let t2 = 2.0 * cosine * a;
    let perpendicular = (t1 - t2) / (t1 + t2);
    let t3 = c2 * a2_plus_b2 + s2 * s2;
    let t4 = t2 * s2;
    let parallel = perpendicular * (t3 - t4) / (t3 + t4);
    return 0.5 * (parallel + perpendicular);
}

fn evaluate_conductor(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let facets = conductor_facets(lobe);
    if facets_are_smooth(facets) || !on_wo_side(surface, wi) {
        return no_value();
    }
    let frame = facet_frame(facets, surface);
    let o = to_local(frame, wo);
    let i = to_local(frame, wi);
    let m = normalize(o + i);
    return conductor_value(lobe, facets, o, i, m);
}

fn conductor_value(lobe: Lobe, facets: Facets, o: vec3<f32>, i: vec3<f32>, m: vec3<f32>) -> BsdfValue {
    let fresnel = conductor_reflectance(lobe, clamp(dot(o, m), 0.0, 1.0));
    let lambda_o = facet_lambda(facets, o);
    let common_factor = facet_distribution(facets, m) / (4.0 * o.z);
    let shadowing = facet_shadowing(facets, lambda_o, facet_lambda(facets, i));
    return BsdfValue(fresnel * (common_factor * shadowing), common_factor / (1.0 + lambda_o));
}

fn sample_conductor(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let facets = conductor_facets(lobe);
    if facets_are_smooth(facets) {
        let wi = mirrored(surface, wo);
        if dot(wi, surface.facing_normal) <= 0.0 {
            return no_sample();
        }
        let cosine = clamp(dot(wo, surface.shading_normal), 0.0, 1.0);
        return BsdfSample(wi, conductor_reflectance(lobe, cosine), -1.0, 1.0, false);
    }
    let frame = facet_frame(facets, surface);
    let o = to_local(frame, wo);
    let m = sample_visible_normal(facets, o, u, v);
    let i = 2.0 * dot(o, m) * m - o;
    let wi = frame_to_world(frame, i);
    if i.z <= 0.0 || dot(wi, surface.facing_normal) <= 0.0 {
        return no_sample();
    }
    // The weight is F G2 / G1; the distribution cancels and with it its rounding.
    let value = conductor_value(lobe, facets, o, i, m);
    let fresnel = conductor_reflectance(lobe, clamp(dot(o, m), 0.0, 1.0));
    let lambda_o = facet_lambda(facets, o);
    let weight = fresnel * facet_shadowing_of_visible(facets, lambda_o, facet_lambda(facets, i));
    return BsdfSample(wi, weight, value.pdf_solid_angle, 1.0, false);
}
