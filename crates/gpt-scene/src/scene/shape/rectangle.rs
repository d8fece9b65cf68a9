//! Rectangles.

use glam::{DAffine3, DVec3};

use super::model::{Extent, ShapeModel, longest_edge, possible};
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
        let opposite = self.corner + self.edge_u + self.edge_v;
        let corners = [self.corner, self.corner + self.edge_u, self.corner + self.edge_v, opposite];
        corners.into_iter().map(|corner| map.transform_point3(corner).distance(point)).fold(0.0, f64::max)
    }

    fn extent(&self, map: &DAffine3) -> Option<Extent> {
        Some(longest_edge(&[self.edge_u, self.edge_v], map))
    }
}
