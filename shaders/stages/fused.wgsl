// All stages in one kernel, for scenes so simple that storing paths between stages costs more than tracing them.
#import core/layout.wgsl
#import core/parameters.wgsl
#import stages/film.wgsl
#import stages/fused_pixels.wgsl
#import stages/fused_vertex.wgsl
#import stages/statistics.wgsl

// Reads the pass's parameters. One invocation traces all samples of one pixel, starting the next path where one ends so that no
// lane waits for its neighbours' longer paths. Adds them to the film, and counts rays. Leaves everything else alone.
@compute @workgroup_size(WORKGROUP)
fn trace_paths(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) invocation: u32) {
    let index = index_in_pass(workgroup.x, invocation);
    if index >= pass_parameters.pixel_count {
        return;
    }
    let pixel = pass_pixel(index);
    var film_pixel = load_film_pixel(pixel.in_band);
    var rays = 0u;
    var vertex = 1u;
    var radiance = vec3<f32>(0.0);
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
            radiance = vec3<f32>(0.0);
            vertex = 1u;
            path = start_path(pixel.pixel, next_sample);
        }
    }
    store_film_pixel(pixel.in_band, film_pixel);
    count_rays(rays);
}
