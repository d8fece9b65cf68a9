// A ray against a triangle: (t or -1, weights of the second and third vertex). The points of its record are its vertices.
#import geometry/prepared_ray.wgsl
#import geometry/motion.wgsl

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
