// The shadow that a surface throws on the normals that a map bends (Estevez, Lecocq and Stein 2019, "A microfacet-based shadowing function to
// solve the bump terminator problem"). src/reference/bsdf/view.rs is the same in f64.
#import core/layout.wgsl
#import geometry/scene.wgsl
#import shading/texture/texture.wgsl

// The material's map bends normals that are shadowed.
fn shadows_bent_normals(material: u32) -> bool {
    let texture = bitcast<u32>(tables[material * MATERIAL_WORDS + 4u].y);
    return texture != NONE && (bitcast<u32>(texture_word(texture, 0u).x) & TEXTURE_SHADOWS) != 0u;
}

// The material's map mirrors normals that it bends away from the viewer.
fn mirrors_bent_normals(material: u32) -> bool {
    let texture = bitcast<u32>(tables[material * MATERIAL_WORDS + 4u].y);
    return texture != NONE && (bitcast<u32>(texture_word(texture, 0u).x) & TEXTURE_MIRRORS) != 0u;
}

// The normal on the viewer's side: as the map bends it, else mirrored about the one before, else the geometric one. `bent` may be of any length.
fn mirrored_normal_towards(bent: vec3<f32>, unbent: vec3<f32>, facing_normal: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    if dot(bent, bent) == 0.0 {
        return facing_normal;
    }
    let unit = normalize(bent);
    let normal = select(-unit, unit, dot(unit, facing_normal) > 0.0);
    if dot(normal, wo) > 0.0 {
        return normal;
    }
    let mirrored = 2.0 * dot(normal, unbent) * unbent - normal;
    return select(facing_normal, mirrored, dot(mirrored, wo) > 0.0 && dot(mirrored, facing_normal) > 0.0);
}

fn squared_tangent(cosine: f32) -> f32 {
    let squared_cosine = clamp(cosine * cosine, 1.0e-12, 1.0);
    return (1.0 - squared_cosine) / squared_cosine;
}

// Share of light that leaves along `wi` where a map has replaced the normal `unbent` by `bent`; `unbent` is 0
// where there is no map.
fn normal_shadowing(unbent: vec3<f32>, bent: vec3<f32>, wi: vec3<f32>) -> f32 {
    if dot(unbent, unbent) == 0.0 {
        return 1.0;
    }
    let alpha2 = min(0.125 * squared_tangent(dot(unbent, bent)), 1.0);
    return 2.0 / (1.0 + sqrt(1.0 + alpha2 * squared_tangent(dot(unbent, wi))));
}
