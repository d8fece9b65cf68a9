// Directions over a diffuse surface.
#import core/math.wgsl
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
    if HAS_UNIFORM_HEMISPHERE {
        return 0.5 * INVERSE_PI;
    } else {
        return cosine * INVERSE_PI;
    }
}
