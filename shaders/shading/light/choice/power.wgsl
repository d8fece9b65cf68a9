// The choice of a light by power, alike everywhere.
#import shading/light/choice/by_power.wgsl
#import shading/light/record.wgsl

alias LightContext = u32;

fn light_context(point: vec3<f32>, facing: u32) -> LightContext {
    return 0u;
}

fn choose_light(context: LightContext, bits: u32) -> LightChoice {
    let light = light_by_power(bits);
    return LightChoice(light, pmf_by_power(light));
}

fn light_pmf(context: LightContext, light: u32) -> f32 {
    return pmf_by_power(light);
}

fn distant_light_pmf(context: LightContext, light: u32) -> f32 {
    return pmf_by_power(light);
}
