//! Boxes.

use glam::{DAffine3, DVec3};

use super::model::{Extent, ShapeModel, farthest_corner, longest_edge, possible};
use crate::scene::check::Check;

/// Axis-aligned in its own space; normals outward. At most one edge has no length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cuboid {
    pub min: DVec3,
    pub max: DVec3,
}

impl ShapeModel for Cuboid {
    fn check(&self) -> Check {
        possible(self.min.is_finite() && self.max.is_finite() && self.min.cmple(self.max).all())
    }

    fn farthest_from(&self, map: &DAffine3, point: DVec3) -> f64 {
        farthest_corner(self.min, self.max, map, point)
    }

    fn extent(&self, map: &DAffine3) -> Option<Extent> {
        Some(longest_edge(&DVec3::AXES.map(|axis| axis * (self.max - self.min)), map))
    }

    fn faces(&self) -> usize {
        6
    }
}
