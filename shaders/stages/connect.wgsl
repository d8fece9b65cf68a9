// Traces the shadow rays.
#import geometry/closest.wgsl
#import stages/wavefront.wgsl

// Reads the shadow rays and their count. Adds to the radiance of the paths that see their light; a path has at most one shadow ray
// at a time, so no two invocations touch the same radiance. Leaves everything else alone.
@compute @workgroup_size(WORKGROUP)
fn connect(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= atomicLoad(&counts[2u + edge_parameters.queue]) {
        return;
    }
    let s0 = shadow_rays[SHADOW_ORIGIN + id.x];
    let s1 = shadow_rays[SHADOW_DIRECTION + id.x];
    if occluded(Ray(s0.xyz, s1.xyz), s0.w) {
        return;
    }
    let slot = bitcast<u32>(s1.w);
    let gained = shadow_rays[SHADOW_RADIANCE + id.x].xyz;
    path_state[PLANE_RADIANCE + slot] = vec4<f32>(path_state[PLANE_RADIANCE + slot].xyz + gained, 0.0);
}
