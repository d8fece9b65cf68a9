//! A four-wide bounding volume hierarchy with 8-bit boxes, 48 bytes a node, made from obvhs's binary one.
//!
//! What a traversal step costs on software Vulkan is the number of words it loads, so four children's boxes are quantised to bytes
//! on a grid of the node's own (as in Ylitie, Karras and Laine 2017). Boxes only ever grow.

use glam::Vec3;
use obvhs::bvh2::{Bvh2, builder::build_bvh2};
use obvhs::{Boundable, BvhBuildParams, aabb::Aabb};

use super::motion::FlatMotion;
use super::primitive::{PrimitiveKind, WorldPrimitive};
use super::validate::FlatError;

/// Leaves hold at most this many primitives: their size takes two bits.
const MAX_LEAF: u32 = 4;
/// First primitive of a node's leaves: 24 bits.
pub const MAX_PRIMITIVES: usize = 1 << 24;
/// Shapes other than triangles that stay outside of the hierarchy, at most.
const MAX_OUTSIDE: usize = 16;
/// Planes are code, one by one.
const MAX_PLANES: usize = 256;
/// Up to so many primitives, a third of the nodes is tried elsewhere in the tree.
const REINSERT_MANY: usize = 1 << 18;
/// Grid lines of a node. One is kept free at either end as a margin, so that rounding never cuts a box.
const GRID: f64 = 253.0;

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

/// The hierarchy, and how many primitives it holds.
#[derive(Debug, Clone, Default)]
pub struct Bvh4 {
    /// Node 0 is the root. It has no children where there is nothing to bound.
    pub nodes: Vec<Node>,
    /// Most entries a traversal's stack can hold.
    pub stack_size: u32,
    /// Primitives in leaves.
    pub primitive_count: u32,
}

struct Bounds(Aabb);

impl Boundable for Bounds {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

/// A child about to be stored: its box, and the binary node it stands for.
#[derive(Clone, Copy)]
struct Child {
    low: Vec3,
    high: Vec3,
    node: usize,
}

impl Bvh4 {
    /// Builds the hierarchy. The second value is the order in which primitives have to stand: the leaves' first, then those that it
    /// does not hold, which kernels test one by one: planes, which nothing bounds, and other shapes where they are few, so that a
    /// model on a ground under a lamp needs a hierarchy of triangles alone. What moves is always in it, bounded over the time for
    /// which the shutter is open.
    ///
    /// # Errors
    /// [`FlatError`] for more primitives or planes than can be held.
    pub fn build(primitives: &[WorldPrimitive], motions: &[FlatMotion]) -> Result<(Self, Vec<usize>), FlatError> {
        let belongs = |primitive: &WorldPrimitive| primitive.kind() == PrimitiveKind::Triangle || primitive.moves();
        let others = primitives.iter().filter(|primitive| !belongs(primitive)).count();
        let few_others = others <= MAX_OUTSIDE && others < primitives.len();
        let (inside, outside): (Vec<usize>, Vec<usize>) = (0..primitives.len()).partition(|&index| {
            let primitive = &primitives[index];
            belongs(primitive) || !(few_others || primitive.is_plane())
        });
        if outside.len() > MAX_PLANES {
            return Err(FlatError::TooManyPlanes { found: outside.len(), limit: MAX_PLANES });
        }
        let bounds: Vec<Bounds> = inside
            .iter()
            .filter_map(|&index| {
                let primitive = &primitives[index];
                motions.get(primitive.motion as usize).map_or_else(|| primitive.bounds(), |motion| motion.swept(primitive))
            })
            .map(|(low, high)| Bounds(Aabb::new(low.into(), high.into())))
            .collect();
        if bounds.len() > MAX_PRIMITIVES {
            return Err(FlatError::TooManyPrimitives { found: bounds.len(), limit: MAX_PRIMITIVES });
        }
        let mut bvh = Self { nodes: vec![Node::default()], stack_size: 1, primitive_count: bounds.len() as u32 };
        if bounds.is_empty() {
            return Ok((bvh, outside));
        }
        let medium = BvhBuildParams::medium_build();
        let parameters = BvhBuildParams {
            max_prims_per_leaf: MAX_LEAF,
            collapse_traversal_cost: 1.0,
            // A tenth of a second for 100,000 triangles, and a few per cent fewer steps in every ray.
            reinsertion_batch_ratio: if bounds.len() <= REINSERT_MANY { 0.3 } else { medium.reinsertion_batch_ratio },
            ..medium
        };
        let binary = build_bvh2(&bounds, parameters, &mut std::time::Duration::default());
        let mut collapse = Collapse { binary: &binary, nodes: &mut bvh.nodes, order: Vec::with_capacity(bounds.len()) };
        collapse.root();
        let order = collapse.order.into_iter().map(|index| inside[index]).chain(outside).collect();
        bvh.stack_size = bvh.deepest_stack();
        Ok((bvh, order))
    }

