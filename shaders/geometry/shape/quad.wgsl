// A ray against a parallelogram: (t or -1, u, v). The points of its record are a corner and the edges from it.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/motion.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/shape_point.wgsl

fn intersect_quad(ray: PreparedRay, t_max: f32, corner: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>) -> vec3<f32> {
    let p = cross(ray.direction, edge_v);
    let inverse = 1.0 / dot(edge_u, p);
    let from_corner = ray.origin - corner;
    let u = dot(from_corner, p) * inverse;
    let q = cross(from_corner, edge_u);
    let v = dot(ray.direction, q) * inverse;
    let t = dot(edge_v, q) * inverse;
    let inside = min(u, v) >= -QUAD_OVERLAP && max(u, v) <= 1.0 + QUAD_OVERLAP;
    return vec3<f32>(select(-1.0, t, inside && t > 0.0 && t < t_max), u, v);
}

// Variant of `intersect_quad` with the plane's constants folded in: `normal` = edge_u x edge_v, `dual_u` and
// `dual_v` measure along the edges.
fn intersect_quad_constant(
    ray: PreparedRay, t_max: f32, corner: vec3<f32>, normal: vec3<f32>, dual_u: vec3<f32>, dual_v: vec3<f32>
) -> vec3<f32> {
    let to_corner = corner - ray.origin;
    let t = dot(normal, to_corner) / dot(normal, ray.direction);
    let r = t * ray.direction - to_corner;
    let u = dot(dual_u, r);
    let v = dot(dual_v, r);
    let inside = min(u, v) >= -QUAD_OVERLAP && max(u, v) <= 1.0 + QUAD_OVERLAP;
    return vec3<f32>(select(-1.0, t, inside && t > 0.0 && t < t_max), u, v);
}

fn move_quad(motion: Motion, corner: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>) -> MovedPoints {
    let size = abs(corner) + abs(edge_u) + abs(edge_v);
    return MovedPoints(moved_point(motion, corner), motion.linear * edge_u, motion.linear * edge_v, size);
}

fn quad_point(ray: Ray, hit: Hit, corner: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>) -> ShapePoint {
    return flat_point(corner, edge_u, edge_v, vec2<f32>(hit.u, hit.v), 1.0, 0.0);
}

fn sample_quad(corner: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>, u: f32, v: f32) -> ShapePoint {
    return drawn_flat_point(corner, edge_u, edge_v, vec2<f32>(u, v), 0.0);
}

fn quad_direction_pdf(ray: PreparedRay, corner: vec4<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>) -> f32 {
    let t = intersect_quad(ray, INFINITY_DISTANCE, corner.xyz, edge_u, edge_v).x;
    return area_pdf_by_solid_angle(t, ray.direction, normalize(cross(edge_u, edge_v)), corner.w);
}
