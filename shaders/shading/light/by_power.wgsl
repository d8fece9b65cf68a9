// The choice of a light by power, alike everywhere.
#import core/sampler.wgsl
#import shading/light/record.wgsl

// Constant time; the same choice in integers on every device (AliasTable::choose).
fn choose_light(bits: u32) -> u32 {
#if ONE_LIGHT
    return 0u;
#else
    let entry = multiply_high(bits, LIGHT_COUNT);
    let remainder = bits * LIGHT_COUNT;
    let word = bitcast<vec4<u32>>(light_word(entry, 0u));
    return select(word.z, entry, remainder < word.y);
#endif
}
