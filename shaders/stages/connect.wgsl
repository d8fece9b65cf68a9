// Traces the shadow rays.
#import geometry/closest.wgsl
#import stages/wavefront.wgsl

// Reads the shadow rays and their count. Adds to the radiance of the paths that see their light; a path has at most one shadow ray
// at a time, so no two invocations touch the same radiance. Leaves everything else alone.
// An invocation takes several rays, as in `extend`.
@compute @workgroup_size(WORKGROUP)
fn connect(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>) {
    let count = atomicLoad(&counts[2u + edge_parameters.queue]);
    let stride = workgroups.x * WORKGROUP;
    var next = id.x;
#if BVH
    var stack: array<StackEntry, STACK_SIZE>;
    var traversal = no_traversal();
    var place = NONE;
    loop {
        if is_finished(traversal) {
            if place != NONE && traversal.hit.primitive == NONE {
                add_light(place);
            }
            if next >= count {
                break;
            }
            place = next;
            next += stride;
#if MOTION
            set_path_time_of(bitcast<u32>(shadow_rays[SHADOW_DIRECTION + place].w));
#endif
            let s0 = shadow_rays[SHADOW_ORIGIN + place];
            traversal = begin_any(Ray(s0.xyz, shadow_rays[SHADOW_DIRECTION + place].xyz), s0.w);
        }
        if !is_finished(traversal) {
            step_any(&traversal, &stack);
        }
    }
#else
    for (; next < count; next += stride) {
        let s0 = shadow_rays[SHADOW_ORIGIN + next];
        if !occluded(Ray(s0.xyz, shadow_rays[SHADOW_DIRECTION + next].xyz), s0.w) {
            add_light(next);
        }
    }
#endif
}

fn add_light(place: u32) {
    let slot = bitcast<u32>(shadow_rays[SHADOW_DIRECTION + place].w);
    let gained = shadow_rays[SHADOW_RADIANCE + place].xyz;
    // The fourth word holds bits, not a number: it is copied, never added to.
    let before = path_state[PLANE_RADIANCE + slot];
    path_state[PLANE_RADIANCE + slot] = vec4<f32>(before.xyz + gained, before.w);
}
