// A ray against an infinite plane: (t or -1, 0, 0). The points of its record are one of its own and its normal.
#import core/math.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/shape_point.wgsl

fn intersect_plane(ray: PreparedRay, t_max: f32, point: vec3<f32>, normal: vec3<f32>, p2: vec3<f32>) -> vec3<f32> {
    let t = dot(normal, point - ray.origin) / dot(normal, ray.direction);
    return vec3<f32>(select(-1.0, t, t > 0.0 && t < t_max), 0.0, 0.0);
}

// The point along the ray is put back onto the plane.
fn plane_point(ray: Ray, hit: Hit, point: vec3<f32>, normal: vec3<f32>, p2: vec3<f32>) -> ShapePoint {
    let along = ray.origin + hit.t * ray.direction;
    let position = along + normal * dot(normal, point - along);
    let nothing = vec3<f32>(0.0);
    return ShapePoint(position, normal, vec2<f32>(hit.u, hit.v), nothing, nothing, abs(point) + abs(position), 0.0, 0.0);
}
