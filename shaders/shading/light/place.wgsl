// Places of lights, about which places of scattering may be drawn. `Lights::place` of src/reference/lights is the same in f64.
#import core/layout.wgsl
#import core/sampler.wgsl
#import shading/light/choice.wgsl
#import shading/light/record.wgsl
#import shading/shapes.wgsl

struct LightPlace {
    // Not so for lights at infinity.
    exists: bool,
    point: vec3<f32>,
}

// The place of the light that is chosen at a point, by bits as light samples have them: a point of its surface, the centre of a sphere, or its position.
fn light_place(point: vec3<f32>, facing: u32, bits: vec4<u32>) -> LightPlace {
    let choice = choose_light(light_context(point, facing), bits.x);
    let kind = bitcast<u32>(light_word(choice.light, 0u).x) & 255u;
    let first = light_word(choice.light, 1u).xyz;
    let is_far = kind == LIGHT_PORTAL || kind == LIGHT_ENVIRONMENT || kind == DIRECTIONAL_LIGHT;
    if choice.pmf == 0.0 || is_far {
        return LightPlace(false, first);
    }
    if HAS_AREA_LIGHTS && kind < LIGHT_PORTAL && kind != KIND_SPHERE {
        let second = light_word(choice.light, 2u).xyz;
        let third = light_word(choice.light, 3u).xyz;
        return LightPlace(true, sample_shape(kind, first, second, third, uniform_float(bits.y), uniform_float(bits.z)).position);
    }
    return LightPlace(true, first);
}
