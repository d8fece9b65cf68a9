//! Elements: the primitives of kernels, of which shapes are made.

use glam::{DAffine3, DVec3, Vec3};

use crate::emission_map::Unrolled;

/// A primitive in world space.
pub trait Element: Copy {
    /// How whole ones are drawn by what they show, where they can be: `unrolled` of the reference says the same.
    const UNROLLED: Option<Unrolled> = None;

    /// The element under a motion. Round ones are scaled by the same factor along every axis.
    fn moved(&self, map: &DAffine3) -> Self;

    /// Bounds in f32, grown past rounding. None: it is infinite.
    fn bounds(&self) -> Option<(Vec3, Vec3)>;

    /// Lower and upper corner of the box around it. None: it is infinite.
    fn extent(&self) -> Option<[DVec3; 2]>;

    /// Surface area; infinite for a plane.
    fn area(&self) -> f64;

    /// The three points of its record.
    fn points(&self) -> [Vec3; 3];

    /// Its data as a light: its area, or 0 where it is not sampled by area; and three points. None: no
    /// density covers it evenly.
    fn light(&self) -> Option<(f64, [DVec3; 3])>;

    /// Its normal as a light. None: it is not flat.
    fn light_normal(&self) -> Option<DVec3> {
        self.light().map(|(_, [_, edge_u, edge_v])| edge_u.cross(edge_v).normalize_or_zero())
    }
}
