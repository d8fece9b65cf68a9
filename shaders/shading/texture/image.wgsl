// Images, looked up by uv. Their texels are stored as they came from the file (crates/gpt-scene/src/scene/image.rs), and
// turned into linear colours here.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/texels.wgsl

struct Image {
    flags: u32,
    // The first word of its texels.
    first: u32,
    // Width and height.
    size: vec2<i32>,
    // The first word of the values that its integers stand for.
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

// The numbers that have these bits, without the rounding to 0 that conversions may do.
fn half_floats(bits: vec3<u32>) -> vec3<f32> {
    let magnitude = bits & vec3<u32>(0x7fffu);
    let normal = bitcast<vec3<f32>>((magnitude << vec3<u32>(13u)) + vec3<u32>(0x38000000u));
    let small = vec3<f32>(magnitude) * 5.9604644775390625e-8;
    return select(normal, small, magnitude < vec3<u32>(0x400u));
}

// A colour; or a grey, if one channel counts. The loads at the end are the same code for several formats:
// drivers copy a function to each of its calls.
fn texel(image: Image, x: i32, y: i32) -> Spectrum {
    let index = u32(y * image.size.x + x);
    // The numbers of the texel's values that count: red, green, blue or alpha.
    var numbers = vec3<u32>(0u, 1u, 2u);
    let channel = (image.flags >> CHANNEL_SHIFT) & 7u;
    if HAS_TEXTURE_CHANNELS && channel != 0u {
        numbers = vec3<u32>(channel - 1u);
    }
    // The words of those values.
    var words = vec3<u32>(0u);
    switch (image.flags >> FORMAT_SHIFT) & 3u {
        case TEXELS_OF_BYTES: {
            if HAS_TEXELS_IN_BYTES {
                let codes = (vec3<u32>(texel_word(image.first + index)) >> (8u * numbers)) & vec3<u32>(255u);
                words = image.first_value + codes;
            }
        }
        case TEXELS_OF_SHORTS: {
            if HAS_TEXELS_IN_SHORTS {
                words = image.first_value + texel_halves(image, index, numbers);
            }
        }
        case TEXELS_OF_HALF_FLOATS: {
            if HAS_TEXELS_IN_HALF_FLOATS {
                return half_floats(texel_halves(image, index, numbers));
            }
        }
        case TEXELS_OF_FLOATS: {
            if HAS_TEXELS_IN_FLOATS {
                words = image.first + select(3u, 4u, (image.flags & FLOAT_ALPHA) != 0u) * index + numbers;
            }
        }
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

// Halves of the words of a texel that has two, by their numbers.
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
    // One look-up in the code serves all texels: the nearest, or upper left, upper right, lower left and
    // lower right. Drivers unroll a loop whose number of turns they know, and this one's they do not.
    let count = select(4, 1, is_nearest);
    var left = vec3<f32>(0.0);
    var upper = vec3<f32>(0.0);
    var row = vec3<f32>(0.0);
    let is_triangle = is_triangle_of_texels(image);
    var first = vec3<f32>(0.0);
    // The range of the corners' colours, at which the plane ends beyond the triangle.
    var low = vec3<f32>(INFINITY_DISTANCE);
    var high = vec3<f32>(-INFINITY_DISTANCE);
    for (var number = 0; number < count; number++) {
        let x = wrapped_texel(i32(corner.x) + (number & 1), size.x, wrap.x);
        let y = wrapped_texel(i32(corner.y) + (number >> 1u), size.y, wrap.y);
        let color = texel(image, x, y);
        row = mix(left, color, blend.x);
        // The lower edge changes as the upper one does: all lie in the plane through three corners.
        first = select(first, color, number == 0);
        low = select(low, min(low, color), number < 3);
        high = select(high, max(high, color), number < 3);
        row = select(row, left + upper - first, is_triangle && number == 3);
        upper = select(upper, row, number == 1);
        left = color;
    }
    let between = mix(upper, row, blend.y);
    return select(select(between, clamp(between, low, high), is_triangle), left, is_nearest);
}

// The image's texels are the corners of triangles.
fn is_triangle_of_texels(image: Image) -> bool {
    return HAS_TEXTURES_OF_TRIANGLES && (image.flags & TEXTURE_TRIANGLES) != 0u;
}

// The gradient of the luminance there: that of the bilinear interpolation between the four texels around, or
// of the plane of a triangle.
fn image_gradient(image: Image, st: vec2<f32>) -> vec2<f32> {
    let size = vec2<f32>(image.size);
    let position = vec2<f32>(st.x, 1.0 - st.y) * size;
    let corner = floor(position - 0.5);
    let blend = select(position - 0.5 - corner, vec2<f32>(0.0), is_triangle_of_texels(image));
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
