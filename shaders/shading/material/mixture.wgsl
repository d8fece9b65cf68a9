// The Bsdf of a blend in mixture mode: every lobe is evaluated, one is sampled.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/material/blend.wgsl
#import shading/bsdf/diffuse.wgsl
#import shading/material/lobe.wgsl
#import shading/material/lobes.wgsl
#import shading/material/scattering.wgsl
#import shading/material/seen.wgsl
#import shading/surface.wgsl

// The lobes of the blend. All diffuse ones together are one, the first: a blend of Lamberts is a Lambert.
struct Bsdf {
    run: PartRun,
    seen: Seen,
    // Σ wᵢ ρᵢ over the diffuse lobes.
    diffuse: Spectrum,
    // The sum of all lobes' sampling weights: the denominator of their probabilities.
    total: f32,
    non_delta_lobe: bool,
    // There are lobes besides the diffuse one.
    more_lobes: bool,
    // The part of `total` of the lobes that scatter in all directions, without the diffuse one.
    broad: f32,
}

// A part of the blend that is a lobe of its own, with its share of `total`; 0 for those that are not.
struct WeightedLobe {
    lobe: Lobe,
    weight: f32,
    share: f32,
}

fn load_weighted_lobe(bsdf: Bsdf, index: u32, surface: Surface) -> WeightedLobe {
    let part = weighted_part(bsdf.run, index, bsdf.seen, surface.uv);
    var weighted: WeightedLobe;
    if HAS_ONE_SIDED && part.front_only && !surface.front {
        return weighted;
    }
    if part.weight > 0.0 {
        weighted.lobe = load_lobe(part.material, surface.uv);
        weighted.weight = part.weight;
        if lobe_kind(weighted.lobe) != DIFFUSE {
            weighted.share = part.weight * lobe_sampling_weight(weighted.lobe);
        }
    }
    return weighted;
}

fn load_bsdf(surface: Surface, wo: vec3<f32>, choice: f32) -> Bsdf {
    var bsdf: Bsdf;
    bsdf.run = part_run(surface.material);
    bsdf.seen = seen_along(surface, wo);
    for (var index = 0u; index < bsdf.run.count; index++) {
        let weighted = load_weighted_lobe(bsdf, index, surface);
        if weighted.weight > 0.0 && lobe_kind(weighted.lobe) == DIFFUSE {
            bsdf.diffuse += weighted.weight * weighted.lobe.color0;
        }
        if HAS_MORE_LOBES && weighted.share > 0.0 {
            bsdf.total += weighted.share;
            bsdf.more_lobes = true;
            bsdf.broad += weighted.share * lobe_broad_share(weighted.lobe);
            bsdf.non_delta_lobe = bsdf.non_delta_lobe || lobe_is_non_delta(weighted.lobe);
        }
    }
    let diffuse_share = max_component(bsdf.diffuse);
    bsdf.total += diffuse_share;
    bsdf.non_delta_lobe = bsdf.non_delta_lobe || diffuse_share > 0.0;
    return bsdf;
}

fn has_non_delta_lobe(bsdf: Bsdf) -> bool {
    return bsdf.non_delta_lobe;
}

// The share of light that it scatters, roughly.
fn sampling_weight_of(bsdf: Bsdf) -> f32 {
    return bsdf.total;
}

// The probability of lobes that scatter in all directions, whose samples a guide may replace.
fn guided_probability(bsdf: Bsdf) -> f32 {
    if bsdf.total <= 0.0 {
        return 0.0;
    }
    if !HAS_MORE_LOBES {
        return 1.0;
    }
    return (max_component(bsdf.diffuse) + bsdf.broad) / bsdf.total;
}

// Σ wⱼ fⱼ |cos| and Σ Pⱼ pdfⱼ over the non-delta lobes: the values that next event estimation and sampling
// agree on.
fn evaluate_bsdf(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    if bsdf.total <= 0.0 {
        return no_value();
    }
    var sum = evaluate_lambert(bsdf.diffuse, surface, wi);
    sum.pdf_solid_angle *= max_component(bsdf.diffuse) / bsdf.total;
    if HAS_MORE_LOBES && bsdf.more_lobes {
        for (var index = 0u; index < bsdf.run.count; index++) {
            let weighted = load_weighted_lobe(bsdf, index, surface);
            if weighted.share > 0.0 {
                let value = evaluate_lobe(weighted.lobe, surface, wo, wi);
                sum.value += weighted.weight * value.value;
                sum.pdf_solid_angle += weighted.share / bsdf.total * value.pdf_solid_angle;
            }
        }
    }
    return sum;
}

// A direction drawn from one lobe, before the others are evaluated.
struct Draw {
    chosen: BsdfSample,
    // Other non-delta lobes may draw the same direction: the weight of the sample is that of all of them
    // together.
    mixed: bool,
}

// A delta lobe i chosen with probability Pᵢ carries wᵢ fᵢ / Pᵢ; a non-delta one Σ wⱼ fⱼ / Σ Pⱼ pdfⱼ over all non-delta lobes.
fn draw_direction(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> Draw {
    if bsdf.total <= 0.0 {
        return Draw(no_sample(), false);
    }
    var below = max_component(bsdf.diffuse) / bsdf.total;
    var chosen = no_sample();
    var probability = below;
    if choice < below || !bsdf.more_lobes {
        chosen = sample_lambert(bsdf.diffuse, surface, u, v);
    } else {
        var weighted: WeightedLobe;
        for (var index = 0u; index < bsdf.run.count; index++) {
            let candidate = load_weighted_lobe(bsdf, index, surface);
            if candidate.share > 0.0 {
                // The last lobe takes the remainder that rounding leaves.
                weighted = candidate;
                probability = candidate.share / bsdf.total;
                below += probability;
                if choice < below {
                    break;
                }
            }
        }
        // The random digits that the choice of the lobe leaves.
        let left = clamp((choice - (below - probability)) / probability, 0.0, LARGEST_NUMBER);
        chosen = sample_lobe(weighted.lobe, surface, wo, left, u, v);
        chosen.weight *= weighted.weight;
        if chosen.pdf_solid_angle < 0.0 {
            chosen.weight /= probability;
            return Draw(chosen, false);
        }
    }
    // Alone, a lobe is sampled as the pure material.
    return Draw(chosen, probability != 1.0 && max_component(chosen.weight) > 0.0);
}

// The sample, given the value of all non-delta lobes together in its direction.
fn mixed_sample(draw: Draw, all: BsdfValue) -> BsdfSample {
    var chosen = draw.chosen;
    if draw.mixed {
        if all.pdf_solid_angle <= 0.0 {
            return no_sample();
        }
        chosen.weight = all.value / all.pdf_solid_angle;
        chosen.pdf_solid_angle = all.pdf_solid_angle;
    }
    return chosen;
}

// A direction drawn where the diffuse lobe is the only one.
fn sample_bsdf(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    if bsdf.total <= 0.0 {
        return no_sample();
    }
    return sample_lambert(bsdf.diffuse, surface, u, v);
}
