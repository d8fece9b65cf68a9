// An alias table of all lights, by which their power chooses.
#import core/sampler.wgsl
#import shading/light/record.wgsl

// Constant time; the same choice in integers on every device (AliasTable::choose).
fn light_by_power(bits: u32) -> u32 {
#if ONE_LIGHT
    return 0u;
#else
    let entry = multiply_high(bits, LIGHT_COUNT);
    let remainder = bits * LIGHT_COUNT;
    let word = bitcast<vec4<u32>>(light_word(entry, 0u));
    return select(word.z, entry, remainder < word.y);
#endif
}

fn pmf_by_power(light: u32) -> f32 {
    return light_word(light, 0u).w;
}
