// A smooth plate of glass, a delta lobe: a reflected direction and the one straight on.
#import shading/microfacet/dielectric.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl

fn thin_glass_sampling_weight(lobe: Lobe) -> f32 {
    return dielectric_sampling_weight(lobe);
}

fn sample_thin_glass(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    return sample_delta_plate(lobe, surface, wo, choice);
}
