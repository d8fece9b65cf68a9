// Light that is the same from everywhere outside the scene.
#import core/math.wgsl
#import core/parameters.wgsl
#import core/sampler.wgsl
#import shading/light/environment_sample.wgsl

fn constant_radiance(wi: vec3<f32>) -> Spectrum {
    return view.environment[0].xyz;
}

// Density of sample_constant, per steradian.
fn constant_pdf(wi: vec3<f32>) -> f32 {
    return 0.25 * INVERSE_PI;
}

fn sample_constant(bits_u: u32, bits_v: u32) -> EnvironmentSample {
    let u = uniform_float(bits_u);
    let v = uniform_float(bits_v);
    let cosine = 1.0 - 2.0 * u;
    let sine = sqrt(max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    let circle = sin_cos_turns(v);
    let wi = vec3<f32>(sine * circle.y, sine * circle.x, cosine);
    return EnvironmentSample(wi, view.environment[0].xyz, 0.25 * INVERSE_PI);
}
