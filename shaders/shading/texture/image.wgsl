// Images, looked up by uv. Their texels are kept as they came from the file (crates/gpt-scene/src/scene/image.rs), and turned into linear colours here.
#import core/layout.wgsl
#import core/math.wgsl
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
// The numbers of which these are the bits, without the rounding to 0 that conversions may do.
fn half_floats(bits: vec3<u32>) -> vec3<f32> {
    let magnitude = bits & vec3<u32>(0x7fffu);
    let normal = bitcast<vec3<f32>>((magnitude << vec3<u32>(13u)) + vec3<u32>(0x38000000u));
    let small = vec3<f32>(magnitude) * 5.9604644775390625e-8;
    return select(normal, small, magnitude < vec3<u32>(0x400u));
}
#endif

// A colour; or a grey, where one channel counts. Whatever the format, what it leads to is loaded at the end by the same code: drivers copy
// what is called to wherever it is called.
fn texel(image: Image, x: i32, y: i32) -> Spectrum {
    let index = u32(y * image.size.x + x);
    // Which of a texel's values: red, green, blue or alpha.
    var numbers = vec3<u32>(0u, 1u, 2u);
#if TEXTURE_CHANNELS
    let channel = (image.flags >> CHANNEL_SHIFT) & 7u;
    if channel != 0u {
        numbers = vec3<u32>(channel - 1u);
    }
#endif
    // Where those stand, or what their integers stand for.
    var words = vec3<u32>(0u);
    switch (image.flags >> FORMAT_SHIFT) & 3u {
#if TEXELS_IN_BYTES
        case TEXELS_OF_BYTES: {
            let codes = (vec3<u32>(texel_word(image.first + index)) >> (8u * numbers)) & vec3<u32>(255u);
            words = image.first_value + codes;
        }
#endif
#if TEXELS_IN_SHORTS
        case TEXELS_OF_SHORTS: {
            words = image.first_value + texel_halves(image, index, numbers);
        }
#endif
#if TEXELS_IN_HALF_FLOATS
        case TEXELS_OF_HALF_FLOATS: {
            return half_floats(texel_halves(image, index, numbers));
        }
#endif
#if TEXELS_IN_FLOATS
        case TEXELS_OF_FLOATS: {
            words = image.first + select(3u, 4u, (image.flags & FLOAT_ALPHA) != 0u) * index + numbers;
        }
#endif
        default: {}
    }
#if TEXEL_CHUNKS
    // One load of many branches, not three.
    var values: vec3<f32>;
    for (var number = 0u; number < 3u; number++) {
        values[number] = texel_float(words[number]);
    }
    return values;
#else
    return vec3<f32>(texel_float(words.x), texel_float(words.y), texel_float(words.z));
#endif
}

// Of a texel of two words, halves by their numbers.
fn texel_halves(image: Image, index: u32, numbers: vec3<u32>) -> vec3<u32> {
    let first = image.first + 2u * index;
    let both = select(vec3<u32>(texel_word(first)), vec3<u32>(texel_word(first + 1u)), numbers > vec3<u32>(1u));
    return (both >> (16u * (numbers & vec3<u32>(1u)))) & vec3<u32>(0xffffu);
}

// v = 0 is the bottom row.
fn image_color(image: Image, st: vec2<f32>) -> Spectrum {
    let size = image.size;
    let wrap = (vec2<u32>(image.flags) >> vec2<u32>(WRAP_SHIFT, WRAP_V_SHIFT)) & vec2<u32>(3u);
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
#if TEXTURES_OF_TRIANGLES
    let is_triangle = (image.flags & TEXTURE_TRIANGLES) != 0u;
    var first = vec3<f32>(0.0);
    // Of the corners: beyond the triangle the plane ends at their colours.
    var low = vec3<f32>(INFINITY_DISTANCE);
    var high = vec3<f32>(-INFINITY_DISTANCE);
#endif
    for (var number = 0; number < count; number++) {
        let x = wrapped_texel(i32(corner.x) + (number & 1), size.x, wrap.x);
        let y = wrapped_texel(i32(corner.y) + (number >> 1u), size.y, wrap.y);
        let color = texel(image, x, y);
        row = mix(left, color, blend.x);
#if TEXTURES_OF_TRIANGLES
        // Below, colours change as above: the plane through three corners.
        first = select(first, color, number == 0);
        low = select(low, min(low, color), number < 3);
        high = select(high, max(high, color), number < 3);
        row = select(row, left + upper - first, is_triangle && number == 3);
#endif
        upper = select(upper, row, number == 1);
        left = color;
    }
    let between = mix(upper, row, blend.y);
#if TEXTURES_OF_TRIANGLES
    return select(select(between, clamp(between, low, high), is_triangle), left, is_nearest);
#else
    return select(between, left, is_nearest);
#endif
}

#if BUMP_MAPS
// How the luminance changes there: of the bilinear interpolation between the four texels around, or of the plane of a triangle.
fn image_gradient(image: Image, st: vec2<f32>) -> vec2<f32> {
    let size = vec2<f32>(image.size);
    let position = vec2<f32>(st.x, 1.0 - st.y) * size;
    let corner = floor(position - 0.5);
    var blend = position - 0.5 - corner;
#if TEXTURES_OF_TRIANGLES
    blend = select(blend, vec2<f32>(0.0), (image.flags & TEXTURE_TRIANGLES) != 0u);
#endif
    let wrap = (vec2<u32>(image.flags) >> vec2<u32>(WRAP_SHIFT, WRAP_V_SHIFT)) & vec2<u32>(3u);
    // Upper left, upper right, lower left and lower right.
    var heights = vec4<f32>(0.0);
    for (var number = 0; number < 4; number++) {
        let x = wrapped_texel(i32(corner.x) + (number & 1), image.size.x, wrap.x);
        let y = wrapped_texel(i32(corner.y) + (number >> 1u), image.size.y, wrap.y);
        heights[number] = luminance(texel(image, x, y));
    }
    let across = heights.yw - heights.xz;
    let down = heights.zw - heights.xy;
    return size * vec2<f32>(mix(across.x, across.y, blend.y), -mix(down.x, down.y, blend.x));
}
#endif
