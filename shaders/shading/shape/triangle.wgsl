// Points of triangles.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/shape/triangle.wgsl
#import geometry/prepared_ray.wgsl
#import shading/shape_point.wgsl

// Contribution of a triangle's width to the error of its points: a ray that starts in its plane finds it
// again at a distance of rounding size, which grows with the triangle. A wide floor at height 0 has no other
// error to keep rays off it.
fn triangle_error(edge_u: vec3<f32>, edge_v: vec3<f32>) -> f32 {
    return 0.125 * POINT_ERROR * max_coordinate(abs(edge_u) + abs(edge_v));
}

fn triangle_point(ray: Ray, hit: Hit, p0: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> ShapePoint {
    return triangle_point_by_edges(hit, p0, p1 - p0, p2 - p0);
}

fn triangle_point_by_edges(hit: Hit, vertex: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>) -> ShapePoint {
    return flat_point(vertex, edge_u, edge_v, vec2<f32>(hit.u, hit.v), 0.5, triangle_error(edge_u, edge_v));
}

fn sample_triangle(vertex: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>, u: f32, v: f32) -> ShapePoint {
    let root = sqrt(u);
    return drawn_flat_point(vertex, edge_u, edge_v, vec2<f32>(1.0 - root, v * root), triangle_error(edge_u, edge_v));
}

fn triangle_direction_pdf(ray: PreparedRay, vertex: vec4<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>) -> f32 {
    let t = intersect_triangle(ray, INFINITY_DISTANCE, vertex.xyz, vertex.xyz + edge_u, vertex.xyz + edge_v).x;
    return area_pdf_by_solid_angle(t, ray.direction, normalize(cross(edge_u, edge_v)), vertex.w);
}
