//! Boxes on a grid of powers of two, a byte a coordinate (as in Ylitie, Karras and Laine 2017).
//!
//! Boxes only ever grow: neither putting them onto the grid nor what a kernel computes of them in f32 may cut one.

use glam::{DVec3, Vec3};
use obvhs::aabb::Aabb;

/// Grid lines of a node. One is kept free at either end as a margin, so that rounding never cuts a box.
const GRID: f64 = 253.0;

/// A box in f32.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Box3 {
    pub low: Vec3,
    pub high: Vec3,
}

impl Box3 {
    /// Holds nothing: no ray meets it.
    pub const EMPTY: Self = Self { low: Vec3::splat(1e30), high: Vec3::splat(-1e30) };

    /// Around both.
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// True where all of `other` is inside.
    pub fn contains(&self, other: &Self) -> bool {
        self.low.cmple(other.low).all() && self.high.cmpge(other.high).all()
    }
}

impl From<&Aabb> for Box3 {
    fn from(aabb: &Aabb) -> Self {
        Self { low: aabb.min.into(), high: aabb.max.into() }
    }
}

/// The grid of a node's children: a line lies at origin + line · 2^exponent.
#[derive(Debug, Clone, Copy)]
pub struct Grid {
    origin: Vec3,
    exponents: [i32; 3],
}

impl Grid {
    /// The finest that holds all boxes.
    pub fn around(boxes: impl Iterator<Item = Box3>) -> Self {
        let all = boxes.reduce(Box3::union).unwrap_or(Box3 { low: Vec3::ZERO, high: Vec3::ZERO });
        let (low, high) = (all.low.as_dvec3(), all.high.as_dvec3());
        let mut grid = Self { origin: Vec3::ZERO, exponents: [0; 3] };
        for axis in 0..3 {
            let extent = (high[axis] - low[axis]).max(low[axis].abs().max(high[axis].abs()) * 1e-6).max(1e-30);
            let exponent = (extent / GRID).log2().ceil().clamp(-126.0, 127.0);
            // One free line below; f32 rounding of the origin is far less than a line unless the grid is tiny for its place, which
            // the extent's lower bound rules out.
            grid.origin[axis] = (low[axis] - exponent.exp2()) as f32;
            grid.exponents[axis] = exponent as i32;
        }
        grid
    }

    /// The grid with these packed words.
    pub fn unpack(origin: [u32; 3], exponents: u32) -> Self {
        let exponent = |axis: u32| (exponents >> (8 * axis) & 0xff) as i32 - 127;
        Self { origin: Vec3::from(origin.map(f32::from_bits)), exponents: [exponent(0), exponent(1), exponent(2)] }
    }

    pub fn origin_bits(&self) -> [u32; 3] {
        self.origin.to_array().map(f32::to_bits)
    }

    /// The biased exponents of x, y, z, a byte each.
    pub fn exponents(&self) -> u32 {
        (0..3).map(|axis| ((self.exponents[axis] + 127) as u32) << (8 * axis)).sum()
    }

    /// The lines around a box, 0 to 255. A hundredth of a line covers what a kernel rounds where the distance to the box is small beside
    /// its distance from the ray's origin.
    pub fn lines(&self, bounds: Box3) -> ([u32; 3], [u32; 3]) {
        let line =
            |x: Vec3, axis: usize| (f64::from(x[axis]) - f64::from(self.origin[axis])) / f64::from(self.exponents[axis]).exp2();
        let below = |axis| (line(bounds.low, axis) - 0.01).floor().clamp(0.0, 255.0) as u32;
        let above = |axis| (line(bounds.high, axis) + 0.01).ceil().clamp(0.0, 255.0) as u32;
        ([0, 1, 2].map(below), [0, 1, 2].map(above))
    }

    /// The box between these lines, rounded inwards at most by f32.
    pub fn at(&self, low: [u32; 3], high: [u32; 3]) -> Box3 {
        let spacing = DVec3::from(self.exponents.map(|exponent| f64::from(exponent).exp2()));
        let place = |lines: [u32; 3]| (self.origin.as_dvec3() + DVec3::from(lines.map(f64::from)) * spacing).as_vec3();
        Box3 { low: place(low), high: place(high) }
    }
}
