// The band's film. Per pixel: (sum of radiance, sample count) and (what the sum's rounding lost, sum of squared luminance).
#import core/math.wgsl
#import core/parameters.wgsl
#import stages/statistics.wgsl

#if FILM_TEXTURE
@group(0) @binding(15) var film_sum: texture_storage_2d<rgba32float, read_write>;
@group(0) @binding(16) var film_compensation: texture_storage_2d<rgba32float, read_write>;

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
@group(0) @binding(15) var<storage, read_write> film_sum: array<vec4<f32>>;
@group(0) @binding(16) var<storage, read_write> film_compensation: array<vec4<f32>>;

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

// Samples of one pixel gathered in registers before they reach the film.
struct PixelSum {
    radiance: vec3<f32>,
    squared_luminance: f32,
    refused: u32,
}

fn empty_pixel_sum() -> PixelSum {
    return PixelSum(vec3<f32>(0.0), 0.0, 0u);
}

// A sample that is not finite is refused: it counts as 0, and is counted.
fn add_sample(sum: ptr<function, PixelSum>, radiance: vec3<f32>) {
    let l = luminance(radiance);
    if is_finite(l * l) && is_finite(max_component(abs(radiance))) {
        (*sum).radiance += radiance;
        (*sum).squared_luminance += l * l;
    } else {
        (*sum).refused++;
    }
}

fn opaque(x: vec3<f32>) -> vec3<f32> {
    return bitcast<vec3<f32>>(bitcast<vec3<u32>>(x) ^ vec3<u32>(pass_parameters.opaque_zero));
}

// Compensated summation (Kahan 1965): the film's relative error does not grow with the number of samples. `opaque` keeps compilers
// from cancelling (sum + y) - sum.
fn add_to_film(pixel_in_band: u32, added: PixelSum, samples: u32) {
    var old = vec4<f32>(0.0);
    var compensation = vec4<f32>(0.0);
    if pass_parameters.film_is_empty == 0u {
        old = load_film_sum(pixel_in_band);
        compensation = load_film_compensation(pixel_in_band);
    }
    let y = added.radiance - compensation.xyz;
    let sum = opaque(old.xyz + y);
    let lost = opaque(sum - old.xyz) - y;
    store_film(
        pixel_in_band,
        vec4<f32>(sum, old.w + f32(samples)),
        vec4<f32>(lost, compensation.w + added.squared_luminance)
    );
    if added.refused > 0u {
        count_refused_samples(added.refused);
    }
}
