// The Bsdf of a blend in mixture mode.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/blend.wgsl
#import shading/diffuse.wgsl
#import shading/leaf.wgsl
#import shading/lobes.wgsl
#import shading/scattering.wgsl
#import shading/surface.wgsl

// Every lobe is evaluated, one is sampled. All diffuse leaves together are one lobe, the first: a blend of Lamberts is a Lambert.
struct Bsdf {
    run: LeafRun,
    cosine: f32,
    // Σ wᵢ ρᵢ over the diffuse leaves.
    diffuse: vec3<f32>,
    // The sum of all lobes' sampling weights: the denominator of their probabilities.
    total: f32,
    non_delta_lobe: bool,
#if MORE_LOBES
    // There are lobes besides the diffuse one.
    more_lobes: bool,
#endif
}

// A leaf that is a lobe of its own, with its share of `total`; 0 for those that are not.
struct Lobe {
    leaf: Leaf,
    weight: f32,
    share: f32,
}

fn load_lobe(bsdf: Bsdf, index: u32, uv: vec2<f32>) -> Lobe {
    let weighted = weighted_leaf(bsdf.run, index, bsdf.cosine, uv);
    var lobe: Lobe;
    if weighted.weight > 0.0 {
        lobe.leaf = load_leaf(weighted.material, uv);
        lobe.weight = weighted.weight;
        if leaf_kind(lobe.leaf) != DIFFUSE {
            lobe.share = weighted.weight * leaf_sampling_weight(lobe.leaf);
        }
    }
    return lobe;
}

fn load_bsdf(surface: Surface, wo: vec3<f32>, choice: f32) -> Bsdf {
    let cosine = clamp(dot(wo, surface.shading_normal), 0.0, 1.0);
    var bsdf: Bsdf;
    bsdf.run = leaf_run(surface.material);
    bsdf.cosine = cosine;
    for (var index = 0u; index < bsdf.run.count; index++) {
        let lobe = load_lobe(bsdf, index, surface.uv);
        if lobe.weight > 0.0 && leaf_kind(lobe.leaf) == DIFFUSE {
            bsdf.diffuse += lobe.weight * lobe.leaf.first;
        }
#if MORE_LOBES
        if lobe.share > 0.0 {
            bsdf.total += lobe.share;
            bsdf.more_lobes = true;
            bsdf.non_delta_lobe = bsdf.non_delta_lobe || leaf_is_non_delta(lobe.leaf);
        }
#endif
    }
    let diffuse_share = max_component(bsdf.diffuse);
    bsdf.total += diffuse_share;
    bsdf.non_delta_lobe = bsdf.non_delta_lobe || diffuse_share > 0.0;
    return bsdf;
}

fn has_non_delta_lobe(bsdf: Bsdf) -> bool {
    return bsdf.non_delta_lobe;
}

// Σ wⱼ fⱼ |cos| and Σ Pⱼ pdfⱼ over the non-delta lobes: what next event estimation and sampling agree on.
fn evaluate_bsdf(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    if bsdf.total <= 0.0 {
        return no_value();
    }
    var sum = evaluate_diffuse(bsdf.diffuse, surface, wi);
    sum.pdf_solid_angle *= max_component(bsdf.diffuse) / bsdf.total;
#if MORE_LOBES
    if bsdf.more_lobes {
        for (var index = 0u; index < bsdf.run.count; index++) {
            let lobe = load_lobe(bsdf, index, surface.uv);
            if lobe.share > 0.0 {
                let value = evaluate_leaf(lobe.leaf, surface, wo, wi);
                sum.value += lobe.weight * value.value;
                sum.pdf_solid_angle += lobe.share / bsdf.total * value.pdf_solid_angle;
            }
        }
    }
#endif
    return sum;
}

#if MORE_LOBES
// A direction drawn from one lobe, before the others have had their say.
struct Draw {
    chosen: BsdfSample,
    // Other non-delta lobes may draw the same direction: the sample counts what all of them make of it.
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
        chosen = sample_diffuse(bsdf.diffuse, surface, u, v);
    } else {
        var lobe: Lobe;
        for (var index = 0u; index < bsdf.run.count; index++) {
            let candidate = load_lobe(bsdf, index, surface.uv);
            if candidate.share > 0.0 {
                // The last lobe takes what rounding leaves over.
                lobe = candidate;
                probability = candidate.share / bsdf.total;
                below += probability;
                if choice < below {
                    break;
                }
            }
        }
        // What is left of the random number once it has chosen the lobe.
        let left = clamp((choice - (below - probability)) / probability, 0.0, 0.99999994);
        chosen = sample_leaf(lobe.leaf, surface, wo, left, u, v);
        chosen.weight *= lobe.weight;
        if chosen.pdf_solid_angle < 0.0 {
            chosen.weight /= probability;
            return Draw(chosen, false);
        }
    }
    // Alone, a lobe is sampled as the pure material.
    return Draw(chosen, probability != 1.0 && max_component(chosen.weight) > 0.0);
}

// The sample, given what all non-delta lobes make of its direction.
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
#else
// The diffuse lobe is the only one.
fn sample_bsdf(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    if bsdf.total <= 0.0 {
        return no_sample();
    }
    return sample_diffuse(bsdf.diffuse, surface, u, v);
}
#endif
