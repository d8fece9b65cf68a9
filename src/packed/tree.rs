//! Builds the hierarchy over a scene's primitives.

use obvhs::bvh2::Bvh2;
use obvhs::{BvhBuildParams, aabb::Aabb};

use super::error::PackError;
use super::hierarchy::{Hierarchy, Traversal};
use super::motion::PackedMotion;
use super::primitive::WorldPrimitive;
use super::shape::PrimitiveKind;
use super::{bvh4, ray_query};
use crate::binary_tree;

/// Leaves hold at most this many primitives: their size takes two bits.
const MAX_LEAF: u32 = 4;
/// First primitive of a node's leaves: 24 bits.
pub const MAX_PRIMITIVES: usize = 1 << 24;
/// Shapes other than triangles that stay outside of the hierarchy, at most.
const MAX_OUTSIDE: usize = 16;
/// Planes are code, one by one.
const MAX_PLANES: usize = 256;
/// Up to so many primitives, a third of the nodes is tried elsewhere in the tree: a tenth of a second for 100,000 triangles, and a few
/// per cent fewer steps in every ray.
const REINSERT_MANY: usize = 1 << 18;

const PARAMETERS: BvhBuildParams = BvhBuildParams::medium_build();

/// Builds the hierarchy. The second value is the order in which primitives have to stand: the leaves' first, then those that it does not
/// hold, which kernels test one by one.
///
/// Planes, which nothing bounds, stay outside, and other shapes where they are few, so that a model on a ground under a lamp needs a
/// hierarchy of triangles alone. What moves is always in it, bounded over the time for which the shutter is open.
///
/// # Errors
/// [`PackError`] for more primitives or planes than can be held.
pub fn build(
    primitives: &[WorldPrimitive],
    motions: &[PackedMotion],
    traversal: Traversal,
) -> Result<(Hierarchy, Vec<usize>), PackError> {
    let belongs = |primitive: &WorldPrimitive| primitive.kind() == PrimitiveKind::Triangle || primitive.moves();
    let others = primitives.iter().filter(|primitive| !belongs(primitive)).count();
    let few_others = others <= MAX_OUTSIDE && others < primitives.len();
    let (inside, outside): (Vec<usize>, Vec<usize>) = (0..primitives.len()).partition(|&index| {
        let primitive = &primitives[index];
        belongs(primitive) || !(few_others || primitive.is_infinite())
    });
    if outside.len() > MAX_PLANES {
        return Err(PackError::TooManyPlanes { found: outside.len(), limit: MAX_PLANES });
    }
    if inside.len() > MAX_PRIMITIVES {
        return Err(PackError::TooManyPrimitives { found: inside.len(), limit: MAX_PRIMITIVES });
    }
    let count = inside.len() as u32;
    let (hierarchy, order) = match traversal {
        Traversal::Bvh => {
            let (nodes, order) = bvh4::build(&binary_tree(primitives, motions, &inside));
            (Hierarchy::of_nodes(nodes, count), order)
        }
        Traversal::RayQuery => {
            let (boxes, order) = ray_query::build(primitives, &inside);
            (Hierarchy::of_boxes(boxes, count), order)
        }
    };
    Ok((hierarchy, order.into_iter().map(|index| inside[index]).chain(outside).collect()))
}

/// A binary tree over the primitives `inside`, leaves of which hold up to [`MAX_LEAF`].
fn binary_tree(primitives: &[WorldPrimitive], motions: &[PackedMotion], inside: &[usize]) -> Bvh2 {
    let boxes: Vec<Aabb> = inside
        .iter()
        .filter_map(|&index| {
            let primitive = &primitives[index];
            motions.get(primitive.motion as usize).map_or_else(|| primitive.bounds(), |motion| motion.swept(primitive))
        })
        .map(|(low, high)| Aabb::new(low.into(), high.into()))
        .collect();
    let few = boxes.len() <= REINSERT_MANY;
    let parameters = BvhBuildParams {
        reinsertion_batch_ratio: if few { 0.3 } else { PARAMETERS.reinsertion_batch_ratio },
        max_prims_per_leaf: MAX_LEAF,
        collapse_traversal_cost: 1.0,
        ..PARAMETERS
    };
    binary_tree::build(&boxes, &parameters)
}
