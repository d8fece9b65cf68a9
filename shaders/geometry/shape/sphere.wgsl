// A ray against a sphere: (t or -1, 0, 0). The points of its record are its center and (radius, 0, 0).
#import geometry/prepared_ray.wgsl
#import geometry/motion.wgsl

// The crossings of a ray's line and the sphere, nearer and farther; not above 0 where there are none. Roots are taken relative to the point of closest
// approach, which keeps them accurate for small and far spheres (Haines et al., Ray Tracing Gems, chapter 7).
fn sphere_crossings(ray: PreparedRay, center: vec3<f32>, radius: f32) -> vec2<f32> {
    let to_center = center - ray.origin;
    let along = dot(to_center, ray.direction);
    let across = to_center - along * ray.direction;
    let discriminant = radius * radius - dot(across, across);
    if discriminant < 0.0 {
        return vec2<f32>(-1.0);
    }
    let half_chord = sqrt(discriminant);
    // The product of the roots is |to_center|² - r²; the one that would cancel is found from the other.
    let outside = dot(to_center, to_center) - radius * radius;
    let far_root = along + select(-half_chord, half_chord, along >= 0.0);
    let other_root = select(0.0, outside / far_root, far_root != 0.0);
    return vec2<f32>(min(far_root, other_root), max(far_root, other_root));
}

fn intersect_sphere(ray: PreparedRay, t_max: f32, center: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> vec3<f32> {
    let crossings = sphere_crossings(ray, center, p1.x);
    let t = select(crossings.y, crossings.x, crossings.x > 0.0);
    return vec3<f32>(select(-1.0, t, t > 0.0 && t < t_max), 0.0, 0.0);
}

// The crossing behind the one that intersect_sphere finds.
fn intersect_sphere_again(ray: PreparedRay, t_max: f32, center: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> vec3<f32> {
    let crossings = sphere_crossings(ray, center, p1.x);
    return vec3<f32>(select(-1.0, crossings.y, crossings.x > 0.0 && crossings.y < t_max), 0.0, 0.0);
}

fn move_sphere(motion: Motion, center: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> MovedPoints {
    // Round shapes are scaled by the same factor along every axis.
    let radius = vec3<f32>(p1.x * length(motion.linear[0]), p1.yz);
    return MovedPoints(moved_point(motion, center), radius, p2, abs(center) + p1.x);
}
