// Shapes that move while the shutter is open. Everything is moved to where it is at the path's time before it is looked at.
#import core/exposure.wgsl
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/records.wgsl
#import geometry/scene.wgsl

// p to linear * (p - origin) + place.
struct Motion {
    linear: mat3x3<f32>,
    origin: vec3<f32>,
    place: vec3<f32>,
}

// When the path being traced sees the scene: 0 as the shutter opens, 1 as it closes.
var<private> path_time: f32;
// The motion looked up last and what it is at that time: neighbouring triangles share theirs.
var<private> known_motion: u32 = NONE;
var<private> known: Motion;

// To be called before anything is asked of the scene for a path.
fn set_path_time(pixel: u32, sample_in_pass: u32) {
    path_time = time_of_path(pixel, sample_in_pass);
    known_motion = NONE;
}

fn rotated(v: vec3<f32>, axis: vec3<f32>, sine_cosine: vec2<f32>) -> vec3<f32> {
    return v * sine_cosine.y + cross(axis, v) * sine_cosine.x + axis * (dot(axis, v) * (1.0 - sine_cosine.y));
}

// A motion takes 1 + 2 steps vec4 of the tables (src/packed/motion.rs):
//   (origin; number of steps), then of each step (start; kind), (change until the shutter closes; -)
//   a rotation: (axis; kind), (turns as the shutter opens, turns until it closes, -, -)
fn motion_at_path_time(first: u32) -> Motion {
    if first == known_motion {
        return known;
    }
    let header = tables[FIRST_MOTION_WORD + first];
    let end = first + 1u + 2u * bitcast<u32>(header.w);
    var linear = mat3x3<f32>(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    var offset = vec3<f32>(0.0);
    for (var word = first + 1u; word < end; word += 2u) {
        let start = tables[FIRST_MOTION_WORD + word];
        let change = tables[FIRST_MOTION_WORD + word + 1u];
        let kind = bitcast<u32>(start.w);
        let now = start.xyz + path_time * change.xyz;
        if kind == STEP_TRANSLATE {
            offset += now;
        } else if kind == STEP_SCALE {
            linear = mat3x3<f32>(now * linear[0], now * linear[1], now * linear[2]);
            offset *= now;
        } else {
            let turn = sin_cos_turns(fract(change.x + path_time * change.y));
            linear = mat3x3<f32>(
                rotated(linear[0], start.xyz, turn), rotated(linear[1], start.xyz, turn), rotated(linear[2], start.xyz, turn)
            );
            offset = rotated(offset, start.xyz, turn);
        }
    }
    known = Motion(linear, header.xyz, header.xyz + offset);
    known_motion = first;
    return known;
}

// Index of the motion of whatever has these attributes; NONE where it rests.
fn motion_of_attributes(first: u32) -> u32 {
    return bitcast<u32>(attribute_words(first).w3.w);
}

fn moved_point(motion: Motion, p: vec3<f32>) -> vec3<f32> {
    return motion.linear * (p - motion.origin) + motion.place;
}

// By the inverse transpose up to a positive factor: its columns are the cross products of the map's.
fn moved_normal(motion: Motion, n: vec3<f32>) -> vec3<f32> {
    let m = motion.linear;
    return n.x * cross(m[1], m[2]) + n.y * cross(m[2], m[0]) + n.z * cross(m[0], m[1]);
}

// 0 stays 0: no normal.
fn moved_unit_normal(motion: Motion, n: vec3<f32>) -> vec3<f32> {
    if dot(n, n) == 0.0 {
        return n;
    }
    return normalize(moved_normal(motion, n));
}

// The sum of the magnitudes that rounding of a moved point is relative to.
fn moved_magnitude(motion: Motion, size: vec3<f32>) -> vec3<f32> {
    let m = mat3x3<f32>(abs(motion.linear[0]), abs(motion.linear[1]), abs(motion.linear[2]));
    return m * (size + abs(motion.origin)) + abs(motion.place);
}

// The points of a primitive's record as a motion has moved them, and the sum of the magnitudes at rest that their rounding is relative to.
struct MovedPoints {
    p0: vec3<f32>,
    p1: vec3<f32>,
    p2: vec3<f32>,
    size: vec3<f32>,
}
