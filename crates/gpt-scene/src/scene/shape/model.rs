//! The questions of a scene to a shape's geometry, whatever its kind.

use glam::{DAffine3, DVec3};

use super::tessellation::Tessellated;
use crate::math::box_corners;
use crate::scene::check::Check;
use crate::scene::material::MaterialId;

/// The length by which single precision limits a shape, in units of the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Extent {
    /// The longest edge, of a shape of parallelograms.
    LongestEdge(f64),
    /// The extent from side to side, of all other shapes.
    Across(f64),
}

/// The part of space that a surface parts from the rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Enclosure {
    /// None: rays go around its edge.
    None,
    /// A body, from which its fronts look away.
    Body,
    /// All but a body, which its fronts look into.
    Surroundings,
    /// One half of all there is.
    Half,
}

impl Enclosure {
    /// The surface has no edge, and no ray goes on for ever within.
    pub fn is_closed(self) -> bool {
        matches!(self, Self::Body | Self::Surroundings)
    }
}

pub trait ShapeModel {
    /// Checks its numbers; the error is the mistake, in words.
    fn check(&self) -> Check;

    /// Why it has no texture coordinates, and what to use instead; None: it has them.
    fn lacks_uv(&self) -> Option<&'static str> {
        None
    }

    /// A distance from `point` within which all of it lies once `map` has placed it; of what is infinite the distance of its surface.
    fn farthest_from(&self, map: &DAffine3, point: DVec3) -> f64;

    /// The lower and upper corner of an upright box around it once `map` has placed it; None: it is infinite, or there is nothing of it.
    fn bounds(&self, map: &DAffine3) -> Option<[DVec3; 2]>;

    /// Says what its fronts look away from. Faces of a mesh may have several materials; all of them count.
    fn enclosure(&self) -> Enclosure;

    /// Triangles in its place.
    fn tessellated(&self) -> Tessellated;

    /// Its extent once `map` has placed it; None: it is infinite, or there is nothing of it.
    fn extent(&self, map: &DAffine3) -> Option<Extent>;

    /// True if it keeps its form only under a scaling by one factor along every axis.
    fn is_round(&self) -> bool {
        false
    }

    /// True if it has neither bounds nor an area: it cannot move, and no light or portal has this shape.
    fn is_infinite(&self) -> bool {
        false
    }

    /// Faces that a ray is tested against one by one where the shape is a portal.
    fn faces(&self) -> usize {
        1
    }

    /// One material for each face; empty: that of the shape is the material of all.
    fn face_materials(&self) -> &[MaterialId] {
        &[]
    }
}

/// The mistake where numbers of a shape are impossible.
pub fn possible(possible: bool) -> Check {
    if possible { Ok(()) } else { Err("its numbers must be finite, radii positive, and normals of length 1".into()) }
}

/// The longest of these edges once `map` has placed them.
pub fn longest_edge(edges: &[DVec3], map: &DAffine3) -> Extent {
    Extent::LongestEdge(edges.iter().map(|edge| map.transform_vector3(*edge).length()).fold(0.0, f64::max))
}

/// How far from `point` the farthest corner of a box is once `map` has placed it.
pub fn farthest_corner(low: DVec3, high: DVec3, map: &DAffine3, point: DVec3) -> f64 {
    box_corners(low, high).map(|corner| map.transform_point3(corner).distance(point)).into_iter().fold(0.0, f64::max)
}

/// The upright box around points once `map` has placed them.
pub fn around_points(points: impl IntoIterator<Item = DVec3>, map: &DAffine3) -> Option<[DVec3; 2]> {
    let mut placed = points.into_iter().map(|point| map.transform_point3(point));
    let first = placed.next()?;
    Some(placed.fold([first; 2], |[low, high], point| [low.min(point), high.max(point)]))
}

/// The upright box around one of the shape's own space once `map` has placed that.
pub fn around_box(low: DVec3, high: DVec3, map: &DAffine3) -> Option<[DVec3; 2]> {
    around_points(box_corners(low, high), map)
}
