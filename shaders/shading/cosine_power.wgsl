// Lobes whose shape is a power of a cosine: glossy, phong, and rough glass after Honsdorf. What such a lobe has below the horizon is cut
// off. Imported where some material has one.
#import core/math.wgsl
#import shading/diffuse.wgsl
#import shading/fresnel.wgsl
#import shading/glass.wgsl
#import shading/leaf.wgsl
#import shading/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

// The cosine of a narrow lobe is next to 1, where f32 has no digits left for the angle. So what is computed with is 1 - cos.

// 1 - exp(-x), x not negative.
fn one_minus_exp(x: f32) -> f32 {
    return select(1.0 - exp(-x), x * (1.0 - x * (1.0 / 2.0 - x * (1.0 / 6.0 - x * (1.0 / 24.0)))), x < 0.03);
}

// log(1 - x), x in [0, 1).
fn log_one_minus(x: f32) -> f32 {
    return select(log(1.0 - x), -x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 3.0 + x * (1.0 / 4.0)))), x < 0.02);
}

// cosⁿ about an axis: cos = ξ^(1/(n+1)), density (n+1)/(2π) cosⁿ (Lafortune and Willems 1994).
fn sample_cosine_power(axis: vec3<f32>, exponent: f32, u: f32, v: f32) -> vec3<f32> {
    var away = 1.0;
    if u > 0.0 {
        away = one_minus_exp(-log(u) / (exponent + 1.0));
    }
    let sine = sqrt(away * (2.0 - away));
    let circle = sin_cos_turns(v);
    return frame_to_world(frame_from_normal(axis), vec3<f32>(sine * circle.y, sine * circle.x, 1.0 - away));
}

fn cosine_power_pdf(axis: vec3<f32>, exponent: f32, wi: vec3<f32>) -> f32 {
    // Half the squared distance of two unit vectors is 1 - cos, and keeps its digits.
    let apart = axis - wi;
    let away = 0.5 * dot(apart, apart);
    if away >= 1.0 {
        return 0.0;
    }
    return (exponent + 1.0) / TWO_PI * exp(exponent * log_one_minus(away));
}

#if GLOSSY
// f = ρ (n+2)/(2π) cosⁿα
fn evaluate_glossy(leaf: Leaf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    if !on_wo_side(surface, wi) {
        return no_value();
    }
    let pdf = cosine_power_pdf(mirrored(surface, wo), leaf.scalar, wi);
    let scale = (leaf.scalar + 2.0) / (leaf.scalar + 1.0) * dot(wi, surface.shading_normal);
    return BsdfValue(leaf.first * (pdf * scale), pdf);
}
#endif

#if PHONG
fn phong_specular_share(leaf: Leaf) -> f32 {
    let specular = leaf.second.x + leaf.second.y + leaf.second.z;
    return specular / max(leaf.first.x + leaf.first.y + leaf.first.z + specular, 1.0e-30);
}

fn evaluate_phong(leaf: Leaf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    if !on_wo_side(surface, wi) {
        return no_value();
    }
    let cosine = dot(wi, surface.shading_normal);
    let lobe = cosine_power_pdf(mirrored(surface, wo), leaf.scalar, wi);
    let specular = leaf.second * (lobe * (leaf.scalar + 2.0) / (leaf.scalar + 1.0));
    let share = phong_specular_share(leaf);
    return BsdfValue(
        (leaf.first * INVERSE_PI + specular) * cosine,
        mix(hemisphere_pdf(cosine), lobe, share)
    );
}
#endif

#if PHONG_GLASS
fn evaluate_phong_glass(leaf: Leaf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let n = surface.shading_normal;
    let eta = relative_ior(leaf, surface);
    let reflected = fresnel_dielectric(min(dot(wo, n), 1.0), eta);
    let probability = reflection_probability(leaf, reflected);
    if on_wo_side(surface, wi) {
        let lobe = cosine_power_pdf(mirrored(surface, wo), leaf.scalar, wi);
        return BsdfValue(leaf.first * (reflected * lobe), probability * lobe);
    }
    if reflected < 1.0 && on_far_side(surface, wi) {
        let lobe = cosine_power_pdf(refracted(n, wo, eta), leaf.scalar, wi);
        return BsdfValue(leaf.second * ((1.0 - reflected) * lobe / (eta * eta)), (1.0 - probability) * lobe);
    }
    return no_value();
}
#endif
