// Layers of the point that a ray met as a point of its object: its place in the object's own space, and its way across the picture while the shutter
// is open. src/reference/layer.rs is the same in f64.
#import core/camera.wgsl
#import core/layout.wgsl
#import core/math.wgsl
#import core/parameters.wgsl
#import geometry/instance.wgsl
#import geometry/motion.wgsl
#import geometry/records.wgsl
#import geometry/scene.wgsl

// First word of the motion of what a ray met; NONE where it rests.
fn motion_of_hit(hit: Hit) -> u32 {
    if HAS_INSTANCES && hit.instance != NONE {
        return bitcast<u32>(instance_word(hit.instance, 2u).w);
    }
    if (bitcast<u32>(primitive_word(hit.primitive, 0u).w) & PRIMITIVE_MOVES) == 0u {
        return NONE;
    }
    return motion_of_attributes(bitcast<u32>(primitive_word(hit.primitive, 2u).w));
}

// The point about which a hit's motion is given: an instance's place, or the world's origin.
fn pivot_of_hit(hit: Hit) -> vec3<f32> {
    if HAS_INSTANCES && hit.instance != NONE {
        return instance_place(instance_words(hit.instance));
    }
    return vec3<f32>(0.0);
}

// The point that a motion has moved here.
fn unmoved_point(motion: Motion, p: vec3<f32>) -> vec3<f32> {
    let m = motion.linear;
    let rows = mat3x3<f32>(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    return ((p - motion.place) * rows) / dot(m[0], rows[0]) + motion.origin;
}

// The place at rest, from the pivot, of a hit's place at the path's time.
fn place_at_rest(hit: Hit, position: vec3<f32>) -> vec3<f32> {
    let place = position - pivot_of_hit(hit);
    if HAS_MOTION {
        let moving = motion_of_hit(hit);
        if moving != NONE {
            return unmoved_point(motion_at_path_time(moving), place);
        }
    }
    return place;
}

// The place in the space of a hit's object.
fn object_position(hit: Hit, position: vec3<f32>) -> vec3<f32> {
    let at_rest = place_at_rest(hit, position);
    if HAS_INSTANCES && hit.instance != NONE {
        let words = instance_words(hit.instance);
        return at_rest * mat3x3<f32>(words.w0.xyz, words.w1.xyz, words.w2.xyz);
    }
    if HAS_OBJECT_MAPS {
        let named = bitcast<vec4<u32>>(tables[FIRST_OBJECT_WORD + hit.primitive / 4u]);
        let row = FIRST_OBJECT_WORD + named[hit.primitive % 4u];
        let point = vec4<f32>(at_rest, 1.0);
        return vec3<f32>(dot(tables[row], point), dot(tables[row + 1u], point), dot(tables[row + 2u], point));
    }
    return at_rest;
}

// The place of a point in the world at a time, from its place at rest.
fn place_at_time(moving: u32, at_rest: vec3<f32>, time: f32) -> vec3<f32> {
    path_time = time;
    known_motion = NONE;
    return moved_point(motion_at_path_time(moving), at_rest);
}

// A place of the picture in two parts, whose differences lose less than that of their sum: in pixels from where the axis meets it, and the rest of
// the way to the corner.
struct PicturePlace {
    from_axis: vec2<f32>,
    to_corner: vec2<f32>,
    // The point lies before the camera.
    is_seen: bool,
}

// The place at which a camera whose picture is flat shows a point.
fn place_in_picture(pose: Pose, pixel: u32, position: vec3<f32>) -> PicturePlace {
    var way = position - pose.position.xyz;
    if HAS_STEREO {
        way -= select(-pose.eye.xyz, pose.eye.xyz, tile_of(pixel).number == 1u);
    }
    // The film's axes are at a right angle to each other and to the viewing direction.
    let scale = vec2<f32>(1.0 / dot(pose.step_x.xyz, pose.step_x.xyz), 1.0 / dot(pose.step_y.xyz, pose.step_y.xyz));
    let across = vec2<f32>(dot(way, pose.step_x.xyz), dot(way, pose.step_y.xyz)) * scale;
    let corner = vec2<f32>(dot(pose.corner.xyz, pose.step_x.xyz), dot(pose.corner.xyz, pose.step_y.xyz)) * scale;
    if HAS_ORTHOGRAPHIC {
        return PicturePlace(across, corner, true);
    } else {
        let depth = dot(way, pose.forward.xyz);
        return PicturePlace(across / depth, corner, depth > 0.0);
    }
}

// The pose as the shutter opens, or, with the last stretch's end, as it closes.
fn pose_at_end(closes: bool) -> Pose {
    if HAS_CAMERA_MOTION {
        let step = select(0u, EXPOSURE_STRETCHES, closes);
        return Pose(
            view.exposure[step][0], view.exposure[step][1], view.exposure[step][2], view.exposure[step][3],
            view.exposure[step][4], view.exposure[step][5], view.exposure[step][6], view.exposure[step][7]
        );
    }
    return Pose(view.position, view.corner, view.step_x, view.step_y, view.forward, view.lens_u, view.lens_v, view.eye);
}

// How far a hit goes across the picture while the shutter is open, in pixels to the right and up; `unseen` where it is not always before the camera.
fn screen_motion(hit: Hit, pixel: u32, position: vec3<f32>, unseen: f32) -> vec3<f32> {
    var start = position;
    var end = position;
    if HAS_MOTION {
        let moving = motion_of_hit(hit);
        if moving != NONE {
            let own_time = path_time;
            let at_rest = place_at_rest(hit, position);
            let pivot = pivot_of_hit(hit);
            start = place_at_time(moving, at_rest, 0.0) + pivot;
            end = place_at_time(moving, at_rest, 1.0) + pivot;
            path_time = own_time;
            known_motion = NONE;
        }
    }
    let opened = place_in_picture(pose_at_end(false), pixel, start);
    let closed = place_in_picture(pose_at_end(true), pixel, end);
    if !(opened.is_seen && closed.is_seen) {
        return vec3<f32>(unseen);
    }
    let way = (closed.from_axis - opened.from_axis) - (closed.to_corner - opened.to_corner);
    return vec3<f32>(way.x, -way.y, 0.0);
}
