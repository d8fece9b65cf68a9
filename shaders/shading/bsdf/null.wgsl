// The surface that is not there: rays go straight on.
#import core/spectrum.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl

fn null_sampling_weight(lobe: Lobe) -> f32 {
    return 1.0;
}

fn sample_null(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    return BsdfSample(-wo, WHITE, -1.0, 1.0, true);
}
