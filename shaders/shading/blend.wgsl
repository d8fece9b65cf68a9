// Blends: a tree of any depth is a run of leaves, each with the weights along its branch as data. Plain materials are one leaf.
// A leaf takes one vec4 of the tables: (material; first factor; number of factors; constant factor). A factor is a heuristic; where it
// stands for the second child it is stored reversed.
#import core/layout.wgsl
#import geometry/scene.wgsl
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

// Σ wᵢ Leᵢ, and what the blend emits by itself.
fn material_emission(material: u32, cosine: f32, front: bool, uv: vec2<f32>) -> vec3<f32> {
    var radiance = leaf_emission(material, front, uv);
    if (bitcast<u32>(tables[material * MATERIAL_WORDS + 2u].w) & PARTS_EMIT) != 0u {
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
