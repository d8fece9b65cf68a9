// Normals read from textures: red along the tangent, in which u grows; green along the bitangent, on the side
// where v grows; blue along the shading normal; each colour times 2 minus 1.
// src/reference/intersect/normal_map.rs is the same in f64.
#import core/layout.wgsl
#import geometry/scene.wgsl
#import shading/texture/coordinates.wgsl
#import geometry/shape_point.wgsl
#import shading/texture/tangent_space.wgsl
#import shading/texture/tangents.wgsl
#import shading/texture/texture.wgsl
#import shading/texture/attributes.wgsl

// The normal of the surface that is lifted along `normal` by a texture's height (Blinn 1978). `along_u` and
// `along_v` are the derivatives of its points by the texture coordinates.
fn bumped_normal(texture: u32, normal: vec3<f32>, geometric: vec3<f32>, along_u: vec3<f32>, along_v: vec3<f32>, uv: TextureCoordinates) -> vec3<f32> {
    let slope = texture_word(texture, 2u).w * texture_gradient(texture, uv);
    let lifted_u = along_u + normal * (slope.x - dot(normal, along_u));
    let lifted_v = along_v + normal * (slope.y - dot(normal, along_v));
    let bumped = cross(lifted_u, lifted_v);
    if !(dot(bumped, bumped) > 0.0) {
        return normal;
    }
    let unit = normalize(bumped);
    return select(unit, -unit, dot(unit, geometric) < 0.0);
}

// The area of the triangle's or quad's edges in texture coordinates; tangents know its sign alone.
fn edge_area(kind: u32, first: u32, by_second: bool) -> f32 {
#if ATTRIBUTES
    if first != NONE {
        return attribute_uv_area(select(first, first + 1u, by_second && kind == KIND_TRIANGLE));
    }
#endif
    return 1.0;
}

// The shading normal after the material's map; unchanged if there is no map or no tangent. `shading` is 0 if
// it is the geometric one, and may be of any length.
fn mapped_normal(material: u32, kind: u32, first: u32, shading: vec3<f32>, point: ShapePoint, uv: TextureCoordinates) -> vec3<f32> {
    let texture = bitcast<u32>(tables[material * MATERIAL_WORDS + 4u].y);
    if texture == NONE {
        return shading;
    }
    var normal = point.normal;
    if dot(shading, shading) > 0.0 {
        normal = normalize(shading);
    }
    let by_second = lies_by_second_uvs(texture);
    let tangents = tangents_of_set(kind, first, point, bends_by_second_uvs(texture));
    if HAS_BUMP_MAPS && (bitcast<u32>(texture_word(texture, 0u).x) & TEXTURE_HEIGHTS) != 0u {
        let per_uv = 1.0 / edge_area(kind, first, by_second);
        return bumped_normal(texture, normal, point.normal, tangents.along_u * per_uv, tangents.along_v * per_uv, uv);
    }
    var local = texture_color(texture, uv) * 2.0 - 1.0;
    if HAS_NORMAL_SCALES {
        local = vec3<f32>(local.xy * texture_word(texture, 2u).w, local.z);
    }
    let mapped = from_tangent_space(normal, tangents, local);
    return select(mapped, shading, dot(mapped, mapped) == 0.0);
}
