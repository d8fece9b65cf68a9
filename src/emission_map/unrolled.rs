//! How texture coordinates cover whole shapes.

use std::f64::consts::PI;

use glam::DVec2;

/// How points of a shape are drawn by a grid over the unit square of its texture coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Unrolled {
    /// Equal areas of the square are equal areas of the shape: rectangles, and the sides of cylinders.
    Evenly,
    /// A sphere, whose height above the lower pole is sin²(πv/2) diameters. The grid's rows are bands of different areas; within each of them points
    /// are even over the area, which a height is in proportion to (Archimedes).
    Sphere,
}

impl Unrolled {
    /// For a place in the square, of which a grid has so many rows: the share of the area that lies below what is drawn there, and that of the row
    /// against the share of the square that it is.
    pub fn area_below(self, v: f64, rows: u32) -> (f64, f64) {
        match self {
            Self::Evenly => (v, 1.0),
            Self::Sphere => {
                let (rows, row) = (f64::from(rows), (v * f64::from(rows)).floor().clamp(0.0, f64::from(rows) - 1.0));
                let angle = 0.5 * PI / rows;
                // sin²b − sin²a = sin(b − a) sin(b + a)
                let area = angle.sin() * (angle * (2.0 * row + 1.0)).sin();
                ((angle * row).sin().powi(2) + (v * rows - row) * area, area * rows)
            }
        }
    }

    /// Texture coordinates of a point of the area, which lies so high.
    pub fn uv(self, place: DVec2) -> DVec2 {
        match self {
            Self::Evenly => place,
            Self::Sphere => DVec2::new(place.x, (1.0 - 2.0 * place.y).clamp(-1.0, 1.0).acos() / PI),
        }
    }
}
