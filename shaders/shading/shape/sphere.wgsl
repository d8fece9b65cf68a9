// Points of spheres. Directions to those that are lights: shading/light/sphere_light.wgsl.
#import core/math.wgsl
#import geometry/shape/sphere.wgsl
#import geometry/prepared_ray.wgsl
#import shading/shape_point.wgsl
#import core/layout.wgsl
#import geometry/records.wgsl
#import shading/texture/attributes.wgsl
#import geometry/motion.wgsl
#import shading/light/sphere_light.wgsl

fn sphere_point(ray: Ray, hit: Hit, center: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> ShapePoint {
    let normal = normalize(ray.origin + hit.t * ray.direction - center);
    let nothing = vec3<f32>(0.0);
    return ShapePoint(center + p1.x * normal, normal, vec2<f32>(hit.u, hit.v), nothing, nothing, abs(center) + p1.x, 0.0, 0.0);
}

fn sphere_direction_pdf(ray: PreparedRay, center: vec4<f32>, l2: vec3<f32>, l3: vec3<f32>) -> f32 {
    let met = intersect_sphere(ray, INFINITY_DISTANCE, center.xyz, vec3<f32>(center.w, 0.0, 0.0), vec3<f32>(0.0)).x > 0.0;
    return select(0.0, sphere_cone_pdf(ray.origin, center.xyz, center.w), met);
}

// u = atan2(x, -z) / 2π (mod 1), v = acos(-y) / π of the direction from the centre in the sphere's own space: the attributes' first
// three vec4 hold the rows of the rotation into it.
fn sphere_uv(first: u32, normal_now: vec3<f32>) -> vec2<f32> {
    var normal = normal_now;
#if MOTION
    let moving = motion_of_attributes(first);
    if moving != NONE {
        // The transpose of a rotation, up to a factor, takes it back.
        normal = normal * motion_at_path_time(moving).linear;
    }
#endif
    let words = attribute_words(first);
    let direction = vec3<f32>(dot(words.w0.xyz, normal), dot(words.w1.xyz, normal), dot(words.w2.xyz, normal));
    let turns = atan2_turns(direction.x, -direction.z);
    return vec2<f32>(select(turns, turns + 1.0, turns < 0.0), 2.0 * atan2_turns(length(direction.xz), -direction.y));
}

fn sphere_attribute(first: u32, normal: vec3<f32>) -> Attribute {
    return Attribute(vec3<f32>(0.0), sphere_uv(first, normal));
}

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
    if HAS_MOTION {
        return Tangents(to_now * along_u, to_now * along_v);
    } else {
        return Tangents(along_u, along_v);
    }
}
