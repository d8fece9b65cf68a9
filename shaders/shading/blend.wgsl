// Blends: a tree of any depth is a run of leaves, each with the weights along its branch as data. Plain materials are one leaf.
// A leaf takes one vec4 of the tables: (material; first factor; number of factors; constant factor). A factor is a heuristic; where it
// stands for the second child it is stored reversed.
#import core/math.wgsl
#import shading/heuristic.wgsl
#import shading/leaf.wgsl

struct LeafRun {
    // NONE: the material itself is the only leaf.
    first: u32,
    count: u32,
    material: u32,
}

fn leaf_run(material: u32) -> LeafRun {
    let word = material * MATERIAL_WORDS;
    if (bitcast<u32>(tables[word].w) & 255u) != BLEND {
        return LeafRun(NONE, 1u, material);
    }
    let run = bitcast<vec4<u32>>(tables[word + 1u]);
    return LeafRun(run.x, run.y, material);
}

struct WeightedLeaf {
    material: u32,
    weight: f32,
}

fn weighted_leaf(run: LeafRun, index: u32, cosine: f32, uv: vec2<f32>) -> WeightedLeaf {
    if run.first == NONE {
        return WeightedLeaf(run.material, 1.0);
    }
    let word = tables[FIRST_LEAF_WORD + run.first + index];
    let leaf = bitcast<vec4<u32>>(word);
    var weight = word.w;
    for (var factor = leaf.y; factor < leaf.y + leaf.z; factor++) {
        weight *= heuristic_weight(factor, cosine, uv);
    }
    return WeightedLeaf(leaf.x, weight);
}

#if EMISSION
// Σ wᵢ Leᵢ, and what the blend emits by itself.
fn material_emission(material: u32, cosine: f32, front: bool, uv: vec2<f32>) -> vec3<f32> {
    var radiance = leaf_emission(material, front, uv);
    if (bitcast<u32>(tables[material * MATERIAL_WORDS + 2u].w) & LEAVES_EMIT) != 0u {
        let run = leaf_run(material);
        // Behind the leaves stand the inner blends that emit by themselves.
        let count = run.count + bitcast<u32>(tables[material * MATERIAL_WORDS + 1u].z);
        for (var index = 0u; index < count; index++) {
            let leaf = weighted_leaf(run, index, cosine, uv);
            if leaf.weight > 0.0 {
                radiance += leaf.weight * leaf_emission(leaf.material, front, uv);
            }
        }
    }
    return radiance;
}
#endif

#if PICK
// One leaf per hit, chosen with its weight as probability; from then on it is the whole material.
struct Bsdf {
    leaf: Leaf,
}

fn load_bsdf(surface: Surface, wo: vec3<f32>, choice: f32) -> Bsdf {
    let cosine = clamp(dot(wo, surface.shading_normal), 0.0, 1.0);
    let run = leaf_run(surface.material);
    var below = 0.0;
    var chosen = run.material;
    for (var index = 0u; index < run.count; index++) {
        let leaf = weighted_leaf(run, index, cosine, surface.uv);
        if leaf.weight > 0.0 {
            // The last leaf of any weight takes what rounding leaves over.
            chosen = leaf.material;
            below += leaf.weight;
            if choice < below {
                break;
            }
        }
    }
    return Bsdf(load_leaf(chosen, surface.uv));
}

fn has_smooth_lobe(bsdf: Bsdf) -> bool {
    return leaf_is_smooth(bsdf.leaf);
}

fn evaluate_bsdf(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    return evaluate_leaf(bsdf.leaf, surface, wo, wi);
}

fn sample_bsdf(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, lobe: f32, u: f32, v: f32) -> BsdfSample {
    return sample_leaf(bsdf.leaf, surface, wo, lobe, u, v);
}
#else
// Every lobe is evaluated, one is sampled. All diffuse leaves together are one lobe, the first: a blend of Lamberts is a Lambert.
struct Bsdf {
    run: LeafRun,
    cosine: f32,
    // Σ wᵢ ρᵢ over the diffuse leaves.
    diffuse: vec3<f32>,
    // The sum of all lobes' sampling weights: the denominator of their probabilities.
    total: f32,
    smooth_lobe: bool,
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
            bsdf.smooth_lobe = bsdf.smooth_lobe || leaf_is_smooth(lobe.leaf);
        }
#endif
    }
    let diffuse_share = max_component(bsdf.diffuse);
    bsdf.total += diffuse_share;
    bsdf.smooth_lobe = bsdf.smooth_lobe || diffuse_share > 0.0;
    return bsdf;
}

fn has_smooth_lobe(bsdf: Bsdf) -> bool {
    return bsdf.smooth_lobe;
}

// Σ wⱼ fⱼ |cos| and Σ Pⱼ pdfⱼ over the smooth lobes: what next event estimation and sampling agree on.
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
    // Other smooth lobes may draw the same direction: the sample counts what all of them make of it.
    mixed: bool,
}

// A delta lobe i chosen with probability Pᵢ carries wᵢ fᵢ / Pᵢ; a smooth one Σ wⱼ fⱼ / Σ Pⱼ pdfⱼ over all smooth lobes.
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

// The sample, given what all smooth lobes make of its direction.
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
#endif
