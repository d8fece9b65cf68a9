// All stages in one kernel, for scenes so simple that storing paths between stages costs more than tracing them.
#import geometry/closest.wgsl
#import shading/path.wgsl
#import stages/film.wgsl
#import stages/fused_pixels.wgsl

// Reads the pass's parameters. One invocation traces all samples of one pixel, starting the next path where one ends so that no
// lane waits for its neighbours' longer paths, and adds them to the film.
@compute @workgroup_size(WORKGROUP)
fn trace_paths(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) invocation: u32) {
    let place = place_in_pass(workgroup.x, invocation);
    if place >= pass_parameters.pixel_count {
        return;
    }
    let pixel = pass_pixel(place);
    var film_pixel = load_film_pixel(pixel.in_band);
    var rays = 0u;
    var visit = 1u;
    var radiance = vec3<f32>(0.0);
    var path = start_path(pixel.pixel, 0u);
    loop {
        let hit = closest_hit(path.ray, INFINITY_DISTANCE);
#if SEVERAL_LIGHT_SAMPLES
        let incoming = path;
#endif
        let vertex = shade_vertex(&path, hit, visit);
        radiance += vertex.radiance;
        rays++;
#if LIGHTS
        if any(vertex.shadow.radiance != vec3<f32>(0.0)) {
            rays++;
            if !occluded(vertex.shadow.ray, vertex.shadow.distance) {
#if TRACE
                trace_note(TRACED_LIGHT_SEEN);
#endif
                radiance += vertex.shadow.radiance;
            }
        }
#if SEVERAL_LIGHT_SAMPLES
        let lit = lit_surface(incoming, hit, visit);
        for (var number = 1u; number < LIGHT_SAMPLES && lit.takes_more; number++) {
            let shadow = more_light(incoming, lit, visit, number);
            if any(shadow.radiance != vec3<f32>(0.0)) {
                rays++;
                if !occluded(shadow.ray, shadow.distance) {
#if TRACE
                    trace_note(TRACED_LIGHT_SEEN);
#endif
                    radiance += shadow.radiance;
                }
            }
        }
#endif
#endif
#if TRACE
        store_trace(visit - 1u);
#endif
        visit++;
        if !vertex.alive {
            add_sample(&film_pixel, radiance);
            let next_sample = path.sample_in_pass + 1u;
            if next_sample >= pass_parameters.sample_count {
                break;
            }
            radiance = vec3<f32>(0.0);
            visit = 1u;
            path = start_path(pixel.pixel, next_sample);
        }
    }
    store_film_pixel(pixel.in_band, film_pixel);
    count_rays(rays);
}
