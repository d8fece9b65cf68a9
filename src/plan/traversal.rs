//! How rays find what they meet, and why so.

use std::fmt;

use super::limits::{DeviceLimits, RayQueryLimits};
use super::memory::{ACCELERATION, PRIMITIVE_BYTES, megabytes};
use super::{GeometryPlacement, Plan};
use crate::flat::FlatScene;
use crate::flat::hierarchy::HierarchyKind;
use crate::render::RenderError;

/// How rays find what they meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TraversalWay {
    /// They are tested against every primitive.
    Constants,
    /// Kernels walk a hierarchy of ours.
    Bvh,
    /// The device walks its own, asked by ray queries.
    RayQuery,
}

/// A way, and why it was taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Traversal {
    pub way: TraversalWay,
    /// A clause that follows "because".
    pub why: &'static str,
}

impl TraversalWay {
    /// As `--traversal` and the statistics of a render have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Constants => "constants",
            Self::Bvh => "bvh",
            Self::RayQuery => "ray-query",
        }
    }
}

impl Traversal {
    pub(super) fn of(plan: &Plan) -> Self {
        let way = match (plan.geometry, plan.hierarchy) {
            (GeometryPlacement::Unrolled, _) => TraversalWay::Constants,
            (GeometryPlacement::Hierarchy, HierarchyKind::RayQuery) => TraversalWay::RayQuery,
            (GeometryPlacement::Hierarchy, _) => TraversalWay::Bvh,
        };
        let why = match way {
            // Nothing chooses ray queries by itself.
            TraversalWay::RayQuery => "it was asked for",
            _ if plan.geometry_asked => "it was asked for",
            TraversalWay::Constants => "the primitives are few",
            TraversalWay::Bvh => "no device was measured on which ray queries are faster",
        };
        Self { way, why }
    }
}

impl fmt::Display for Traversal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, because {}", self.way.name(), self.why)
    }
}

/// Refuses scenes that ray queries cannot see, or that no structure can hold.
///
/// # Errors
/// [`RenderError::DoesNotFit`], saying what to do.
pub(super) fn check_ray_queries(flat: &FlatScene, limits: &DeviceLimits) -> Result<(), RenderError> {
    let RayQueryLimits { max_primitives } = limits.check_ray_queries("the device")?;
    let refuse =
        |why: String| Err(RenderError::DoesNotFit(format!("{why}; without `--traversal ray-query` it renders all the same")));
    if flat.moves() {
        return refuse("its shapes move, and acceleration structures hold a scene at rest".to_owned());
    }
    let held = u64::from(flat.hierarchy.primitive_count);
    let boxes = (flat.hierarchy.nodes.bytes().len() / size_of::<crate::flat::ray_query::ShapeBox>()) as u64;
    let triangles = held - boxes;
    // Of triangles, vertices are counted.
    if 3 * triangles > u64::from(max_primitives) || boxes > u64::from(max_primitives) {
        return refuse(format!(
            "it has {triangles} triangles and {boxes} other shapes, and an {ACCELERATION} holds {} or {max_primitives}",
            max_primitives / 3
        ));
    }
    let input = triangles * PRIMITIVE_BYTES;
    if input > limits.max_buffer {
        return refuse(format!(
            "an {ACCELERATION} of its triangles is built from {} at once, and a buffer holds {}",
            megabytes(input),
            megabytes(limits.max_buffer)
        ));
    }
    Ok(())
}
