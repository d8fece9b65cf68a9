// Blends: a tree of any depth is a run of parts, each with the weights along its branch as data. A plain
// material is its own only part.
// A part takes one vec4 of the tables: (material; first factor; number of factors; constant factor). A factor
// is a blend weight; a factor of the second child is stored reversed.
#import core/layout.wgsl
#import core/spectrum.wgsl
#import geometry/scene.wgsl
#import shading/material/blend_weight.wgsl
#import shading/texture/coordinates.wgsl
#import shading/material/lobe.wgsl
#import shading/material/seen.wgsl

struct PartRun {
    // NONE: the material itself is the only part.
    first: u32,
    count: u32,
    material: u32,
}

fn part_run(material: u32) -> PartRun {
    let word = material * MATERIAL_WORDS;
    if (bitcast<u32>(tables[word].w) & 255u) != BLEND {
        return PartRun(NONE, 1u, material);
    }
    let run = bitcast<vec4<u32>>(tables[word + 1u]);
    return PartRun(run.x, run.y, material);
}

struct WeightedPart {
    material: u32,
    weight: f32,
    // The back scatters nothing.
    front_only: bool,
}

fn part_material(run: PartRun, index: u32) -> u32 {
    if run.first == NONE {
        return run.material;
    }
    return bitcast<u32>(tables[FIRST_PART_WORD + run.first + index].x);
}

fn weighted_part(run: PartRun, index: u32, seen: Seen, uv: TextureCoordinates) -> WeightedPart {
    if run.first == NONE {
        return WeightedPart(run.material, 1.0, is_front_only(run.material));
    }
    let word = tables[FIRST_PART_WORD + run.first + index];
    let part = bitcast<vec4<u32>>(word);
    var weight = word.w;
    let count = part.z & ~PART_FRONT_ONLY;
    for (var factor = part.y; factor < part.y + count; factor++) {
        weight *= blend_weight(factor, seen, uv);
    }
    return WeightedPart(part.x, weight, (part.z & PART_FRONT_ONLY) != 0u);
}

// Radiance that a material sends out towards where it is seen from: Σ wᵢ Leᵢ of a blend, and its own.
fn material_emission(material: u32, seen: Seen, uv: TextureCoordinates) -> Spectrum {
    var radiance = own_emission(material, seen.front, uv);
    if HAS_BLENDS && (bitcast<u32>(tables[material * MATERIAL_WORDS + 2u].w) & PARTS_EMIT) != 0u {
        let run = part_run(material);
        // Behind the parts stand the inner blends that emit by themselves.
        let count = run.count + bitcast<u32>(tables[material * MATERIAL_WORDS + 1u].z);
        for (var index = 0u; index < count; index++) {
            let part = weighted_part(run, index, seen, uv);
            if part.weight > 0.0 {
                radiance += part.weight * own_emission(part.material, seen.front, uv);
            }
        }
    }
    return radiance;
}
