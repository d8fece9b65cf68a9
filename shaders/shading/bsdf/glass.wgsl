// Smooth glass, a delta lobe: a reflected and a refracted direction.
#import shading/microfacet/dielectric.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl

fn glass_sampling_weight(lobe: Lobe) -> f32 {
    return dielectric_sampling_weight(lobe);
}

fn sample_glass(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    return sample_delta_dielectric(lobe, surface, wo, choice);
}
