// A point light: its intensity is the same in every direction unless it has a profile.
#import core/layout.wgsl
#import shading/light/record.wgsl
#import shading/light/light_sample.wgsl
#if LIGHT_PROFILES
#import shading/light/profile.wgsl
#endif

fn sample_point_light(light: u32, reference: vec3<f32>, pmf: f32) -> LightSample {
    let to_light = light_word(light, 1u).xyz - reference;
    let distance2 = dot(to_light, to_light);
    if distance2 == 0.0 {
        return no_light();
    }
    let distance = sqrt(distance2);
    let word4 = light_word(light, 4u);
    var intensity = word4.xyz;
#if LIGHT_PROFILES
    let profile = bitcast<u32>(word4.w);
    if profile != NONE {
        intensity *= profile_candela(profile, to_light / distance);
    }
#endif
    return LightSample(to_light / distance, distance * SHADOW_SHORTENING, intensity / (distance2 * pmf), -1.0);
}
