//! Primitives, how they move, and the hierarchy.

use rayon::prelude::*;

use super::{Check, MANY};
use crate::packed::bvh4::Child;
use crate::packed::constants::NONE;
use crate::packed::hierarchy::{Traversal, deepest_stack};
use crate::packed::instance::PackedInstance;
use crate::packed::motion::KINDS_OF_STEPS;
use crate::packed::primitive::Primitive;
use crate::packed::scene::PackedScene;
use crate::packed::shape::PrimitiveKind;
use crate::packed::tree::MAX_PRIMITIVES;

impl PackedScene {
    /// Motions stand one behind the other and end where the array does; attributes name the first word of one.
    pub(super) fn check_motions(&self) -> Check {
        let mut is_first = vec![false; self.motions.len()];
        let mut word = 0;
        while word < self.motions.len() {
            is_first[word] = true;
            let steps = self.motions[word][3].to_bits() as usize;
            let end = word + 1 + 2 * steps;
            let Some(rows) = self.motions.get(word + 1..end) else {
                return Err(format!("the motion at word {word} has {steps} steps"));
            };
            if let Some(step) = rows.chunks_exact(2).find(|step| step[0][3].to_bits() >= KINDS_OF_STEPS) {
                return Err(format!("the motion at word {word} has a step of kind {}", step[0][3].to_bits()));
            }
            word = end;
        }
        let is_wrong = |motion: u32| motion != NONE && is_first.get(motion as usize) != Some(&true);
        if let Some(index) = self.instances.iter().position(|instance| is_wrong(instance.motion)) {
            return Err(format!("instance {index} moves by {}", self.instances[index].motion));
        }
        match self.attributes.iter().position(|attributes| is_wrong(attributes.motion)) {
            Some(index) => Err(format!("attributes {index} move by {}", self.attributes[index].motion)),
            None => Ok(()),
        }
    }

    pub(super) fn check_primitives(&self) -> Check {
        let check = |(index, primitive): (usize, &Primitive)| {
            self.check_primitive(primitive).map_err(|message| format!("primitive {index} {message}"))
        };
        self.primitives.par_iter().enumerate().with_min_len(MANY).try_for_each(check)
    }

    /// Each begins at the root of a group's tree.
    pub(super) fn check_instances(&self) -> Check {
        if self.hierarchy.traversal == Traversal::RayQuery {
            // No kernel reads them.
            return Ok(());
        }
        let is_root = |instance: &PackedInstance| self.hierarchy.roots.binary_search(&instance.root()).is_ok();
        match self.instances.iter().position(|instance| !is_root(instance)) {
            Some(index) => Err(format!("instance {index} begins at node {}, no root", self.instances[index].root())),
            None => Ok(()),
        }
    }

    fn check_primitive(&self, primitive: &Primitive) -> Check {
        if let Some(instance) = primitive.instance().filter(|_| !primitive.moves()) {
            let exists = (instance as usize) < self.instances.len();
            return if exists { Ok(()) } else { Err(format!("is instance {instance}, which is missing")) };
        }
        if primitive.material() as usize >= self.materials.materials.len() {
            return Err(format!("has material {}", primitive.material()));
        }
        if PrimitiveKind::of(primitive.kind()).is_none() {
            return Err(format!("is of kind {}", primitive.kind()));
        }
        let has_second = primitive.attributes == NONE || (primitive.attributes as usize) + 1 < self.attributes.len();
        if self.second_uvs && primitive.is(PrimitiveKind::Triangle) && !has_second {
            return Err(format!("has attributes {}, and no second texture coordinates follow", primitive.attributes));
        }
        // Moving primitives have attributes, which name the motion.
        if primitive.moves() && self.motion_of(primitive.attributes).is_none() {
            return Err("moves, and nothing says how".to_owned());
        }
        let Some(light) = self.lights.get(primitive.light as usize) else { return Ok(()) };
        // Lights that are surfaces have the kinds of primitives.
        let is_that_light = light.kind() == primitive.kind()
            && light.material == primitive.material()
            && light.attributes == primitive.attributes
            && light.moves() == primitive.moves();
        if is_that_light { Ok(()) } else { Err(format!("is light {}, which is another surface", primitive.light)) }
    }

    /// The first word of the motion that attributes name; None where they name none or do not exist.
    pub(super) fn motion_of(&self, attributes: u32) -> Option<u32> {
        self.attributes.get(attributes as usize).map(|attributes| attributes.motion).filter(|&motion| motion != NONE)
    }

