// Procedural textures over uv; the lattice's hash is integer arithmetic, the same on every device.
// src/texture has them in f64.
#import core/sampler.wgsl

fn lattice_hash(cell: vec2<i32>, seed: u32) -> u32 {
    let c = bitcast<vec2<u32>>(cell);
    return mix_bits(mix_bits((c.x * GOLDEN) ^ seed) + c.y * 0x85ebca6bu);
}

// One of eight unit gradients, dotted with the offset from its lattice point: ±x, ±y, and the four diagonals.
fn gradient_dot(cell: vec2<i32>, seed: u32, offset: vec2<f32>) -> f32 {
    let direction = lattice_hash(cell, seed) >> 29u;
    let first = (direction & 1u) != 0u;
    let second = (direction & 2u) != 0u;
    if (direction & 4u) != 0u {
        return 0.70710678 * (select(offset.x, -offset.x, first) + select(offset.y, -offset.y, second));
    }
    let along = select(offset.x, offset.y, second);
    return select(along, -along, first);
}

fn perlin_fade(f: vec2<f32>) -> vec2<f32> {
    return f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
}

// Improved noise (Perlin 2002) in [-1, 1]: the sum of `octaves`, each half as high and twice as fine as the
// one before.
fn perlin_noise(position: vec2<f32>, octaves: u32, seed: u32) -> f32 {
    var p = position;
    var amplitude = 1.0;
    var sum = 0.0;
    var total = 0.0;
    for (var octave = 0u; octave < octaves; octave++) {
        let corner = floor(p);
        let f = p - corner;
        let cell = vec2<i32>(corner);
        let fade = perlin_fade(f);
        var noise = 0.0;
        for (var corner_index = 0; corner_index < 4; corner_index++) {
            let step = vec2<i32>(corner_index & 1, corner_index >> 1u);
            let share = select(1.0 - fade, fade, step == vec2<i32>(1));
            noise += share.x * share.y * gradient_dot(cell + step, seed, f - vec2<f32>(step));
        }
        sum += amplitude * noise;
        total += amplitude;
        amplitude *= 0.5;
        p *= 2.0;
    }
    return 1.41421356 * sum / max(total, 1.0e-30);
}

// One of eight unit gradients.
fn lattice_gradient(cell: vec2<i32>, seed: u32) -> vec2<f32> {
    return vec2<f32>(gradient_dot(cell, seed, vec2<f32>(1.0, 0.0)), gradient_dot(cell, seed, vec2<f32>(0.0, 1.0)));
}

// The gradient of that noise by the position. Each octave adds as much as the first: it is half as high and
// twice as fine as the one before.
fn perlin_gradient(position: vec2<f32>, octaves: u32, seed: u32) -> vec2<f32> {
    var frequency = 1.0;
    var amplitude = 1.0;
    var sum = vec2<f32>(0.0);
    var total = 0.0;
    for (var octave = 0u; octave < octaves; octave++) {
        let p = position * frequency;
        let corner = floor(p);
        let f = p - corner;
        let cell = vec2<i32>(corner);
        let fade = perlin_fade(f);
        let fade_slope = 30.0 * f * f * (1.0 - f) * (1.0 - f);
        for (var corner_index = 0; corner_index < 4; corner_index++) {
            let step = vec2<i32>(corner_index & 1, corner_index >> 1u);
            let is_far = step == vec2<i32>(1);
            let share = select(1.0 - fade, fade, is_far);
            let share_slope = select(-fade_slope, fade_slope, is_far);
            let gradient = lattice_gradient(cell + step, seed);
            sum += share.x * share.y * gradient + dot(gradient, f - vec2<f32>(step)) * share_slope * share.yx;
        }
        total += amplitude;
        amplitude *= 0.5;
        frequency += frequency;
    }
    return 1.41421356 * sum / max(total, 1.0e-30);
}

// A cell's feature point, from its corner.
fn feature_point(h: u32) -> vec2<f32> {
    return vec2<f32>(f32(h >> 16u), f32(h & 0xffffu)) / 65536.0;
}

// Distance to the nearest feature point, one per cell (Worley 1996), at most 1.
fn worley_noise(position: vec2<f32>, seed: u32) -> f32 {
    let corner = floor(position);
    let f = position - corner;
    let cell = vec2<i32>(corner);
    var nearest2 = 1.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let h = lattice_hash(cell + vec2<i32>(x, y), seed);
            let feature = feature_point(h);
            let offset = vec2<f32>(f32(x), f32(y)) + feature - f;
            nearest2 = min(nearest2, dot(offset, offset));
        }
    }
    return sqrt(nearest2);
}

// The gradient of that distance by the position: away from the nearest feature point.
fn worley_gradient(position: vec2<f32>, seed: u32) -> vec2<f32> {
    let corner = floor(position);
    let f = position - corner;
    let cell = vec2<i32>(corner);
    var nearest2 = 1.0;
    var nearest = vec2<f32>(0.0);
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let h = lattice_hash(cell + vec2<i32>(x, y), seed);
            let feature = feature_point(h);
            let offset = vec2<f32>(f32(x), f32(y)) + feature - f;
            let distance2 = dot(offset, offset);
            if distance2 < nearest2 {
                nearest2 = distance2;
                nearest = offset;
            }
        }
    }
    return -nearest / sqrt(max(nearest2, 1.0e-30));
}
