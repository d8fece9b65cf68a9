// Points of infinite planes.
#import core/math.wgsl
#import shading/shape_point.wgsl

// The point along the ray is put back onto the plane.
fn plane_point(ray: Ray, hit: Hit, point: vec3<f32>, normal: vec3<f32>, p2: vec3<f32>) -> ShapePoint {
    let along = ray.origin + hit.t * ray.direction;
    let position = along + normal * dot(normal, point - along);
    let nothing = vec3<f32>(0.0);
    return ShapePoint(position, normal, vec2<f32>(hit.u, hit.v), nothing, nothing, abs(point) + abs(position), 0.0, 0.0);
}
