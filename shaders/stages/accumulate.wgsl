// Adds the finished samples of a pass to the film.
#import core/layout.wgsl
#import core/parameters.wgsl
#import stages/film.wgsl
#import stages/statistics.wgsl
#import stages/wavefront.wgsl

// Reads the paths' radiance. Adds each pixel's samples to the film in a fixed order, so the picture does not depend on the order in
// which queues were filled. Leaves everything else alone.
@compute @workgroup_size(WORKGROUP)
fn accumulate(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel_count = pass_parameters.pixel_count;
    if id.x >= pixel_count {
        return;
    }
#if PIXEL_LIST
    let pixel_in_band = listed_pixel_in_band(id.x);
#else
    let pixel_in_band = pass_parameters.first_pixel_in_band + id.x;
#endif
    var pixel = load_film_pixel(pixel_in_band);
    for (var sample = 0u; sample < pass_parameters.sample_count; sample++) {
        add_sample(&pixel, path_state[PLANE_RADIANCE + sample * pixel_count + id.x].xyz);
    }
    store_film_pixel(pixel_in_band, pixel);
}
