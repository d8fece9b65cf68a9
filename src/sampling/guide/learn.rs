//! How a guide is learned from light that arrived along training paths.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::table::{
    BINS, CELL_WORDS, Domain, GUIDE_COLUMNS, GUIDE_FACING_IN_MEDIA, GUIDE_FACINGS, GUIDE_ROWS, Guide, WHOLE, packed_axis,
    unpacked_axis,
};
use crate::math::Frame;
use crate::sampling::cell_grid::{CellGrid, Region, facing};

/// Boxes of the grid at most, for each facing.
const MOST_BOXES: usize = 1 << 16;
/// Cells that there are about at most; four times as many where arrivals are spread badly.
const MOST_CELLS: usize = 8192;
/// Arrivals of a cell at least, and from which on it is cut in two. A histogram of some hundred is mostly noise, and many cells are read slowly.
const FEWEST_ARRIVALS: usize = 64;
const MOST_ARRIVALS: usize = 3072;
/// The even share of a histogram that was made of so many arrivals is a half.
const DOUBT: f64 = 16.0;
/// Least even share of a histogram.
const LEAST_EVEN_SHARE: f64 = 0.03;
/// Share that a bin gives to each of its four neighbours: light moves a little from one end of a cell to the
/// other.
const SPILL: f64 = 0.1;

/// Light that arrived at a point of a surface or of a medium by one direction. In single precision: there are millions of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    pub position: Vec3,
    /// On the side from where the point was seen; 0 within media.
    pub normal: Vec3,
    pub wi: Vec3,
    /// An estimate of the radiance, light left out that light sampling finds.
    pub radiance: f32,
    /// Density with which the direction was drawn, per steradian.
    pub pdf: f32,
    /// Estimates of what the surface sends on, per throughput: of light that comes by way of its scattering, and of all light.
    pub sent_on: [f32; 2],
}

impl Arrival {
    fn is_in_medium(&self) -> bool {
        self.normal == Vec3::ZERO
    }
}

/// The parts that a guide is put together from.
struct Learner<'a> {
    arrivals: &'a [Arrival],
    /// The boxes of the grid that they are in, where they are in one.
    places: Vec<BoxIndex>,
    most_arrivals: usize,
}

/// A box by its numbers along the axes, which are below [`MOST_BOXES`].
type BoxIndex = [u16; 3];

/// Boxes of which the same is known.
struct Cell {
    facing: u32,
    region: Region,
    words: [u32; CELL_WORDS],
}

/// Learns a guide; the same of the same arrivals in the same order. None where there are too few.
pub fn learn(arrivals: &[Arrival]) -> Option<Guide> {
    if arrivals.len() < FEWEST_ARRIVALS {
        return None;
    }
    let grid = CellGrid::around(arrivals.par_iter().map(|arrival| arrival.position.as_dvec3()), MOST_BOXES);
    let place = |arrival: &Arrival| {
        let place = grid.place(arrival.position.as_dvec3())?;
        let facing = if arrival.is_in_medium() { GUIDE_FACING_IN_MEDIA } else { facing(arrival.normal.as_dvec3()) };
        Some((facing as usize, place.map(|number| number as u16)))
    };
    let placed: Vec<Option<(usize, BoxIndex)>> = arrivals.par_iter().map(place).collect();
    let mut of_facings: [Vec<u32>; GUIDE_FACINGS] = Default::default();
    for (number, facing) in placed.iter().enumerate().filter_map(|(number, placed)| Some((number, placed.as_ref()?.0))) {
        of_facings[facing].push(number as u32);
    }
    let places = placed.into_par_iter().map(|placed| placed.map_or_else(BoxIndex::default, |(_, place)| place)).collect();
    let learner = Learner { arrivals, places, most_arrivals: MOST_ARRIVALS.max(2 * arrivals.len() / MOST_CELLS) };
    let of_facing = |(facing, members): (usize, Vec<u32>)| learner.cells(facing as u32, grid.region(), &members);
    let cells: Vec<Cell> = of_facings.into_par_iter().enumerate().flat_map_iter(of_facing).collect();
    (!cells.is_empty()).then(|| guide(&grid, &cells))
}

fn guide(grid: &CellGrid, cells: &[Cell]) -> Guide {
    let mut index = grid.empty_index(GUIDE_FACINGS);
    for (number, cell) in cells.iter().enumerate() {
        grid.fill(&mut index, cell.facing, cell.region, number as u32 + 1);
    }
    let mut words = grid.table(&index);
    words.extend(cells.iter().flat_map(|cell| cell.words));
    Guide { words }
}

