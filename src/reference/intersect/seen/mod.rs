//! Flat pieces of surface as they are seen from a point, where points of them are drawn by solid angle: rectangles and triangles.

mod rectangle;
mod triangle;

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use rectangle::SeenRectangle;
use triangle::SeenTriangle;

/// Outlines that can be drawn by solid angle; the one that takes least comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outline {
    Rectangle,
    Triangle,
}

/// A rectangle or a triangle.
#[derive(Debug, Clone, Copy)]
pub struct Flat {
    pub outline: Outline,
    pub corner: DVec3,
    /// They begin at the corner.
    pub edges: [DVec3; 2],
}

impl Flat {
    /// None where its points are better drawn by area: it is seen aslant or under too small an angle.
    pub fn seen_from(&self, from: DVec3) -> Option<Seen> {
        let Self { outline, corner, edges: [edge_u, edge_v] } = *self;
        match outline {
            Outline::Rectangle => SeenRectangle::new(from, corner, edge_u, edge_v).map(Seen::Rectangle),
            Outline::Triangle => SeenTriangle::new(from, corner, edge_u, edge_v).map(Seen::Triangle),
        }
    }
}

/// One of these, seen from a point.
#[derive(Debug, Clone, Copy)]
pub enum Seen {
    Rectangle(SeenRectangle),
    Triangle(SeenTriangle),
}

impl Seen {
    /// In steradians.
    pub fn solid_angle(&self) -> f64 {
        match self {
            Self::Rectangle(seen) => seen.solid_angle,
            Self::Triangle(seen) => seen.solid_angle,
        }
    }

    /// The numbers with which the point is drawn by area that is the one drawn by these, uniform over the solid angle.
    pub fn numbers(&self, u: f64, v: f64) -> DVec2 {
        match self {
            Self::Rectangle(seen) => seen.place(u, v),
            Self::Triangle(seen) => seen.numbers(u, v),
        }
    }

    /// By how much that magnifies rounding errors of the numbers, where single precision computes it. A rectangle's solid angle is what is left
    /// of angles that add up to 2π, and so is each part of it.
    pub fn magnifies(&self) -> f64 {
        match self {
            Self::Rectangle(seen) => (TAU / seen.solid_angle).max(1.0),
            Self::Triangle(_) => 1.0,
        }
    }
}
