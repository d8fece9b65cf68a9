// How a surface is seen: what the weights of its blends may depend on.

struct Seen {
    // The cosine of the angle between the direction from which it is seen and the shading normal, from 0 to 1.
    cosine: f32,
    front: bool,
    // Seen by a ray of the camera that nothing has scattered.
    by_camera: bool,
}

// Seen by anything but the camera.
fn seen_by_light(cosine: f32, front: bool) -> Seen {
    return Seen(cosine, front, false);
}
