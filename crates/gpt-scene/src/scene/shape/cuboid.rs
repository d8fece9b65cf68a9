//! Boxes.

use glam::{DAffine3, DVec3};

use super::model::{Enclosure, Extent, ShapeModel, around_box, farthest_corner, longest_edge, possible};
use super::tessellation::{Tessellated, of_quads};
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

    fn bounds(&self, map: &DAffine3) -> Option<[DVec3; 2]> {
        around_box(self.min, self.max, map)
    }

    fn enclosure(&self) -> Enclosure {
        Enclosure::Body
    }

    fn tessellated(&self) -> Tessellated {
        Tessellated::exact(of_quads(&self.sides(), true))
    }

    fn extent(&self, map: &DAffine3) -> Option<Extent> {
        Some(longest_edge(&DVec3::AXES.map(|axis| axis * (self.max - self.min)), map))
    }

    fn faces(&self) -> usize {
        6
    }
}

impl Cuboid {
    /// Corner and edges of the faces, edge_u × edge_v outward; in the order and with the texture coordinates that boxes have.
    fn sides(&self) -> Vec<[DVec3; 3]> {
        let extent = self.max - self.min;
        let axis = |index: usize| DVec3::AXES[index % 3] * extent[index % 3];
        let side = |index: usize| {
            let along = index / 2;
            match index % 2 {
                0 => [self.min, axis(along + 2), axis(along + 1)],
                _ => [self.min + axis(along), axis(along + 1), axis(along + 2)],
            }
        };
        (0..6).map(side).filter(|[_, u, v]| u.cross(*v) != DVec3::ZERO).collect()
    }
}
