// How a surface is seen: what the weights of its blends may depend on.

struct Seen {
    // The cosine of the angle between the direction from where it is seen and the shading normal, from 0 to 1.
    cosine: f32,
    front: bool,
#if WEIGHTS_BY_VIEWER
    // By a ray of the camera that nothing has scattered.
    by_camera: bool,
#endif
}

// By anything but the camera.
fn seen_by_light(cosine: f32, front: bool) -> Seen {
#if WEIGHTS_BY_VIEWER
    return Seen(cosine, front, false);
#else
    return Seen(cosine, front);
#endif
}
