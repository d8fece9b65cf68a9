// Camera rays. src/reference/camera.rs is the same in f64.
#import core/layout.wgsl
#import core/math.wgsl
#import core/parameters.wgsl
#import core/sampler.wgsl

#if FILTER
// Distance of a sample from the pixel's centre along one axis, in radii of the filter (src/sampling/filter.rs).
fn filter_offset(u: f32) -> f32 {
    let signed_share = 2.0 * u - 1.0;
#if FILTER_BOX
    return signed_share;
#else
    let tail = 1.0 - abs(signed_share);
#if FILTER_CURVE
    let scaled = (1.0 - sqrt(sqrt(tail))) * 32.0;
    let piece = min(u32(scaled), 31u);
    let s = scaled - f32(piece);
    let c = view.filter_curve[piece];
    let distance = c.x + s * (c.y + s * (c.z + s * c.w));
#else
    let distance = 1.0 - sqrt(tail);
#endif
    return select(distance, -distance, signed_share < 0.0);
#endif
}
#endif

// Position of the sample in the picture, in pixels.
fn sample_position(pixel: u32, random: vec4<u32>) -> vec2<f32> {
    // Division by a constant is a multiplication and a shift.
    let y = pixel / FILM_WIDTH;
    let x = pixel - y * FILM_WIDTH;
    let u = uniform_float(random.x);
    let v = uniform_float(random.y);
#if FILTER
    let radius = view.forward.w;
    return vec2<f32>(f32(x) + 0.5 + radius * filter_offset(u), f32(y) + 0.5 + radius * filter_offset(v));
#else
    return vec2<f32>(f32(x) + u, f32(y) + v);
#endif
}

#if LENS
// A point of the aperture, in its radii.
fn aperture_point(bits_u: u32, bits_v: u32) -> vec2<f32> {
    let v = uniform_float(bits_v);
#if APERTURE_SQUARE
    return vec2<f32>(2.0 * uniform_float(bits_u) - 1.0, 2.0 * v - 1.0);
#else
#if APERTURE_POLYGON
    // One of the triangles between the centre and two corners; what the choice leaves of the bits serves again.
    let corner = f32(multiply_high(bits_u, BLADES));
    let root = sqrt(uniform_float(bits_u * BLADES));
    let first = sin_cos_turns(fract(corner / f32(BLADES) + view.lens_v.w));
    let second = sin_cos_turns(fract((corner + 1.0) / f32(BLADES) + view.lens_v.w));
    return root * ((1.0 - v) * first.yx + v * second.yx);
#else
    return sqrt(uniform_float(bits_u)) * sin_cos_turns(v).yx;
#endif
#endif
}
#endif

// Position and orientation of the camera at the path's time: words of the view.
struct Pose {
    position: vec4<f32>,
    corner: vec4<f32>,
    step_x: vec4<f32>,
    step_y: vec4<f32>,
    forward: vec4<f32>,
    lens_u: vec4<f32>,
    lens_v: vec4<f32>,
}

#if CAMERA_MOTION
// A word of the pose, `share` of the way through a stretch of the exposure.
fn exposed(stretch: u32, word: u32, share: f32) -> vec4<f32> {
    let start = view.exposure[stretch][word];
    return start + share * (view.exposure[stretch + 1u][word] - start);
}

// At the time of a path, which is that of its shapes (geometry/motion.wgsl).
fn pose_of(pixel: u32, sample_in_pass: u32) -> Pose {
    let scaled = uniform_float(random_block(pixel, sample_in_pass, 1u).x) * f32(EXPOSURE_STRETCHES);
    let stretch = min(u32(scaled), EXPOSURE_STRETCHES - 1u);
    let share = scaled - f32(stretch);
    return Pose(
        exposed(stretch, 0u, share), exposed(stretch, 1u, share), exposed(stretch, 2u, share), exposed(stretch, 3u, share),
        exposed(stretch, 4u, share), exposed(stretch, 5u, share), exposed(stretch, 6u, share)
    );
}
#else
fn pose_of(pixel: u32, sample_in_pass: u32) -> Pose {
    return Pose(view.position, view.corner, view.step_x, view.step_y, view.forward, view.lens_u, view.lens_v);
}
#endif

fn camera_ray(pixel: u32, sample_in_pass: u32) -> Ray {
    let random = camera_block(pixel, sample_in_pass);
    let film = sample_position(pixel, random);
    let pose = pose_of(pixel, sample_in_pass);
#if ORTHOGRAPHIC
    var origin = pose.position.xyz + (pose.corner.xyz + film.x * pose.step_x.xyz + film.y * pose.step_y.xyz);
    var direction = pose.forward.xyz;
#else
    var origin = pose.position.xyz;
    var direction = pose.corner.xyz + film.x * pose.step_x.xyz + film.y * pose.step_y.xyz;
#endif
#if LENS
    // All rays of a film position meet where the one through the middle of the lens crosses the plane in focus.
    let aperture = aperture_point(random.z, random.w);
    let offset = aperture.x * pose.lens_u.xyz + aperture.y * pose.lens_v.xyz;
    origin += offset;
    direction = pose.lens_u.w * direction - offset;
#endif
    return Ray(origin, normalize(direction));
}
