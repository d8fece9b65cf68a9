// Profiles of lights: candela by direction, interpolated bilinearly in the angles.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/scene.wgsl
#import geometry/texels.wgsl

// A place among ascending angles: the first of the two around it, and how far it is to the second.
struct ProfilePlace {
    index: u32,
    share: f32,
}

// `count` is 2 or more.
fn profile_place(first: u32, count: u32, angle: f32) -> ProfilePlace {
    var low = 0u;
    var high = count - 1u;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if texel_float(first + middle) <= angle {
            low = middle;
        } else {
            high = middle;
        }
    }
    let start = texel_float(first + low);
    return ProfilePlace(low, clamp((angle - start) / (texel_float(first + low + 1u) - start), 0.0, 1.0));
}

// Candela of the plane whose numbers begin at a word.
fn profile_plane(first: u32, place: ProfilePlace) -> f32 {
    return mix(texel_float(first + place.index), texel_float(first + place.index + 1u), place.share);
}

// Candela that a light with this profile sends to where it arrives along `wi`. A profile takes two vec4 of the tables:
//   (nadir; first word of its table), (direction of horizontal angle 0; vertical and horizontal angles)
fn profile_candela(profile: u32, wi: vec3<f32>) -> f32 {
    let word0 = tables[FIRST_LIGHT_PROFILE_WORD + profile * LIGHT_PROFILE_WORDS];
    let word1 = tables[FIRST_LIGHT_PROFILE_WORD + profile * LIGHT_PROFILE_WORDS + 1u];
    let first = bitcast<u32>(word0.w);
    let counts = bitcast<u32>(word1.w);
    let rows = counts & ((1u << PROFILE_HORIZONTAL_SHIFT) - 1u);
    let planes = counts >> PROFILE_HORIZONTAL_SHIFT;
    let along = vec2<f32>(-dot(wi, word1.xyz), -dot(wi, cross(word1.xyz, word0.xyz)));
    let vertical = atan2_turns(length(along), -dot(wi, word0.xyz));
    if vertical < texel_float(first) || vertical > texel_float(first + rows - 1u) {
        return 0.0;
    }
    let row = profile_place(first, rows, vertical);
    let candela = first + rows + planes;
    if planes == 1u {
        return profile_plane(candela, row);
    }
    var horizontal = atan2_turns(along.y, along.x);
    horizontal = select(horizontal, horizontal + 1.0, horizontal < 0.0);
    let plane = profile_place(first + rows, planes, horizontal);
    let here = candela + plane.index * rows;
    return mix(profile_plane(here, row), profile_plane(here + rows, row), plane.share);
}
