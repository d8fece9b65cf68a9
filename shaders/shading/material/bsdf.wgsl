// The scattering of light by a surface, whatever its material is made of: load, evaluate, sample.
#import shading/texture/normal_shadowing.wgsl
#export shading/material/blend.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl
#if MIXTURE
#export shading/material/mixture.wgsl
#else
#import shading/material/lobe.wgsl
#import shading/material/lobes.wgsl

// The material has a single lobe, by itself or because one was picked.
struct Bsdf {
    lobe: Lobe,
}

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
            // The last part of any weight takes the remainder that rounding leaves.
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
    var part = WeightedPart(surface.material, 1.0, is_front_only(surface.material));
    if HAS_PICK {
        part = pick_part(surface, wo, choice);
    }
    if HAS_ONE_SIDED && part.front_only && !surface.front {
        return Bsdf(no_lobe());
    }
    return Bsdf(load_lobe(part.material, surface.uv));
}

// Light sampling can contribute: some lobe is not a delta, and not black.
fn has_non_delta_lobe(bsdf: Bsdf) -> bool {
    return lobe_is_non_delta(bsdf.lobe);
}

// The probability of lobes that scatter in all directions, whose samples a guide may replace.
fn guided_probability(bsdf: Bsdf) -> f32 {
    return lobe_broad_share(bsdf.lobe);
}

// The share of light that it scatters, roughly.
fn sampling_weight_of(bsdf: Bsdf) -> f32 {
    return lobe_sampling_weight(bsdf.lobe);
}

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

// The scattering with the shadow that the surface throws on a normal from a map. Light that goes straight on
// through a null surface meets no normal.
fn shadowed(scattering: Scattering, surface: Surface, light_wi: vec3<f32>) -> Scattering {
    var found = scattering;
#if NORMAL_SHADOWING
    found.towards_light.value *= normal_shadowing(surface.unperturbed_normal, surface.shading_normal, light_wi);
    if !found.drawn.is_null {
        found.drawn.weight *= normal_shadowing(surface.unperturbed_normal, surface.shading_normal, found.drawn.wi);
    }
#endif
    return found;
}

#if MORE_LOBES
// The surface is evaluated towards the light and along the drawn direction by the same code, one after the
// other: drivers that copy a function to each of its calls have half of it to compile.
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
