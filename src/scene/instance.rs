//! Meshes that are stored once and stand in many places.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::check::Check;
use super::material::{MaterialId, MaterialKind};
use super::model::Scene;
use super::motion::Motion;
use super::shape::{Geometry, Shape};
use super::transform::Transform;

/// Meshes in a space of their own. Rays meet them where [`Instances`] place them.
#[derive(Debug, Clone, Default)]
pub struct Group {
    pub name: String,
    /// Meshes at rest, whose transforms lead to the group's space.
    pub shapes: Vec<Shape>,
}

/// One group in one place or in many.
#[derive(Debug, Clone)]
pub struct Instances {
    /// How errors and reports call them.
    pub label: String,
    /// Index into the scene's groups.
    pub group: usize,
    /// From the group's space, a place each.
    pub places: Arc<Vec<DAffine3>>,
    /// From the places on to the world at shutter time 0.
    pub transform: Transform,
    /// What all of them are made of in place of the group's own materials; faces of a `pass` material stay openings.
    pub material: Option<MaterialId>,
    /// How each moves while the shutter is open, about where it puts the group's (0, 0, 0); None: at rest.
    pub motion: Option<Motion>,
}

/// A ball around a group.
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    pub center: DVec3,
    pub radius: f64,
}

impl Group {
    /// Around all vertices; None where there are none.
    pub fn ball(&self) -> Option<Ball> {
        let points = || self.shapes.iter().flat_map(Shape::world_positions);
        let low = points().reduce(|low, point| low.min(point))?.as_dvec3();
        let high = points().reduce(|high, point| high.max(point))?.as_dvec3();
        Some(Ball { center: 0.5 * (low + high), radius: 0.5 * (high - low).length() })
    }

    /// Triangles of all of its meshes.
    pub fn triangles(&self) -> usize {
        let faces = |shape: &Shape| if let Geometry::Mesh(mesh) = &shape.geometry { mesh.faces.len() } else { 0 };
        self.shapes.iter().map(faces).sum()
    }
}

impl Instances {
    /// From the group's space to the world at shutter time 0, one map for each instance.
    pub fn maps(&self) -> impl ExactSizeIterator<Item = DAffine3> + '_ {
        let all = self.transform.to_affine();
        self.places.iter().map(move |place| all * *place)
    }

    /// A distance from `point` within which all of the nearest instance lies.
    pub(super) fn farthest_from(&self, ball: Ball, point: DVec3) -> f64 {
        let of_map =
            |map: DAffine3| map.transform_point3(ball.center).distance(point) + ball.radius * largest_stretch(map.matrix3);
        self.maps().map(of_map).fold(f64::INFINITY, f64::min)
    }

    /// The extents of the smallest and of the largest instance.
    pub(super) fn extents(&self, ball: Ball) -> [f64; 2] {
        let of_map = |map: DAffine3| {
            let axes = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
            2.0 * ball.radius * axes.map(DVec3::length).into_iter().fold(0.0, f64::max)
        };
        self.maps().map(of_map).fold([f64::INFINITY, 0.0], |[least, most], extent| [least.min(extent), most.max(extent)])
    }
}

/// A bound on the factor by which lengths grow.
fn largest_stretch(matrix: DMat3) -> f64 {
    matrix.to_cols_array().into_iter().map(|entry| entry * entry).sum::<f64>().sqrt()
}

