// One ray against one primitive. Each function returns the nearest t in (0, t_max) in `t`, or -1.
#import core/layout.wgsl
#import core/math.wgsl

// A ray with what its tests share: two axes across it, so that points can be projected along the ray.
struct PreparedRay {
    origin: vec3<f32>,
    direction: vec3<f32>,
    across_x: vec3<f32>,
    across_y: vec3<f32>,
}

fn prepare_ray(ray: Ray) -> PreparedRay {
    let frame = frame_from_normal(ray.direction);
    return PreparedRay(ray.origin, ray.direction, frame.tangent, frame.bitangent);
}

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

// A parallelogram; returns (t, u, v).
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

// The same with the plane's constants folded in: `normal` = edge_u x edge_v, `dual_u` and `dual_v` measure along the edges.
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

// Roots are taken relative to the point of closest approach, which keeps them accurate for small and far spheres
// (Haines et al., Ray Tracing Gems, chapter 7).
fn intersect_sphere(ray: PreparedRay, t_max: f32, center: vec3<f32>, radius: f32) -> f32 {
    let to_center = center - ray.origin;
    let along = dot(to_center, ray.direction);
    let across = to_center - along * ray.direction;
    let discriminant = radius * radius - dot(across, across);
    if discriminant < 0.0 {
        return -1.0;
    }
    let half_chord = sqrt(discriminant);
    // The product of the roots is |to_center|² - r²; the one that would cancel is found from the other.
    let outside = dot(to_center, to_center) - radius * radius;
    let far_root = along + select(-half_chord, half_chord, along >= 0.0);
    let other_root = select(0.0, outside / far_root, far_root != 0.0);
    let near = min(far_root, other_root);
    let far = max(far_root, other_root);
    let t = select(far, near, near > 0.0);
    return select(-1.0, t, t > 0.0 && t < t_max);
}

fn intersect_disk(ray: PreparedRay, t_max: f32, center: vec3<f32>, normal: vec3<f32>, radius: f32) -> f32 {
    let to_center = center - ray.origin;
    let t = dot(normal, to_center) / dot(normal, ray.direction);
    let r = t * ray.direction - to_center;
    return select(-1.0, t, dot(r, r) <= radius * radius && t > 0.0 && t < t_max);
}

fn intersect_plane(ray: PreparedRay, t_max: f32, point: vec3<f32>, normal: vec3<f32>) -> f32 {
    let t = dot(normal, point - ray.origin) / dot(normal, ray.direction);
    return select(-1.0, t, t > 0.0 && t < t_max);
}
