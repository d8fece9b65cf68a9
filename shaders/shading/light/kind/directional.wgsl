// A directional light: the same irradiance everywhere, from one direction.
#import core/math.wgsl
#import shading/light/record.wgsl
#import shading/light/light_sample.wgsl

fn sample_directional_light(light: u32, reference: vec3<f32>, pmf: f32) -> LightSample {
    return LightSample(light_word(light, 2u).xyz, INFINITY_DISTANCE, light_word(light, 4u).xyz / pmf, -1.0);
}
