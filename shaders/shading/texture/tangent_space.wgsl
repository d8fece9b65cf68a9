// The space that normal maps are written in.
#import geometry/shape_point.wgsl

// The direction that stands for `local` about a normal: x along the tangent, in which u grows, y along the
// bitangent, on the side where v grows; 0 if there is no tangent. src/reference/intersect/normal_map.rs is
// the same in f64.
fn from_tangent_space(normal: vec3<f32>, tangents: Tangents, local: vec3<f32>) -> vec3<f32> {
    let along = tangents.along_u - normal * dot(normal, tangents.along_u);
    if dot(along, along) == 0.0 {
        return vec3<f32>(0.0);
    }
    let tangent = normalize(along);
    let across = cross(normal, tangent);
    let bitangent = select(-across, across, dot(across, tangents.along_v) >= 0.0);
    return tangent * local.x + bitangent * local.y + normal * local.z;
}
