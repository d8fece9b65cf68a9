//! The six sides of a cube in one picture.

use glam::{DVec2, DVec3, DVec4};

use super::model::{CameraModel, Eyes, ViewPlace};
use crate::choice::choices;
use crate::scene::check::Check;

choices! {
    /// How the sides of a cube map lie in its picture: right, left, up, down, front, back, row by row.
    pub enum CubeLayout {
        /// Six beside each other.
        Row = "row",
        /// Two rows of three.
        Grid = "grid",
    }
}

/// Pictures of a right angle each: to the right of the viewing direction, to the left, up, down, in front and behind, each as a person sees it who
/// turns there from the front; up and down are seen with the head bent back and forth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CubeMap {
    pub layout: CubeLayout,
}

impl CameraModel for CubeMap {
    fn check(&self) -> Check {
        Ok(())
    }

    fn check_view(&self, size: DVec2) -> Check {
        if size.x == size.y {
            return Ok(());
        }
        let [columns, rows] = self.tiles();
        Err(format!(
            "the sides of a cube map are squares, {columns} × {rows} of them in the picture, and these would have {} × {} pixels",
            size.x, size.y
        ))
    }

    fn direction(&self, place: &ViewPlace) -> Option<DVec3> {
        let a = 2.0 * place.at.x / place.size.x - 1.0;
        let b = 1.0 - 2.0 * place.at.y / place.size.y;
        let towards = match place.tile {
            0 => DVec3::new(1.0, b, a),
            1 => DVec3::new(-1.0, b, -a),
            2 => DVec3::new(a, 1.0, b),
            3 => DVec3::new(a, -1.0, -b),
            4 => DVec3::new(a, b, -1.0),
            _ => DVec3::new(-a, b, 1.0),
        };
        Some(towards.normalize())
    }

    /// Two over a side in pixels.
    fn words(&self, size: DVec2) -> [DVec4; 4] {
        [DVec4::splat(2.0 / size.x), DVec4::ZERO, DVec4::ZERO, DVec4::ZERO]
    }

    fn eyes(&self) -> Eyes {
        Eyes::One
    }

    fn tiles(&self) -> [u32; 2] {
        match self.layout {
            CubeLayout::Row => [6, 1],
            CubeLayout::Grid => [3, 2],
        }
    }
}
