//! A guide as a table, and what is read from it.
//!
//! The table begins as [`crate::sampling::cell_grid`] says, with the cell's number from 1 in the index, or 0
//! where there is no guide.
//! Then come [`GUIDE_CELL_WORDS`] for each cell: its axis, and its bins, row after row. Of a bin the lower half is its start, the sum of the shares of all
//! bins before it, and the upper half its share, in 65536ths. Then, as the bits of f32, what a surface there sends on ([`GuideCell::sent_on`]).

use std::f64::consts::PI;

use glam::DVec3;

use crate::math::{Frame, octahedron};
use crate::sampling::cell_grid::{CellGrid, GRID_HEADER_WORDS, facing};

/// Bins of a histogram: rows by the squared sine of the angle with the axis, columns around it.
pub const GUIDE_ROWS: u32 = 8;
pub const GUIDE_COLUMNS: u32 = 16;
/// Words of a cell.
pub const GUIDE_CELL_WORDS: u32 = 1 + GUIDE_ROWS * GUIDE_COLUMNS + 2;
/// Share of the directions that the guide draws, where a surface scatters by diffuse lobes alone. What the guide does not know of is found
/// less often and then counts for more: more pays where a guide learned long, and less where it learned little.
pub const GUIDED_SHARE: f32 = 0.5625;
/// A path goes on with a probability of the root of so many times what it is expected to bring yet, over what it was expected to bring at first.
pub const SURVIVAL_FACTOR: f32 = 3.0;
/// The least chance to go on: what is expected is an estimate.
pub const LEAST_SURVIVAL: f32 = 0.1;
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

    /// The cell of a point on a surface, whose normal is on the side from where it is seen; None where
    /// nothing is known there.
    pub fn cell(&self, position: DVec3, normal: DVec3) -> Option<GuideCell<'_>> {
        let index = CellGrid::of_table(&self.words).index_of(facing(normal), position)?;
        let number = self.words[GRID_HEADER_WORDS as usize + index];
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

    /// Light per throughput that a surface here sends on, on average: light that comes by way of its
    /// scattering, and all light.
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
