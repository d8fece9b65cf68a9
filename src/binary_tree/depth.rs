//! How deep a tree is.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;

/// Most steps from the root to a leaf: enough for 2³² primitives in a balanced tree below as many levels that are not.
pub const DEEPEST: usize = 64;

/// Makes `slot` the root of a balanced tree over the leaves.
fn balance(nodes: &mut Vec<Bvh2Node>, slot: usize, leaves: &[Bvh2Node]) {
    let mut pending = vec![(slot, leaves)];
    while let Some((slot, leaves)) = pending.pop() {
        let [leaf] = leaves else {
            let bounds = leaves.iter().fold(Aabb::empty(), |bounds, leaf| bounds.union(leaf.aabb()));
            let first = nodes.len();
            nodes[slot] = Bvh2Node::new(bounds, 0, first as u32);
            nodes.extend([Bvh2Node::default(); 2]);
            let (left, right) = leaves.split_at(leaves.len() / 2);
            pending.extend([(first + 1, right), (first, left)]);
            continue;
        };
        nodes[slot] = *leaf;
    }
}

fn forget_the_old_shape(tree: &mut Bvh2) {
    tree.parents.clear();
    tree.primitives_to_nodes.clear();
    tree.children_are_ordered_after_parents = false;
    tree.max_depth = tree.max_depth.max(DEEPEST + 1);
}

/// Nodes with their depths, parents before children. A tree over nothing has none.
pub fn top_down(nodes: &[Bvh2Node]) -> Vec<(usize, usize)> {
    let mut order = Vec::with_capacity(nodes.len());
    let mut pending: Vec<(usize, usize)> = if nodes.is_empty() { Vec::new() } else { vec![(0, 0)] };
    while let Some((index, depth)) = pending.pop() {
        order.push((index, depth));
        if !nodes[index].is_leaf() {
            let first = nodes[index].first_index as usize;
            pending.extend([(first + 1, depth + 1), (first, depth + 1)]);
        }
    }
    order
}

/// Steps from the root to the deepest leaf.
pub fn reached(nodes: &[Bvh2Node]) -> usize {
    below(nodes, 0, 0)
}

/// Down to so many steps from the root, halves are looked at side by side.
const SIDE_BY_SIDE: usize = 8;

fn below(nodes: &[Bvh2Node], index: usize, depth: usize) -> usize {
    if depth < SIDE_BY_SIDE && !nodes[index].is_leaf() {
        let first = nodes[index].first_index as usize;
        let (left, right) = rayon::join(|| below(nodes, first, depth + 1), || below(nodes, first + 1, depth + 1));
        return left.max(right);
    }
    let mut deepest = depth;
    let mut pending = vec![(index as u32, depth)];
    while let Some((index, depth)) = pending.pop() {
        deepest = deepest.max(depth);
        let node = &nodes[index as usize];
        if !node.is_leaf() {
            pending.extend([(node.first_index + 1, depth + 1), (node.first_index, depth + 1)]);
        }
    }
    deepest
}

/// A limit that a balanced tree of so many leaves keeps with room to spare.
pub fn nearly_balanced(leaves: usize) -> usize {
    (leaves.next_power_of_two().ilog2() as usize + 8).min(DEEPEST)
}

/// Balances the parts of a tree that would reach below `deepest`, to which a balanced tree would not reach.
pub fn limit_depth(tree: &mut Bvh2, deepest: usize) {
    let order = top_down(&tree.nodes);
    if order.iter().all(|(_, depth)| *depth <= deepest) {
        return;
    }
    let old = &tree.nodes;
    let (mut heights, mut leaves) = (vec![0; old.len()], vec![1_usize; old.len()]);
    for &(index, _) in order.iter().rev().filter(|(index, _)| !old[*index].is_leaf()) {
        let first = old[index].first_index as usize;
        heights[index] = heights[first].max(heights[first + 1]) + 1;
        leaves[index] = leaves[first] + leaves[first + 1];
    }
    let mut nodes = vec![Bvh2Node::default()];
    let mut pending = vec![(0, 0, 0)];
    while let Some((slot, index, depth)) = pending.pop() {
        nodes[slot] = old[index];
        if old[index].is_leaf() {
            continue;
        }
        let fits = depth + heights[index] <= deepest;
        let balanced_height = leaves[index].next_power_of_two().ilog2() as usize;
        if !fits && depth + balanced_height >= deepest {
            balance(&mut nodes, slot, &leaves_below(old, index));
            continue;
        }
        let (from, to) = (old[index].first_index as usize, nodes.len());
        nodes[slot].first_index = to as u32;
        nodes.extend([Bvh2Node::default(); 2]);
        pending.extend([(to + 1, from + 1, depth + 1), (to, from, depth + 1)]);
    }
    tree.nodes = nodes;
    forget_the_old_shape(tree);
}

/// From left to right.
fn leaves_below(nodes: &[Bvh2Node], index: usize) -> Vec<Bvh2Node> {
    let mut leaves = Vec::new();
    let mut pending = vec![index];
    while let Some(index) = pending.pop() {
        if nodes[index].is_leaf() {
            leaves.push(nodes[index]);
        } else {
            let first = nodes[index].first_index as usize;
            pending.extend([first + 1, first]);
        }
    }
    leaves
}

#[cfg(test)]
pub(crate) mod tests {
    use glam::Vec3A;

    use super::*;
    use crate::binary_tree::tests::{around, checked_depth};

    /// Every inner node holds one leaf and the rest of the chain.
    pub fn chain(boxes: &[Aabb]) -> Bvh2 {
        let count = boxes.len();
        let mut tree = Bvh2 { primitive_indices: (0..count as u32).collect(), ..Bvh2::default() };
        // Around the first boxes, so many as stand in a node.
        let around: Vec<Aabb> = boxes
            .iter()
            .scan(Aabb::empty(), |all, bounds| {
                *all = all.union(bounds);
                Some(*all)
            })
            .collect();
        tree.nodes.push(Bvh2Node::default());
        let mut slot = 0;
        for index in (1..count).rev() {
            let first = tree.nodes.len();
            tree.nodes[slot] = Bvh2Node::new(around[index], 0, first as u32);
            tree.nodes.extend([Bvh2Node::default(), Bvh2Node::new(boxes[index], 1, index as u32)]);
            slot = first;
        }
        tree.nodes[slot] = Bvh2Node::new(boxes[0], 1, 0);
        tree
    }

    #[test]
    fn chains_are_cut_off_at_the_limit() {
        let count = 3000_u32;
        let boxes: Vec<Aabb> = (0..count).map(|radius| around(Vec3A::ZERO, radius as f32 + 1.0)).collect();
        let mut tree = chain(&boxes);
        // The control: it is as deep as it is long.
        assert_eq!(checked_depth(&tree, &boxes), count as usize - 1);
        limit_depth(&mut tree, DEEPEST);
        assert_eq!(checked_depth(&tree, &boxes), DEEPEST);
    }
}
