//! The bounding volume hierarchy, or what a device needs to build one of its own.

use super::bvh4::{self, Child};
use super::ray_query::ShapeBox;

/// How rays find what stands in the hierarchy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Traversal {
    /// Kernels walk a four-wide hierarchy ([`bvh4`]).
    #[default]
    Bvh,
    /// The device builds an acceleration structure, and kernels use its ray queries.
    RayQuery,
}

impl Traversal {
    /// Its name in statistics: `bvh4` or `ray_query`.
    pub fn key(self) -> &'static str {
        match self {
            Self::Bvh => "bvh4",
            Self::RayQuery => "ray_query",
        }
    }
}

/// The hierarchy, and how many primitives it holds.
#[derive(Debug, Clone, Default)]
pub struct Hierarchy {
    pub traversal: Traversal,
    /// The nodes, in the device's layout. Node 0 is the root; it has no children where there is nothing to
    /// bound. Children come after their parents. Empty with ray queries.
    pub nodes: Vec<bvh4::Node>,
    /// First node of each group's tree; the trees follow each other behind the scene's own.
    pub roots: Vec<u32>,
    /// With ray queries: boxes around what is no triangle, of which the device makes its own structure.
    pub boxes: Vec<ShapeBox>,
    /// Most entries that a traversal's stack can hold.
    pub stack_size: u32,
    /// Primitives that it holds: those in leaves, or in the device's acceleration structure.
    pub primitive_count: u32,
}

impl Hierarchy {
    /// A hierarchy that kernels walk.
    pub fn of_nodes(nodes: Vec<bvh4::Node>, roots: Vec<u32>, primitive_count: u32) -> Self {
        Self { stack_size: deepest_stack(&nodes, &roots), nodes, roots, primitive_count, ..Self::default() }
    }

    /// Bytes of the nodes where kernels say how many there are: more than are used, so that hierarchies of about one size have the same kernels.
    pub fn uniform_node_bytes(&self) -> usize {
        size_of_val(&self.nodes[..]).next_power_of_two()
    }

    /// The input from which a device builds a structure of its own.
    pub fn of_boxes(boxes: Vec<ShapeBox>, primitive_count: u32) -> Self {
        Self { traversal: Traversal::RayQuery, boxes, stack_size: 1, primitive_count, ..Self::default() }
    }
}

/// Entries that wait while a ray is in a group: what stands beside the instance, the rest of its leaf, and the mark of the way back.
const ENTRIES_OF_INSTANCE: u32 = 3;

/// Most entries that wait on a traversal's stack: all children of a node but the one taken, each an entry. Of the trees of groups, which begin at
/// `roots`, a ray is in one at a time.
pub(super) fn deepest_stack(nodes: &[bvh4::Node], roots: &[u32]) -> u32 {
    // One pass from the back sees every child before its parent.
    let mut need = vec![0_u32; nodes.len()];
    for index in (0..need.len()).rev() {
        let children = nodes[index].children();
        let of_child = |child: &Child| if let Child::Inner(inner) = child { need[*inner] } else { 0 };
        let deepest = children.iter().map(of_child).max().unwrap_or(0);
        let count = children.len() as u32;
        need[index] = count.max((count + deepest).saturating_sub(1));
    }
    let of_groups = roots.iter().map(|&root| ENTRIES_OF_INSTANCE + need[root as usize].max(1)).max().unwrap_or(0);
    need.first().map_or(1, |need| (*need).max(1)) + of_groups
}
