//! The rules for a scene's groups and instances, and facts about all of them together.

use super::check::Check;
use super::instance::{Ball, Group, Instances, is_singular};
use super::model::Scene;
use super::shape::{Geometry, Shape};

impl Scene {
    /// How many instances there are, over all entries.
    pub fn instance_count(&self) -> usize {
        self.instances.iter().map(|instances| instances.places.len()).sum()
    }

    /// How reports call the shape of this number, behind which instances are counted.
    pub fn label_of(&self, number: usize) -> String {
        if let Some(shape) = self.shapes.get(number) {
            return shape.label.clone();
        }
        let mut left = number - self.shapes.len();
        for entry in &self.instances {
            match left.checked_sub(entry.places.len()) {
                None if entry.places.len() == 1 => return entry.label.clone(),
                None => return format!("{} number {left}", entry.label),
                Some(further) => left = further,
            }
        }
        format!("instance {left} beyond the last")
    }

    /// Checks a group whose shapes have been checked by themselves; the error is the mistake.
    pub(super) fn check_group(&self, group: &Group) -> Check {
        if group.shapes.iter().any(|shape| !matches!(shape.geometry, Geometry::Mesh(_))) {
            return Err("a group consists of meshes; other shapes stand in the scene by themselves".into());
        }
        if group.shapes.iter().any(|shape| shape.motion.is_some() || shape.portal) {
            return Err("a mesh of a group neither moves by itself nor is a portal; its instances can move".into());
        }
        Ok(())
    }

    /// Checks instances of a group; the error is the mistake, in words. `textured` and `emits` have a value
    /// for each material, and `balls` a bounding ball for each group.
    pub fn check_instances(&self, instances: &Instances, textured: &[bool], emits: &[bool], balls: &[Option<Ball>]) -> Check {
        let Some(group) = self.groups.get(instances.group) else { return Err(format!("there is no group {}", instances.group)) };
        if let Some(place) = instances.maps().position(|map| !map.is_finite() || is_singular(map.matrix3)) {
            return Err(format!("the transform of number {place}, counted from 0, flattens it or leaves the range of numbers"));
        }
        let emissive = match instances.material {
            Some(material) if material >= self.materials.len() => return Err(format!("there is no material {material}")),
            Some(material) => emits[material].then_some(material),
            None => group.shapes.iter().flat_map(Shape::materials).find(|&id| emits[id]),
        };
        if let Some(emissive) = emissive {
            let name = &self.materials[emissive].name;
            return Err(format!(
                "the material `{name}` emits, and area lights are sampled one by one: put the meshes of the group `{}` into the scene's shapes, once for each place, \
                 as readers of scene files do",
                group.name
            ));
        }
        let lacks_uv = || group.shapes.iter().find_map(|shape| shape.geometry.lacks_uv());
        if let Some(material) = instances.material
            && textured[material]
            && let Some(lacking) = lacks_uv()
        {
            let (name, group) = (&self.materials[material].name, &group.name);
            return Err(format!(
                "the material `{name}` uses a texture, which needs uv coordinates, and of a mesh of `{group}`: {lacking}"
            ));
        }
        if instances.pivot.is_some_and(|pivot| !pivot.is_finite()) {
            return Err("its pivot must be finite".into());
        }
        // The motion does not depend on where an instance stands, but for what it turns about.
        instances.motion.as_ref().map_or(Ok(()), |motion| motion.check(self.camera.shutter)).map_err(|(_, message)| message)?;
        let ball = balls.get(instances.group).copied().flatten();
        ball.map_or(Ok(()), |ball| instances.check_reach(ball, self.camera.shutter))
    }

    /// Around each group.
    pub fn balls(&self) -> Vec<Option<Ball>> {
        self.groups.iter().map(Group::ball).collect()
    }

    /// No ray meets instances that are made of nothing.
    pub fn are_visible(&self, instances: &Instances) -> bool {
        !instances.material.is_some_and(|id| self.materials[id].is_nothing())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DAffine3;

    use super::*;
    use crate::scene::MaterialKind;
    use crate::scene::{Mesh, Transform};

    fn instances(places: Vec<DAffine3>) -> Instances {
        let (transform, places) = (Transform::default(), Arc::new(places));
        Instances {
            label: "instance[0]".into(),
            group: 0,
            places,
            transform,
            material: None,
            motion: None,
            pivot: None,
            receiver: 0,
        }
    }

    #[test]
    fn what_cannot_be_an_instance_is_named() {
        let mesh =
            Mesh { positions: vec![glam::Vec3::ZERO, glam::Vec3::X, glam::Vec3::Y], faces: vec![[0, 1, 2]], ..Mesh::default() };
        let shape = Shape {
            label: "shape".into(),
            geometry: Geometry::Mesh(Arc::new(mesh)),
            material: 0,
            transform: Transform::default(),
            motion: None,
            portal: false,
            receiver: 0,
        };
        let material = crate::scene::Material {
            name: "lamp".into(),
            kind: MaterialKind::Emissive,
            normal_map: None,
            emission: None,
            two_sided: true,
            interior: None,
        };
        let scene = Scene {
            materials: vec![material],
            groups: vec![Group { name: "tree".into(), shapes: vec![shape] }],
            ..Scene::default()
        };
        let check = |instances: &Instances, emits| {
            scene.check_instances(instances, &[false], &[emits], &scene.balls()).err().unwrap_or_default()
        };
        let one = || instances(vec![DAffine3::IDENTITY]);
        for emitting in [one(), Instances { material: Some(0), ..one() }] {
            let said = check(&emitting, true);
            assert!(said.contains("the material `lamp` emits") && said.contains("meshes of the group `tree`"), "{said}");
            assert_eq!(check(&emitting, false), "");
        }
        assert!(check(&instances(vec![DAffine3::IDENTITY, DAffine3::ZERO]), false).contains("number 1"));
        assert!(check(&Instances { group: 1, ..instances(vec![]) }, false).contains("no group 1"));
        assert!(check(&Instances { material: Some(7), ..instances(vec![]) }, false).contains("no material 7"));
        let far = |distance| instances(vec![DAffine3::IDENTITY, DAffine3::from_translation(glam::DVec3::X * distance)]);
        assert_eq!(check(&far(0.9e18), false), "");
        assert!(check(&far(1.1e18), false).contains("number 1, counted from 0: it reaches farther than 1e18"));
        let translate = crate::scene::MotionStep::Translate(glam::DVec3::X * 0.4e18);
        let moving = |distance| Instances { motion: Some(crate::scene::Motion::new(vec![translate])), ..far(distance) };
        assert_eq!(check(&moving(0.1e18), false), "");
        assert!(check(&moving(0.9e18), false).contains("number 1, counted from 0: it reaches farther than 1e18"));
    }
}
