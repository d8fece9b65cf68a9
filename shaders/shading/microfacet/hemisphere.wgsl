// Directions over a diffuse surface.
#import core/math.wgsl
#import shading/surface.wgsl

// A direction about the shading normal in proportion to its cosine, or uniform, and its cosine.
fn sample_hemisphere(surface: Surface, u: f32, v: f32) -> vec4<f32> {
    let circle = sin_cos_turns(v);
    var r = sqrt(u);
    var cosine = sqrt(1.0 - u);
    if HAS_UNIFORM_HEMISPHERE {
        r = sqrt((1.0 - u) * (1.0 + u));
        cosine = u;
    }
    let local = vec3<f32>(r * circle.y, r * circle.x, cosine);
    return vec4<f32>(frame_to_world(frame_from_normal(surface.shading_normal), local), cosine);
}

// The weight of such a direction under a reflectance of 1: cosine / (π · density).
fn hemisphere_weight(cosine: f32) -> f32 {
    return select(1.0, 2.0 * cosine, HAS_UNIFORM_HEMISPHERE);
}

fn hemisphere_pdf(cosine: f32) -> f32 {
    return select(cosine, 0.5, HAS_UNIFORM_HEMISPHERE) * INVERSE_PI;
}
