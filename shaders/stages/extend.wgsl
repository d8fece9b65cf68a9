// Finds what every living path's ray meets.
#import core/layout.wgsl
#import core/math.wgsl
#import core/parameters.wgsl
#import geometry/closest.wgsl
#import stages/wavefront.wgsl

// Reads the queue, its count and the paths' rays. Writes the paths' hits. Leaves everything else alone.
// An invocation takes several rays, the next one as soon as the last is done: lanes do not wait for each other's longer ways.
@compute @workgroup_size(WORKGROUP)
fn extend(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>) {
    let queue = vertex_parameters.queue;
    let count = atomicLoad(&counts[queue]);
    let stride = workgroups.x * WORKGROUP;
    var next = id.x;
#if BVH
    var stack: array<StackEntry, STACK_SIZE>;
    var traversal = no_traversal();
    var slot = NONE;
    loop {
        if is_finished(traversal) {
            if slot != NONE {
                store_hit(slot, traversal.hit);
            }
            if next >= count {
                break;
            }
            slot = queues[queue * PATH_CAPACITY + next];
            next += stride;
            if HAS_MOTION {
                set_path_time_of(slot);
            }
            traversal = begin_closest(load_ray(slot), INFINITY_DISTANCE);
        }
        step_closest(&traversal, &stack);
    }
#else
    for (; next < count; next += stride) {
        let slot = queues[queue * PATH_CAPACITY + next];
        store_hit(slot, closest_hit(load_ray(slot), INFINITY_DISTANCE));
    }
#endif
}
