// Evaluates the vertices found: emission, next event estimation, the next direction, Russian roulette.
#import stages/queue.wgsl
#import stages/wavefront.wgsl

// Reads the queue, the paths and their hits. Adds emission to the paths' radiance, replaces their rays, appends the survivors to the
// other queue and shadow rays to theirs. Neither can overflow: a path appends at most one of each, and there is a slot per path.
// Invocations beyond the queue's end have no path, and stay to take places together with the others of their subgroup.
@compute @workgroup_size(WORKGROUP)
fn shade(
    @builtin(global_invocation_id) id: vec3<u32>,
#if SUBGROUP_QUEUES
    @builtin(subgroup_invocation_id) lane_in_subgroup: u32,
#endif
) {
#if SUBGROUP_QUEUES
    subgroup_lane = lane_in_subgroup;
#endif
    let queue = edge_parameters.queue;
    var slot = 0u;
    var survives = false;
    var shadow = no_shadow();
    if id.x < atomicLoad(&counts[queue]) {
        slot = queues[queue * PATH_CAPACITY + id.x];
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
        survives = vertex.alive;
        if survives {
            store_path(slot, path);
        }
        shadow = vertex.shadow;
    }
    let place = take_place(1u - queue, survives);
    if survives {
        queues[(1u - queue) * PATH_CAPACITY + place] = slot;
    }
#if LIGHTS
    let asks = any(shadow.radiance != vec3<f32>(0.0));
    let shadow_place = take_place(2u + queue, asks);
    if asks {
        shadow_rays[SHADOW_ORIGIN + shadow_place] = vec4<f32>(shadow.ray.origin, shadow.distance);
        shadow_rays[SHADOW_DIRECTION + shadow_place] = vec4<f32>(shadow.ray.direction, bitcast<f32>(slot));
        shadow_rays[SHADOW_RADIANCE + shadow_place] = vec4<f32>(shadow.radiance, 0.0);
    }
#endif
}
