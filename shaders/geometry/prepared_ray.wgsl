// A ray as every test of it against a shape takes it.
#import core/layout.wgsl
#import core/math.wgsl

// A ray with what its tests share: two axes across it, so that points can be projected along the ray.
struct PreparedRay {
    origin: vec3<f32>,
    direction: vec3<f32>,
    across_x: vec3<f32>,
    across_y: vec3<f32>,
#if INSTANCES
    // In whose space it is, or NONE.
    instance: u32,
#endif
}

fn prepare_ray(ray: Ray) -> PreparedRay {
    let frame = frame_from_normal(ray.direction);
    return PreparedRay(
        ray.origin, ray.direction, frame.tangent, frame.bitangent
#if INSTANCES
        , NONE
#endif
    );
}
