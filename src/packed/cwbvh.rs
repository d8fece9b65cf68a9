//! obvhs's eight-wide compressed hierarchy (Ylitie, Karras and Laine 2017), 80 bytes a node.
//!
//! Which nodes there are, and which child stands in which of a node's eight slots, is obvhs's; the boxes are put onto the grid anew. obvhs
//! takes differences of coordinates in f32 and rounds to lines without a margin, so that a box may lose a rounding error of its node's
//! extent, and a kernel that rounds as well may then miss what touches the box from inside.

use std::thread;

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::cwbvh::{CwBvh, bvh2_to_cwbvh::bvh2_to_cwbvh};

use super::grid::{Box3, Grid};
use super::hierarchy::Child;

/// Leaves hold at most this many primitives: their number takes three bits, one each.
const MAX_LEAF: u32 = 3;
/// Bytes of stack that the conversion may take for each level of the binary tree, and besides: it calls itself.
const STACK_PER_LEVEL: usize = 1 << 10;
const STACK: usize = 1 << 20;

/// Layout in `shaders/geometry/cwbvh.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Node {
    /// f32 bits of the grid's origin.
    pub origin: [u32; 3],
    /// Biased exponents of the grid's spacing in x, y, z; bits 24..32: the child in this slot is an inner node.
    pub exponents_and_inner: u32,
    /// Inner children are consecutive from here.
    pub first_child: u32,
    /// The leaves' primitives are consecutive from here.
    pub first_primitive: u32,
    /// A byte a slot. Inner node: 001, then 24 + slot. Leaf: a bit for each of its primitives in the upper three, then where they begin,
    /// counted from the node's first. Empty: 0.
    pub meta: [u32; 2],
    /// One byte per child.
    pub low: [[u32; 2]; 3],
    pub high: [[u32; 2]; 3],
}

impl Node {
    fn slots(&self) -> impl Iterator<Item = usize> {
        let meta = self.meta;
        (0..8).filter(move |&slot| byte(meta, slot) != 0)
    }

    /// What its children are, in the order of their slots.
    pub fn children(&self) -> Vec<Child> {
        let inner = self.exponents_and_inner >> 24;
        let child = |slot: usize| {
            if inner >> slot & 1 == 1 {
                Child::Inner((self.first_child + (inner & ((1 << slot) - 1)).count_ones()) as usize)
            } else {
                let meta = byte(self.meta, slot);
                Child::Leaf { first: self.first_primitive + (meta & 31), count: (meta >> 5).count_ones() }
            }
        };
        self.slots().map(child).collect()
    }

    /// The boxes of [`Node::children`], as the device sees them.
    pub fn boxes(&self) -> Vec<Box3> {
        let grid = Grid::unpack(self.origin, self.exponents_and_inner);
        let lines = |words: [[u32; 2]; 3], slot: usize| words.map(|words| byte(words, slot));
        self.slots().map(|slot| grid.at(lines(self.low, slot), lines(self.high, slot))).collect()
    }
}

fn byte(words: [u32; 2], slot: usize) -> u32 {
    words[slot / 4] >> (8 * (slot % 4)) & 0xff
}

/// The nodes, and the order of the primitives. The binary tree has one primitive a leaf.
pub fn build(mut binary: Bvh2) -> (Vec<Node>, Vec<usize>) {
    if binary.nodes.is_empty() {
        return (vec![Node::default()], Vec::new());
    }
    let mut bounds = vec![Box3::EMPTY; binary.primitive_indices.len()];
    for node in binary.nodes.iter().filter(|node| node.is_leaf()) {
        bounds[binary.primitive_indices[node.first_index as usize] as usize] = node.aabb().into();
    }
    normalise(&mut binary);
    let wide = convert(&binary);
    let order: Vec<usize> = wide.primitive_indices.iter().map(|&index| index as usize).collect();
    let mut nodes: Vec<Node> = wide.nodes.iter().map(topology).collect();
    // Children come after their parents, so one sweep from the back knows every child's box before its parent's.
    let mut boxes = vec![Box3::EMPTY; nodes.len()];
    for index in (0..nodes.len()).rev() {
        let node = &mut nodes[index];
        let of_child = |child: Child| match child {
            Child::Inner(inner) => boxes[inner],
            Child::Leaf { first, count } => {
                let leaf = &order[first as usize..(first + count) as usize];
                leaf.iter().map(|&primitive| bounds[primitive]).fold(Box3::EMPTY, Box3::union)
            }
        };
        let children: Vec<Box3> = node.children().into_iter().map(of_child).collect();
        boxes[index] = children.iter().copied().fold(Box3::EMPTY, Box3::union);
        set_boxes(node, &children);
    }
    (nodes, order)
}

/// Scales the tree's boxes to the size of 1: the conversion compares areas, which for very large or small scenes f32 does not hold.
fn normalise(binary: &mut Bvh2) {
    let root = binary.nodes[0].aabb();
    let largest = root.min.abs().max(root.max.abs()).max_element();
    let scale = f64::from(largest.max(f32::MIN_POSITIVE)).log2().ceil().clamp(-126.0, 126.0);
    let scale = (-scale).exp2() as f32;
    for node in &mut binary.nodes {
        let (min, max) = (node.aabb().min * scale, node.aabb().max * scale);
        node.set_aabb(Aabb::new(min, max));
    }
}

/// On a thread with a stack for the depth of the tree, which a scene may drive to any number.
fn convert(binary: &Bvh2) -> CwBvh {
    let mut depth = 0;
    let mut pending = vec![(0_usize, 1_usize)];
    while let Some((index, level)) = pending.pop() {
        depth = depth.max(level);
        let node = &binary.nodes[index];
        if !node.is_leaf() {
            let first = node.first_index as usize;
            pending.extend([(first, level + 1), (first + 1, level + 1)]);
        }
    }
    let run = || bvh2_to_cwbvh(binary, MAX_LEAF, true, false);
    thread::scope(|scope| {
        let builder = thread::Builder::new().stack_size(STACK + STACK_PER_LEVEL * depth);
        match builder.spawn_scoped(scope, run) {
            Ok(thread) => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            // Where there is no thread to be had, this one's stack has to do.
            Err(_) => run(),
        }
    })
}

/// A node without its boxes.
fn topology(node: &obvhs::cwbvh::node::CwBvhNode) -> Node {
    let [m0, m1, m2, m3, m4, m5, m6, m7] = node.child_meta;
    Node {
        exponents_and_inner: u32::from(node.imask) << 24,
        first_child: node.child_base_idx,
        first_primitive: node.primitive_base_idx,
        meta: [u32::from_le_bytes([m0, m1, m2, m3]), u32::from_le_bytes([m4, m5, m6, m7])],
        ..Node::default()
    }
}

/// Puts the boxes of the node's children onto a grid.
fn set_boxes(node: &mut Node, children: &[Box3]) {
    let grid = Grid::around(children.iter().copied());
    node.origin = grid.origin_bits();
    node.exponents_and_inner |= grid.exponents();
    let slots: Vec<usize> = node.slots().collect();
    for (slot, bounds) in slots.into_iter().zip(children) {
        let (low, high) = grid.lines(*bounds);
        for axis in 0..3 {
            node.low[axis][slot / 4] |= low[axis] << (8 * (slot % 4));
            node.high[axis][slot / 4] |= high[axis] << (8 * (slot % 4));
        }
    }
}
