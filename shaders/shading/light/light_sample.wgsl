// A light sample.
#import core/spectrum.wgsl

struct LightSample {
    wi: vec3<f32>,
    // Distance at which the shadow ray ends, just before the light.
    distance: f32,
    // 0 where the light does not reach the point.
    radiance: Spectrum,
    // Density of wi, the choice of the light included; negative for a delta light.
    pdf_solid_angle: f32,
}

fn no_light() -> LightSample {
    return LightSample(vec3<f32>(0.0, 0.0, 1.0), 0.0, BLACK, 1.0);
}
