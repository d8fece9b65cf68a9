// A spot light: a point light that is cut to a cone.
#import shading/light_record.wgsl
#import shading/light_sample.wgsl

// 1 inside the inner angle, 0 past the outer, between them Hermite's smooth step in the cosine. `limits` are 1 - cosine of the outer and
// the inner angle: written that way, narrow cones keep their precision.
fn spot_falloff(wi: vec3<f32>, axis: vec3<f32>, limits: vec2<f32>) -> f32 {
    let apart = wi + axis;
    let from_axis = 0.5 * dot(apart, apart);
    if from_axis <= limits.y {
        return 1.0;
    }
    if from_axis >= limits.x {
        return 0.0;
    }
    let t = (limits.x - from_axis) / (limits.x - limits.y);
    return t * t * (3.0 - 2.0 * t);
}

fn sample_spot_light(light: u32, reference: vec3<f32>, pmf: f32) -> LightSample {
    let to_light = light_word(light, 1u).xyz - reference;
    let distance2 = dot(to_light, to_light);
    if distance2 == 0.0 {
        return no_light();
    }
    let distance = sqrt(distance2);
    let wi = to_light / distance;
    let intensity = light_word(light, 4u).xyz * spot_falloff(wi, light_word(light, 2u).xyz, light_word(light, 3u).xy);
    return LightSample(wi, distance * SHADOW_SHORTENING, intensity / (distance2 * pmf), -1.0);
}
