//! Meshes that are stored once and stand in many places.

use std::fmt;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::check::{Check, within_range};
use super::light_links::ReceiverId;
use super::material::MaterialId;
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

/// One group in one place or in many. None of their faces emits: readers of scene files make shapes of emitters, one for each place.
#[derive(Clone)]
pub struct Instances {
    /// How errors and reports call them.
    pub label: String,
    /// Index into the scene's groups.
    pub group: usize,
    /// From the group's space, a place each.
    pub places: Arc<Vec<DAffine3>>,
    /// From the places on to the world at shutter time 0.
    pub transform: Transform,
    /// The material in place of all of the group's own materials; faces of a `pass` material stay openings.
    pub material: Option<MaterialId>,
    /// How each moves while the shutter is open, about where it puts the group's (0, 0, 0); None: at rest.
    pub motion: Option<Motion>,
    /// The point that the motion is about instead, in the world at shutter time 0.
    pub pivot: Option<DVec3>,
    /// The group of receivers that they belong to.
    pub receiver: ReceiverId,
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

/// Prints a receiver where it is one of its own: fingerprints of scenes without light links stay as they are.
impl fmt::Debug for Instances {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { label, group, places, transform, material, motion, pivot, receiver } = self;
        let mut fields = formatter.debug_struct("Instances");
        fields.field("label", label).field("group", group).field("places", places).field("transform", transform);
        fields.field("material", material).field("motion", motion).field("pivot", pivot);
        if *receiver != 0 {
            fields.field("receiver", receiver);
        }
        fields.finish()
    }
}

impl Instances {
    /// From the group's space to the world at shutter time 0, one map for each instance.
    pub fn maps(&self) -> impl ExactSizeIterator<Item = DAffine3> + '_ {
        let all = self.transform.to_affine();
        self.places.iter().map(move |place| all * *place)
    }

    /// The point that the motion of the instance with this map is about.
    pub fn origin_of_motion(&self, map: &DAffine3) -> DVec3 {
        self.pivot.unwrap_or(map.translation)
    }

    /// A distance from `point` within which all of the nearest instance lies.
    pub(super) fn farthest_from(&self, ball: Ball, point: DVec3) -> f64 {
        let of_map =
            |map: DAffine3| map.transform_point3(ball.center).distance(point) + ball.radius * largest_stretch(map.matrix3);
        self.maps().map(of_map).fold(f64::INFINITY, f64::min)
    }

    /// Checks that all of them stay within the range of numbers.
    pub(super) fn check_reach(&self, ball: Ball, shutter: [f64; 2]) -> Check {
        for (place, map) in self.maps().enumerate() {
            let reach_from =
                |point: DVec3| map.transform_point3(ball.center).distance(point) + ball.radius * largest_stretch(map.matrix3);
            let checked = match &self.motion {
                None => within_range(reach_from(DVec3::ZERO)),
                Some(motion) => {
                    let origin = self.origin_of_motion(&map);
                    motion.check_reach(shutter, origin, reach_from(origin))
                }
            };
            checked.map_err(|message| format!("number {place}, counted from 0: {message}"))?;
        }
        Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::TransformStep;

    fn instances(places: Vec<DAffine3>) -> Instances {
        Instances {
            label: "instance[0]".into(),
            group: 0,
            places: Arc::new(places),
            transform: Transform { steps: vec![TransformStep::Translate(DVec3::X)] },
            material: None,
            motion: None,
            pivot: None,
            receiver: 0,
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
}
