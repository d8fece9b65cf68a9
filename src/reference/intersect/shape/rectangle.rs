//! Rectangles, and the quads that boxes are made of as well.

use glam::{DVec2, DVec3};

use super::placement::Placement;
use super::primitive::Primitive;
use crate::emission_map::Unrolled;
use crate::reference::intersect::element::Element;
use crate::reference::intersect::hierarchy::PreparedRay;
use crate::reference::intersect::normal_map::Tangents;
use crate::reference::intersect::pose::Pose;
use crate::reference::intersect::ray::{Local, Ray, SurfacePoint};
use crate::reference::intersect::seen::{Flat, Outline};
use crate::sampling::solid_angle::is_rectangle;
use crate::scene::Rectangle;

pub fn elements(shape: &Rectangle, placement: &Placement<'_>) -> Vec<(usize, Primitive)> {
    let quad = Quad::placed([shape.corner, shape.edge_u, shape.edge_v], placement);
    quad.into_iter().map(|quad| (0, Primitive::of(quad))).collect()
}

/// Rectangles and the faces of boxes. The front is where `edge_u` × `edge_v` points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quad {
    corner: DVec3,
    edge_u: DVec3,
    edge_v: DVec3,
    normal: DVec3,
    /// The first edge runs backwards, to keep the front in front under a reflection; texture coordinates undo that.
    reversed: bool,
    /// Dual basis: the coordinate along edge_u is the offset from the corner dotted with `dual_u`, and so for v.
    dual_u: DVec3,
    dual_v: DVec3,
    /// How far beyond its borders it reaches, in its own coordinates: enough for rounding to leave no gap between two that share
    /// an edge.
    slack: DVec2,
}

impl Element for Quad {
    #[inline]
    fn intersect(&self, ray: &PreparedRay, limit: f64) -> Option<(f64, Local)> {
        let distance = ray.ray.distance_to_plane(self.corner, self.normal, limit)?;
        let offset = ray.ray.at(distance) - self.corner;
        let local = DVec2::new(offset.dot(self.dual_u), offset.dot(self.dual_v));
        let inside = local.cmpge(-self.slack) & local.cmple(DVec2::ONE + self.slack);
        inside.all().then_some((distance, local))
    }

    #[inline]
    fn point(&self, _: &Ray, _: f64, local: Local) -> SurfacePoint {
        self.at(local)
    }

    fn area(&self) -> f64 {
        self.edge_u.cross(self.edge_v).length()
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let zero = DVec3::ZERO;
        let low = self.corner + self.edge_u.min(zero) + self.edge_v.min(zero);
        Some([low, self.corner + self.edge_u.max(zero) + self.edge_v.max(zero)])
    }

    /// (0, 0) at the corner, u along the first edge as written.
    fn uv(&self, local: Local, _: DVec3) -> DVec2 {
        if self.reversed { DVec2::new(1.0 - local.x, local.y) } else { local }
    }

    fn unrolled(&self) -> Option<Unrolled> {
        Some(Unrolled::Evenly)
    }

    fn numbers_of_place(&self, _: Option<&Pose>, place: DVec2) -> DVec2 {
        if self.reversed { DVec2::new(1.0 - place.x, place.y) } else { place }
    }

    fn tangents(&self, _: Local, _: DVec3) -> Option<Tangents> {
        Some(Tangents::along(if self.reversed { -self.edge_u } else { self.edge_u }, self.edge_v))
    }

    fn sample_area(&self, u1: f64, u2: f64) -> Option<(SurfacePoint, Local)> {
        let local = DVec2::new(u1, u2);
        Some((self.at(local), local))
    }

    fn flat(&self) -> Option<Flat> {
        let flat = Flat { outline: Outline::Rectangle, corner: self.corner, edges: [self.edge_u, self.edge_v] };
        is_rectangle(self.edge_u, self.edge_v).then_some(flat)
    }
}

impl Quad {
    /// Corner and edges in the shape's own space. None where the area is zero.
    pub fn placed([corner, edge_u, edge_v]: [DVec3; 3], placement: &Placement<'_>) -> Option<Self> {
        let linear = placement.to_world.matrix3;
        let corner = placement.to_world.transform_point3(corner);
        Self::new(corner, linear * edge_u, linear * edge_v, placement.shape.is_mirrored())
    }

    /// Corner and edges as transformed, by a reflection or not. None where the area is zero.
    fn new(corner: DVec3, edge_u: DVec3, edge_v: DVec3, reversed: bool) -> Option<Self> {
        let (corner, edge_u) = if reversed { (corner + edge_u, -edge_u) } else { (corner, edge_u) };
        let cross = edge_u.cross(edge_v);
        let squared = cross.length_squared();
        let (dual_u, dual_v) = (edge_v.cross(cross) / squared, cross.cross(edge_u) / squared);
        let rounding = 32.0 * f64::EPSILON * (corner.abs() + edge_u.abs() + edge_v.abs()).max_element();
        (squared > 0.0 && squared.is_finite()).then(|| Self {
            corner,
            edge_u,
            edge_v,
            normal: cross.normalize(),
            reversed,
            dual_u,
            dual_v,
            slack: DVec2::new(dual_u.length(), dual_v.length()) * rounding,
        })
    }

    #[inline]
    fn at(&self, local: Local) -> SurfacePoint {
        let position = self.corner + self.edge_u * local.x + self.edge_v * local.y;
        let magnitude = (self.corner.abs() + self.edge_u.abs() + self.edge_v.abs()).max_element();
        SurfacePoint::new(position, self.normal, magnitude)
    }
}