    /// Children of a node as traversal entries: Ok(inner node) or Err(first primitive, count).
    pub fn children(&self, node: &Node) -> Vec<Result<usize, (u32, u32)>> {
        let flags = node.exponents_and_flags >> 24;
        let mut inner = node.first_child;
        let mut primitive = node.first_primitive_and_sizes & 0x00ff_ffff;
        (0..4)
            .filter(|child| flags >> (4 + child) & 1 == 1)
            .map(|child| {
                if flags >> child & 1 == 1 {
                    inner += 1;
                    Ok(inner as usize - 1)
                } else {
                    let count = (node.first_primitive_and_sizes >> (24 + 2 * child) & 3) + 1;
                    primitive += count;
                    Err((primitive - count, count))
                }
            })
            .collect()
    }

    /// Most entries on the stack of a traversal that pushes all children of a node and then takes one.
    fn deepest_stack(&self) -> u32 {
        // Children come after their parents, so one sweep from the back sees every child before its parent.
        let mut need = vec![0_u32; self.nodes.len()];
        for index in (0..self.nodes.len()).rev() {
            let children = self.children(&self.nodes[index]);
            let count = children.len() as u32;
            let deepest = children.iter().map(|child| child.map_or(0, |inner| need[inner])).max().unwrap_or(0);
            need[index] = count.max((count + deepest).saturating_sub(1));
        }
        need[0].max(1)
    }
}

struct Collapse<'a> {
    binary: &'a Bvh2,
    nodes: &'a mut Vec<Node>,
    /// Primitive indices in leaf order.
    order: Vec<usize>,
}

impl Collapse<'_> {
    fn child(&self, node: usize) -> Child {
        let aabb = self.binary.nodes[node].aabb();
        Child { low: aabb.min.into(), high: aabb.max.into(), node }
    }

    fn root(&mut self) {
        let root = &self.binary.nodes[0];
        // Last in, first out: what a ray visits one after the other stands close together.
        let children = if root.is_leaf() { vec![self.child(0)] } else { self.widen(0) };
        let mut pending = vec![(0_usize, children)];
        while let Some((slot, children)) = pending.pop() {
            let first_child = self.nodes.len() as u32;
            let first_primitive = self.order.len() as u32;
            let mut node = quantise(&children);
            node.first_child = first_child;
            node.first_primitive_and_sizes = first_primitive;
            for (place, child) in children.iter().enumerate() {
                let binary = &self.binary.nodes[child.node];
                node.exponents_and_flags |= 1 << (28 + place);
                if binary.is_leaf() {
                    let first = binary.first_index as usize;
                    let leaf = &self.binary.primitive_indices[first..first + binary.prim_count as usize];
                    self.order.extend(leaf.iter().map(|&index| index as usize));
                    node.first_primitive_and_sizes |= (binary.prim_count - 1) << (24 + 2 * place);
                } else {
                    node.exponents_and_flags |= 1 << (24 + place);
                    pending.push((self.nodes.len(), self.widen(child.node)));
                    self.nodes.push(Node::default());
                }
            }
            self.nodes[slot] = node;
        }
    }

    /// Up to four descendants of an inner binary node, found by opening the largest again and again.
    fn widen(&self, node: usize) -> Vec<Child> {
        let first = self.binary.nodes[node].first_index as usize;
        let mut children = vec![self.child(first), self.child(first + 1)];
        while children.len() < 4 {
            let area = |child: &Child| self.binary.nodes[child.node].aabb().half_area();
            let openable = children.iter().enumerate().filter(|(_, c)| !self.binary.nodes[c.node].is_leaf());
            let Some((largest, _)) = openable.max_by(|(_, a), (_, b)| area(a).total_cmp(&area(b))) else { break };
            let first = self.binary.nodes[children[largest].node].first_index as usize;
            children[largest] = self.child(first);
            children.push(self.child(first + 1));
        }
        children
    }
}

/// Puts the children's boxes onto a grid of powers of two around them.
fn quantise(children: &[Child]) -> Node {
    let low = children.iter().map(|c| c.low).reduce(Vec3::min).unwrap_or_default().as_dvec3();
    let high = children.iter().map(|c| c.high).reduce(Vec3::max).unwrap_or_default().as_dvec3();
    let mut node = Node::default();
    for axis in 0..3 {
        let extent = (high[axis] - low[axis]).max(low[axis].abs().max(high[axis].abs()) * 1e-6).max(1e-30);
        let exponent = (extent / GRID).log2().ceil().clamp(-126.0, 127.0);
        let spacing = exponent.exp2();
        // One free line below; f32 rounding of the origin is far less than a line unless the grid is tiny for its place, which the
        // extent's lower bound rules out.
        let origin = (low[axis] - spacing) as f32;
        node.origin[axis] = origin.to_bits();
        node.exponents_and_flags |= ((exponent as i32 + 127) as u32) << (8 * axis);
        for (place, child) in children.iter().enumerate() {
            let line = |x: f32| (f64::from(x) - f64::from(origin)) / spacing;
            let below = (line(child.low[axis]) - 0.01).floor().clamp(0.0, 255.0) as u32;
            let above = (line(child.high[axis]) + 0.01).ceil().clamp(0.0, 255.0) as u32;
            node.low[axis] |= below << (8 * place);
            node.high[axis] |= above << (8 * place);
        }
    }
    node
}