/// The columns are so nearly dependent that nothing of the volume is left, or they leave the range of numbers.
pub fn is_singular(matrix: DMat3) -> bool {
    let lengths = matrix.x_axis.length() * matrix.y_axis.length() * matrix.z_axis.length();
    let volume = matrix.determinant().abs();
    !(volume.is_normal() && volume > 1e-12 * lengths)
}

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

    /// What is wrong with a group, whose shapes have been checked by themselves.
    pub(super) fn check_group(&self, group: &Group) -> Check {
        if group.shapes.iter().any(|shape| !matches!(shape.geometry, Geometry::Mesh(_))) {
            return Err("a group consists of meshes; other shapes stand in the scene by themselves".into());
        }
        if group.shapes.iter().any(|shape| shape.motion.is_some() || shape.portal) {
            return Err("a mesh of a group neither moves by itself nor is a portal; its instances can move".into());
        }
        Ok(())
    }

    /// What is wrong with instances of a group, in words. `textured` and `emits` are of each material.
    pub(crate) fn check_instances(&self, instances: &Instances, textured: &[bool], emits: &[bool]) -> Check {
        let Some(group) = self.groups.get(instances.group) else { return Err(format!("there is no group {}", instances.group)) };
        if let Some(place) = instances.maps().position(|map| !map.is_finite() || is_singular(map.matrix3)) {
            return Err(format!("the transform of number {place}, counted from 0, flattens it or leaves the range of numbers"));
        }
        let lamp = match instances.material {
            Some(material) if material >= self.materials.len() => return Err(format!("there is no material {material}")),
            Some(material) => emits[material].then_some(material),
            None => group.shapes.iter().flat_map(Shape::materials).find(|&id| emits[id]),
        };
        if let Some(lamp) = lamp {
            let name = &self.materials[lamp].name;
            return Err(format!("the material `{name}` emits, and instances give no light: write lamps as shapes"));
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
        // The motion does not depend on where an instance stands, but for what it turns about.
        instances.motion.as_ref().map_or(Ok(()), |motion| motion.check(self.camera.shutter)).map_err(|(_, message)| message)
    }

    /// No ray meets instances that are made of nothing.
    pub(crate) fn are_visible(&self, instances: &Instances) -> bool {
        !instances.material.is_some_and(|id| matches!(self.materials[id].kind, MaterialKind::Pass))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Mesh, TransformStep};

    fn instances(places: Vec<DAffine3>) -> Instances {
        Instances {
            label: "instance[0]".into(),
            group: 0,
            places: Arc::new(places),
            transform: Transform { steps: vec![TransformStep::Translate(DVec3::X)] },
            material: None,
            motion: None,
        }
    }

    #[test]
    fn places_come_first_and_the_transform_behind_them() {
        let two = instances(vec![DAffine3::from_scale(DVec3::splat(2.0)), DAffine3::from_translation(DVec3::Y)]);
        let moved: Vec<DVec3> = two.maps().map(|map| map.transform_point3(DVec3::Z)).collect();
        assert_eq!(moved, [DVec3::new(1.0, 0.0, 2.0), DVec3::new(1.0, 1.0, 1.0)]);
        let ball = Ball { center: DVec3::ZERO, radius: 0.5 };
        assert_eq!(two.extents(ball), [1.0, 2.0]);
        // The second lies within √3/2 of (1, 1, 0).
        assert!((two.farthest_from(ball, DVec3::new(1.0, 1.0, 0.0)) - 0.75_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn flat_transforms_are_singular_and_mirrored_ones_are_not() {
        assert!(!is_singular(DMat3::from_diagonal(DVec3::new(-1.0, 1e-3, 1e3))));
        for flat in [DVec3::new(1.0, 0.0, 1.0), DVec3::splat(f64::NAN), DVec3::splat(1e-160), DVec3::splat(1e160)] {
            assert!(is_singular(DMat3::from_diagonal(flat)), "{flat}");
        }
        assert!(is_singular(DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::X + DVec3::Y)));
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
        };
        let material = crate::scene::Material {
            name: "lamp".into(),
            kind: MaterialKind::Emissive,
            normal_map: None,
            emission: None,
            two_sided: true,
        };
        let scene = Scene {
            materials: vec![material],
            groups: vec![Group { name: "tree".into(), shapes: vec![shape] }],
            ..Scene::default()
        };
        let check = |instances: &Instances, emits| scene.check_instances(instances, &[false], &[emits]).err().unwrap_or_default();
        assert_eq!(check(&instances(vec![DAffine3::IDENTITY]), false), "");
        assert!(check(&instances(vec![DAffine3::IDENTITY]), true).contains("give no light"));
        assert!(check(&instances(vec![DAffine3::IDENTITY, DAffine3::ZERO]), false).contains("number 1"));
        assert!(check(&Instances { group: 1, ..instances(vec![]) }, false).contains("no group 1"));
        assert!(check(&Instances { material: Some(7), ..instances(vec![]) }, false).contains("no material 7"));
    }
}
