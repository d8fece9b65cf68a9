// A point light: its intensity is the same in every direction.
#import core/layout.wgsl
#import shading/light/record.wgsl
#import shading/light/light_sample.wgsl

fn sample_point_light(light: u32, reference: vec3<f32>, pmf: f32) -> LightSample {
    let to_light = light_word(light, 1u).xyz - reference;
    let distance2 = dot(to_light, to_light);
    if distance2 == 0.0 {
        return no_light();
    }
    let distance = sqrt(distance2);
    let intensity = light_word(light, 4u).xyz;
    return LightSample(to_light / distance, distance * SHADOW_SHORTENING, intensity / (distance2 * pmf), -1.0);
}
