// Smooth glass whose channels are not refracted or reflected alike, a delta lobe.
#import shading/microfacet/dielectric.wgsl
#import shading/microfacet/spectral_dielectric.wgsl
#import shading/microfacet/thin_film.wgsl
#import shading/material/lobe.wgsl
#import shading/material/parameters.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl

fn spectral_glass_sampling_weight(lobe: Lobe) -> f32 {
    return dielectric_sampling_weight(lobe);
}

fn sample_spectral_glass(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let parameters = spectral_glass_parameters(lobe);
    let dielectric = SpectralDielectric(parameters.iors, thin_film_of(parameters.thin_film_thickness, parameters.thin_film));
    return sample_delta_spectral(lobe, dielectric, surface, wo, choice);
}
