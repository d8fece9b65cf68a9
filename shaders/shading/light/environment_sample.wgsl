// A sampled direction to the light from outside the scene.
#import core/spectrum.wgsl

struct EnvironmentSample {
    wi: vec3<f32>,
    radiance: Spectrum,
    // Per steradian.
    pdf_solid_angle: f32,
}
