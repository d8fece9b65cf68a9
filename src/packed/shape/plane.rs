//! Infinite planes.

use glam::{DAffine3, DVec3, Vec3};

use super::element::Element;
use super::placement::Placement;
use crate::packed::attributes::TriangleAttributes;
use crate::scene;

pub fn add(shape: &scene::Plane, placement: &Placement<'_>, push: &mut dyn FnMut(Plane, Option<TriangleAttributes>, usize)) {
    push(Plane { point: placement.point(shape.point), normal: placement.normal(shape.normal) }, None, 0);
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    pub point: DVec3,
    pub normal: DVec3,
}

impl Element for Plane {
    /// Planes never move.
    fn moved(&self, _: &DAffine3) -> Self {
        *self
    }

    fn bounds(&self) -> Option<(Vec3, Vec3)> {
        None
    }

    fn extent(&self) -> Option<[DVec3; 2]> {
        None
    }

    fn area(&self) -> f64 {
        f64::INFINITY
    }

    /// Point; normal; nothing.
    fn points(&self) -> [Vec3; 3] {
        [self.point.as_vec3(), self.normal.as_vec3(), Vec3::ZERO]
    }

    fn light(&self) -> Option<(f64, [DVec3; 3])> {
        None
    }
}
