//! A guide as a table, and what is read from it.
//!
//! The table consists of words of 32 bits, because each word that a kernel loads costs:
//!
//! - from 0 on: where the grid begins, and the inverse size of its boxes, as the bits of f32; how many boxes it has along x, y and z; the first
//!   word of the cells;
//! - then a word for each facing and box, x first, then y, z and the facing: the cell's number from 1, or 0 where there is no guide;
//! - [`GUIDE_CELL_WORDS`] for each cell: its axis, and its bins, row after row. Of a bin the lower half is its start, the sum of the shares of all
//!   bins before it, and the upper half its share, in 65536ths. Then, as the bits of f32, what a surface there sends on ([`GuideCell::sent_on`]).

use std::f64::consts::PI;

use glam::DVec3;

use crate::math::{Frame, octahedron};

/// Bins of a histogram: rows by the squared sine of the angle with the axis, columns around it.
pub const GUIDE_ROWS: u32 = 8;
pub const GUIDE_COLUMNS: u32 = 16;
/// Words of a cell.
pub const GUIDE_CELL_WORDS: u32 = 1 + GUIDE_ROWS * GUIDE_COLUMNS + 2;
/// Words before the index.
pub const GUIDE_HEADER_WORDS: u32 = 8;
/// Share of the directions that the guide draws, where a surface scatters by diffuse lobes alone. What the guide does not know of is found
/// less often and then counts for more: with a half, fireflies of paths that training did not find outweighed the gain.
pub const GUIDED_SHARE: f32 = 0.375;
/// What a path is expected to bring yet, over what it was expected to bring at first, that is let go on in any case.
pub const SURVIVAL_FACTOR: f32 = 3.0;
/// The least chance to go on: what is expected is an estimate.
pub const LEAST_SURVIVAL: f32 = 0.1;
/// By these the components of a normal are weighed where the largest says which way it faces: none of 45° lies on a border.
pub const FACING_WEIGHT_Y: f32 = 1.0078125;
pub const FACING_WEIGHT_Z: f32 = 1.015625;
/// Steps of the octahedron's coordinates in which axes are kept.
pub const GUIDE_AXIS_STEP: f32 = 1.0 / 127.0;

/// Words of a cell.
pub const CELL_WORDS: usize = GUIDE_CELL_WORDS as usize;
/// Bins of a cell.
pub const BINS: usize = (GUIDE_ROWS * GUIDE_COLUMNS) as usize;
/// All shares of a cell's bins together.
pub(super) const WHOLE: u32 = 1 << 16;
/// Random numbers have 24 bits.
const NUMBERS: f64 = 16_777_216.0;

/// From where light arrives, all over a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Guide {
    pub(super) words: Vec<u32>,
}

/// The part of a guide that holds at one point of a surface.
#[derive(Debug, Clone, Copy)]
pub struct GuideCell<'a> {
    words: &'a [u32],
    frame: Frame,
}

/// Which way a normal faces: twice the axis along which it is longest, and one more where it points down that axis.
pub fn facing(normal: DVec3) -> u32 {
    let weighed = normal.abs() * DVec3::new(1.0, f64::from(FACING_WEIGHT_Y), f64::from(FACING_WEIGHT_Z));
    let axis = if weighed.x >= weighed.y && weighed.x >= weighed.z {
        0
    } else if weighed.y >= weighed.z {
        1
    } else {
        2
    };
    2 * axis + u32::from(normal[axis as usize] < 0.0)
}

impl Guide {
    /// The table, as devices read it.
    pub fn words(&self) -> &[u32] {
        &self.words
    }

    pub fn cells(&self) -> usize {
        (self.words.len() - self.first_cell()) / CELL_WORDS
    }

    fn first_cell(&self) -> usize {
        self.words[7] as usize
    }

    /// What the guide knows of a point on a surface, whose normal is on the side from where it is seen.
    pub fn cell(&self, position: DVec3, normal: DVec3) -> Option<GuideCell<'_>> {
        let number = |word: usize| f64::from(f32::from_bits(self.words[word]));
        let [width, height, depth] = [self.words[4], self.words[5], self.words[6]];
        let mut boxes = [0; 3];
        for (axis, count) in [width, height, depth].into_iter().enumerate() {
            let place = (position[axis] - number(axis)) * number(3);
            if !(place >= 0.0 && place < f64::from(count)) {
                return None;
            }
            boxes[axis] = place as u32;
        }
        let index = ((facing(normal) * depth + boxes[2]) * height + boxes[1]) * width + boxes[0];
        let number = self.words[(GUIDE_HEADER_WORDS + index) as usize];
        let start = self.first_cell() + CELL_WORDS * (number.checked_sub(1)? as usize);
        let words = &self.words[start..start + CELL_WORDS];
        Some(GuideCell { words, frame: Frame::around(unpacked_axis(words[0])) })
    }
}

