// Primitives and lights that move, where they are at the path's time.
#import core/layout.wgsl
#import geometry/motion.wgsl
#import geometry/records.wgsl
#import geometry/scene.wgsl
#import geometry/shapes.wgsl

// A primitive's three words as they are at the path's time, and the magnitude that their rounding is relative to; 0 where it rests.
struct PlacedPrimitive {
    p0: vec4<f32>,
    p1: vec4<f32>,
    p2: vec4<f32>,
    magnitude: vec3<f32>,
}

fn placed_primitive(words: PrimitiveWords) -> PlacedPrimitive {
    let p0 = words.w0;
    let p1 = words.w1;
    let p2 = words.w2;
    if (bitcast<u32>(p0.w) & PRIMITIVE_MOVES) == 0u {
        return PlacedPrimitive(p0, p1, p2, vec3<f32>(0.0));
    }
    let motion = motion_at_path_time(motion_of_attributes(bitcast<u32>(p2.w)));
    let moved = move_shape(motion, primitive_kind(p0.w), p0.xyz, p1.xyz, p2.xyz);
    return PlacedPrimitive(
        vec4<f32>(moved.p0, p0.w), vec4<f32>(moved.p1, p1.w), vec4<f32>(moved.p2, p2.w), moved_magnitude(motion, moved.size)
    );
}

// Word 1, 2 or 3 of a moving light with the attributes `first` as it is at the path's time. `word_1`, `word_2` and `word_3` are those at
// rest.
fn placed_light_word(first: u32, word: u32, is_sphere: bool, word_1: vec4<f32>, word_2: vec4<f32>, word_3: vec4<f32>) -> vec4<f32> {
    let motion = motion_at_path_time(motion_of_attributes(first));
    if word == 1u {
        if is_sphere {
            return vec4<f32>(moved_point(motion, word_1.xyz), word_1.w * length(motion.linear[0]));
        }
        let at_rest = cross(word_2.xyz, word_3.xyz);
        return vec4<f32>(moved_point(motion, word_1.xyz), word_1.w * length(moved_normal(motion, at_rest)) / length(at_rest));
    }
    if word == 2u {
        return vec4<f32>(motion.linear * word_2.xyz, word_2.w);
    }
    return vec4<f32>(motion.linear * word_3.xyz, word_3.w);
}
