// A ray against a sphere: (t or -1, 0, 0). The points of its record are its center and (radius, 0, 0).
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/motion.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/records.wgsl
#import geometry/shape_point.wgsl

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

fn sphere_point(ray: Ray, hit: Hit, center: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> ShapePoint {
    let normal = normalize(ray.origin + hit.t * ray.direction - center);
    let nothing = vec3<f32>(0.0);
    return ShapePoint(center + p1.x * normal, normal, vec2<f32>(hit.u, hit.v), nothing, nothing, abs(center) + p1.x, 0.0, 0.0);
}

// Density of directions drawn evenly from the cone of those that meet the sphere, or from inside over all directions.
fn sphere_cone_pdf(reference: vec3<f32>, center: vec3<f32>, radius: f32) -> f32 {
    let to_center = center - reference;
    let center_distance2 = dot(to_center, to_center);
    let radius2 = radius * radius;
    if center_distance2 <= radius2 {
        return 0.25 * INVERSE_PI;
    }
    let sin2_max = radius2 / center_distance2;
    return (1.0 + sqrt(max(0.0, 1.0 - sin2_max))) / (TWO_PI * sin2_max);
}

fn sphere_direction_pdf(ray: PreparedRay, center: vec4<f32>, l2: vec3<f32>, l3: vec3<f32>) -> f32 {
    let met = intersect_sphere(ray, INFINITY_DISTANCE, center.xyz, vec3<f32>(center.w, 0.0, 0.0), vec3<f32>(0.0)).x > 0.0;
    return select(0.0, sphere_cone_pdf(ray.origin, center.xyz, center.w), met);
}

// u = atan2(x, -z) / 2π (mod 1), v = acos(-y) / π of the direction from the centre in the sphere's own space: the attributes' first
// three vec4 hold the rows of the rotation into it.
fn sphere_uv(first: u32, normal_now: vec3<f32>) -> vec2<f32> {
    var normal = normal_now;
#if MOTION
    let moving = motion_of_attributes(first);
    if moving != NONE {
        // The transpose of a rotation, up to a factor, takes it back.
        normal = normal * motion_at_path_time(moving).linear;
    }
#endif
    let words = attribute_words(first);
    let direction = vec3<f32>(dot(words.w0.xyz, normal), dot(words.w1.xyz, normal), dot(words.w2.xyz, normal));
    let turns = atan2_turns(direction.x, -direction.z);
    return vec2<f32>(select(turns, turns + 1.0, turns < 0.0), 2.0 * atan2_turns(length(direction.xz), -direction.y));
}

fn sphere_tangents(first: u32, normal_now: vec3<f32>) -> Tangents {
    var normal = normal_now;
#if MOTION
    var to_now = mat3x3<f32>(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    let moving = motion_of_attributes(first);
    if moving != NONE {
        to_now = motion_at_path_time(moving).linear;
        // The transpose of a rotation, up to a factor, takes it back.
        normal = normalize(normal * to_now);
    }
#endif
    let words = attribute_words(first);
    let row_x = words.w0.xyz;
    let row_y = words.w1.xyz;
    let row_z = words.w2.xyz;
    let d = vec3<f32>(dot(row_x, normal), dot(row_y, normal), dot(row_z, normal));
    let radius = length(d.xz);
    if radius == 0.0 {
        return Tangents(vec3<f32>(0.0), vec3<f32>(0.0));
    }
    let along_u = row_z * d.x - row_x * d.z;
    let along_v = row_y * radius - (row_x * d.x + row_z * d.z) * (d.y / radius);
    if HAS_MOTION {
        return Tangents(to_now * along_u, to_now * along_v);
    } else {
        return Tangents(along_u, along_v);
    }
}
