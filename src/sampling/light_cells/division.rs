//! Space cut into cells, by the points that shading was seen to happen at.

use rayon::prelude::*;

use super::light_sample_context::LightSampleContext;
use super::list::{Reaching, slots};
use super::table::LightCells;
use crate::sampling::cell_grid::{CellGrid, FACINGS, Region};

/// Boxes of the grid at most, for each of the facings.
const MOST_BOXES: usize = 1 << 15;
/// Cells that there are about at most.
const MOST_CELLS: usize = 1024;
/// Points of a cell from which on it is cut in two, where there are few points.
const MOST_POINTS: usize = 16;
/// How many boxes far what is known of a cell is taken to hold where nothing else is known.
const SPREAD: u32 = 2;

/// A grid of boxes, and the cells that they belong to.
#[derive(Debug, Clone)]
pub struct Division {
    grid: CellGrid,
    /// The cells' numbers from 1, by facing and box; 0 where there is none.
    index: Vec<u32>,
    /// The numbers of the points in each cell.
    cells: Vec<Vec<u32>>,
}

impl Division {
    /// Divides some points; equal points in equal order give equal divisions.
    pub fn new(points: &[LightSampleContext]) -> Self {
        let grid = CellGrid::around(points.par_iter().map(|point| point.point), MOST_BOXES);
        let mut division = Self { grid, index: grid.empty_index(FACINGS), cells: Vec::new() };
        let mut of_facings: [Vec<u32>; FACINGS] = Default::default();
        for (number, point) in points.iter().enumerate() {
            if grid.place(point.point).is_some() {
                of_facings[point.facing as usize].push(number as u32);
            }
        }
        let most_points = MOST_POINTS.max(points.len() / MOST_CELLS);
        for (facing, members) in of_facings.into_iter().enumerate() {
            division.divide(points, most_points, (facing as u32, grid.region()), members);
        }
        division
    }

    /// The numbers of the points in each cell.
    pub fn cells(&self) -> &[Vec<u32>] {
        &self.cells
    }

    /// Cuts boxes of a facing in two, across where they are longest, for as long as they hold enough points; what is left are cells.
    fn divide(&mut self, points: &[LightSampleContext], most_points: usize, (facing, region): (u32, Region), members: Vec<u32>) {
        if members.is_empty() {
            return;
        }
        let axis = (0..3).fold(0, |best, axis| if length(region[axis]) > length(region[best]) { axis } else { best });
        let [first, end] = region[axis];
        if members.len() <= most_points || end - first < 2 {
            return self.add_cell(facing, region, members);
        }
        let middle = first + (end - first) / 2;
        let is_before = |number: &u32| self.grid.place(points[*number as usize].point).is_some_and(|place| place[axis] < middle);
        let (before, behind): (Vec<u32>, Vec<u32>) = members.into_iter().partition(is_before);
        for (range, part) in [([first, middle], before), ([middle, end], behind)] {
            let mut half = region;
            half[axis] = range;
            self.divide(points, most_points, (facing, half), part);
        }
    }

    fn add_cell(&mut self, facing: u32, region: Region, members: Vec<u32>) {
        self.cells.push(members);
        let number = self.cells.len() as u32;
        self.grid.fill(&mut self.index, facing, region, number);
    }

    /// The table, given what reaches each cell.
    pub fn table(&self, reaching: &[Vec<Reaching>]) -> LightCells {
        let mut lists = Vec::new();
        // Cells that no light reaches have no list.
        let mut known = 0;
        let numbers: Vec<u32> = reaching
            .iter()
            .map(|lights| {
                let Some(slots) = slots(lights) else { return 0 };
                lists.extend(slots);
                known += 1;
                known
            })
            .collect();
        if known == 0 {
            return LightCells::default();
        }
        let index: Vec<u32> =
            self.index.iter().map(|&number| number.checked_sub(1).map_or(0, |cell| numbers[cell as usize])).collect();
        let mut words = self.grid.table(&(0..SPREAD).fold(index, |index, _| self.spread(&index)));
        words.extend(lists);
        LightCells { words }
    }
}

impl Division {
    /// The numbers of cells in the boxes, with those of neighbours where there is none: light is sampled there as well, only less often.
    fn spread(&self, index: &[u32]) -> Vec<u32> {
        let [width, height, depth] = self.grid.counts().map(|count| count as usize);
        let steps = [(1, width), (width, height), (width * height, depth)];
        let filled = |(place, &number): (usize, &u32)| {
            let neighbours = steps.into_iter().flat_map(|(step, count)| {
                let along = place / step % count;
                let [before, behind] = [along > 0, along + 1 < count];
                [before.then(|| index[place - step]), behind.then(|| index[place + step])]
            });
            if number > 0 { number } else { neighbours.flatten().find(|number| *number > 0).unwrap_or(0) }
        };
        index.iter().enumerate().map(filled).collect()
    }
}

fn length([first, end]: [u32; 2]) -> u32 {
    end - first
}
