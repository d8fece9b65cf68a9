//! Rectangles.

use glam::{DAffine3, DVec3};

use super::model::{Enclosure, Extent, ShapeModel, around_points, longest_edge, possible};
use super::tessellation::{Tessellated, of_quads};
use crate::scene::check::Check;

/// A parallelogram; normal along edge_u × edge_v. UV (0,0) at `corner`, u along edge_u.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    pub corner: DVec3,
    pub edge_u: DVec3,
    pub edge_v: DVec3,
}

impl ShapeModel for Rectangle {
    fn check(&self) -> Check {
        possible([self.corner, self.edge_u, self.edge_v].into_iter().all(DVec3::is_finite))
    }

    fn farthest_from(&self, map: &DAffine3, point: DVec3) -> f64 {
        self.corners().into_iter().map(|corner| map.transform_point3(corner).distance(point)).fold(0.0, f64::max)
    }

    fn bounds(&self, map: &DAffine3) -> Option<[DVec3; 2]> {
        around_points(self.corners(), map)
    }

    fn enclosure(&self) -> Enclosure {
        Enclosure::None
    }

    fn tessellated(&self) -> Tessellated {
        Tessellated::exact(of_quads(&[[self.corner, self.edge_u, self.edge_v]], true))
    }

    fn extent(&self, map: &DAffine3) -> Option<Extent> {
        Some(longest_edge(&[self.edge_u, self.edge_v], map))
    }
}

impl Rectangle {
    fn corners(&self) -> [DVec3; 4] {
        let opposite = self.corner + self.edge_u + self.edge_v;
        [self.corner, self.corner + self.edge_u, self.corner + self.edge_v, opposite]
    }
}
