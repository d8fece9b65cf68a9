// The shadow that a surface throws on the normals of a map (Estevez, Lecocq and Stein 2019, "A
// microfacet-based shadowing function to solve the bump terminator problem"). src/reference/bsdf/view.rs is
// the same in f64.
#import core/layout.wgsl
#import geometry/scene.wgsl
#import shading/texture/texture.wgsl

// The normals of the material's map are shadowed.
fn shadows_perturbed_normals(material: u32) -> bool {
    let texture = bitcast<u32>(tables[material * MATERIAL_WORDS + 4u].y);
    return texture != NONE && (bitcast<u32>(texture_word(texture, 0u).x) & TEXTURE_SHADOWS) != 0u;
}

// The material's map mirrors normals that it turns away from the viewer.
fn mirrors_perturbed_normals(material: u32) -> bool {
    let texture = bitcast<u32>(tables[material * MATERIAL_WORDS + 4u].y);
    return texture != NONE && (bitcast<u32>(texture_word(texture, 0u).x) & TEXTURE_MIRRORS) != 0u;
}

// The normal on the viewer's side: that of the map, else the same mirrored about the one before, else the
// geometric one. `mapped` may be of any length.
fn mirrored_normal_towards(mapped: vec3<f32>, unmapped: vec3<f32>, facing_normal: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    if dot(mapped, mapped) == 0.0 {
        return facing_normal;
    }
    let unit = normalize(mapped);
    let normal = select(-unit, unit, dot(unit, facing_normal) > 0.0);
    if dot(normal, wo) > 0.0 {
        return normal;
    }
    let mirrored = 2.0 * dot(normal, unmapped) * unmapped - normal;
    return select(facing_normal, mirrored, dot(mirrored, wo) > 0.0 && dot(mirrored, facing_normal) > 0.0);
}

fn squared_tangent(cosine: f32) -> f32 {
    let squared_cosine = clamp(cosine * cosine, 1.0e-12, 1.0);
    return (1.0 - squared_cosine) / squared_cosine;
}

// The share that the shadow leaves of light along `wi`; `unmapped` is the normal before the map, 0 if there
// is no shadow.
fn normal_shadowing(unmapped: vec3<f32>, mapped: vec3<f32>, wi: vec3<f32>) -> f32 {
    if dot(unmapped, unmapped) == 0.0 {
        return 1.0;
    }
    let alpha2 = min(0.125 * squared_tangent(dot(unmapped, mapped)), 1.0);
    return 2.0 / (1.0 + sqrt(1.0 + alpha2 * squared_tangent(dot(unmapped, wi))));
}
