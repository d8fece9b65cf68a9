// Instances: groups of meshes that are stored once (src/packed/instance.rs). A ray goes on in the group's own space, where its direction keeps
// the length that it has there, so that distances along it are those of the world.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/records.wgsl
#import geometry/scene.wgsl
#import geometry/motion.wgsl

// Stands on a traversal's stack below what is left of a group's tree: from there on the ray is in the world again. No leaf has this entry.
const LEAVE_INSTANCE: u32 = 0xc0000000u;

fn is_instance(words: PrimitiveWords) -> bool {
    return primitive_kind(words.w0.w) == KIND_INSTANCE;
}

// Number of the instance for which a primitive's record stands.
fn instance_number(words: PrimitiveWords) -> u32 {
    return primitive_material(words.w0.w);
}

// The node at which its group's tree begins.
fn instance_root(words: InstanceWords) -> u32 {
    return bitcast<u32>(words.w0.w) & ~INSTANCE_IS_MIRRORED;
}

fn instance_place(words: InstanceWords) -> vec3<f32> {
    return vec3<f32>(words.w3.w, words.w4.w, words.w5.w);
}

// The way back starts from the difference to the place, in which nothing is lost of points near it.
fn ray_in_instance(world: Ray, words: InstanceWords) -> Ray {
    var origin = world.origin - instance_place(words);
    var direction = world.direction;
#if MOTION
    let moving = bitcast<u32>(words.w2.w);
    if moving != NONE {
        // About the place.
        let motion = motion_at_path_time(moving);
        let m = motion.linear;
        let rows = mat3x3<f32>(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
        let scale = 1.0 / dot(m[0], rows[0]);
        origin = ((origin - motion.place) * rows) * scale;
        direction = (direction * rows) * scale;
    }
#endif
    let rows = mat3x3<f32>(words.w0.xyz, words.w1.xyz, words.w2.xyz);
    return Ray(origin * rows, direction * rows);
}

// Projections onto its direction are distances by the world's measure.
fn prepare_ray_in_instance(ray: Ray, instance: u32) -> PreparedRay {
    let frame = frame_from_normal(normalize(ray.direction));
    return PreparedRay(ray.origin, ray.direction / dot(ray.direction, ray.direction), frame.tangent, frame.bitangent, instance);
}

// Transform of an instance at the path's time.
struct Placement {
    exists: bool,
    mirrored: bool,
    // In place of the group's own, or NONE.
    material: u32,
    words: InstanceWords,
#if MOTION
    // About the place; none where it rests.
    motion: Motion,
#endif
}

fn no_placement() -> Placement {
    var placement: Placement;
    placement.material = NONE;
    return placement;
}

fn instance_placement(instance: u32) -> Placement {
    var placement = no_placement();
    if instance != NONE {
        placement.exists = true;
        placement.words = instance_words(instance);
        placement.mirrored = (bitcast<u32>(placement.words.w0.w) & INSTANCE_IS_MIRRORED) != 0u;
        placement.material = bitcast<u32>(placement.words.w1.w);
#if MOTION
        placement.motion.linear = mat3x3<f32>(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        let moving = bitcast<u32>(placement.words.w2.w);
        if moving != NONE {
            placement.motion = motion_at_path_time(moving);
        }
#endif
    }
    return placement;
}

fn placed_vector(placement: Placement, v: vec3<f32>) -> vec3<f32> {
    let words = placement.words;
    let turned = v * mat3x3<f32>(words.w3.xyz, words.w4.xyz, words.w5.xyz);
    if HAS_MOTION {
        return placement.motion.linear * turned;
    } else {
        return turned;
    }
}

fn placed_point(placement: Placement, p: vec3<f32>) -> vec3<f32> {
    if HAS_MOTION {
        return (placed_vector(placement, p) + placement.motion.place) + instance_place(placement.words);
    } else {
        return placed_vector(placement, p) + instance_place(placement.words);
    }
}

// The magnitude to which the rounding error of placed points is relative, beside their own magnitudes. It
// covers the ray's transform to the group's space and back; the translation adds nothing, because both
// transforms use the same one. Some 4 rounding errors come together in either transform, and POINT_ERROR
// stands for 16.
fn placed_magnitude(placement: Placement, size: vec3<f32>) -> vec3<f32> {
    let words = placement.words;
    let forward = mat3x3<f32>(abs(words.w3.xyz), abs(words.w4.xyz), abs(words.w5.xyz));
    let back = mat3x3<f32>(abs(words.w0.xyz), abs(words.w1.xyz), abs(words.w2.xyz));
    let there = size * forward;
    let magnitude = 0.5 * (there + (there * back) * forward);
    if HAS_MOTION {
        return moved_magnitude(placement.motion, magnitude);
    } else {
        return magnitude;
    }
}

// By the inverse transpose, of length 1, on the side of the surface on which it is in the group; 0 stays 0: no normal.
fn placed_normal(placement: Placement, n: vec3<f32>) -> vec3<f32> {
    if dot(n, n) == 0.0 {
        return n;
    }
    let words = placement.words;
    let turned = mat3x3<f32>(words.w0.xyz, words.w1.xyz, words.w2.xyz) * n;
    if HAS_MOTION {
        return normalize(moved_normal(placement.motion, turned));
    } else {
        return normalize(turned);
    }
}
