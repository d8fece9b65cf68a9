// Camera rays. src/reference/camera.rs is the same in f64.
#import core/camera_models.wgsl
#import core/exposure.wgsl
#import core/layout.wgsl
#import core/math.wgsl
#import core/parameters.wgsl
#import core/sampler.wgsl

// Distance of a sample from the pixel's centre along one axis, in radii of the filter (src/sampling/filter.rs).
fn filter_offset(u: f32) -> f32 {
    let signed_share = 2.0 * u - 1.0;
    if HAS_FILTER_BOX {
        return signed_share;
    }
    let tail = 1.0 - abs(signed_share);
    var distance = 1.0 - sqrt(tail);
    if HAS_FILTER_CURVE {
        let scaled = (1.0 - sqrt(sqrt(tail))) * 32.0;
        let piece = min(u32(scaled), 31u);
        let s = scaled - f32(piece);
        let c = view.filter_curve[piece];
        distance = c.x + s * (c.y + s * (c.z + s * c.w));
    }
    return select(distance, -distance, signed_share < 0.0);
}

// The place of the sample in the picture, in pixels.
fn sample_position(pixel: u32, random: vec4<u32>) -> vec2<f32> {
    // Division by a constant is a multiplication and a shift.
    let y = pixel / FILM_WIDTH;
    let x = pixel - y * FILM_WIDTH;
    let u = uniform_float(random.x);
    let v = uniform_float(random.y);
    if HAS_FILTER {
        let radius = view.forward.w;
        return vec2<f32>(f32(x) + 0.5 + radius * filter_offset(u), f32(y) + 0.5 + radius * filter_offset(v));
    }
    return vec2<f32>(f32(x) + u, f32(y) + v);
}

// A point of the aperture, in its radii.
fn aperture_point(bits_u: u32, bits_v: u32) -> vec2<f32> {
    let v = uniform_float(bits_v);
    if HAS_APERTURE_SQUARE {
        return vec2<f32>(2.0 * uniform_float(bits_u) - 1.0, 2.0 * v - 1.0);
    }
    if HAS_APERTURE_POLYGON {
        // One of the triangles between the centre and two corners; the bits that the choice leaves serve
        // again.
        let corner = f32(multiply_high(bits_u, BLADES));
        let root = sqrt(uniform_float(bits_u * BLADES));
        let first = sin_cos_turns(fract(corner / f32(BLADES) + view.lens_v.w));
        let second = sin_cos_turns(fract((corner + 1.0) / f32(BLADES) + view.lens_v.w));
        return root * ((1.0 - v) * first.yx + v * second.yx);
    }
    return sqrt(uniform_float(bits_u)) * sin_cos_turns(v).yx;
}

// The camera at the time when a path sees the scene: words of the view.
struct Pose {
    position: vec4<f32>,
    corner: vec4<f32>,
    step_x: vec4<f32>,
    step_y: vec4<f32>,
    forward: vec4<f32>,
    lens_u: vec4<f32>,
    lens_v: vec4<f32>,
    eye: vec4<f32>,
}

// A word of the pose, `share` of the way through a stretch of the exposure.
fn exposed(stretch: u32, word: u32, share: f32) -> vec4<f32> {
    let start = view.exposure[stretch][word];
    return start + share * (view.exposure[stretch + 1u][word] - start);
}

// The pose at the time of a path, which is that of its shapes (geometry/motion.wgsl).
fn pose_of(pixel: u32, sample_in_pass: u32) -> Pose {
    if !HAS_CAMERA_MOTION {
        return Pose(view.position, view.corner, view.step_x, view.step_y, view.forward, view.lens_u, view.lens_v, view.eye);
    }
    let scaled = time_of_path(pixel, sample_in_pass) * f32(EXPOSURE_STRETCHES);
    let stretch = min(u32(scaled), EXPOSURE_STRETCHES - 1u);
    let share = scaled - f32(stretch);
    return Pose(
        exposed(stretch, 0u, share), exposed(stretch, 1u, share), exposed(stretch, 2u, share), exposed(stretch, 3u, share),
        exposed(stretch, 4u, share), exposed(stretch, 5u, share), exposed(stretch, 6u, share), exposed(stretch, 7u, share)
    );
}

// The view of the picture that a pixel belongs to.
struct Tile {
    number: u32,
    // Its upper left corner in the picture, in pixels.
    corner: vec2<f32>,
}

fn tile_of(pixel: u32) -> Tile {
    let y = pixel / FILM_WIDTH;
    let row = y / TILE_HEIGHT;
    let column = (pixel - y * FILM_WIDTH) / TILE_WIDTH;
    return Tile(row * TILE_COLUMNS + column, vec2<f32>(f32(column * TILE_WIDTH), f32(row * TILE_HEIGHT)));
}

// From the camera to the eye of a view, which looks along `seen`, to the right, up and backward.
fn eye_of(pose: Pose, tile: u32, seen: vec3<f32>) -> vec3<f32> {
    var eye = pose.eye.xyz;
#if TURNING_EYES
    // Along the horizon, at a right angle to the direction.
    let level = length(seen.xz);
    eye = select(0.0, pose.eye.w / level, level > 0.0) * (-seen.z * pose.step_x.xyz - seen.x * pose.forward.xyz);
#endif
    return select(-eye, eye, tile == 1u);
}

struct CameraRay {
    ray: Ray,
    // False where the place of the picture sees nothing; the ray has no meaning then.
    sees: bool,
}

fn camera_ray(pixel: u32, sample_in_pass: u32) -> CameraRay {
    let random = camera_block(pixel, sample_in_pass);
    var film = sample_position(pixel, random);
    let pose = pose_of(pixel, sample_in_pass);
    var tile: Tile;
    if HAS_CAMERA_TILES {
        // Samples of a view's edge reach over into what the view would show there.
        tile = tile_of(pixel);
        film -= tile.corner;
    }
    var seen = vec4<f32>(0.0, 0.0, -1.0, 1.0);
    var origin = pose.position.xyz;
#if CAMERA_MODEL
    seen = camera_model_direction(film, tile.number);
    var direction = seen.x * pose.step_x.xyz + seen.y * pose.step_y.xyz - seen.z * pose.forward.xyz;
    if HAS_CAMERA_INWARD {
        origin += view.convergence.y * normalize(direction);
        direction = -direction;
    }
#else
    let on_film = pose.corner.xyz + film.x * pose.step_x.xyz + film.y * pose.step_y.xyz;
    var direction = on_film;
    if HAS_ORTHOGRAPHIC {
        origin += on_film;
        direction = pose.forward.xyz;
    }
#endif
    if HAS_STEREO {
        let eye = eye_of(pose, tile.number, seen.xyz);
        origin += eye;
        direction -= view.convergence.x * eye;
    }
    if HAS_LENS {
        // All rays of a film position meet where the one through the middle of the lens crosses the plane in
        // focus.
        let aperture = aperture_point(random.z, random.w);
        let offset = aperture.x * pose.lens_u.xyz + aperture.y * pose.lens_v.xyz;
        origin += offset;
        direction = pose.lens_u.w * direction - offset;
    }
    return CameraRay(Ray(origin, normalize(direction)), seen.w > 0.0);
}
