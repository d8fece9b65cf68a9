// The boundary of a dielectric: what smooth and rough glass share.
#import core/math.wgsl
#import shading/microfacet/fresnel.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl

// The larger of what is reflected and what is transmitted.
fn dielectric_sampling_weight(lobe: Lobe) -> f32 {
    return max(max_component(lobe.color0), max_component(lobe.color1));
}

// The direction refracted about n, which is on wo's side; the caller rules out total reflection.
fn refracted(n: vec3<f32>, wo: vec3<f32>, eta: f32) -> vec3<f32> {
    let cosine = dot(wo, n);
    let inverse_eta = 1.0 / eta;
    let cosine_transmitted = sqrt(max(0.0, transmitted_cosine2(cosine, eta)));
    return normalize((inverse_eta * cosine - cosine_transmitted) * n - inverse_eta * wo);
}

// Transmitted over incident index of refraction for light that leaves towards wo.
fn relative_ior(lobe: Lobe, surface: Surface) -> f32 {
    return select(1.0 / lobe.ior, lobe.ior, surface.front);
}

// Reflectance and transmittance of a boundary before its colours, and the probability of sampling either, in
// proportion to the light that it carries.
struct DielectricSplit {
    fresnel: Fresnel,
    choose_reflection: f32,
    choose_transmission: f32,
}

fn dielectric_split(lobe: Lobe, fresnel: Fresnel) -> DielectricSplit {
    let reflection = fresnel.reflected * max_component(lobe.color0);
    let transmission = fresnel.transmitted * max_component(lobe.color1);
    let total = reflection + transmission;
    if total <= 0.0 {
        return DielectricSplit(fresnel, 0.0, 1.0);
    }
    return DielectricSplit(fresnel, reflection / total, transmission / total);
}

fn carries_light(lobe: Lobe, fresnel: Fresnel) -> bool {
    return max(max_component(lobe.color0) * fresnel.reflected, max_component(lobe.color1) * fresnel.transmitted) > 0.0;
}

// A direction that a smooth boundary reflects or refracts.
fn sample_delta_dielectric(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32) -> BsdfSample {
    let n = surface.shading_normal;
    let cosine = min(dot(wo, n), 1.0);
    let eta = relative_ior(lobe, surface);
    let fresnel = fresnel_dielectric(cosine, eta);
    if !carries_light(lobe, fresnel) {
        return no_sample();
    }
    let split = dielectric_split(lobe, fresnel);
    if choice < split.choose_reflection {
        let wi = 2.0 * cosine * n - wo;
        if dot(wi, surface.facing_normal) <= 0.0 {
            return no_sample();
        }
        return BsdfSample(wi, lobe.color0 * (fresnel.reflected / split.choose_reflection), -1.0, 1.0, false);
    }
    let wi = refracted(n, wo, eta);
    if dot(wi, surface.facing_normal) >= 0.0 {
        return no_sample();
    }
    // Radiance is squeezed into a smaller cone where it enters the denser side.
    let weight = fresnel.transmitted / (split.choose_transmission * eta * eta);
    return BsdfSample(wi, lobe.color1 * weight, -1.0, eta * eta, false);
}

// Reflectance and transmittance of a plate with two boundaries, between which light is reflected back and
// forth. From either side the plate is the denser medium.
fn fresnel_plate(lobe: Lobe, cosine: f32) -> Fresnel {
    let once = fresnel_dielectric(cosine, lobe.ior);
    return Fresnel(2.0 * once.reflected / (1.0 + once.reflected), once.transmitted / (1.0 + once.reflected));
}

// A direction that a smooth plate reflects, or the one straight on.
fn sample_delta_plate(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32) -> BsdfSample {
    let n = surface.shading_normal;
    let cosine = min(dot(wo, n), 1.0);
    let fresnel = fresnel_plate(lobe, cosine);
    if !carries_light(lobe, fresnel) {
        return no_sample();
    }
    let split = dielectric_split(lobe, fresnel);
    if choice < split.choose_reflection {
        let wi = 2.0 * cosine * n - wo;
        if dot(wi, surface.facing_normal) <= 0.0 {
            return no_sample();
        }
        return BsdfSample(wi, lobe.color0 * (fresnel.reflected / split.choose_reflection), -1.0, 1.0, false);
    }
    return BsdfSample(-wo, lobe.color1 * (fresnel.transmitted / split.choose_transmission), -1.0, 1.0, false);
}
