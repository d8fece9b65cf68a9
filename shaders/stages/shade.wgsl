// Evaluates the vertices found: emission, next event estimation, the next direction, Russian roulette.
#import core/layout.wgsl
#import core/parameters.wgsl
#import core/spectrum.wgsl
#import geometry/motion.wgsl
#import shading/path/path.wgsl
#import stages/queue.wgsl
#import stages/wavefront.wgsl

// Reads the queue, the paths and their hits. Adds emission to the paths' radiance, replaces their rays, appends the survivors to the
// other queue, and those with shadow rays to the queue of these. Neither can overflow: a path is in each once at most, and there is a slot
// per path. Leaves everything else alone.
// Invocations beyond the queue's end have no path, and stay to take slots together with the others of their subgroup.
@compute @workgroup_size(WORKGROUP)
fn shade(
    @builtin(global_invocation_id) id: vec3<u32>,
#if SUBGROUP_QUEUES
    @builtin(subgroup_invocation_id) lane_in_subgroup: u32,
#endif
) {
    if HAS_SUBGROUP_QUEUES {
        subgroup_lane = lane_in_subgroup;
    }
    let queue = vertex_parameters.queue;
    var slot = 0u;
    var shading = no_shading();
    if id.x < atomicLoad(&counts[queue]) {
        slot = queues[queue * PATH_CAPACITY + id.x];
        var path = load_path(slot);
        if HAS_MOTION {
            set_path_time(path.pixel, path.sample_in_pass);
        }
        shading = shade_vertex(&path, load_hit(slot), vertex_parameters.vertex);
        // The last word changes with every vertex of scenes that use it.
#if LIGHT_LINKS
        let radiance = path_state[PLANE_RADIANCE + slot].xyz + shading.radiance;
        let last_word = path.null_vertices | path.receiver << 22u | path.reference_facing << 28u;
        path_state[PLANE_RADIANCE + slot] = vec4<f32>(radiance, bitcast<f32>(last_word));
#else
        if HAS_NULL_SURFACES || HAS_LIGHT_CELLS || any(shading.radiance != BLACK) {
            let radiance = path_state[PLANE_RADIANCE + slot].xyz + shading.radiance;
            path_state[PLANE_RADIANCE + slot] = vec4<f32>(radiance, bitcast<f32>(path.null_vertices | path.reference_facing << 28u));
        }
#endif
        if shading.alive {
            store_path(slot, path);
        }
    }
    let index = take_index(1u - queue, shading.alive);
    if shading.alive {
        queues[(1u - queue) * PATH_CAPACITY + index] = slot;
    }
#if LIGHTS
    // With several shadow rays it is known only later, one by one, which are needed: such a path may be in
    // the queue without any.
    let is_listed = is_needed(shading.shadow) || (LIGHT_SAMPLES > 1u && shading.light_samples > 1u);
    let shadow_index = take_index(2u + queue, is_listed);
    var rays = 0u;
    if is_listed {
        rays = store_shadow_rays(shadow_index, slot, shading);
    }
    if LIGHT_SAMPLES > 1u {
        count_shadow_rays(rays);
    }
#endif
}

// Writes the shadow rays of the path in a slot to its place in their queue. How many there are.
fn store_shadow_rays(index: u32, slot: u32, shading: Shading) -> u32 {
    var shadow = shading.shadow;
    var rays = 0u;
    var number = 0u;
    loop {
        if is_needed(shadow) {
            let at = shadow_ray_index(index, rays);
            shadow_rays[SHADOW_ORIGIN + at] = vec4<f32>(shadow.ray.origin, shadow.distance);
            shadow_rays[SHADOW_DIRECTION + at] = vec4<f32>(shadow.ray.direction, bitcast<f32>(slot));
            shadow_rays[SHADOW_RADIANCE + at] = vec4<f32>(shadow.radiance, 0.0);
            if HAS_OPEN_BOUNDARIES {
                shadow_rays[SHADOW_MEDIA + at] = vec4<f32>(bitcast<vec2<f32>>(shadow.media), bitcast<f32>(shadow.key), 0.0);
            }
            rays++;
        }
        number++;
        if LIGHT_SAMPLES == 1u || number >= shading.light_samples {
            break;
        }
        shadow = further_shadow_ray(shading.shaded, number);
    }
    if LIGHT_SAMPLES > 1u {
        shadow_rays[SHADOW_RADIANCE + index].w = bitcast<f32>(rays);
    }
    return rays;
}