impl Learner<'_> {
    /// Cuts a region in two for as long as both halves have enough arrivals, and makes cells of what is left.
    fn cells(&self, facing: u32, region: Region, members: &[u32]) -> Vec<Cell> {
        if members.len() < FEWEST_ARRIVALS {
            return Vec::new();
        }
        let mut axes = [0, 1, 2];
        axes.sort_by_key(|&axis| std::cmp::Reverse(region[axis][1] - region[axis][0]));
        for axis in axes.into_iter().filter(|_| members.len() > self.most_arrivals) {
            let [first, end] = region[axis];
            if end - first < 2 {
                continue;
            }
            let middle = first + (end - first) / 2;
            let is_before = |number: u32| u32::from(self.places[number as usize][axis]) < middle;
            let (before, behind): (Vec<u32>, Vec<u32>) = members.iter().partition(|number| is_before(**number));
            let is_enough = |part: &[u32]| part.is_empty() || part.len() >= self.most_arrivals / 8;
            if is_enough(&before) && is_enough(&behind) {
                let half = |range: [u32; 2], part: &[u32]| {
                    let mut half = region;
                    half[axis] = range;
                    self.cells(facing, half, part)
                };
                let (mut cells, rest) = rayon::join(|| half([first, middle], &before), || half([middle, end], &behind));
                cells.extend(rest);
                return cells;
            }
        }
        self.cell(facing, members).map(|words| Cell { facing, region, words }).into_iter().collect()
    }

    /// The words of a cell. None where no light arrives.
    fn cell(&self, facing: u32, members: &[u32]) -> Option<[u32; CELL_WORDS]> {
        let arrivals = || members.iter().map(|&number| &self.arrivals[number as usize]);
        let (axis, domain) = if facing == GUIDE_FACING_IN_MEDIA {
            (0, Domain::Sphere)
        } else {
            let normal: DVec3 = arrivals().map(|arrival| arrival.normal.as_dvec3()).sum();
            let axis = packed_axis(normal.try_normalize()?);
            (axis, Domain::Hemisphere(Frame::around(unpacked_axis(axis))))
        };
        // A direction is worth drawing in proportion to the root of what its squared radiance is on average: that covers what the rest of the
        // path will scatter as well (Rath et al. 2020).
        let mut squares = [0.0; BINS];
        for arrival in arrivals() {
            let cosine = if arrival.is_in_medium() { 1.0 } else { f64::from(arrival.wi.dot(arrival.normal)) };
            if let Some(((row, column), _)) = domain.bin(arrival.wi.as_dvec3())
                && cosine > 0.0
            {
                squares[(row * GUIDE_COLUMNS + column) as usize] +=
                    f64::from(arrival.radiance).powi(2) * cosine / f64::from(arrival.pdf);
            }
        }
        let worths = spilled(&squares.map(f64::sqrt));
        let total: f64 = worths.iter().sum();
        if total <= 0.0 || !total.is_finite() {
            return None;
        }
        let even = (DOUBT / (DOUBT + members.len() as f64)).max(LEAST_EVEN_SHARE);
        let shares = worths.map(|worth| (1.0 - even) * worth / total + even / BINS as f64);
        let count = members.len() as f64;
        let sent_on = [0, 1].map(|which| arrivals().map(|arrival| f64::from(arrival.sent_on[which])).sum::<f64>() / count);
        Some(packed_cell(axis, &shares, sent_on))
    }
}

/// Every bin with a little of its neighbours.
fn spilled(bins: &[f64; BINS]) -> [f64; BINS] {
    let [rows, columns] = [GUIDE_ROWS as usize, GUIDE_COLUMNS as usize];
    std::array::from_fn(|index| {
        let (row, column) = (index / columns, index % columns);
        let at = |row: usize, column: usize| bins[row * columns + column];
        let sides = [at(row, (column + 1) % columns), at(row, (column + columns - 1) % columns)];
        // Across the axis, and at the horizon, a bin is its own neighbour.
        let rest = [at(row.saturating_sub(1), column), at((row + 1).min(rows - 1), column)];
        (1.0 - 4.0 * SPILL) * bins[index] + SPILL * (sides[0] + sides[1] + rest[0] + rest[1])
    })
}

/// A cell's words: the shares, which sum to one, in 65536ths, none of them 0.
fn packed_cell(axis: u32, shares: &[f64; BINS], sent_on: [f64; 2]) -> [u32; CELL_WORDS] {
    let free = f64::from(WHOLE - BINS as u32);
    let mut words = [axis; CELL_WORDS];
    let (mut before, mut start) = (0.0, 0);
    for (index, share) in shares.iter().enumerate() {
        before += share;
        let is_last = index + 1 == BINS;
        let end = if is_last { WHOLE } else { index as u32 + 1 + (f64::min(before, 1.0) * free).round() as u32 };
        words[1 + index] = start | (end - start) << 16;
        start = end;
    }
    for (word, sent_on) in words[1 + BINS..].iter_mut().zip(sent_on) {
        *word = (sent_on as f32).to_bits();
    }
    words
}
