//! A binary bounding volume hierarchy with both children's boxes in the parent, as floats, 64 bytes a node.

use glam::Vec3;
use obvhs::bvh2::Bvh2;

use super::grid::Box3;
use super::hierarchy::Child;

/// Set in an entry that is a leaf: then two bits of its size less one from bit 24 on, and 24 bits of its first primitive.
const LEAF: u32 = 1 << 31;
/// No child. No leaf has this entry.
const ABSENT: u32 = u32::MAX;

/// Layout in `shaders/geometry/bvh2.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Node {
    /// Per axis: low of both children, high of both.
    pub planes: [[f32; 4]; 3],
    /// What the children are: an inner node's index, or a leaf.
    pub entries: [u32; 2],
    pub padding: [u32; 2],
}

impl Node {
    /// Without children.
    fn empty() -> Self {
        let [low, high] = [Box3::EMPTY.low.x, Box3::EMPTY.high.x];
        Self { planes: [[low, low, high, high]; 3], entries: [ABSENT; 2], padding: [0; 2] }
    }

    fn set(&mut self, place: usize, bounds: Box3, entry: u32) {
        for axis in 0..3 {
            self.planes[axis][place] = bounds.low[axis];
            self.planes[axis][2 + place] = bounds.high[axis];
        }
        self.entries[place] = entry;
    }

    /// What its children are, in the order of their places.
    pub fn children(&self) -> Vec<Child> {
        let child = |entry: &u32| {
            if entry & LEAF == 0 {
                Child::Inner(*entry as usize)
            } else {
                Child::Leaf { first: entry & 0x00ff_ffff, count: (entry >> 24 & 3) + 1 }
            }
        };
        self.entries.iter().filter(|entry| **entry != ABSENT).map(child).collect()
    }

    /// The boxes of [`Node::children`].
    pub fn boxes(&self) -> Vec<Box3> {
        let side = |place: usize| Vec3::from(self.planes.map(|planes| planes[place]));
        let exists = |place: &usize| self.entries[*place] != ABSENT;
        (0..2).filter(exists).map(|place| Box3 { low: side(place), high: side(2 + place) }).collect()
    }
}

/// The nodes, and the order of the primitives.
pub fn build(binary: &Bvh2) -> (Vec<Node>, Vec<usize>) {
    let mut nodes = vec![Node::empty()];
    let mut order = Vec::with_capacity(binary.primitive_indices.len());
    let Some(root) = binary.nodes.first() else { return (nodes, order) };
    // Nodes in whose place something stands: (node, place), and the binary node that belongs there. Last in, first out: what a ray
    // visits one after the other stands close together.
    let mut pending = Vec::new();
    let first = root.first_index as usize;
    if root.is_leaf() {
        pending.push((0, 0, 0));
    } else {
        pending.extend([(0, 1, first + 1), (0, 0, first)]);
    }
    while let Some((parent, place, index)) = pending.pop() {
        let node = &binary.nodes[index];
        let first = node.first_index as usize;
        let entry = if node.is_leaf() {
            let leaf = &binary.primitive_indices[first..first + node.prim_count as usize];
            let entry = LEAF | (node.prim_count - 1) << 24 | order.len() as u32;
            order.extend(leaf.iter().map(|&index| index as usize));
            entry
        } else {
            nodes.push(Node::empty());
            let inner = nodes.len() - 1;
            pending.extend([(inner, 1, first + 1), (inner, 0, first)]);
            inner as u32
        };
        nodes[parent].set(place, node.aabb().into(), entry);
    }
    (nodes, order)
}
