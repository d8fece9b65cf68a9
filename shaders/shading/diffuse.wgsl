// The diffuse lobe.
#import core/math.wgsl
#import shading/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

// A direction about the shading normal in proportion to its cosine, or uniform, and its cosine.
fn sample_hemisphere(surface: Surface, u: f32, v: f32) -> vec4<f32> {
    let circle = sin_cos_turns(v);
#if UNIFORM_HEMISPHERE
    let r = sqrt((1.0 - u) * (1.0 + u));
    let cosine = u;
#else
    let r = sqrt(u);
    let cosine = sqrt(1.0 - u);
#endif
    let local = vec3<f32>(r * circle.y, r * circle.x, cosine);
    return vec4<f32>(frame_to_world(frame_from_normal(surface.shading_normal), local), cosine);
}

fn hemisphere_pdf(cosine: f32) -> f32 {
#if UNIFORM_HEMISPHERE
    return 0.5 * INVERSE_PI;
#else
    return cosine * INVERSE_PI;
#endif
}

fn sample_diffuse(reflectance: vec3<f32>, surface: Surface, u: f32, v: f32) -> BsdfSample {
    let direction = sample_hemisphere(surface, u, v);
    let wi = direction.xyz;
    let cosine = direction.w;
    if cosine <= 0.0 || dot(wi, surface.facing_normal) <= 0.0 {
        return no_sample();
    }
#if UNIFORM_HEMISPHERE
    let weight = reflectance * (2.0 * cosine);
#else
    let weight = reflectance;
#endif
    return BsdfSample(wi, weight, hemisphere_pdf(cosine), 1.0, false);
}

fn evaluate_diffuse(reflectance: vec3<f32>, surface: Surface, wi: vec3<f32>) -> BsdfValue {
    if !on_wo_side(surface, wi) {
        return no_value();
    }
    let cosine = dot(wi, surface.shading_normal);
    return BsdfValue(reflectance * (cosine * INVERSE_PI), hemisphere_pdf(cosine));
}
