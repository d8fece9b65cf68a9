// A lobe: one material that is no blend, with its parameters looked up for one hit.
#import core/layout.wgsl
#import core/spectrum.wgsl
#import geometry/scene.wgsl
#import shading/texture/coordinates.wgsl
#import shading/texture/texture.wgsl

// What the parameters mean depends on the lobe: crates/gpt-scene/src/scene/material/kind.rs.
struct Lobe {
    // The kind, and above it the form.
    kind: u32,
    color0: Spectrum,
    color1: Spectrum,
    ior: f32,
    roughness: f32,
#if FURTHER_PARAMETERS
    // Looked up too: what it has beyond those, if it does.
    further_count: u32,
    further: array<vec3<f32>, MOST_FURTHER>,
#endif
#if COAT_NORMALS
#if SECOND_UVS
    // The normal map of its coat lies by the second texture coordinates.
    coat_by_second: bool,
#endif
#endif
#if ROUGH_PLASTIC
    // Where those that need no look-up stand in the tables.
    further_word: u32,
#endif
}

#if FURTHER_PARAMETERS
// A further parameter; `otherwise` where the lobe has none.
fn further_parameter(lobe: Lobe, index: u32, otherwise: vec3<f32>) -> vec3<f32> {
    if index >= lobe.further_count {
        return otherwise;
    }
    var further = lobe.further;
    return further[index];
}

fn load_further(lobe: ptr<function, Lobe>, material: u32, uv: TextureCoordinates) {
    let run = bitcast<u32>(tables[material * MATERIAL_WORDS + 4u].w);
    let first = FIRST_FURTHER_WORD + (run & ((1u << FURTHER_SHIFT) - 1u));
    let count = run >> FURTHER_SHIFT;
    (*lobe).further_count = count;
#if ROUGH_PLASTIC
    (*lobe).further_word = first + count;
#endif
    for (var index = 0u; index < count; index++) {
        let word = tables[first + index];
        (*lobe).further[index] = material_color(word.xyz, word.w, uv);
    }
#if COAT_NORMALS
#if SECOND_UVS
    if ((*lobe).kind & COAT_NORMAL_MAP) != 0u {
        (*lobe).coat_by_second = bends_by_second_uvs(bitcast<u32>(tables[first + COAT_NORMAL_PARAMETER].w));
    }
#endif
#endif
}
#endif

#if ANISOTROPY
// Width of microfacets across the tangent.
fn lobe_width_across(lobe: Lobe) -> f32 {
    let width = further_parameter(lobe, 0u, vec3<f32>(lobe.roughness)).x;
    return select(width, width * width, (lobe.kind & ACROSS_IS_SQUARED) != 0u);
}
#endif

fn material_color(constant: Spectrum, texture: f32, uv: TextureCoordinates) -> Spectrum {
#if TEXTURES
    let index = bitcast<u32>(texture);
    if index != NONE {
        return constant * texture_color(index, uv);
    }
#endif
    return constant;
}

fn load_lobe(material: u32, uv: TextureCoordinates) -> Lobe {
    let word = material * MATERIAL_WORDS;
    let m0 = tables[word];
    var lobe: Lobe;
    lobe.kind = bitcast<u32>(m0.w);
    lobe.color0 = m0.xyz;
    lobe.ior = 1.0;
#if COLOR1
    let m1 = tables[word + 1u];
    lobe.color1 = m1.xyz;
    lobe.ior = m1.w;
#endif
#if ROUGHNESS
    lobe.roughness = tables[word + 4u].x;
#endif
#if TEXTURES
    // One call for all three: software drivers copy what is called to wherever it is called.
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
#if ROUGHNESS
    // A texture of roughness: its square is the width.
    if bitcast<u32>(tables[word + 4u].z) != 0u {
        lobe.roughness *= lobe.roughness;
    }
#endif
#endif
#if FURTHER_PARAMETERS
    load_further(&lobe, material, uv);
#endif
    return lobe;
}

#if ONE_SIDED
// The back of the material scatters nothing.
fn is_front_only(material: u32) -> bool {
    return (bitcast<u32>(tables[material * MATERIAL_WORDS + 2u].w) & FRONT_ONLY) != 0u;
}

// As the lobe of what scatters nothing.
fn no_lobe() -> Lobe {
    var lobe: Lobe;
    lobe.kind = NO_LOBE;
    return lobe;
}
#endif

// Radiance that the front, or the back, of a material that is no blend sends out.
fn own_emission(material: u32, front: bool, uv: TextureCoordinates) -> Spectrum {
    let word = material * MATERIAL_WORDS;
    let m2 = tables[word + 2u];
    let flags = bitcast<u32>(m2.w);
    if (flags & EMITS) == 0u || (!front && (flags & EMITS_TWO_SIDED) == 0u) {
        return BLACK;
    }
#if TEXTURES
    return material_color(m2.xyz, tables[word + 3u].y, uv);
#else
    return m2.xyz;
#endif
}

#if GUIDE
// It scatters in all directions above the surface, mostly evenly.
fn lobe_is_broad(lobe: Lobe) -> bool {
    let kind = lobe_kind(lobe);
    return kind == DIFFUSE || kind == PLASTIC || kind == ROUGH_PLASTIC;
}
#endif

fn lobe_kind(lobe: Lobe) -> u32 {
    return lobe.kind & 255u;
}
