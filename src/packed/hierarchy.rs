//! The bounding volume hierarchy, in one of three forms or left to the device.

use std::fmt;

use super::grid::Box3;
use super::{bvh2, bvh4, cwbvh, ray_query};

/// Which form it has. BENCHMARKS.md compares them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum HierarchyKind {
    /// Binary, float boxes, 64 bytes a node.
    Bvh2,
    /// Four-wide, 8-bit boxes, 48 bytes a node.
    #[default]
    Bvh4,
    /// Eight-wide, 8-bit boxes, 80 bytes a node, children in the order of the ray's octant.
    CwBvh,
    /// None of ours: the device builds an acceleration structure, and kernels ask it by ray queries. Only where it was asked for.
    RayQuery,
}

impl HierarchyKind {
    /// Those that are packed here, which every device can go through.
    pub const ALL: [Self; 3] = [Self::Bvh2, Self::Bvh4, Self::CwBvh];

    /// Words of 16 bytes that a node takes; 0 where there are no nodes of ours.
    pub fn node_words(self) -> u32 {
        match self {
            Self::Bvh2 => 4,
            Self::Bvh4 => 3,
            Self::CwBvh => 5,
            Self::RayQuery => 0,
        }
    }

    /// As statistics have it: `bvh2`, `bvh4`, `cwbvh` or `ray_query`.
    pub fn key(self) -> String {
        self.switch().to_lowercase()
    }

    /// The switch under which the shaders know it.
    pub fn switch(self) -> &'static str {
        match self {
            Self::Bvh2 => "BVH2",
            Self::Bvh4 => "BVH4",
            Self::CwBvh => "CWBVH",
            Self::RayQuery => "RAY_QUERY",
        }
    }
}

impl fmt::Display for HierarchyKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bvh2 => "binary with float boxes (BVH2)",
            Self::Bvh4 => "four-wide with 8-bit boxes (BVH4)",
            Self::CwBvh => "eight-wide with 8-bit boxes (CWBVH)",
            Self::RayQuery => "the device's own, asked by ray queries",
        })
    }
}

/// What stands in a node's place for a child.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Child {
    /// Index of a node.
    Inner(usize),
    /// Consecutive primitives.
    Leaf { first: u32, count: u32 },
}

/// The nodes as the device reads them. Node 0 is the root; it has no children where there is nothing to bound. Children come after their
/// parents.
#[derive(Debug, Clone, PartialEq)]
pub enum Nodes {
    Bvh2(Vec<bvh2::Node>),
    Bvh4(Vec<bvh4::Node>),
    CwBvh(Vec<cwbvh::Node>),
    /// None of ours: boxes around what is no triangle, of which the device makes its own.
    RayQuery(Vec<ray_query::ShapeBox>),
}

impl Default for Nodes {
    fn default() -> Self {
        Self::Bvh4(Vec::new())
    }
}

impl Nodes {
    pub fn kind(&self) -> HierarchyKind {
        match self {
            Self::Bvh2(_) => HierarchyKind::Bvh2,
            Self::Bvh4(_) => HierarchyKind::Bvh4,
            Self::CwBvh(_) => HierarchyKind::CwBvh,
            Self::RayQuery(_) => HierarchyKind::RayQuery,
        }
    }

    /// How many.
    pub fn count(&self) -> usize {
        match self {
            Self::Bvh2(nodes) => nodes.len(),
            Self::Bvh4(nodes) => nodes.len(),
            Self::CwBvh(nodes) => nodes.len(),
            Self::RayQuery(_) => 0,
        }
    }

    pub fn bytes(&self) -> &[u8] {
        match self {
            Self::Bvh2(nodes) => bytemuck::cast_slice(nodes),
            Self::Bvh4(nodes) => bytemuck::cast_slice(nodes),
            Self::CwBvh(nodes) => bytemuck::cast_slice(nodes),
            Self::RayQuery(boxes) => bytemuck::cast_slice(boxes),
        }
    }

    pub fn children(&self, node: usize) -> Vec<Child> {
        match self {
            Self::Bvh2(nodes) => nodes[node].children(),
            Self::Bvh4(nodes) => nodes[node].children(),
            Self::CwBvh(nodes) => nodes[node].children(),
            Self::RayQuery(_) => Vec::new(),
        }
    }

    /// The boxes of [`Nodes::children`], as the device sees them.
    pub fn boxes(&self, node: usize) -> Vec<Box3> {
        match self {
            Self::Bvh2(nodes) => nodes[node].boxes(),
            Self::Bvh4(nodes) => nodes[node].boxes(),
            Self::CwBvh(nodes) => nodes[node].boxes(),
            Self::RayQuery(_) => Vec::new(),
        }
    }

    /// Most entries that a traversal's stack can hold.
    fn deepest_stack(&self) -> u32 {
        // One sweep from the back sees every child before its parent.
        let mut need = vec![0_u32; self.count()];
        for index in (0..need.len()).rev() {
            let children = self.children(index);
            let of_child = |child: &Child| if let Child::Inner(inner) = child { need[*inner] } else { 0 };
            let deepest = children.iter().map(of_child).max().unwrap_or(0);
            let count = children.len() as u32;
            need[index] = match self {
                // All children of a node but the one taken, each an entry.
                Self::Bvh2(_) | Self::Bvh4(_) => count.max((count + deepest).saturating_sub(1)),
                // All children of a node but the one taken, together one entry.
                Self::CwBvh(_) => 1 + deepest,
                Self::RayQuery(_) => 0,
            };
        }
        need.first().map_or(1, |need| (*need).max(1))
    }
}

/// The hierarchy, and how many primitives it holds.
#[derive(Debug, Clone, Default)]
pub struct Hierarchy {
    pub nodes: Nodes,
    /// Most entries a traversal's stack can hold.
    pub stack_size: u32,
    /// Primitives that it holds: those in leaves, or in the device's acceleration structure.
    pub primitive_count: u32,
}

impl Hierarchy {
    pub fn new(nodes: Nodes, primitive_count: u32) -> Self {
        Self { stack_size: nodes.deepest_stack(), nodes, primitive_count }
    }

    pub fn kind(&self) -> HierarchyKind {
        self.nodes.kind()
    }
}
