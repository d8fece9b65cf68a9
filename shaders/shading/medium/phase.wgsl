// Phase functions: how a medium scatters light. src/reference/phase.rs is the same in f64.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/scene.wgsl
#import shading/material/scattering.wgsl

struct PhaseLobe {
    weight: f32,
    g: f32,
    kind: u32,
}

fn phase_lobe(phase: u32, index: u32) -> PhaseLobe {
    let word = tables[FIRST_PHASE_WORD + (phase & ((1u << PHASE_COUNT_SHIFT) - 1u)) + index];
    return PhaseLobe(word.x, word.y, bitcast<u32>(word.z));
}

fn phase_count(phase: u32) -> u32 {
    return (phase & ~PHASE_IS_DARK) >> PHASE_COUNT_SHIFT;
}

// Density of a direction. The angle with the way before comes from a difference of directions, which resolves narrow lobes.
fn lobe_pdf_solid_angle(lobe: PhaseLobe, wo: vec3<f32>, wi: vec3<f32>) -> f32 {
    if lobe.kind == PHASE_RAYLEIGH {
        let cosine = dot(wo, wi);
        return 3.0 / 16.0 * INVERSE_PI * (1.0 + cosine * cosine);
    }
    let from_peak = select(wi - wo, wi + wo, lobe.g >= 0.0);
    let narrow = 1.0 - abs(lobe.g);
    let squared = narrow * narrow + abs(lobe.g) * dot(from_peak, from_peak);
    return narrow * (1.0 + abs(lobe.g)) * 0.25 * INVERSE_PI / (squared * sqrt(squared));
}

// The share of light that is scattered into a direction, per steradian, and the density with which it is drawn: they are the same.
fn evaluate_phase(phase: u32, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    var pdf = 0.0;
    for (var index = 0u; index < phase_count(phase); index++) {
        let lobe = phase_lobe(phase, index);
        pdf += lobe.weight * lobe_pdf_solid_angle(lobe, wo, wi);
    }
    return BsdfValue(Spectrum(pdf), pdf);
}

// About how evenly light is spread over directions, from 0 to 1.
fn phase_evenness(phase: u32) -> f32 {
    var evenness = 0.0;
    for (var index = 0u; index < phase_count(phase); index++) {
        let lobe = phase_lobe(phase, index);
        evenness += lobe.weight * select(1.0 - abs(lobe.g), 1.0, lobe.kind == PHASE_RAYLEIGH);
    }
    return evenness;
}

// 1 less the cosine of the angle with the lobe's peak, at a share of the lobe.
fn off_peak(lobe: PhaseLobe, u: f32) -> f32 {
    if lobe.kind == PHASE_RAYLEIGH {
        let half = 4.0 * u - 2.0;
        let cube = cube_root(abs(half) + sqrt(half * half + 1.0));
        return clamp(1.0 - (cube - 1.0 / cube) * sign(half), 0.0, 2.0);
    }
    let from_peak = select(u, 1.0 - u, lobe.g >= 0.0);
    let narrow = 1.0 - abs(lobe.g);
    let wide = 1.0 + abs(lobe.g);
    let within = wide - 2.0 * abs(lobe.g) * from_peak;
    return clamp(narrow * from_peak * (wide * narrow / within + narrow) / within, 0.0, 2.0);
}

// Draws a direction: `choice` chooses one of the lobes, `u` the angle with the way before, `v` the way around it.
fn sample_phase(phase: u32, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    var left = choice;
    var index = 0u;
    var lobe = phase_lobe(phase, 0u);
    loop {
        left -= lobe.weight;
        if left < 0.0 || index + 1u >= phase_count(phase) {
            break;
        }
        index++;
        lobe = phase_lobe(phase, index);
    }
    let off = off_peak(lobe, u);
    let sine = sqrt(max(0.0, off * (2.0 - off)));
    let along = select(off - 1.0, 1.0 - off, lobe.kind == PHASE_RAYLEIGH || lobe.g >= 0.0);
    let around = sin_cos_turns(v);
    let wi = frame_to_world(frame_from_normal(-wo), vec3<f32>(sine * around.y, sine * around.x, along));
    return from_value(wi, evaluate_phase(phase, wo, wi), 1.0);
}
