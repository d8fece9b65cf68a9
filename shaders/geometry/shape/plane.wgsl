// A ray against an infinite plane: (t or -1, 0, 0). The points of its record are one of its own and its normal.
#import geometry/prepared_ray.wgsl

fn intersect_plane(ray: PreparedRay, t_max: f32, point: vec3<f32>, normal: vec3<f32>, p2: vec3<f32>) -> vec3<f32> {
    let t = dot(normal, point - ray.origin) / dot(normal, ray.direction);
    return vec3<f32>(select(-1.0, t, t > 0.0 && t < t_max), 0.0, 0.0);
}
