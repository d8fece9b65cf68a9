// A sky: from the horizon up, one colour to another in proportion to the direction's height y; a third below.
#import core/math.wgsl
#import core/parameters.wgsl
#import core/sampler.wgsl
#import shading/light/environment_sample.wgsl

fn sky_radiance(wi: vec3<f32>) -> Spectrum {
    return select(view.environment[2].xyz, mix(view.environment[0].xyz, view.environment[1].xyz, wi.y), wi.y >= 0.0);
}

// Density of sample_sky where it is this bright, per steradian.
fn sky_density(radiance: Spectrum) -> f32 {
    return luminance(radiance) * view.environment[2].w;
}

// Density of sample_sky, per steradian.
fn sky_pdf(wi: vec3<f32>) -> f32 {
    return sky_density(sky_radiance(wi));
}

// In proportion to luminance: the half first, then, above, a height whose density is linear.
fn sample_sky(bits_u: u32, bits_v: u32) -> EnvironmentSample {
    let u = uniform_float(bits_u);
    let v = uniform_float(bits_v);
    let share = view.environment[1].w;
    let upper = u < share;
    let horizon = luminance(view.environment[0].xyz);
    let zenith = luminance(view.environment[1].xyz);
    var height = (u - 1.0) / (1.0 - share);
    if upper {
        let xi = u / share;
        // The root of h y + (z - h) y^2 / 2 = xi (h + z) / 2 that does not cancel.
        let root = horizon + sqrt(max(0.0, horizon * horizon + xi * (zenith * zenith - horizon * horizon)));
        height = 0.0;
        if root > 0.0 {
            height = min(xi * (horizon + zenith) / root, 1.0);
        }
    }
    let sine = sqrt(max(0.0, (1.0 - height) * (1.0 + height)));
    let circle = sin_cos_turns(v);
    let radiance = select(view.environment[2].xyz, mix(view.environment[0].xyz, view.environment[1].xyz, height), upper);
    return EnvironmentSample(vec3<f32>(sine * circle.y, height, sine * circle.x), radiance, sky_density(radiance));
}
