// Turns counts into dispatch sizes, on the device, so that no vertex waits for the host.
#import core/layout.wgsl
#import core/parameters.wgsl
#import stages/statistics.wgsl
#import stages/wavefront.wgsl

// Workgroups of the next shade, of the next extend, and of connect: x, y, z each.
@group(0) @binding(BINDING_DISPATCH_SIZES) var<storage, read_write> dispatch_sizes: array<u32, DISPATCH_SIZE_WORDS>;

fn set_dispatch_size(first: u32, workgroups: u32) {
    dispatch_sizes[first] = workgroups;
    dispatch_sizes[first + 1u] = 1u;
    dispatch_sizes[first + 2u] = 1u;
}

// One invocation. Reads the counts after `shade` of a vertex. Writes dispatch_sizes, counts the rays about to be traced, and empties
// the queue just read and the other vertex's queue of shadow rays. Leaves everything else alone.
@compute @workgroup_size(1)
fn prepare() {
    let queue = vertex_parameters.queue;
    let living = atomicLoad(&counts[1u - queue]);
    let shadows = atomicLoad(&counts[2u + queue]);
    let rays_per_workgroup = WORKGROUP * RAYS_PER_INVOCATION;
    set_dispatch_size(SHADE_SIZE, (living + WORKGROUP - 1u) / WORKGROUP);
    set_dispatch_size(EXTEND_SIZE, (living + rays_per_workgroup - 1u) / rays_per_workgroup);
    set_dispatch_size(CONNECT_SIZE, (shadows + rays_per_workgroup - 1u) / rays_per_workgroup);
    var rays_to_lights = shadows;
    if LIGHT_SAMPLES > 1u {
        rays_to_lights = atomicExchange(&counts[COUNT_OF_SHADOW_RAYS], 0u);
    }
    count_rays(living + rays_to_lights);
    atomicStore(&counts[queue], 0u);
    atomicStore(&counts[3u - queue], 0u);
}
