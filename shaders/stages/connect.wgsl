// Traces the shadow rays.
#import core/layout.wgsl
#import core/math.wgsl
#import core/parameters.wgsl
#import geometry/closest.wgsl
#import shading/medium/boundaries.wgsl
#import stages/wavefront.wgsl

// Reads the queue of paths with shadow rays and its count. Adds to the radiance of the paths that see their light: one invocation traces all
// shadow rays of a path, in the order of its light samples, so no two touch the same radiance, and sums do not depend on the queue's order.
// Leaves everything else alone.
// An invocation takes several paths, as in `extend`.
@compute @workgroup_size(WORKGROUP)
fn connect(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>) {
    let count = atomicLoad(&counts[2u + vertex_parameters.queue]);
    let stride = workgroups.x * WORKGROUP;
    var next = id.x;
#if OPEN_BOUNDARIES
    for (; next < count; next += stride) {
        let rays = shadow_ray_count(next);
        for (var number = 0u; number < rays; number++) {
            let share = light_across_boundaries(next, number);
            if max_component(share) > 0.0 {
                add_light(next, number, share);
            }
        }
    }
#else
#if BVH
    var stack: array<StackEntry, STACK_SIZE>;
    var traversal = no_traversal();
    // The path at hand, as an index in the queue; how many shadow rays it has, and how many of them are traced.
    var index = 0u;
    var rays = 0u;
    var traced = 0u;
    loop {
        if is_finished(traversal) {
            if traced < rays {
                let share = traversed_light(traversal);
                if max_component(share) > 0.0 {
                    add_light(index, traced, share);
                }
                traced++;
            }
            if traced == rays {
                if next >= count {
                    break;
                }
                index = next;
                next += stride;
                rays = shadow_ray_count(index);
                traced = 0u;
            }
            if traced < rays {
                let s0 = shadow_rays[SHADOW_ORIGIN + shadow_ray_index(index, traced)];
                let s1 = shadow_rays[SHADOW_DIRECTION + shadow_ray_index(index, traced)];
                if HAS_MOTION {
                    set_path_time_of(bitcast<u32>(s1.w));
                }
                traversal = begin_any(Ray(s0.xyz, s1.xyz), s0.w);
            }
        }
        if !is_finished(traversal) {
            step_any(&traversal, &stack);
        }
    }
#else
    for (; next < count; next += stride) {
        let rays = shadow_ray_count(next);
        for (var number = 0u; number < rays; number++) {
            let s0 = shadow_rays[SHADOW_ORIGIN + shadow_ray_index(next, number)];
            let share = shadow_transmittance(Ray(s0.xyz, shadow_rays[SHADOW_DIRECTION + shadow_ray_index(next, number)].xyz), s0.w);
            if max_component(share) > 0.0 {
                add_light(next, number, share);
            }
        }
    }
#endif
#endif
}

#if OPEN_BOUNDARIES
// The share of light that comes along a shadow ray through surfaces that bound media.
fn light_across_boundaries(index: u32, number: u32) -> Spectrum {
    let s0 = shadow_rays[SHADOW_ORIGIN + shadow_ray_index(index, number)];
    let s1 = shadow_rays[SHADOW_DIRECTION + shadow_ray_index(index, number)];
    let media = bitcast<vec3<u32>>(shadow_rays[SHADOW_MEDIA + shadow_ray_index(index, number)].xyz);
    if HAS_MOTION {
        set_path_time_of(bitcast<u32>(s1.w));
    }
    var crossing = begin_crossing(Ray(s0.xyz, s1.xyz), s0.w, media.xy, media.z, true);
    while crossing.goes_on {
        crossing = cross_surface(crossing, closest_hit(crossing.ray, crossing.remaining));
    }
    return crossing.share;
}
#endif

// Number of shadow rays of the path with this index in the queue.
fn shadow_ray_count(index: u32) -> u32 {
    var rays = 1u;
    if LIGHT_SAMPLES > 1u {
        rays = bitcast<u32>(shadow_rays[SHADOW_RADIANCE + index].w);
    }
    return rays;
}

// Adds the share that comes through of what shadow ray `number` of the path with this index in the queue carries.
fn add_light(index: u32, number: u32, share: Spectrum) {
    let at = shadow_ray_index(index, number);
    let slot = bitcast<u32>(shadow_rays[SHADOW_DIRECTION + at].w);
    let gained = share * shadow_rays[SHADOW_RADIANCE + at].xyz;
    // The fourth word holds bits, not a number: it is copied, never added to.
    let before = path_state[PLANE_RADIANCE + slot];
    path_state[PLANE_RADIANCE + slot] = vec4<f32>(before.xyz + gained, before.w);
}
