// The way through a hierarchy whose nodes sort their children by distance: each child that waits is an entry of one word.
// A form's file has descend: visits a node, puts the children met onto the stack but for the nearest, and returns that.

// Inner child: node index. Leaf: LEAF | (size - 1) << 24 | first primitive.
const LEAF: u32 = 0x80000000u;
// No entry is left. No leaf has this entry: its size would be above any.
const FINISHED: u32 = 0xffffffffu;

alias StackEntry = u32;

struct Pending {
    // The entry to visit next, and how many wait on the stack.
    current: u32,
    depth: u32,
    // Primitives of the leaf entered last that are still to be tested.
    primitive: u32,
    primitive_end: u32,
}

fn nothing_pending() -> Pending {
    return Pending(FINISHED, 0u, 0u, 0u);
}

fn pending_root() -> Pending {
    return Pending(0u, 0u, 0u, 0u);
}

fn is_pending(pending: Pending) -> bool {
    return pending.current != FINISHED || pending.primitive != pending.primitive_end;
}

// Visits one node, nearest first, and tests one primitive of a leaf met before. Lanes that run together pay for both anyway, so a
// leaf's primitives are tested while the way goes on, not before it does.
fn step_closest(traversal: ptr<function, Traversal>, stack: ptr<function, array<StackEntry, STACK_SIZE>>) {
    var current = (*traversal).pending.current;
    var leads_nowhere = false;
    if (current & LEAF) == 0u {
        current = descend(current, traversal, stack);
        leads_nowhere = current == FINISHED;
    }
    let is_leaf = (current & LEAF) != 0u && current != FINISHED;
    if !leads_nowhere && is_leaf && (*traversal).pending.primitive == (*traversal).pending.primitive_end {
        (*traversal).pending.primitive = current & 0x00ffffffu;
        (*traversal).pending.primitive_end = (*traversal).pending.primitive + ((current >> 24u) & 3u) + 1u;
        leads_nowhere = true;
    }
    if leads_nowhere {
        current = FINISHED;
        if (*traversal).pending.depth != 0u {
            (*traversal).pending.depth--;
            current = (*stack)[(*traversal).pending.depth];
        }
    }
    (*traversal).pending.current = current;
    if (*traversal).pending.primitive != (*traversal).pending.primitive_end {
        test_primitive(traversal, (*traversal).pending.primitive);
        (*traversal).pending.primitive++;
    }
}
