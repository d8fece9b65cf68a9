// Evaluates the vertices found: emission, next event estimation, the next direction, Russian roulette.
#import stages/wavefront.wgsl

// Reads the queue, the paths and their hits. Adds emission to the paths' radiance, replaces their rays, appends the survivors to the
// other queue and shadow rays to theirs. Neither can overflow: a path appends at most one of each, and there is a slot per path.
@compute @workgroup_size(WORKGROUP)
fn shade(@builtin(global_invocation_id) id: vec3<u32>) {
    let queue = edge_parameters.queue;
    if id.x >= atomicLoad(&counts[queue]) {
        return;
    }
    let slot = queues[queue * PATH_CAPACITY + id.x];
    let h = path_state[PLANE_HIT + slot];
    var path = load_path(slot);
#if MOTION
    set_path_time(path.pixel, path.sample_in_pass);
#endif
    let vertex = shade_vertex(&path, Hit(h.x, bitcast<u32>(h.y), h.z, h.w), edge_parameters.edge);
#if PASS
    let radiance = path_state[PLANE_RADIANCE + slot].xyz + vertex.radiance;
    path_state[PLANE_RADIANCE + slot] = vec4<f32>(radiance, bitcast<f32>(path.passed));
#else
    if any(vertex.radiance != vec3<f32>(0.0)) {
        let radiance = path_state[PLANE_RADIANCE + slot].xyz + vertex.radiance;
        path_state[PLANE_RADIANCE + slot] = vec4<f32>(radiance, 0.0);
    }
#endif
    if vertex.alive {
        store_path(slot, path);
        let place = atomicAdd(&counts[1u - queue], 1u);
        queues[(1u - queue) * PATH_CAPACITY + place] = slot;
    }
#if LIGHTS
    if any(vertex.shadow.radiance != vec3<f32>(0.0)) {
        let place = atomicAdd(&counts[2u + queue], 1u);
        let shadow = vertex.shadow;
        shadow_rays[SHADOW_ORIGIN + place] = vec4<f32>(shadow.ray.origin, shadow.distance);
        shadow_rays[SHADOW_DIRECTION + place] = vec4<f32>(shadow.ray.direction, bitcast<f32>(slot));
        shadow_rays[SHADOW_RADIANCE + place] = vec4<f32>(shadow.radiance, 0.0);
    }
#endif
}
