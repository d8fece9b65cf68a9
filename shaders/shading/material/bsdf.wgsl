// The BSDF of a surface, for every material: load, evaluate, sample.
#import core/spectrum.wgsl
#import shading/texture/normal_shadowing.wgsl
#import shading/texture/coordinates.wgsl
#import shading/material/scattering.wgsl
#import shading/material/seen.wgsl
#import shading/surface.wgsl
#import shading/material/blend.wgsl
#import shading/material/lobe.wgsl
#import shading/material/lobes.wgsl

// Radiance that a material sends out in the direction from which it is seen.
fn material_emission(material: u32, seen: Seen, uv: TextureCoordinates) -> Spectrum {
    if HAS_BLENDS {
        return blended_emission(material, seen, uv);
    } else {
        return own_emission(material, seen.front, uv);
    }
}

#if MIXTURE
#export shading/material/mixture.wgsl
#else

// The material has a single lobe, by itself or because one was picked.
struct Bsdf {
    lobe: Lobe,
}

#if PICK
// One part of the blend per hit, chosen with its weight as probability; from then on it is the whole material.
fn pick_part(surface: Surface, wo: vec3<f32>, choice: f32) -> WeightedPart {
    let seen = seen_along(surface, wo);
    let run = part_run(surface.material);
    var below = 0.0;
    var chosen: WeightedPart;
    chosen.material = run.material;
    for (var index = 0u; index < run.count; index++) {
        let part = weighted_part(run, index, seen, surface.uv);
        if part.weight > 0.0 {
            // The last part of any weight takes what rounding leaves over.
            chosen = part;
            below += part.weight;
            if choice < below {
                break;
            }
        }
    }
    return chosen;
}

fn load_bsdf(surface: Surface, wo: vec3<f32>, choice: f32) -> Bsdf {
    let part = pick_part(surface, wo, choice);
#if ONE_SIDED
    if part.front_only && !surface.front {
        return Bsdf(no_lobe());
    }
#endif
    return Bsdf(load_lobe(part.material, surface.uv));
}
#else
fn load_bsdf(surface: Surface, wo: vec3<f32>, choice: f32) -> Bsdf {
#if ONE_SIDED
    if !surface.front && is_front_only(surface.material) {
        return Bsdf(no_lobe());
    }
#endif
    return Bsdf(load_lobe(surface.material, surface.uv));
}
#endif

// True where light sampling can contribute: some lobe is not a delta, and not black.
fn has_non_delta_lobe(bsdf: Bsdf) -> bool {
    return lobe_is_non_delta(bsdf.lobe);
}

#if GUIDE
// The probability of lobes that scatter in all directions, whose samples a guide may replace.
fn guided_probability(bsdf: Bsdf) -> f32 {
    return select(0.0, 1.0, lobe_is_broad(bsdf.lobe));
}
#endif

fn evaluate_bsdf(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    return evaluate_lobe(bsdf.lobe, surface, wo, wi);
}

fn sample_bsdf(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    return sample_lobe(bsdf.lobe, surface, wo, choice, u, v);
}
#endif

// A surface's value towards a light, and the direction in which the path goes on.
struct Scattering {
    towards_light: BsdfValue,
    drawn: BsdfSample,
}

// With the shadow that the surface throws on a bent normal. Light that goes straight on through a null surface meets no normal.
fn shadowed(scattering: Scattering, surface: Surface, light_wi: vec3<f32>) -> Scattering {
#if NORMAL_SHADOWING
    var found = scattering;
    found.towards_light.value *= normal_shadowing(surface.unbent_normal, surface.shading_normal, light_wi);
    if !found.drawn.is_null {
        found.drawn.weight *= normal_shadowing(surface.unbent_normal, surface.shading_normal, found.drawn.wi);
    }
    return found;
#else
    return scattering;
#endif
}

#if MORE_LOBES
// The surface is evaluated towards the light and along the drawn direction by the same code, one after the other: drivers that copy what
// is called to wherever it is called have half of it to compile.
fn scatter(
    bsdf: Bsdf, surface: Surface, wo: vec3<f32>, samples_light: bool, light_wi: vec3<f32>, choice: f32, u: f32, v: f32
) -> Scattering {
    let draw = draw_direction(bsdf, surface, wo, choice, u, v);
    var light_value = no_value();
    var draw_value = no_value();
    for (var direction = select(1u, 0u, HAS_LIGHTS); direction < 2u; direction++) {
        let towards_light = direction == 0u;
        if select(draw.mixed, samples_light, towards_light) {
            let value = evaluate_bsdf(bsdf, surface, wo, select(draw.chosen.wi, light_wi, towards_light));
            if towards_light {
                light_value = value;
            } else {
                draw_value = value;
            }
        }
    }
    return shadowed(Scattering(light_value, mixed_sample(draw, draw_value)), surface, light_wi);
}
#else
fn scatter(
    bsdf: Bsdf, surface: Surface, wo: vec3<f32>, samples_light: bool, light_wi: vec3<f32>, choice: f32, u: f32, v: f32
) -> Scattering {
    var light_value = no_value();
    if samples_light {
        light_value = evaluate_bsdf(bsdf, surface, wo, light_wi);
    }
    return shadowed(Scattering(light_value, sample_bsdf(bsdf, surface, wo, choice, u, v)), surface, light_wi);
}
#endif
