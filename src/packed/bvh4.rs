//! A four-wide bounding volume hierarchy with 8-bit boxes, 48 bytes a node, made from obvhs's binary one.
//!
//! The cost of a traversal step on software Vulkan is the number of words it loads, so four children's boxes
//! are quantised to bytes on a [grid](super::grid) of the node's own.

use obvhs::bvh2::Bvh2;

use super::grid::{Box3, Grid};
use super::widening::Widening;
use crate::shader::shared::shared_constants;

/// A child of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Child {
    /// Index of a node.
    Inner(usize),
    /// Consecutive primitives.
    Leaf { first: u32, count: u32 },
}

shared_constants!(constants {
    /// Words of a node's record.
    pub const NODE_RECORD_WORDS: u32 = (size_of::<Node>() / 16) as u32;
});

/// Layout in `shaders/geometry/bvh4.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Node {
    /// f32 bits of the grid's origin.
    pub origin: [u32; 3],
    /// Biased exponents of the grid's spacing in x, y, z; bits 24..28: child is an inner node; bits 28..32: child exists.
    pub exponents_and_flags: u32,
    /// Inner children are consecutive from here.
    pub first_child: u32,
    /// 24 bits: the leaves' primitives are consecutive from here; then two bits per child: leaf size − 1.
    pub first_primitive_and_sizes: u32,
    /// One byte per child.
    pub low: [u32; 3],
    pub high: [u32; 3],
}

impl Node {
    /// The children, in the order of their slots.
    pub fn children(&self) -> Vec<Child> {
        let flags = self.exponents_and_flags >> 24;
        let mut inner = self.first_child as usize;
        let mut primitive = self.first_primitive_and_sizes & 0x00ff_ffff;
        (0..4)
            .filter(|child| flags >> (4 + child) & 1 == 1)
            .map(|child| {
                if flags >> child & 1 == 1 {
                    inner += 1;
                    Child::Inner(inner - 1)
                } else {
                    let count = (self.first_primitive_and_sizes >> (24 + 2 * child) & 3) + 1;
                    primitive += count;
                    Child::Leaf { first: primitive - count, count }
                }
            })
            .collect()
    }

    /// The node of a tree whose nodes and primitives stand behind so many others.
    pub fn behind(self, nodes: u32, primitives: u32) -> Self {
        Self {
            first_child: self.first_child + nodes,
            first_primitive_and_sizes: self.first_primitive_and_sizes + primitives,
            ..self
        }
    }

    /// Kernels count children by their places and primitives by leaf sizes, whether or not the child before exists. So the first places
    /// are taken, and only leaves have sizes.
    pub fn is_well_formed(&self) -> bool {
        let flags = self.exponents_and_flags >> 24;
        let (inner, exists) = (flags & 15, flags >> 4);
        let sizes = self.first_primitive_and_sizes >> 24;
        let is_leaf = |child: u32| exists & !inner & 1 << child != 0;
        exists & (exists + 1) == 0 && inner & !exists == 0 && (0..4).all(|child| is_leaf(child) || sizes >> (2 * child) & 3 == 0)
    }

    /// The boxes of [`Node::children`], as the device sees them.
    pub fn boxes(&self) -> Vec<Box3> {
        let exists = |child: &usize| self.exponents_and_flags >> (28 + child) & 1 == 1;
        let grid = Grid::unpack(self.origin, self.exponents_and_flags);
        let byte = |words: [u32; 3], child: usize| words.map(|word| word >> (8 * child) & 0xff);
        (0..4).filter(exists).map(|child| grid.at(byte(self.low, child), byte(self.high, child))).collect()
    }
}

/// The nodes, and the order of the primitives. Leaves hold up to `most`.
pub fn build(binary: &Bvh2, most: u32) -> (Vec<Node>, Vec<usize>) {
    let mut nodes = vec![Node::default()];
    let order = Vec::with_capacity(binary.primitive_indices.len());
    let mut collapse = Collapse { binary, widening: Widening::new(binary, most), nodes: &mut nodes, order };
    if !binary.nodes.is_empty() {
        collapse.root();
    }
    let order = collapse.order;
    (nodes, order)
}

/// A child about to be stored: its box, and the binary node it stands for.
#[derive(Clone, Copy)]
struct ChildBox {
    bounds: Box3,
    node: usize,
}

struct Collapse<'a> {
    binary: &'a Bvh2,
    widening: Widening<'a>,
    nodes: &'a mut Vec<Node>,
    /// Primitive indices in leaf order.
    order: Vec<usize>,
}

impl Collapse<'_> {
    fn child(&self, node: usize) -> ChildBox {
        ChildBox { bounds: self.binary.nodes[node].aabb().into(), node }
    }

    fn widen(&self, node: usize) -> Vec<ChildBox> {
        self.widening.children(node).into_iter().map(|node| self.child(node)).collect()
    }

    fn root(&mut self) {
        // Last in, first out: what a ray visits one after the other stands close together.
        let children = if self.widening.leaf(0).is_some() { vec![self.child(0)] } else { self.widen(0) };
        let mut pending = vec![(0_usize, children)];
        while let Some((slot, children)) = pending.pop() {
            let first_child = self.nodes.len() as u32;
            let first_primitive = self.order.len() as u32;
            let mut node = quantise(&children);
            node.first_child = first_child;
            node.first_primitive_and_sizes = first_primitive;
            for (place, child) in children.iter().enumerate() {
                node.exponents_and_flags |= 1 << (28 + place);
                if let Some(leaf) = self.widening.leaf(child.node) {
                    node.first_primitive_and_sizes |= (leaf.len() as u32 - 1) << (24 + 2 * place);
                    self.order.extend(leaf);
                } else {
                    node.exponents_and_flags |= 1 << (24 + place);
                    pending.push((self.nodes.len(), self.widen(child.node)));
                    self.nodes.push(Node::default());
                }
            }
            self.nodes[slot] = node;
        }
    }
}

/// Puts the children's boxes onto a grid.
fn quantise(children: &[ChildBox]) -> Node {
    let grid = Grid::around(children.iter().map(|child| child.bounds));
    let mut node = Node { origin: grid.origin_bits(), exponents_and_flags: grid.exponents(), ..Node::default() };
    for (place, child) in children.iter().enumerate() {
        let (low, high) = grid.lines(child.bounds);
        for axis in 0..3 {
            node.low[axis] |= low[axis] << (8 * place);
            node.high[axis] |= high[axis] << (8 * place);
        }
    }
    node
}