impl GuideCell<'_> {
    #[cfg(test)]
    pub(super) fn frame_of_tests(&self) -> Frame {
        self.frame
    }

    /// What a surface here sends on, on average, per throughput: of light that comes by way of its scattering, and of all light.
    pub fn sent_on(&self) -> [f64; 2] {
        [1, 2].map(|behind| f64::from(f32::from_bits(self.words[BINS + behind])))
    }

    fn bin(&self, row: u32, column: u32) -> u32 {
        self.words[(1 + row * GUIDE_COLUMNS + column) as usize]
    }

    /// The start of a row, in 65536ths; of the one behind the last, all.
    fn row_start(&self, row: u32) -> u32 {
        if row == GUIDE_ROWS { WHOLE } else { self.bin(row, 0) & 0xffff }
    }

    /// The start of a bin of a row; behind the last, that of the next row.
    fn start(&self, row: u32, column: u32) -> u32 {
        if column == GUIDE_COLUMNS { self.row_start(row + 1) } else { self.bin(row, column) & 0xffff }
    }

    /// Draws a direction by two numbers of [0, 1) that are multiples of 2⁻²⁴.
    pub fn sample(&self, u: f64, v: f64) -> DVec3 {
        let [u, v] = [u, v].map(|number| (number * NUMBERS) as u32);
        // The row, and where in it.
        let mut row = 0;
        while row + 1 < GUIDE_ROWS && u >= self.row_start(row + 1) << 8 {
            row += 1;
        }
        let (start, end) = (self.row_start(row), self.row_start(row + 1));
        let in_row = f64::from(u - (start << 8)) / f64::from((end - start) << 8);
        // The column, by what part of the row's share the second number means.
        let product = u64::from(v << 8) * u64::from(end - start);
        let (whole, rest) = ((product >> 32) as u32, product as u32);
        let mut column = 0;
        while column + 1 < GUIDE_COLUMNS && start + whole >= self.start(row, column + 1) {
            column += 1;
        }
        let [first, behind] = [column, column + 1].map(|column| self.start(row, column));
        let in_column = (f64::from(start + whole - first) + f64::from(rest) / 4_294_967_296.0) / f64::from(behind - first);
        let squared_sine = (f64::from(row) + in_row) / f64::from(GUIDE_ROWS);
        let turns = (f64::from(column) + in_column) / f64::from(GUIDE_COLUMNS);
        let (sine, angle) = (squared_sine.sqrt(), 2.0 * PI * turns);
        self.frame.to_world(DVec3::new(sine * angle.cos(), sine * angle.sin(), (1.0 - squared_sine).sqrt()))
    }

    /// The density with which a direction is drawn, per steradian.
    pub fn pdf(&self, wi: DVec3) -> f64 {
        let local = self.frame.to_local(wi);
        if local.z <= 0.0 {
            return 0.0;
        }
        let (row, column) = bin(local);
        let share = self.bin(row, column) >> 16;
        f64::from(share) / f64::from(WHOLE) * BINS as f64 * local.z / PI
    }
}

/// Row and column of a direction above the horizon, in the cell's frame.
pub(super) fn bin(local: DVec3) -> (u32, u32) {
    let turns = local.y.atan2(local.x) / (2.0 * PI);
    let turns = if turns < 0.0 { turns + 1.0 } else { turns };
    let row = (local.x * local.x + local.y * local.y) * f64::from(GUIDE_ROWS);
    let column = turns * f64::from(GUIDE_COLUMNS);
    ((row as u32).min(GUIDE_ROWS - 1), (column as u32).min(GUIDE_COLUMNS - 1))
}

/// A direction by its place on an octahedron, a byte a coordinate.
pub(super) fn packed_axis(axis: DVec3) -> u32 {
    let byte = |number: f64| u32::from((number / f64::from(GUIDE_AXIS_STEP)).round() as i8 as u8);
    let [x, y] = octahedron::place_of(axis);
    byte(x) | byte(y) << 8
}

pub(super) fn unpacked_axis(packed: u32) -> DVec3 {
    let number = |byte: u32| f64::from(byte as u8 as i8) * f64::from(GUIDE_AXIS_STEP);
    octahedron::direction_at([number(packed), number(packed >> 8)])
}
