// Normals read from textures: red along the tangent, in which u grows; green along the bitangent, on the side where v grows; blue
// along the shading normal; each colour times 2 minus 1. src/reference/intersect/normal_map.rs is the same in f64.
#import core/layout.wgsl
#import geometry/records.wgsl
#import geometry/scene.wgsl
#import shading/texture.wgsl
#if MOTION
#import geometry/motion.wgsl
#endif

// Directions in which u and v grow, of any length; 0 where there are none.
struct Tangents {
    along_u: vec3<f32>,
    along_v: vec3<f32>,
}

fn surface_tangents(kind: u32, first: u32, normal: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>) -> Tangents {
#if FLAT_ROUND
    if kind == KIND_DISK || kind == KIND_PLANE {
        return Tangents(vec3<f32>(0.0), vec3<f32>(0.0));
    }
#endif
#if ATTRIBUTES
    if first != NONE {
#if SPHERES
        if kind == KIND_SPHERE {
            return sphere_tangents(first, normal);
        }
#endif
        let words = attribute_words(first);
        let uv0 = vec2<f32>(words.w0.w, words.w1.w);
        let du = vec2<f32>(words.w2.w, words.w3.x) - uv0;
        let dv = words.w3.yz - uv0;
        // Only directions matter, so the determinant's sign is enough.
        let orientation = sign(du.x * dv.y - du.y * dv.x);
        return Tangents((edge_u * dv.y - edge_v * du.y) * orientation, (edge_v * du.x - edge_u * dv.x) * orientation);
    }
#endif
    return Tangents(edge_u, edge_v);
}

#if ATTRIBUTES
#if SPHERES
fn sphere_tangents(first: u32, normal_now: vec3<f32>) -> Tangents {
    var normal = normal_now;
#if MOTION
    var to_now = mat3x3<f32>(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    let moving = motion_of_attributes(first);
    if moving != NONE {
        to_now = motion_at_path_time(moving).linear;
        // The transpose of a rotation, up to a factor, takes it back.
        normal = normalize(normal * to_now);
    }
#endif
    let words = attribute_words(first);
    let row_x = words.w0.xyz;
    let row_y = words.w1.xyz;
    let row_z = words.w2.xyz;
    let d = vec3<f32>(dot(row_x, normal), dot(row_y, normal), dot(row_z, normal));
    let radius = length(d.xz);
    if radius == 0.0 {
        return Tangents(vec3<f32>(0.0), vec3<f32>(0.0));
    }
    let along_u = row_z * d.x - row_x * d.z;
    let along_v = row_y * radius - (row_x * d.x + row_z * d.z) * (d.y / radius);
#if MOTION
    return Tangents(to_now * along_u, to_now * along_v);
#else
    return Tangents(along_u, along_v);
#endif
}
#endif
#endif

// The shading normal as the material's map bends it; as it is where there is no map or no tangent. `shading` is 0 where it is the
// geometric one, and may be of any length.
fn mapped_normal(
    material: u32, kind: u32, first: u32, shading: vec3<f32>, geometric: vec3<f32>, uv: vec2<f32>,
    edge_u: vec3<f32>, edge_v: vec3<f32>
) -> vec3<f32> {
    let texture = bitcast<u32>(tables[material * MATERIAL_WORDS + 4u].y);
    if texture == NONE {
        return shading;
    }
    var normal = geometric;
    if dot(shading, shading) > 0.0 {
        normal = normalize(shading);
    }
    let tangents = surface_tangents(kind, first, geometric, edge_u, edge_v);
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
