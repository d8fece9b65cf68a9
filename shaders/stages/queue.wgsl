// Indices at the end of queues.
#import core/layout.wgsl
#import stages/wavefront.wgsl

#if SUBGROUP_QUEUES
// This invocation's number in its subgroup; to be set before indices are taken.
var<private> subgroup_lane: u32;

// An index in the queue for each invocation that wants one, by one atomic for the subgroup; of no meaning to the others. All invocations of a
// workgroup have to call this together, outside of every branch: lanes that are elsewhere are not counted, and the first lane adds for all.
fn take_index(queue: u32, wants: bool) -> u32 {
    let wanted = select(0u, 1u, wants);
    let before = subgroupExclusiveAdd(wanted);
    let together = subgroupAdd(wanted);
    var first = 0u;
    if subgroup_lane == 0u && together != 0u {
        first = atomicAdd(&counts[queue], together);
    }
    return subgroupBroadcastFirst(first) + before;
}

// Counts this invocation's shadow rays; likewise.
fn count_shadow_rays(rays: u32) {
    let together = subgroupAdd(rays);
    if subgroup_lane == 0u && together != 0u {
        atomicAdd(&counts[COUNT_OF_SHADOW_RAYS], together);
    }
}
#else
// An index in the queue for each invocation that wants one; of no meaning to the others.
fn take_index(queue: u32, wants: bool) -> u32 {
    var index = 0u;
    if wants {
        index = atomicAdd(&counts[queue], 1u);
    }
    return index;
}

// Counts this invocation's shadow rays.
fn count_shadow_rays(rays: u32) {
    if rays > 0u {
        atomicAdd(&counts[COUNT_OF_SHADOW_RAYS], rays);
    }
}
#endif
