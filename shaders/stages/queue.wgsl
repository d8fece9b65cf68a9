// Places at the end of queues.
#import stages/wavefront.wgsl

#if SUBGROUP_QUEUES
// This invocation's number in its subgroup; to be set before places are taken.
var<private> subgroup_lane: u32;

// A place for each invocation that wants one, by one atomic for the subgroup; of no meaning to the others. All invocations of a workgroup
// have to call this together, outside of every branch: lanes that are elsewhere are not counted, and the first lane adds for all.
fn take_place(queue: u32, wants: bool) -> u32 {
    let wanted = select(0u, 1u, wants);
    let before = subgroupExclusiveAdd(wanted);
    let together = subgroupAdd(wanted);
    var first = 0u;
    if subgroup_lane == 0u && together != 0u {
        first = atomicAdd(&counts[queue], together);
    }
    return subgroupBroadcastFirst(first) + before;
}
#else
// A place for each invocation that wants one; of no meaning to the others.
fn take_place(queue: u32, wants: bool) -> u32 {
    var place = 0u;
    if wants {
        place = atomicAdd(&counts[queue], 1u);
    }
    return place;
}
#endif
