// The boundary of a dielectric that does not treat all channels alike; src/reference/bsdf/spectral_dielectric.rs says how channels share paths.
#import core/math.wgsl
#import shading/microfacet/dielectric.wgsl
#import shading/microfacet/fresnel.wgsl
#import shading/microfacet/thin_film.wgsl
#import shading/material/channels.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl

struct SpectralDielectric {
    // Inside over outside.
    iors: Spectrum,
    film: ThinFilm,
}

// The effect of a facet on light, before its colours, and the probabilities of its ways.
struct SpectralWays {
    reflected: Spectrum,
    transmitted: Spectrum,
    reflection: f32,
    // The share that each channel refracts; all 0 where nothing is scattered.
    transmission: Spectrum,
}

fn spectral_etas(dielectric: SpectralDielectric, surface: Surface) -> Spectrum {
    return select(1.0 / dielectric.iors, dielectric.iors, surface.front);
}

fn spectral_fresnel(dielectric: SpectralDielectric, channel: u32, cosine: f32, front: bool) -> Fresnel {
    let ior = dielectric.iors[channel];
    if HAS_THIN_FILM && dielectric.film.thickness > 0.0 {
        // The film is seen from outside: light takes the same way from within.
        let outside = select(transmitted_cosine2(cosine, 1.0 / ior), cosine * cosine, front);
        if outside <= 0.0 {
            return Fresnel(1.0, 0.0);
        }
        let reflected = film_reflectance(dielectric.film, channel, sqrt(outside), ior, 0.0);
        return Fresnel(reflected, 1.0 - reflected);
    }
    return fresnel_dielectric(cosine, select(1.0 / ior, ior, front));
}

fn spectral_ways(lobe: Lobe, dielectric: SpectralDielectric, surface: Surface, cosine: f32) -> SpectralWays {
    var ways: SpectralWays;
    for (var channel = 0u; channel < 3u; channel++) {
        let fresnel = spectral_fresnel(dielectric, channel, cosine, surface.front);
        ways.reflected[channel] = fresnel.reflected;
        ways.transmitted[channel] = fresnel.transmitted;
    }
    let shares = carried_shares(surface);
    let reflection = dot(shares, lobe.color0 * ways.reflected);
    let transmission = shares * lobe.color1 * ways.transmitted;
    let sum = reflection + dot(transmission, WHITE);
    if sum > 0.0 {
        ways.reflection = reflection / sum;
        ways.transmission = transmission / sum;
    }
    return ways;
}

fn sample_delta_spectral(lobe: Lobe, dielectric: SpectralDielectric, surface: Surface, wo: vec3<f32>, choice: f32) -> BsdfSample {
    let n = surface.shading_normal;
    let cosine = min(dot(wo, n), 1.0);
    let ways = spectral_ways(lobe, dielectric, surface, cosine);
    if choice < ways.reflection {
        let wi = 2.0 * cosine * n - wo;
        if dot(wi, surface.facing_normal) <= 0.0 {
            return no_sample();
        }
        return BsdfSample(wi, lobe.color0 * ways.reflected / ways.reflection, -1.0, 1.0, false);
    }
    let channel = choose_channel(ways.transmission, choice - ways.reflection).channel;
    if channel > 2u {
        return no_sample();
    }
    let etas = spectral_etas(dielectric, surface);
    let eta = etas[channel];
    let wi = refracted(n, wo, eta);
    if dot(wi, surface.facing_normal) >= 0.0 {
        return no_sample();
    }
    // The channels that are refracted alike.
    let alike = select(BLACK, WHITE, etas == Spectrum(eta));
    let probability = dot(alike, ways.transmission);
    return BsdfSample(wi, alike * lobe.color1 * ways.transmitted / (probability * eta * eta), -1.0, eta * eta, false);
}
