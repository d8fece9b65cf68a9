// A leaf: one material that is no blend, with its parameters looked up for one hit.
#import core/layout.wgsl
#import geometry/scene.wgsl
#if TEXTURES
#import shading/texture.wgsl
#endif

struct Leaf {
    // The kind, COMPLEX_FRESNEL beside it.
    kind: u32,
    // Reflectance, diffuse reflectance or eta.
    first: vec3<f32>,
    // Transmittance, specular reflectance or k.
    second: vec3<f32>,
    ior: f32,
    // GGX width or cosine exponent.
    scalar: f32,
}

fn material_color(constant: vec3<f32>, texture: f32, uv: vec2<f32>) -> vec3<f32> {
#if TEXTURES
    let index = bitcast<u32>(texture);
    if index != NONE {
        return constant * texture_color(index, uv);
    }
#endif
    return constant;
}

fn load_leaf(material: u32, uv: vec2<f32>) -> Leaf {
    let word = material * MATERIAL_WORDS;
    let m0 = tables[word];
    var leaf = Leaf(bitcast<u32>(m0.w), m0.xyz, vec3<f32>(0.0), 1.0, 0.0);
#if SECOND_COLORS
    let m1 = tables[word + 1u];
    leaf.second = m1.xyz;
    leaf.ior = m1.w;
#endif
#if SCALARS
    leaf.scalar = tables[word + 4u].x;
#endif
#if TEXTURES
    // One call for all three: software drivers copy what is called to wherever it is called.
    let textures = bitcast<vec4<u32>>(tables[word + 3u]);
    for (var slot = 0u; slot < 3u; slot++) {
        let texture = select(select(textures.x, textures.z, slot == 1u), textures.w, slot == 2u);
        if texture != NONE {
            let color = texture_color(texture, uv);
            leaf.first *= select(vec3<f32>(1.0), color, slot == 0u);
            leaf.second *= select(vec3<f32>(1.0), color, slot == 1u);
            leaf.scalar *= select(1.0, color.x, slot == 2u);
        }
    }
#if SCALARS
    // A texture of roughness: its square is the width.
    if bitcast<u32>(tables[word + 4u].z) != 0u {
        leaf.scalar *= leaf.scalar;
    }
#endif
#endif
    return leaf;
}

// Radiance that a leaf's front, or back, sends out.
fn leaf_emission(material: u32, front: bool, uv: vec2<f32>) -> vec3<f32> {
    let word = material * MATERIAL_WORDS;
    let m2 = tables[word + 2u];
    let flags = bitcast<u32>(m2.w);
    if (flags & EMITS) == 0u || (!front && (flags & EMITS_TWO_SIDED) == 0u) {
        return vec3<f32>(0.0);
    }
#if TEXTURES
    return material_color(m2.xyz, tables[word + 3u].y, uv);
#else
    return m2.xyz;
#endif
}

fn leaf_kind(leaf: Leaf) -> u32 {
    return leaf.kind & 255u;
}
