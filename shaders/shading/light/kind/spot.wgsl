// A spot light: a point light that is cut to a cone.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/light/record.wgsl
#import shading/light/light_sample.wgsl
#import shading/texture/coordinates.wgsl
#import shading/texture/texture.wgsl
#import shading/light/projected_picture.wgsl
#if LIGHT_PROFILES
#import shading/light/profile.wgsl
#endif

// The intensity where t is `t` of the way from the outer angle to the inner one: Hermite's smooth step unless the light's form says otherwise.
fn spot_step(t: f32, kind_and_flags: u32) -> f32 {
#if SPOT_FALLOFFS
    let form = (kind_and_flags >> LIGHT_FORM_SHIFT) & 3u;
    if form == SPOT_FALLOFF_SQUARE {
        return t * t;
    }
    if form == SPOT_FALLOFF_LINEAR {
        return t;
    }
#endif
    return t * t * (3.0 - 2.0 * t);
}

// 1 inside the inner angle, 0 past the outer. `limits` are 1 - cosine of the outer and the inner angle: written that way, narrow cones keep
// their precision. A linear falloff has the angles in whole turns.
fn spot_falloff(wi: vec3<f32>, axis: vec3<f32>, limits: vec2<f32>, kind_and_flags: u32) -> f32 {
    let apart = wi + axis;
    var from_axis = 0.5 * dot(apart, apart);
    if HAS_SPOT_FALLOFFS && ((kind_and_flags >> LIGHT_FORM_SHIFT) & 3u) == SPOT_FALLOFF_LINEAR {
        let half_sine2 = min(0.5 * from_axis, 1.0);
        from_axis = 2.0 * atan2_turns(sqrt(half_sine2), sqrt(1.0 - half_sine2));
    }
    if from_axis <= limits.y {
        return 1.0;
    }
    if from_axis >= limits.x {
        return 0.0;
    }
    let t = (limits.x - from_axis) / (limits.x - limits.y);
    return spot_step(t, kind_and_flags);
}

fn sample_spot_light(light: u32, reference: vec3<f32>, pmf: f32) -> LightSample {
    let word1 = light_word(light, 1u);
    let to_light = word1.xyz - reference;
    let distance2 = dot(to_light, to_light);
    if distance2 == 0.0 {
        return no_light();
    }
    let distance = sqrt(distance2);
    let wi = to_light / distance;
    let word2 = light_word(light, 2u);
    let word3 = light_word(light, 3u);
    let falloff = spot_falloff(wi, word2.xyz, word3.xy, bitcast<u32>(light_word(light, 0u).x));
    let word4 = light_word(light, 4u);
    var intensity = word4.xyz * falloff;
#if LIGHT_PROFILES
    let profile = bitcast<u32>(word4.w);
    if profile != NONE && falloff > 0.0 {
        intensity *= profile_candela(profile, wi);
    }
#endif
#if LIGHT_TEXTURES
    let texture = bitcast<u32>(word3.w);
    if texture != NONE && falloff > 0.0 {
        // The picture fills the square around the cone.
        var outer = word3.x;
        if HAS_SPOT_FALLOFFS && ((bitcast<u32>(light_word(light, 0u).x) >> LIGHT_FORM_SHIFT) & 3u) == SPOT_FALLOFF_LINEAR {
            let half_sine = sin_cos_turns(0.5 * outer).x;
            outer = 2.0 * half_sine * half_sine;
        }
        let half_inverse_tangent = 0.5 * (1.0 - outer) / sqrt(outer * (2.0 - outer));
        let place = picture_place(wi, word2.xyz, vec2<f32>(word3.z, word1.w));
        intensity *= texture_color(texture, only_coordinates(0.5 + half_inverse_tangent * place));
    }
#endif
    return LightSample(wi, distance * SHADOW_SHORTENING, intensity / (distance2 * pmf), -1.0);
}
