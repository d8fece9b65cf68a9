// The lights' records in the tables.
#import core/layout.wgsl
#import geometry/scene.wgsl
#import geometry/motion.wgsl
#import geometry/placed.wgsl

// A light that was chosen among all.
struct LightChoice {
    light: u32,
    // The probability of the choice; 0 where no light was chosen.
    pmf: f32,
}

// A light takes five vec4 of the tables:
//   (kind and flags; alias threshold; alias; probability of being chosen)
//   (first point; area or radius), (second; trail), (third; attributes, of a delta light the texture
//   that it projects, or NONE), (radiance or intensity; material, of a delta
//   light its profile, or NONE)
fn light_word(light: u32, word: u32) -> vec4<f32> {
#if MOVING_LIGHTS
    let flags = bitcast<u32>(tables[FIRST_LIGHT_WORD + light * LIGHT_WORDS].x);
    if word != 0u && word != 4u && (flags & LIGHT_MOVES) != 0u {
        let word_3 = tables[FIRST_LIGHT_WORD + light * LIGHT_WORDS + 3u];
        return placed_light_word(
            bitcast<u32>(word_3.w), word, (flags & 255u) == KIND_SPHERE, tables[FIRST_LIGHT_WORD + light * LIGHT_WORDS + 1u],
            tables[FIRST_LIGHT_WORD + light * LIGHT_WORDS + 2u], word_3
        );
    }
#endif
    return tables[FIRST_LIGHT_WORD + light * LIGHT_WORDS + word];
}

// The magnitude that rounding of a moving light's points is relative to; 0 where it rests.
fn moved_light_magnitude(light: u32) -> vec3<f32> {
    let word_3 = tables[FIRST_LIGHT_WORD + light * LIGHT_WORDS + 3u];
    if (bitcast<u32>(tables[FIRST_LIGHT_WORD + light * LIGHT_WORDS].x) & LIGHT_MOVES) == 0u {
        return vec3<f32>(0.0);
    }
    let size = abs(tables[FIRST_LIGHT_WORD + light * LIGHT_WORDS + 1u].xyz) + abs(tables[FIRST_LIGHT_WORD + light * LIGHT_WORDS + 2u].xyz);
    return moved_magnitude(motion_at_path_time(motion_of_attributes(bitcast<u32>(word_3.w))), size + abs(word_3.xyz));
}