    pub(super) fn check_hierarchy(&self) -> Check {
        let count = self.hierarchy.primitive_count as usize;
        let Some(in_hierarchy) = self.primitives.get(..count).filter(|_| count <= MAX_PRIMITIVES) else {
            return Err(format!("the hierarchy holds {count} primitives of {}", self.primitives.len()));
        };
        if let Some(index) =
            in_hierarchy.iter().position(|primitive| PrimitiveKind::of(primitive.kind()).is_some_and(PrimitiveKind::is_infinite))
        {
            return Err(format!("primitive {index} has no bounds, and is in the hierarchy"));
        }
        if let Some(index) = self.primitives[in_hierarchy.len()..].iter().position(|primitive| primitive.instance().is_some()) {
            return Err(format!("primitive {} is an instance, and not in the hierarchy", in_hierarchy.len() + index));
        }
        match self.hierarchy.traversal {
            Traversal::Bvh => self.check_nodes(in_hierarchy),
            Traversal::RayQuery => self.check_boxes(in_hierarchy),
        }
    }

    /// A device knows primitives by their places alone: triangles first, then those that have boxes.
    fn check_boxes(&self, in_hierarchy: &[Primitive]) -> Check {
        if !self.hierarchy.nodes.is_empty() {
            return Err("there are nodes, and the device has its own".to_owned());
        }
        let is_triangle = |primitive: &Primitive| primitive.is(PrimitiveKind::Triangle);
        let boxes = self.hierarchy.boxes.len();
        let first_shape = in_hierarchy.iter().position(|primitive| !is_triangle(primitive)).unwrap_or(in_hierarchy.len());
        if in_hierarchy.len() - first_shape != boxes || in_hierarchy[first_shape..].iter().any(is_triangle) {
            return Err(format!("{boxes} boxes stand for the primitives from {first_shape} to {}", in_hierarchy.len()));
        }
        Ok(())
    }

    /// Every node but the roots is the child of one before it in its tree, every primitive is in one leaf, instances are in the scene's own tree,
    /// and the stack holds what waits.
    fn check_nodes(&self, in_hierarchy: &[Primitive]) -> Check {
        let (nodes, roots) = (&self.hierarchy.nodes, &self.hierarchy.roots);
        if nodes.is_empty() {
            return Err("there is no root".to_owned());
        }
        let in_order = roots.windows(2).all(|pair| pair[0] < pair[1]);
        if !in_order || roots.first() == Some(&0) || roots.last().is_some_and(|&root| root as usize >= nodes.len()) {
            return Err("the roots of groups are no nodes, or out of order".to_owned());
        }
        let mut has_parent = vec![false; nodes.len()];
        roots.iter().for_each(|&root| has_parent[root as usize] = true);
        let mut is_in_leaf = vec![false; in_hierarchy.len()];
        // The tree at hand: that of the scene, then those of groups.
        let mut tree = 0;
        for (index, node) in nodes.iter().enumerate() {
            tree += usize::from(roots.get(tree).is_some_and(|&root| root as usize == index));
            let end = roots.get(tree).map_or(nodes.len(), |&root| root as usize);
            if !node.is_well_formed() {
                return Err(format!("node {index} has children between which none is, or sizes of what are no leaves"));
            }
            for child in node.children() {
                match child {
                    Child::Inner(inner) => match has_parent.get_mut(inner) {
                        Some(seen) if inner > index && inner < end && !*seen => *seen = true,
                        _ => {
                            return Err(format!("node {index} has the child {inner}, which is missing, before it, or another's"));
                        }
                    },
                    Child::Leaf { first, count } => {
                        for primitive in first..first + count {
                            match is_in_leaf.get_mut(primitive as usize) {
                                Some(seen) if !*seen => *seen = true,
                                _ => return Err(format!("node {index} holds primitive {primitive}, missing or held twice")),
                            }
                            if tree > 0 && in_hierarchy[primitive as usize].instance().is_some() {
                                return Err(format!("node {index} of a group holds an instance, primitive {primitive}"));
                            }
                        }
                    }
                }
            }
        }
        if let Some(orphan) = has_parent.iter().skip(1).position(|seen| !seen) {
            return Err(format!("node {} is nobody's child", orphan + 1));
        }
        if let Some(missing) = is_in_leaf.iter().position(|seen| !seen) {
            return Err(format!("primitive {missing} is in no leaf"));
        }
        let needed = deepest_stack(nodes, roots);
        if self.hierarchy.stack_size != needed {
            return Err(format!("the stack has {} entries, and {needed} wait", self.hierarchy.stack_size));
        }
        Ok(())
    }
}
