// The stack of a packet of rays (geometry/software/packet.wgsl): nodes still to visit. It lies in registers,
// one entry a lane. The next node is never on it: the time from loading one node to loading the next decides
// the speed, and the nearest child is known before the others are sorted.
#import geometry/software/lanes.wgsl
#import geometry/bvh4.wgsl

// Registers that hold the stack.
const STACK_REGISTERS: u32 = (STACK_SIZE + LANES - 1u) / LANES;

// All lanes hold equal values except in the registers: register r of lane l is entry r * LANES + l from the
// top, and FINISHED below the last. The registers are an array so that every index is a constant once loops
// are unrolled.
struct PacketStack {
    // The entry to visit next.
    current: u32,
    registers: array<u32, STACK_REGISTERS>,
}

fn packet_at_root() -> PacketStack {
    var stack: PacketStack;
    for (var number = 0u; number < STACK_REGISTERS; number++) {
        stack.registers[number] = FINISHED;
    }
    return stack;
}

// Pushes the entries of lanes 0 to count - 1 and continues with `first`, the entry of lane 0, which is not
// pushed; lane 1's entry comes to lie on top. With count 0 the top of the stack is next, or FINISHED where
// the stack is empty.
fn go_on(stack: ptr<function, PacketStack>, first: u32, entry: u32, count: u32) {
    let top = subgroupShuffle((*stack).registers[0], 0u);
    (*stack).current = select(first, top, count == 0u);
    // Registers move down by count - 1 entries, or up by one.
    let source = (lane + 1u - count) & (LANES - 1u);
    let comes_from_above = lane + 1u < count;
    let comes_from_below = count == 0u && lane == LANES - 1u;
    var above = subgroupShuffle(entry, (lane + 1u) & (LANES - 1u));
    var here = subgroupShuffle((*stack).registers[0], source);
    for (var number = 0u; number < STACK_REGISTERS; number++) {
        var below = FINISHED;
        // The index stays in the array's bounds even where the branch is not taken: software devices run it masked.
        if number + 1u < STACK_REGISTERS {
            below = subgroupShuffle((*stack).registers[min(number + 1u, STACK_REGISTERS - 1u)], source);
        }
        (*stack).registers[number] = select(select(here, above, comes_from_above), below, comes_from_below);
        above = here;
        here = below;
    }
}

// Goes on with what is on top of the stack.
fn pop(stack: ptr<function, PacketStack>) {
    go_on(stack, FINISHED, FINISHED, 0u);
}
