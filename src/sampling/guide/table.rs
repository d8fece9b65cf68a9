//! A guide as a table, and what is read from it.
//!
//! The table begins as [`crate::sampling::cell_grid`] says, with the cell's number from 1 in the index, or 0
//! where there is no guide.
//! Places within media have a facing of their own behind those of surfaces.
//! Then come [`GUIDE_CELL_WORDS`] for each cell: its axis, which is of no use within media, and its bins, row after row. Of a bin the lower half is its start, the sum of the shares of all
//! bins before it, and the upper half its share, in 65536ths. Then, as the bits of f32, what a surface or a medium there sends on ([`GuideCell::sent_on`]).

use std::f64::consts::PI;

use glam::DVec3;

use crate::math::{Frame, octahedron};
use crate::sampling::cell_grid::{CellGrid, FACINGS, GRID_HEADER_WORDS, facing};

/// Bins of a histogram: rows by the squared sine of the angle with the axis, columns around it.
pub const GUIDE_ROWS: u32 = 8;
pub const GUIDE_COLUMNS: u32 = 16;
/// The facing of places within media, behind those of surfaces.
pub const GUIDE_FACING_IN_MEDIA: u32 = FACINGS as u32;
/// The ways to face for which a guide has cells.
pub(super) const GUIDE_FACINGS: usize = FACINGS + 1;
/// Words of a cell.
pub const GUIDE_CELL_WORDS: u32 = 1 + GUIDE_ROWS * GUIDE_COLUMNS + 2;
/// Share of the directions that the guide draws, where a surface scatters by diffuse lobes alone, or a medium evenly. What the guide does not know of is found
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

/// The part of a guide that holds at one point of a surface or of a medium.
#[derive(Debug, Clone, Copy)]
pub struct GuideCell<'a> {
    words: &'a [u32],
    domain: Domain,
}

/// The directions that a histogram is about.
#[derive(Debug, Clone, Copy)]
pub(super) enum Domain {
    /// The directions above a surface, in the frame of its cell's axis; bins have equal projected solid angle.
    Hemisphere(Frame),
    /// All directions, by the axes of the scene; bins have equal solid angle.
    Sphere,
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
        let words = self.words_of_cell(position, facing(normal))?;
        Some(GuideCell { words, domain: Domain::Hemisphere(Frame::around(unpacked_axis(words[0]))) })
    }

    /// The cell of a place within a medium; None where nothing is known there.
    pub fn cell_in_medium(&self, position: DVec3) -> Option<GuideCell<'_>> {
        let words = self.words_of_cell(position, GUIDE_FACING_IN_MEDIA)?;
        Some(GuideCell { words, domain: Domain::Sphere })
    }

    fn words_of_cell(&self, position: DVec3, facing: u32) -> Option<&[u32]> {
        let index = CellGrid::of_table(&self.words).index_of(facing, position)?;
        let number = self.words[GRID_HEADER_WORDS as usize + index];
        let start = self.first_cell() + CELL_WORDS * (number.checked_sub(1)? as usize);
        Some(&self.words[start..start + CELL_WORDS])
    }
}

impl GuideCell<'_> {
    #[cfg(test)]
    pub(super) fn frame_of_tests(&self) -> Frame {
        match self.domain {
            Domain::Hemisphere(frame) => frame,
            Domain::Sphere => panic!("a cell of a medium has no frame"),
        }
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
        let down = (f64::from(row) + in_row) / f64::from(GUIDE_ROWS);
        let turns = (f64::from(column) + in_column) / f64::from(GUIDE_COLUMNS);
        let (sine_around, cosine_around) = (2.0 * PI * turns).sin_cos();
        let at = |sine: f64, cosine: f64| DVec3::new(sine * cosine_around, sine * sine_around, cosine);
        match self.domain {
            Domain::Hemisphere(frame) => frame.to_world(at(down.sqrt(), (1.0 - down).sqrt())),
            Domain::Sphere => at(2.0 * (down * (1.0 - down)).sqrt(), 1.0 - 2.0 * down),
        }
    }

    /// The density with which a direction is drawn, per steradian.
    pub fn pdf(&self, wi: DVec3) -> f64 {
        let Some(((row, column), even)) = self.domain.bin(wi) else { return 0.0 };
        f64::from(self.bin(row, column) >> 16) / f64::from(WHOLE) * BINS as f64 * even
    }
}

impl Domain {
    /// Row and column of a direction, and the density of directions where all bins have the same share. None below the horizon.
    pub(super) fn bin(&self, wi: DVec3) -> Option<((u32, u32), f64)> {
        match self {
            Self::Hemisphere(frame) => {
                let local = frame.to_local(wi);
                let down = local.x * local.x + local.y * local.y;
                (local.z > 0.0).then(|| (row_and_column(down, local), local.z / PI))
            }
            Self::Sphere => Some((row_and_column(0.5 - 0.5 * wi.z, wi), 0.25 / PI)),
        }
    }
}

/// Row and column by how far a direction is down from the axis, from 0 to 1, and by its angle around it.
fn row_and_column(down: f64, local: DVec3) -> (u32, u32) {
    let turns = local.y.atan2(local.x) / (2.0 * PI);
    let turns = if turns < 0.0 { turns + 1.0 } else { turns };
    let (row, column) = (down * f64::from(GUIDE_ROWS), turns * f64::from(GUIDE_COLUMNS));
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
