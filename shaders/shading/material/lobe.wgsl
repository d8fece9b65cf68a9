// A lobe: one material that is no blend, with its parameters looked up for one hit.
#import core/layout.wgsl
#import core/spectrum.wgsl
#import geometry/scene.wgsl
#import shading/texture/coordinates.wgsl
#import shading/texture/texture.wgsl

// The meaning of the parameters depends on the lobe: crates/gpt-scene/src/scene/material/kind.rs.
struct Lobe {
    // The kind, and above it the form.
    kind: u32,
    color0: Spectrum,
    color1: Spectrum,
    ior: f32,
    roughness: f32,
    // The parameters beyond those, if the lobe has some; shading/material/parameters.wgsl has their names.
    further_count: u32,
    further: array<vec3<f32>, MOST_FURTHER>,
    // The first word of the lobe's own table, which stands behind its further parameters.
    table_word: u32,
    // The normal map of its coat lies by the second texture coordinates.
    coat_by_second: bool,
}

fn load_further(lobe: ptr<function, Lobe>, material: u32, uv: TextureCoordinates) {
    let run = bitcast<u32>(tables[material * MATERIAL_WORDS + 4u].w);
    let first = FIRST_FURTHER_WORD + (run & ((1u << FURTHER_SHIFT) - 1u));
    let count = run >> FURTHER_SHIFT;
    (*lobe).further_count = count;
    (*lobe).table_word = first + count;
    for (var index = 0u; index < count; index++) {
        let word = tables[first + index];
        (*lobe).further[index] = material_color(word.xyz, word.w, uv);
    }
    if HAS_COAT_NORMALS && ((*lobe).kind & COAT_NORMAL_MAP) != 0u {
        (*lobe).coat_by_second = bends_by_second_uvs(bitcast<u32>(tables[first + COAT_TEXEL_PARAMETER].w));
    }
}

fn material_color(constant: Spectrum, texture: f32, uv: TextureCoordinates) -> Spectrum {
    let index = bitcast<u32>(texture);
    if HAS_TEXTURES && index != NONE {
        return constant * texture_color(index, uv);
    }
    return constant;
}

fn load_lobe(material: u32, uv: TextureCoordinates) -> Lobe {
    let word = material * MATERIAL_WORDS;
    let m0 = tables[word];
    var lobe: Lobe;
    lobe.kind = bitcast<u32>(m0.w);
    lobe.color0 = m0.xyz;
    lobe.ior = 1.0;
    if HAS_COLOR1 {
        let m1 = tables[word + 1u];
        lobe.color1 = m1.xyz;
        lobe.ior = m1.w;
    }
    if HAS_ROUGHNESS {
        lobe.roughness = tables[word + 4u].x;
    }
    if HAS_TEXTURES {
        // One call serves all three: software drivers copy a function to each of its calls.
        let textures = bitcast<vec4<u32>>(tables[word + 3u]);
        for (var slot = 0u; slot < 3u; slot++) {
            let texture = select(select(textures.x, textures.z, slot == 1u), textures.w, slot == 2u);
            if texture != NONE {
                let color = texture_color(texture, uv);
                lobe.color0 *= select(WHITE, color, slot == 0u);
                lobe.color1 *= select(WHITE, color, slot == 1u);
                lobe.roughness *= select(1.0, color.x, slot == 2u);
            }
        }
        // The square of a texture of roughness is the width.
        if HAS_ROUGHNESS && bitcast<u32>(tables[word + 4u].z) != 0u {
            lobe.roughness *= lobe.roughness;
        }
    }
    if HAS_FURTHER_PARAMETERS {
        load_further(&lobe, material, uv);
    }
    return lobe;
}

// The back of the material scatters nothing.
fn is_front_only(material: u32) -> bool {
    return (bitcast<u32>(tables[material * MATERIAL_WORDS + 2u].w) & FRONT_ONLY) != 0u;
}

// The lobe of a side that scatters nothing.
fn no_lobe() -> Lobe {
    var lobe: Lobe;
    lobe.kind = NO_LOBE;
    return lobe;
}

// Radiance that the front, or the back, of a material that is no blend sends out.
fn own_emission(material: u32, front: bool, uv: TextureCoordinates) -> Spectrum {
    let word = material * MATERIAL_WORDS;
    let m2 = tables[word + 2u];
    let flags = bitcast<u32>(m2.w);
    if (flags & EMITS) == 0u || (!front && (flags & EMITS_TWO_SIDED) == 0u) {
        return BLACK;
    }
    return material_color(m2.xyz, tables[word + 3u].y, uv);
}

fn lobe_kind(lobe: Lobe) -> u32 {
    return lobe.kind & 255u;
}
