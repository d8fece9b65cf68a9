// When paths see the scene. src/reference/camera.rs is the same in f64.
#import core/parameters.wgsl
#import core/sampler.wgsl

// The time of a path: 0 as the shutter opens, 1 as it closes.
fn time_of_path(pixel: u32, sample_in_pass: u32) -> f32 {
    let u = uniform_float(random_block(pixel, sample_in_pass, 1u).x);
    if HAS_ROLLING_SHUTTER {
        let row = f32(pixel / FILM_WIDTH);
        return min(row * view.rolling.x + u * view.rolling.y, 1.0);
    }
    return u;
}
