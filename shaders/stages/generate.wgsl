// Starts the paths of a pass.
#import core/layout.wgsl
#import core/parameters.wgsl
#import shading/path/camera_path.wgsl
#import stages/wavefront.wgsl
#import stages/statistics.wgsl

// Reads the pass's parameters. Writes every path's state (radiance 0) and puts all slots into queue 0.
// Leaves hits, shadow rays and counts alone; the host sets the counts of a new pass.
@compute @workgroup_size(WORKGROUP)
fn generate(@builtin(global_invocation_id) id: vec3<u32>) {
    let slot = id.x;
    if slot >= pass_parameters.pixel_count * pass_parameters.sample_count {
        return;
    }
    let sample_in_pass = slot / pass_parameters.pixel_count;
#if PIXEL_LIST
    let pixel = pass_parameters.first_pixel + listed_pixel_in_band(slot - sample_in_pass * pass_parameters.pixel_count);
#else
    let pixel = pass_parameters.first_pixel + slot - sample_in_pass * pass_parameters.pixel_count;
#endif
    store_path(slot, camera_path(pixel, sample_in_pass));
#if LIGHT_LINKS
    path_state[PLANE_RADIANCE + slot] = vec4<f32>(0.0, 0.0, 0.0, bitcast<f32>(SEES_ALL_LAMPS << 22u));
#else
    path_state[PLANE_RADIANCE + slot] = vec4<f32>(0.0);
#endif
    queues[slot] = slot;
}
