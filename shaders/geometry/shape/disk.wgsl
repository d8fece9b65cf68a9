// A ray against a disk: (t or -1, 0, 0). The points of its record are its center, its normal and (radius, 0, 0).
#import core/math.wgsl
#import geometry/motion.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/shape_point.wgsl

fn intersect_disk(ray: PreparedRay, t_max: f32, center: vec3<f32>, normal: vec3<f32>, p2: vec3<f32>) -> vec3<f32> {
    let radius = p2.x;
    let to_center = center - ray.origin;
    let t = dot(normal, to_center) / dot(normal, ray.direction);
    let r = t * ray.direction - to_center;
    return vec3<f32>(select(-1.0, t, dot(r, r) <= radius * radius && t > 0.0 && t < t_max), 0.0, 0.0);
}

fn move_disk(motion: Motion, center: vec3<f32>, normal: vec3<f32>, p2: vec3<f32>) -> MovedPoints {
    let moved = motion.linear * normal;
    let scale = length(moved);
    return MovedPoints(moved_point(motion, center), moved / scale, vec3<f32>(p2.x * scale, p2.yz), abs(center) + p2.x);
}

// The point along the ray is put back onto the plane.
fn disk_point(ray: Ray, hit: Hit, center: vec3<f32>, normal: vec3<f32>, p2: vec3<f32>) -> ShapePoint {
    let along = ray.origin + hit.t * ray.direction;
    let position = along + normal * dot(normal, center - along);
    let area = PI * p2.x * p2.x;
    let nothing = vec3<f32>(0.0);
    return ShapePoint(position, normal, vec2<f32>(hit.u, hit.v), nothing, nothing, abs(center) + abs(position), 0.0, area);
}

// Samples a disk light, given by its center and two perpendicular radii.
fn sample_disk(center: vec3<f32>, radius_u: vec3<f32>, radius_v: vec3<f32>, u: f32, v: f32) -> ShapePoint {
    let circle = sin_cos_turns(v);
    let r = sqrt(u);
    return drawn_flat_point(center, radius_u, radius_v, vec2<f32>(r * circle.y, r * circle.x), 0.0);
}

fn disk_direction_pdf(ray: PreparedRay, center: vec4<f32>, radius_u: vec3<f32>, radius_v: vec3<f32>) -> f32 {
    let normal = normalize(cross(radius_u, radius_v));
    let t = intersect_disk(ray, INFINITY_DISTANCE, center.xyz, normal, vec3<f32>(length(radius_u), 0.0, 0.0)).x;
    return area_pdf_by_solid_angle(t, ray.direction, normal, center.w);
}
