// Points of disks.
#import core/math.wgsl
#import geometry/shape/disk.wgsl
#import geometry/prepared_ray.wgsl
#import shading/shape_point.wgsl

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
