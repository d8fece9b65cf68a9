// Scattering at a surface: its BSDF, and the guide where paths are guided, with the shadowing term of mapped
// normals. Within a medium: its phase function. src/reference/scatterer.rs is the same in f64.
#import core/layout.wgsl
#import core/sampler.wgsl
#import shading/material/bsdf.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl
#import shading/path/guide.wgsl
#import shading/path/guided.wgsl
#if LAYERED
#import shading/layered/scatterer.wgsl
#endif
#if GUIDE
#if SCATTERING
#import shading/path/guided_phase.wgsl
#endif
#endif
#import shading/medium/phase.wgsl
#import shading/texture/normal_shadowing.wgsl

struct Scatterer {
    bsdf: Bsdf,
#if GUIDE
    guide: GuideCell,
#endif
#if LAYERED
    chosen: ChosenStack,
#endif
#if SCATTERING
    // Within a medium, its phase lobes; there is no BSDF. Else 0.
    phase: u32,
#endif
}

// Key of the random numbers of stacks at a vertex, from the bits that choose among its lobes and parts.
fn key_of_stack(lobe_bits: u32, part_bits: u32) -> u32 {
    return mix_bits(part_bits ^ mix_bits(lobe_bits));
}

// Key of the random numbers that go with a light sample, from its bits.
fn key_of_light(light_bits: vec4<u32>) -> u32 {
    return mix_bits(light_bits.x ^ mix_bits(light_bits.y ^ mix_bits(light_bits.z)));
}

// `choice` picks a part of a blend where one is picked; `key` is that of numbers for stacks.
fn load_scatterer(surface: Surface, wo: vec3<f32>, choice: f32, key: u32) -> Scatterer {
    let bsdf = load_bsdf(surface, wo, choice);
    var scatterer: Scatterer;
    scatterer.bsdf = bsdf;
#if LAYERED
    scatterer.chosen = choose_stack(surface, bsdf, wo, choice, key);
#endif
#if GUIDE
    var probability = guided_probability(bsdf);
#if LAYERED
    probability = select(probability, 0.0, scatterer.chosen.probability > 0.0);
#endif
    scatterer.guide = guide_at(surface, probability);
#endif
    return scatterer;
}

// Scattering at a surface, or within a medium of these phase lobes, which are not 0 there.
fn scatterer_at(surface: Surface, phase: u32, wo: vec3<f32>, choice: f32, key: u32) -> Scatterer {
#if SCATTERING
    if phase != 0u {
        var scatterer: Scatterer;
        scatterer.phase = phase;
#if GUIDE
        scatterer.guide = guide_in_medium(surface.position, phase_evenness(phase));
#endif
        return scatterer;
    }
#endif
    return load_scatterer(surface, wo, choice, key);
}

// Directions of light samples can be scattered.
fn has_non_delta_scattering(scatterer: Scatterer) -> bool {
#if SCATTERING
    if scatterer.phase != 0u {
        // No light sample within a dark medium finds a light.
        return (scatterer.phase & PHASE_IS_DARK) == 0u;
    }
#endif
#if LAYERED
    if scatterer.chosen.probability > 0.0 && scatterer.chosen.stack.most_breadth > 0.0 {
        return true;
    }
#endif
    return has_non_delta_lobe(scatterer.bsdf);
}

#if SCATTERING
// The value of a phase function, and the density with which wi is drawn.
fn evaluate_in_medium(scatterer: Scatterer, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
#if GUIDE
    return evaluate_guided_phase(scatterer.guide, scatterer.phase, wo, wi);
#else
    return evaluate_phase(scatterer.phase, wo, wi);
#endif
}
#endif

// The non-delta lobes' f |cos|, and the density with which wi is drawn. `key` is that of the numbers by which stacks estimate both.
fn evaluate_scatterer(scatterer: Scatterer, surface: Surface, wo: vec3<f32>, wi: vec3<f32>, key: u32) -> BsdfValue {
#if SCATTERING
    if scatterer.phase != 0u {
        return evaluate_in_medium(scatterer, wo, wi);
    }
#endif
#if GUIDE
    var value = evaluate_guided(scatterer.guide, scatterer.bsdf, surface, wo, wi);
#else
    var value = evaluate_bsdf(scatterer.bsdf, surface, wo, wi);
#endif
#if LAYERED
    if scatterer.chosen.probability > 0.0 {
        value = evaluate_layered(scatterer.chosen, value, surface, wo, wi, key);
    }
#endif
    if HAS_NORMAL_SHADOWING {
        value.value *= normal_shadowing(surface.unperturbed_normal, surface.shading_normal, wi);
    }
    return value;
}

// The value towards a light, if one is sampled, and a drawn direction: `choice` chooses the lobe, `u` and `v` the direction.
fn scatter_by(
    scatterer: Scatterer, surface: Surface, wo: vec3<f32>, samples_light: bool, light_wi: vec3<f32>, light_key: u32, choice: f32, u: f32,
    v: f32
) -> Scattering {
#if SCATTERING
    if scatterer.phase != 0u {
        var light_value = no_value();
        if samples_light {
            light_value = evaluate_in_medium(scatterer, wo, light_wi);
        }
#if GUIDE
        return Scattering(light_value, sample_guided_phase(scatterer.guide, scatterer.phase, wo, choice, u, v));
#else
        return Scattering(light_value, sample_phase(scatterer.phase, wo, choice, u, v));
#endif
    }
#endif
#if LAYERED
#if GUIDE
    if scatterer.chosen.probability == 0.0 {
        return scatter_guided(scatterer.guide, scatterer.bsdf, surface, wo, samples_light, light_wi, choice, u, v);
    }
#endif
    return scatter_layered(scatterer.chosen, scatterer.bsdf, surface, wo, samples_light, light_wi, light_key, choice, u, v);
#else
    if HAS_GUIDE {
        return scatter_guided(scatterer.guide, scatterer.bsdf, surface, wo, samples_light, light_wi, choice, u, v);
    } else {
        return scatter(scatterer.bsdf, surface, wo, samples_light, light_wi, choice, u, v);
    }
#endif
}
