// Finds what every living path's ray meets.
#import geometry/closest.wgsl
#import stages/wavefront.wgsl

// Reads the queue, its count and the paths' rays. Writes the paths' hits. Leaves everything else alone.
@compute @workgroup_size(WORKGROUP)
fn extend(@builtin(global_invocation_id) id: vec3<u32>) {
    let queue = edge_parameters.queue;
    if id.x >= atomicLoad(&counts[queue]) {
        return;
    }
    let slot = queues[queue * PATH_CAPACITY + id.x];
    let hit = closest_hit(load_ray(slot), INFINITY_DISTANCE);
    path_state[PLANE_HIT + slot] = vec4<f32>(hit.t, bitcast<f32>(hit.primitive), hit.u, hit.v);
}
