// What every light sample consists of.
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

// A shadow ray ends this much of its length early, on top of the light's own error: one rounding error of its distance.
const SHADOW_SHORTENING: f32 = 0.999999;

// How far aside a shadow ray may be off at its end, as a share of its length: rounding of its direction.
const DIRECTION_ERROR: f32 = 2.5e-7;

fn no_light() -> LightSample {
    return LightSample(vec3<f32>(0.0, 0.0, 1.0), 0.0, BLACK, 1.0);
}
