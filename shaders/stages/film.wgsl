// The band's film. Per pixel: (sum of radiance, sample count as count_word writes it) and (what the sum's rounding lost, sum of squared luminance).
#import core/layout.wgsl
#import core/math.wgsl
#import core/parameters.wgsl
#import stages/statistics.wgsl

#if FILM_TEXTURE
@group(0) @binding(BINDING_FILM_SUM) var film_sum: texture_storage_2d<rgba32float, read_write>;
@group(0) @binding(BINDING_FILM_COMPENSATION) var film_compensation: texture_storage_2d<rgba32float, read_write>;

fn film_position(pixel_in_band: u32) -> vec2<u32> {
    let y = pixel_in_band / FILM_WIDTH;
    return vec2<u32>(pixel_in_band - y * FILM_WIDTH, y);
}

fn load_film_sum(pixel_in_band: u32) -> vec4<f32> {
    return textureLoad(film_sum, film_position(pixel_in_band));
}

fn load_film_compensation(pixel_in_band: u32) -> vec4<f32> {
    return textureLoad(film_compensation, film_position(pixel_in_band));
}

fn store_film(pixel_in_band: u32, sum: vec4<f32>, compensation: vec4<f32>) {
    textureStore(film_sum, film_position(pixel_in_band), sum);
    textureStore(film_compensation, film_position(pixel_in_band), compensation);
}
#else
// Adapters that cannot read and write rgba32float textures keep the film in storage buffers.
@group(0) @binding(BINDING_FILM_SUM) var<storage, read_write> film_sum: array<vec4<f32>>;
@group(0) @binding(BINDING_FILM_COMPENSATION) var<storage, read_write> film_compensation: array<vec4<f32>>;

fn load_film_sum(pixel_in_band: u32) -> vec4<f32> {
    return film_sum[pixel_in_band];
}

fn load_film_compensation(pixel_in_band: u32) -> vec4<f32> {
    return film_compensation[pixel_in_band];
}

fn store_film(pixel_in_band: u32, sum: vec4<f32>, compensation: vec4<f32>) {
    film_sum[pixel_in_band] = sum;
    film_compensation[pixel_in_band] = compensation;
}
#endif

// A number of samples, below 2^31, as a float of the same information: single precision itself counts to 2^24. The bits are moved so that the
// float is neither denormal nor infinite nor NaN, which devices may change on the way. src/film/count.rs is the same for the host.
fn count_word(count: u32) -> f32 {
    return bitcast<f32>(((count & 0x00800000u) << 8u) | (((count >> 24u) + 1u) << 23u) | (count & 0x007fffffu));
}

fn count_in(word: f32) -> u32 {
    let bits = bitcast<u32>(word);
    let high = max((bits >> 23u) & 255u, 1u) - 1u;
    return (high << 24u) | ((bits >> 8u) & 0x00800000u) | (bits & 0x007fffffu);
}

// A pixel of the film on its way through registers.
struct FilmPixel {
    sum: Spectrum,
    count: u32,
    compensation: vec4<f32>,
    // Refused samples since it was loaded.
    refused: u32,
#if CLAMP
    clamped: u32,
    // Luminance that clamping took.
    taken: f32,
#endif
}

fn load_film_pixel(pixel_in_band: u32) -> FilmPixel {
    if pass_parameters.film_is_empty != 0u {
        return FilmPixel();
    }
    var pixel = FilmPixel();
    let sum = load_film_sum(pixel_in_band);
    pixel.sum = sum.xyz;
    pixel.count = count_in(sum.w);
    pixel.compensation = load_film_compensation(pixel_in_band);
    return pixel;
}

fn opaque(x: vec3<f32>) -> vec3<f32> {
    return bitcast<vec3<f32>>(bitcast<vec3<u32>>(x) ^ vec3<u32>(pass_parameters.opaque_zero));
}

fn opaque_number(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) ^ pass_parameters.opaque_zero);
}

#if CLAMP
// The sample, its brightest channel no brighter than the setting `clamp` allows, in its own colour. One that is not finite is left as it is.
fn clamped(pixel: ptr<function, FilmPixel>, sample: Spectrum) -> Spectrum {
    let limit = bitcast<f32>(CLAMP_BITS);
    let brightest = max_component(sample);
    if !(brightest > limit) || !is_finite(max_component(abs(sample))) {
        return sample;
    }
    let darkened = sample * (limit / brightest);
    (*pixel).clamped++;
    (*pixel).taken += luminance(sample - darkened);
    return darkened;
}
#else
fn clamped(pixel: ptr<function, FilmPixel>, sample: Spectrum) -> Spectrum {
    return sample;
}
#endif

// The sum of squares and one more. They too are summed sample by sample, so that parts of pictures are the same bytes however samples were cut
// into passes. There is no room for what rounding lost, and to the nearest number a long sum would lose small squares altogether. So a sum that
// is no number of single precision goes to the one above or below, with the probability that keeps the mean (stochastic rounding), which
// loses a digit with the square root of the samples: four are left of 2^24, as many as a variance is worth. `number` counts the samples.
fn with_square(sum: f32, square: f32, number: u32) -> f32 {
    let nearest = opaque_number(sum + square);
    let lost = opaque_number(nearest - max(sum, square)) - min(sum, square);
    let bits = bitcast<u32>(nearest);
    // The distance to the next number is 2^-23 of the power of two below.
    let unit = bitcast<f32>(bits & 0x7f800000u) * 1.1920929e-7;
    // Multiples of the golden ratio: evenly spread over any run of samples.
    let chance = (f32((number * 0x9e3779b9u) >> 9u) + 0.5) / 8388608.0;
    if !(abs(lost) > chance * unit) {
        return nearest;
    }
    return bitcast<f32>(select(bits + 1u, bits - 1u, lost > 0.0));
}

// Compensated summation (Kahan 1965), sample by sample: the relative error does not grow with the number of samples, and the sum does
// not depend on how samples were cut into passes. `opaque` keeps compilers from cancelling (sum + y) - sum.
// A sample that is not finite is refused: it counts as 0, and is counted.
fn add_sample(pixel: ptr<function, FilmPixel>, found: Spectrum) {
    let sample = clamped(pixel, found);
#if LAYER_SQUARES
    // Squares, from which variances are made.
    let radiance = sample * sample;
#else
    let radiance = sample;
#endif
    (*pixel).count++;
    let l = luminance(radiance);
    if !is_finite(l * l) || !is_finite(max_component(abs(radiance))) {
        if HAS_LAYER_OF_SURFACES {
            // Nothing was met: the mean is over the samples that met something.
            (*pixel).count--;
        } else {
            (*pixel).refused++;
        }
        return;
    }
    let old = (*pixel).sum;
    let y = radiance - (*pixel).compensation.xyz;
    let sum = opaque(old + y);
    let lost = opaque(sum - old) - y;
    (*pixel).sum = sum;
    let squares = with_square((*pixel).compensation.w, l * l, (*pixel).count);
    (*pixel).compensation = vec4<f32>(lost, squares);
}

fn store_film_pixel(pixel_in_band: u32, pixel: FilmPixel) {
    store_film(pixel_in_band, vec4<f32>(pixel.sum, count_word(pixel.count)), pixel.compensation);
    if pixel.refused > 0u {
        count_refused_samples(pixel.refused);
    }
    if HAS_CLAMP && pixel.clamped > 0u {
        // CLAMP_UNITS and MOST_CLAMP_UNITS.
        count_clamped_samples(pixel.clamped, u32(min(pixel.taken / bitcast<f32>(CLAMP_BITS) * 1024.0, 4.0e9)));
    }
}
