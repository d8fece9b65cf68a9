// Lobes whose shape is a power of a cosine: glossy, phong, and rough glass after Honsdorf. What such a lobe has below the horizon is cut
// off. Imported where some material has one.
#import core/math.wgsl
#import shading/surface.wgsl

// cosⁿ about an axis: cos = ξ^(1/(n+1)), density (n+1)/(2π) cosⁿ (Lafortune and Willems 1994).
fn sample_cosine_power(axis: vec3<f32>, exponent: f32, u: f32, v: f32) -> vec3<f32> {
    let cosine = pow(u, 1.0 / (exponent + 1.0));
    let sine = sqrt(max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    let circle = sin_cos_turns(v);
    return frame_to_world(frame_from_normal(axis), vec3<f32>(sine * circle.y, sine * circle.x, cosine));
}

fn cosine_power_pdf(axis: vec3<f32>, exponent: f32, wi: vec3<f32>) -> f32 {
    let cosine = clamp(dot(axis, wi), 0.0, 1.0);
    if cosine == 0.0 {
        return 0.0;
    }
    return (exponent + 1.0) / TWO_PI * pow(cosine, exponent);
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
