// A ray against a triangle: (t or -1, weights of the second and third vertex). The points of its record are its vertices.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/motion.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/shape_point.wgsl

// a·b - c·d with the sign of the exact value, whether or not fma is fused (Kahan's difference of products).
fn difference_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    let cd = c * d;
    return fma(a, b, -cd) + fma(-c, d, cd);
}

fn project(ray: PreparedRay, p: vec3<f32>) -> vec3<f32> {
    let r = p - ray.origin;
    return vec3<f32>(dot(ray.across_x, r), dot(ray.across_y, r), dot(ray.direction, r));
}

// Watertight (after Woop, Benthin and Wald 2013): vertices are projected along the ray one by one, so that triangles sharing a
// vertex see the same projected point, and the signs of the edge functions are exact.
fn intersect_triangle(ray: PreparedRay, t_max: f32, p0: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> vec3<f32> {
    let a = project(ray, p0);
    let b = project(ray, p1);
    let c = project(ray, p2);
    let e0 = difference_of_products(c.x, b.y, c.y, b.x);
    let e1 = difference_of_products(a.x, c.y, a.y, c.x);
    let e2 = difference_of_products(b.x, a.y, b.y, a.x);
    let determinant = e0 + e1 + e2;
    let mixed = min(e0, min(e1, e2)) < 0.0 && max(e0, max(e1, e2)) > 0.0;
    let inverse = 1.0 / determinant;
    let t = (e0 * a.z + e1 * b.z + e2 * c.z) * inverse;
    let met = !mixed && determinant != 0.0 && t > 0.0 && t < t_max;
    return vec3<f32>(select(-1.0, t, met), e1 * inverse, e2 * inverse);
}

fn move_triangle(motion: Motion, p0: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> MovedPoints {
    let size = max(abs(p0), max(abs(p1), abs(p2)));
    return MovedPoints(moved_point(motion, p0), moved_point(motion, p1), moved_point(motion, p2), size);
}

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
