// A ray against a disk: (t or -1, 0, 0). The points of its record are its center, its normal and (radius, 0, 0).
#import geometry/prepared_ray.wgsl
#import geometry/motion.wgsl

fn intersect_disk(ray: PreparedRay, t_max: f32, center: vec3<f32>, normal: vec3<f32>, p2: vec3<f32>) -> vec3<f32> {
    let radius = p2.x;
    let to_center = center - ray.origin;
    let t = dot(normal, to_center) / dot(normal, ray.direction);
    let r = t * ray.direction - to_center;
    return vec3<f32>(select(-1.0, t, dot(r, r) <= radius * radius && t > 0.0 && t < t_max), 0.0, 0.0);
}

fn move_disk(motion: Motion, center: vec3<f32>, normal: vec3<f32>, p2: vec3<f32>) -> MovedPoints {
    let moved = motion.linear * normal;
    let scale = length(moved);
    return MovedPoints(moved_point(motion, center), moved / scale, vec3<f32>(p2.x * scale, p2.yz), abs(center) + p2.x);
}
