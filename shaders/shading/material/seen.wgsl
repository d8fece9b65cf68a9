// The view of a surface, on which the weights of its blends may depend.

struct Seen {
    // The cosine of the angle between the direction from where it is seen and the shading normal, from 0 to 1.
    cosine: f32,
    front: bool,
    // A ray of the camera that nothing has scattered sees it; read where weights depend on that alone.
    by_camera: bool,
#if WEIGHTS_BY_DIRECTION
    // The shading normal on the side from where it is seen.
    normal: vec3<f32>,
#endif
}

// The view from anywhere but the camera.
fn seen_by_light(cosine: f32, front: bool, normal: vec3<f32>) -> Seen {
    return Seen(
        cosine, front, false
#if WEIGHTS_BY_DIRECTION
        , normal
#endif
    );
}
