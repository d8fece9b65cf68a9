//! Builds the hierarchy over a scene's primitives.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::Vec3;
use obvhs::bvh2::Bvh2;
use obvhs::{BvhBuildParams, aabb::Aabb};
use rayon::prelude::*;

use super::bvh4::Node;
use super::error::PackError;
use super::grid::Box3;
use super::hierarchy::{Hierarchy, Traversal};
use super::instance::WorldInstance;
use super::primitive::{Primitive, WorldPrimitive};
use super::shape::PrimitiveKind;
use super::world::WorldGeometry;
use super::{bvh4, instance, ray_query};
use crate::binary_tree;
use crate::binary_tree::parts::{KeptTrees, MovingPart, Pose, build_of_parts};

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
/// Trees of an earlier frame are `kept` for the next one, which saves time and changes nothing.
///
/// # Errors
/// [`PackError`] for more primitives or planes than a hierarchy can hold.
pub fn build(world: &WorldGeometry, traversal: Traversal, kept: &mut KeptTrees) -> Result<(Hierarchy, Vec<Slot>), PackError> {
    let primitives = &world.primitives;
    let belongs = |primitive: &WorldPrimitive| primitive.kind() == PrimitiveKind::Triangle || primitive.moves();
    let others = primitives.iter().filter(|primitive| !belongs(primitive)).count();
    let few_others = others <= MAX_OUTSIDE && (others < primitives.len() || !world.instances.is_empty());
    let (inside, outside): (Vec<usize>, Vec<usize>) = (0..primitives.len()).partition(|&index| {
        let primitive = &primitives[index];
        belongs(primitive) || !(few_others || primitive.is_infinite())
    });
    if outside.len() > MAX_PLANES {
        return Err(PackError::TooManyPlanes { found: outside.len(), limit: MAX_PLANES });
    }
    let in_groups: usize = world.groups.iter().map(|group| group.primitives.len()).sum();
    let in_hierarchy = inside.len() + world.instances.len() + in_groups;
    if in_hierarchy > MAX_PRIMITIVES {
        return Err(PackError::TooManyPrimitives { found: in_hierarchy, limit: MAX_PRIMITIVES });
    }
    let slot = |&index: &usize| Slot::Primitive(index as u32);
    let (hierarchy, mut order) = match traversal {
        Traversal::Bvh => of_two_levels(world, &inside, kept),
        Traversal::RayQuery => {
            let (boxes, order) = ray_query::build(primitives, &inside);
            (Hierarchy::of_boxes(boxes, inside.len() as u32), order.iter().map(|&index| slot(&inside[index])).collect())
        }
    };
    order.extend(outside.iter().map(slot));
    kept.forget_unused();
    Ok((hierarchy, order))
}

/// The content of a slot in the array of primitives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slot {
    /// By their indices in the world.
    Primitive(u32),
    Instance(u32),
    /// Group, and primitive in it.
    InGroup(u32, u32),
}

impl Slot {
    pub fn pack(self, world: &WorldGeometry) -> Primitive {
        match self {
            Self::Primitive(index) => world.primitives[index as usize].pack(),
            Self::Instance(index) => instance::leaf_record(index),
            Self::InGroup(group, index) => world.groups[group as usize].primitives[index as usize].pack(),
        }
    }
}

/// A tree over the primitives `inside` and all instances, and behind it one for each group.
fn of_two_levels(world: &WorldGeometry, inside: &[usize], kept: &KeptTrees) -> (Hierarchy, Vec<Slot>) {
    let groups: Vec<(Vec<Node>, Vec<usize>)> = world
        .groups
        .par_iter()
        .map(|group| {
            let boxes: Vec<Aabb> = group.primitives.iter().filter_map(WorldPrimitive::bounds).map(as_box).collect();
            let binary = if world.posed.is_some() { kept.tree(&boxes, &binary_tree) } else { Arc::new(binary_tree(&boxes)) };
            bvh4::build(&binary, MAX_LEAF)
        })
        .collect();
    let upper: Vec<Vec<Box3>> = groups.iter().map(|(nodes, _)| instance::upper_boxes(nodes, 0)).collect();
    let of_primitive = |&index: &usize| {
        let primitive = &world.primitives[index];
        world.motions.get(primitive.motion as usize).map_or_else(|| primitive.bounds(), |motion| motion.swept(primitive))
    };
    let mut boxes: Vec<Aabb> = inside.iter().filter_map(of_primitive).map(as_box).collect();
    let of_instance = |instance: &WorldInstance| as_box(instance.bounds(&upper[instance.group], &world.motions));
    boxes.par_extend(world.instances.par_iter().map(of_instance));
    // A ray is brought into the space of each instance of a leaf that it meets, so where they are many each has a box of its own.
    let most = if world.instances.len() > inside.len() { 1 } else { MAX_LEAF };
    let binary = match &world.posed {
        None => binary_tree(&boxes),
        Some(posed) => build_of_parts(&boxes, &parts(world, inside, posed, boxes.len()), kept, &binary_tree),
    };
    let (mut nodes, leaves) = bvh4::build(&binary, most);
    let slot = |index: usize| match inside.get(index) {
        Some(&index) => Slot::Primitive(index as u32),
        None => Slot::Instance((index - inside.len()) as u32),
    };
    let mut order: Vec<Slot> = leaves.into_iter().map(slot).collect();
    let mut roots = Vec::with_capacity(groups.len());
    for (group, (of_group, leaves)) in groups.into_iter().enumerate() {
        let (first_node, first_primitive) = (nodes.len() as u32, order.len() as u32);
        roots.push(first_node);
        nodes.extend(of_group.into_iter().map(|node| node.behind(first_node, first_primitive)));
        order.extend(leaves.into_iter().map(|index| Slot::InGroup(group as u32, index as u32)));
    }
    (Hierarchy::of_nodes(nodes, roots, order.len() as u32), order)
}

/// The shapes with keyframes, each as a part, and what else there is.
fn parts(world: &WorldGeometry, inside: &[usize], posed: &BTreeMap<usize, Pose>, count: usize) -> Vec<MovingPart> {
    let mut parts: Vec<MovingPart> =
        posed.values().map(|pose| MovingPart { reference: Some(pose.clone()), ..MovingPart::default() }).collect();
    let places: BTreeMap<usize, usize> = posed.keys().enumerate().map(|(part, &shape)| (shape, part)).collect();
    let mut others = MovingPart::default();
    for place in 0..count {
        let part = inside.get(place).and_then(|&index| places.get(&world.primitives[index].shape));
        part.map_or(&mut others, |&part| &mut parts[part]).members.push(place as u32);
    }
    parts.push(others);
    parts
}

fn as_box((low, high): (Vec3, Vec3)) -> Aabb {
    Aabb::new(low.into(), high.into())
}

/// A binary tree over boxes, with a box in each leaf.
fn binary_tree(boxes: &[Aabb]) -> Bvh2 {
    let few = boxes.len() <= REINSERT_MANY;
    let parameters = BvhBuildParams {
        reinsertion_batch_ratio: if few { 0.3 } else { PARAMETERS.reinsertion_batch_ratio },
        post_collapse_reinsertion_batch_ratio_multiplier: 1.0,
        max_prims_per_leaf: 1,
        ..PARAMETERS
    };
    binary_tree::build(boxes, &parameters)
}
