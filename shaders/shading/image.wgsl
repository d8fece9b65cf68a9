// Images, looked up by uv. Their texels are kept as they came from the file (src/scene/image.rs), and turned into linear colours here.
#import core/layout.wgsl
#import geometry/texels.wgsl

struct Image {
    flags: u32,
    // Word where its texels begin.
    first: u32,
    // Width and height.
    size: vec2<i32>,
    // Word where the values of its integers begin.
    first_value: u32,
}

fn wrapped_texel(index: i32, size: i32, wrap: u32) -> i32 {
    switch wrap {
        // Clamp.
        case 1u: { return clamp(index, 0, size - 1); }
        // Mirror.
        case 2u: {
            let period = 2 * size;
            let folded = ((index % period) + period) % period;
            return select(folded, period - 1 - folded, folded >= size);
        }
        // Repeat.
        default: { return ((index % size) + size) % size; }
    }
}

#if TEXELS_IN_HALF_FLOATS
// The number of which these are the bits, without the rounding to 0 that conversions may do.
fn half_float(bits: u32) -> f32 {
    let magnitude = bits & 0x7fffu;
    let normal = bitcast<f32>((magnitude << 13u) + 0x38000000u);
    let small = f32(magnitude) * 5.9604644775390625e-8;
    return select(normal, small, magnitude < 0x400u);
}
#endif

#if TEXTURE_CHANNELS
// One value of texel number `place`: red, green, blue or alpha by its number from 0.
fn texel_value(image: Image, place: u32, number: u32) -> f32 {
    switch (image.flags >> FORMAT_SHIFT) & 3u {
#if TEXELS_IN_BYTES
        case TEXELS_OF_BYTES: {
            return texel_float(image.first_value + ((texel_word(image.first + place) >> (8u * number)) & 255u));
        }
#endif
#if TEXELS_IN_SHORTS
        case TEXELS_OF_SHORTS: {
            let word = texel_word(image.first + 2u * place + (number >> 1u));
            return texel_float(image.first_value + ((word >> (16u * (number & 1u))) & 0xffffu));
        }
#endif
#if TEXELS_IN_HALF_FLOATS
        case TEXELS_OF_HALF_FLOATS: {
            return half_float(texel_word(image.first + 2u * place + (number >> 1u)) >> (16u * (number & 1u)));
        }
#endif
#if TEXELS_IN_FLOATS
        case TEXELS_OF_FLOATS: {
            return texel_float(image.first + select(3u, 4u, (image.flags & FLOAT_ALPHA) != 0u) * place + number);
        }
#endif
        default: { return 0.0; }
    }
}
#endif

fn texel_color(image: Image, place: u32) -> vec3<f32> {
    switch (image.flags >> FORMAT_SHIFT) & 3u {
#if TEXELS_IN_BYTES
        case TEXELS_OF_BYTES: {
            let codes = (vec3<u32>(texel_word(image.first + place)) >> vec3<u32>(0u, 8u, 16u)) & vec3<u32>(255u);
            return texel_values(image.first_value + codes);
        }
#endif
#if TEXELS_IN_SHORTS
        case TEXELS_OF_SHORTS: {
            let first = image.first + 2u * place;
            let low = texel_word(first);
            return texel_values(image.first_value + vec3<u32>(low & 0xffffu, low >> 16u, texel_word(first + 1u) & 0xffffu));
        }
#endif
#if TEXELS_IN_HALF_FLOATS
        case TEXELS_OF_HALF_FLOATS: {
            let first = image.first + 2u * place;
            let low = texel_word(first);
            return vec3<f32>(half_float(low), half_float(low >> 16u), half_float(texel_word(first + 1u)));
        }
#endif
#if TEXELS_IN_FLOATS
        case TEXELS_OF_FLOATS: {
            let first = image.first + select(3u, 4u, (image.flags & FLOAT_ALPHA) != 0u) * place;
            return texel_values(vec3<u32>(first, first + 1u, first + 2u));
        }
#endif
        default: { return vec3<f32>(0.0); }
    }
}

fn texel_values(words: vec3<u32>) -> vec3<f32> {
#if TEXEL_CHUNKS
    // One load of many branches, not three: drivers copy what is called to wherever it is called.
    var values: vec3<f32>;
    for (var number = 0u; number < 3u; number++) {
        values[number] = texel_float(words[number]);
    }
    return values;
#else
    return vec3<f32>(texel_float(words.x), texel_float(words.y), texel_float(words.z));
#endif
}

// A colour; or a grey, where one channel counts.
fn texel(image: Image, x: i32, y: i32) -> vec3<f32> {
    let place = u32(y * image.size.x + x);
#if TEXTURE_CHANNELS
    let channel = (image.flags >> CHANNEL_SHIFT) & 7u;
    if channel != 0u {
        return vec3<f32>(texel_value(image, place, channel - 1u));
    }
#endif
    return texel_color(image, place);
}

// v = 0 is the bottom row.
fn image_color(image: Image, st: vec2<f32>) -> vec3<f32> {
    let size = image.size;
    let wrap = (image.flags >> WRAP_SHIFT) & 3u;
    let position = vec2<f32>(st.x, 1.0 - st.y) * vec2<f32>(size);
    let is_nearest = (image.flags & TEXTURE_NEAREST) != 0u;
    let corner = floor(position - select(0.5, 0.0, is_nearest));
    let blend = position - 0.5 - corner;
    // The code of a look-up stands there once for all: the nearest, or upper left, upper right, lower left and lower right. Drivers copy
    // loops as well whose turns they can count, and this one's they cannot.
    let count = select(4, 1, is_nearest);
    var left = vec3<f32>(0.0);
    var upper = vec3<f32>(0.0);
    var row = vec3<f32>(0.0);
    for (var number = 0; number < count; number++) {
        let x = wrapped_texel(i32(corner.x) + (number & 1), size.x, wrap);
        let y = wrapped_texel(i32(corner.y) + (number >> 1u), size.y, wrap);
        let color = texel(image, x, y);
        row = mix(left, color, blend.x);
        upper = select(upper, row, number == 1);
        left = color;
    }
    return select(mix(upper, row, blend.y), left, is_nearest);
}
