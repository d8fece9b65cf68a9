// Randomness as a pure function of (seed, pixel, sample index, named dimension): the device's half of src/sampling.
#import core/layout.wgsl
#import core/lcg.wgsl
#import core/parameters.wgsl

const GOLDEN: u32 = 0x9e3779b9u;

fn mix_bits(value: u32) -> u32 {
    var x = value;
    x ^= x >> 16u;
    x *= 0x21f0aaadu;
    x ^= x >> 15u;
    x *= 0xd35a2d97u;
    return x ^ (x >> 15u);
}

fn mix_bits4(value: vec4<u32>) -> vec4<u32> {
    var x = value;
    x ^= x >> vec4<u32>(16u);
    x *= 0x21f0aaadu;
    x ^= x >> vec4<u32>(15u);
    x *= 0xd35a2d97u;
    return x ^ (x >> vec4<u32>(15u));
}

// `pixel` is y * width + x over the whole film.
fn pixel_key(pixel: u32) -> u32 {
    return mix_bits(mix_bits(pixel * GOLDEN) + mix_bits(pass_parameters.seed ^ 0x2545f491u));
}

fn path_key(key_of_pixel: u32, sample: u32) -> u32 {
    return mix_bits(key_of_pixel ^ mix_bits(sample + 0x6a09e667u));
}

// The bits of four successive dimensions under a key.
fn dimension_bits4(key: u32, first_dimension: u32) -> vec4<u32> {
    let dimensions = vec4<u32>(1u, 2u, 3u, 4u) + first_dimension;
    return mix_bits4(vec4<u32>(key) + dimensions * GOLDEN);
}

// The bits of four successive dimensions of a path that has a key of its own.
fn own_bits4(key: u32, first_dimension: u32) -> vec4<u32> {
    if HAS_LCG {
        return lcg_bits4(key, first_dimension);
    } else {
        return dimension_bits4(key, first_dimension);
    }
}

// The bits of a point of the sequence, moved by a shift of the pixel's own.
fn shifted(point: vec4<u32>, shift: vec4<u32>) -> vec4<u32> {
    return select(point + shift, point ^ shift, HAS_DIGITAL_SHIFT);
}

// Bits of dimensions 4·block .. 4·block + 3 of a path. Blocks 0 and 1 are the camera's, vertex v has blocks
// 2v and 2v + 1.
fn random_block(pixel: u32, sample_in_pass: u32, block: u32) -> vec4<u32> {
    let key = pixel_key(pixel);
#if SEQUENCE
    if block < SEQUENCE_BLOCKS {
        return shifted(sequence_points[sample_in_pass * SEQUENCE_STRIDE + block], dimension_bits4(key, block * 4u));
    }
#endif
    return own_bits4(path_key(key, pass_parameters.first_sample + sample_in_pass), block * 4u);
}

// Hashed light samples after the first of a surface have blocks from here on.
const HASHED_LIGHT_BLOCK: u32 = 1u << 28u;

// Bits of light sample `number`, not the first, at a path's vertex number `vertex`, which ends an edge of
// this depth: choice of the light (x), point on it (y, z).
fn further_light_bits(pixel: u32, sample_in_pass: u32, vertex: u32, depth: u32, number: u32) -> vec4<u32> {
    let key = pixel_key(pixel);
#if SEQUENCE
    let block = SEQUENCE_BLOCKS + (depth - 1u) * (LIGHT_SAMPLES - 1u) + number - 1u;
    // The shift is that of the first one's block: together they stay one sequence.
    return shifted(sequence_points[sample_in_pass * SEQUENCE_STRIDE + block], dimension_bits4(key, 8u * vertex));
#else
    let block = HASHED_LIGHT_BLOCK + 16u * vertex + number;
    return own_bits4(path_key(key, pass_parameters.first_sample + sample_in_pass), block * 4u);
#endif
}

// Bits for the position in the pixel (x, y) and on the lens (z, w). The pixel's may have a sampler of their own.
fn camera_block(pixel: u32, sample_in_pass: u32) -> vec4<u32> {
    let random = random_block(pixel, sample_in_pass, 0u);
    var in_pixel = random;
    if HAS_PIXEL_CENTRE {
        in_pixel = vec4<u32>(0x80000000u);
    }
    if HAS_PIXEL_HASHED {
        in_pixel = dimension_bits4(path_key(pixel_key(pixel), pass_parameters.first_sample + sample_in_pass), 0u);
    }
    if HAS_PIXEL_LCG {
        in_pixel = lcg_bits4(path_key(pixel_key(pixel), pass_parameters.first_sample + sample_in_pass), 0u);
    }
#if PIXEL_ROTATION
    in_pixel = sequence_points[sample_in_pass * SEQUENCE_STRIDE] + dimension_bits4(pixel_key(pixel), 0u);
#endif
#if PIXEL_DIGITAL_SHIFT
    in_pixel = sequence_points[sample_in_pass * SEQUENCE_STRIDE] ^ dimension_bits4(pixel_key(pixel), 0u);
#endif
    return vec4<u32>(in_pixel.xy, random.zw);
}

// [0, 1), a multiple of 2^-24.
fn uniform_float(bits: u32) -> f32 {
    return f32(bits >> 8u) * 5.9604644775390625e-8;
}

// Uniform in (0, 1): all bits, and fine near 0, where rare events are.
fn open_float(bits: u32) -> f32 {
    return min((f32(bits) + 0.5) * 2.3283064365386963e-10, LARGEST_NUMBER);
}

// The upper 32 bits of a 64-bit product.
fn multiply_high(a: u32, b: u32) -> u32 {
    let a_low = a & 0xffffu;
    let a_high = a >> 16u;
    let b_low = b & 0xffffu;
    let b_high = b >> 16u;
    let middle = a_high * b_low + ((a_low * b_low) >> 16u);
    let middle_low = (middle & 0xffffu) + a_low * b_high;
    return a_high * b_high + (middle >> 16u) + (middle_low >> 16u);
}
