// Normals read from textures: red along the tangent, in which u grows; green along the bitangent, on the side where v grows; blue
// along the shading normal; each colour times 2 minus 1. src/reference/intersect/normal_map.rs is the same in f64.
#import core/layout.wgsl
#import geometry/scene.wgsl
#import shading/shape_point.wgsl
#import shading/shapes.wgsl
#import shading/texture.wgsl

// The shading normal as the material's map bends it; as it is where there is no map or no tangent. `shading` is 0 where it is the
// geometric one, and may be of any length.
fn mapped_normal(material: u32, kind: u32, first: u32, shading: vec3<f32>, point: ShapePoint, uv: vec2<f32>) -> vec3<f32> {
    let texture = bitcast<u32>(tables[material * MATERIAL_WORDS + 4u].y);
    if texture == NONE {
        return shading;
    }
    var normal = point.normal;
    if dot(shading, shading) > 0.0 {
        normal = normalize(shading);
    }
    let tangents = shape_tangents(kind, first, point);
    let along = tangents.along_u - normal * dot(normal, tangents.along_u);
    if dot(along, along) == 0.0 {
        return shading;
    }
    let tangent = normalize(along);
    let across = cross(normal, tangent);
    let bitangent = select(-across, across, dot(across, tangents.along_v) >= 0.0);
    let local = texture_color(texture, uv) * 2.0 - 1.0;
    return tangent * local.x + bitangent * local.y + normal * local.z;
}
