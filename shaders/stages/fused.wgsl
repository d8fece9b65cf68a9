// All stages in one kernel: on software devices, and on hardware for scenes of few features, storing paths
// between stages costs more than tracing them.
#import core/layout.wgsl
#import core/parameters.wgsl
#import core/spectrum.wgsl
#import stages/film.wgsl
#import stages/fused_pixels.wgsl
#import stages/fused_vertex.wgsl
#import stages/statistics.wgsl

// All samples of the pixel with this index in the pass, added to the film. The next path starts where one ends, so that no lane waits for its
// neighbours' longer paths. Number of rays.
fn render_pixel(index: u32) -> u32 {
    let pixel = pass_pixel(index);
    var film_pixel = load_film_pixel(pixel.in_band);
    var rays = 0u;
    var vertex = 1u;
    var radiance = BLACK;
    var path = start_path(pixel.pixel, 0u);
    loop {
        let alive = trace_vertex(&path, vertex, true, &radiance, &rays);
        vertex++;
        if !alive {
            add_sample(&film_pixel, radiance);
            let next_sample = path.sample_in_pass + 1u;
            if next_sample >= pass_parameters.sample_count {
                break;
            }
            radiance = BLACK;
            vertex = 1u;
            path = start_path(pixel.pixel, next_sample);
        }
    }
    store_film_pixel(pixel.in_band, film_pixel);
    return rays;
}

// Reads the pass's parameters. One invocation traces all samples of one pixel; on software devices, of one pixel after the other, as long as any
// is left. Adds them to the film, and counts rays. Leaves everything else alone.
@compute @workgroup_size(WORKGROUP)
fn trace_paths(@builtin(global_invocation_id) id: vec3<u32>) {
    var rays = 0u;
    if HAS_TAKEN_PIXELS {
        for (var index = take_pixels(1u); index < pass_parameters.pixel_count; index = take_pixels(1u)) {
            rays += render_pixel(index);
        }
    } else {
        if id.x < pass_parameters.pixel_count {
            rays = render_pixel(id.x);
        }
    }
    count_rays(rays);
}
