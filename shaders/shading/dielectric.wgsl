// The boundary of a dielectric: what smooth and rough glass share.
#import core/math.wgsl
#import shading/fresnel.wgsl
#import shading/lobe.wgsl
#import shading/scattering.wgsl
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

// Share of reflection in sampling a dielectric.
fn reflection_probability(lobe: Lobe, reflected: f32) -> f32 {
    let reflection = reflected * max_component(lobe.color0);
    let total = reflection + (1.0 - reflected) * max_component(lobe.color1);
    return select(0.0, reflection / total, total > 0.0);
}

// A direction that a smooth boundary reflects or refracts.
fn sample_delta_dielectric(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32) -> BsdfSample {
    let n = surface.shading_normal;
    let cosine = min(dot(wo, n), 1.0);
    let eta = relative_ior(lobe, surface);
    let reflected = fresnel_dielectric(cosine, eta);
    if max(max_component(lobe.color0) * reflected, max_component(lobe.color1) * (1.0 - reflected)) <= 0.0 {
        return no_sample();
    }
    let probability = reflection_probability(lobe, reflected);
    if choice < probability {
        let wi = 2.0 * cosine * n - wo;
        if dot(wi, surface.facing_normal) <= 0.0 {
            return no_sample();
        }
        return BsdfSample(wi, lobe.color0 * (reflected / probability), -1.0, 1.0, false);
    }
    let wi = refracted(n, wo, eta);
    if dot(wi, surface.facing_normal) >= 0.0 {
        return no_sample();
    }
    // Radiance is squeezed into a smaller cone where it enters the denser side.
    let weight = (1.0 - reflected) / ((1.0 - probability) * eta * eta);
    return BsdfSample(wi, lobe.color1 * weight, -1.0, eta * eta, false);
}

// Share that a plate with two boundaries reflects: light goes to and fro between them. From either side it is the denser.
fn plate_reflectance(lobe: Lobe, cosine: f32) -> f32 {
    let reflected = fresnel_dielectric(cosine, lobe.ior);
    return 2.0 * reflected / (1.0 + reflected);
}

// A direction that a smooth plate reflects, or the one straight on.
fn sample_delta_plate(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32) -> BsdfSample {
    let n = surface.shading_normal;
    let cosine = min(dot(wo, n), 1.0);
    let reflected = plate_reflectance(lobe, cosine);
    if max(max_component(lobe.color0) * reflected, max_component(lobe.color1) * (1.0 - reflected)) <= 0.0 {
        return no_sample();
    }
    let probability = reflection_probability(lobe, reflected);
    if choice < probability {
        let wi = 2.0 * cosine * n - wo;
        if dot(wi, surface.facing_normal) <= 0.0 {
            return no_sample();
        }
        return BsdfSample(wi, lobe.color0 * (reflected / probability), -1.0, 1.0, false);
    }
    return BsdfSample(-wo, lobe.color1 * ((1.0 - reflected) / (1.0 - probability)), -1.0, 1.0, false);
}
