// The perfect mirror, a delta lobe.
#import core/math.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn mirror_sampling_weight(lobe: Lobe) -> f32 {
    return max_component(lobe.color0);
}

fn sample_mirror(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let wi = mirrored(surface, wo);
    if dot(wi, surface.facing_normal) <= 0.0 {
        return no_sample();
    }
    return BsdfSample(wi, lobe.color0, -1.0, 1.0, false);
}
