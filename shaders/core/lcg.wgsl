// A linear congruential generator, for comparison: the device's half of src/sampling/lcg.rs.

const LCG_MULTIPLIER: u32 = 1664525u;
const LCG_INCREMENT: u32 = 1013904223u;

fn lcg_step(x: u32) -> u32 {
    return LCG_MULTIPLIER * x + LCG_INCREMENT;
}

// Four successive numbers of the stream that starts at a key.
fn lcg_bits4(key: u32, first: u32) -> vec4<u32> {
    var x = key;
    var multiplier = LCG_MULTIPLIER;
    var increment = LCG_INCREMENT;
    for (var steps = first; steps > 0u; steps >>= 1u) {
        if (steps & 1u) == 1u {
            x = multiplier * x + increment;
        }
        increment = (multiplier + 1u) * increment;
        multiplier = multiplier * multiplier;
    }
    let a = lcg_step(x);
    let b = lcg_step(a);
    let c = lcg_step(b);
    return vec4<u32>(a, b, c, lcg_step(c));
}
