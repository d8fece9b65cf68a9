// Turns counts into dispatch sizes, on the device, so that no bounce waits for the host.
#import core/parameters.wgsl
#import stages/wavefront.wgsl

// Workgroups of the next extend and shade, then of connect: x, y, z each.
@group(0) @binding(13) var<storage, read_write> dispatch_sizes: array<u32, 6>;
#import stages/statistics.wgsl

// One invocation. Reads the counts after `shade` of an edge. Writes dispatch_sizes, counts the rays about to be traced, and empties
// the queue just read and the other edge's shadow rays.
@compute @workgroup_size(1)
fn prepare() {
    let queue = edge_parameters.queue;
    let living = atomicLoad(&counts[1u - queue]);
    let shadows = atomicLoad(&counts[2u + queue]);
    dispatch_sizes[0] = (living + WORKGROUP - 1u) / WORKGROUP;
    dispatch_sizes[1] = 1u;
    dispatch_sizes[2] = 1u;
    dispatch_sizes[3] = (shadows + WORKGROUP - 1u) / WORKGROUP;
    dispatch_sizes[4] = 1u;
    dispatch_sizes[5] = 1u;
    count_rays(living + shadows);
    atomicStore(&counts[queue], 0u);
    atomicStore(&counts[3u - queue], 0u);
}
