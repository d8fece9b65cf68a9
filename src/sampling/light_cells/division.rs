//! Space cut into cells, by the points that shading was seen to happen at.

use glam::DVec3;

use super::list::{Reaching, slots};
use super::lit_point::LitPoint;
use super::table::{FACINGS, HEADER, LIGHT_CELLS_HEADER_WORDS, LightCells};

/// Boxes of the grid at most, for each of the facings.
const MOST_BOXES: usize = 1 << 15;
/// Cells that there are about at most.
const MOST_CELLS: usize = 1024;
/// Points of a cell from which on it is cut in two, where there are few points.
const MOST_POINTS: usize = 16;
/// Share of the points that lie outside the grid along each axis on either side: far ones would make its boxes too large.
const OUTLIERS: f64 = 0.002;

/// How many boxes far what is known of a cell is taken to hold where nothing else is known.
const SPREAD: u32 = 2;

/// Boxes, a range along each axis.
type Region = [[u32; 2]; 3];

/// A grid of boxes, and the cells that they belong to.
#[derive(Debug, Clone)]
pub struct Division {
    origin: DVec3,
    inverse: f64,
    counts: [u32; 3],
    /// The cells' numbers from 1, by facing and box; 0 where there is none.
    index: Vec<u32>,
    /// The numbers of the points in each cell.
    cells: Vec<Vec<u32>>,
}

impl Division {
    /// Of some points; the same of the same points in the same order.
    pub fn new(points: &[LitPoint]) -> Self {
        let [low, high] = bounds(points);
        let size = (high - low).max(DVec3::ZERO);
        // Flat scenes have some depth all the same; and no wall stands on the border between two boxes by a round number.
        let extent = (size.max(DVec3::splat(size.max_element() * 1e-3)) * 1.017).max(DVec3::splat(1e-6));
        let origin = (low - extent * 0.00731).as_vec3().as_dvec3();
        let mut side = (extent.element_product() / MOST_BOXES as f64).cbrt();
        let counts = loop {
            let counts = (extent / side).ceil().max(DVec3::ONE);
            if counts.element_product() <= MOST_BOXES as f64 {
                break counts.to_array().map(|count| count as u32);
            }
            side *= 1.03;
        };
        let inverse = f64::from((1.0 / side) as f32);
        let boxes = counts.iter().product::<u32>() as usize;
        let mut division = Self { origin, inverse, counts, index: vec![0; FACINGS * boxes], cells: Vec::new() };
        let mut of_facings: [Vec<u32>; FACINGS] = Default::default();
        for (number, point) in points.iter().enumerate() {
            if division.place(point.point).is_some() {
                of_facings[point.facing as usize].push(number as u32);
            }
        }
        let most_points = MOST_POINTS.max(points.len() / MOST_CELLS);
        for (facing, members) in of_facings.into_iter().enumerate() {
            division.divide(points, most_points, (facing as u32, counts.map(|count| [0, count])), members);
        }
        division
    }

    /// The numbers of the points in each cell.
    pub fn cells(&self) -> &[Vec<u32>] {
        &self.cells
    }

    /// The box that a point is in.
    fn place(&self, position: DVec3) -> Option<[u32; 3]> {
        let place = (position - self.origin) * self.inverse;
        let inside = |axis: usize| place[axis] >= 0.0 && place[axis] < f64::from(self.counts[axis]);
        (0..3).all(inside).then(|| place.to_array().map(|place| place as u32))
    }

    /// Cuts boxes of a facing in two, across where they are longest, for as long as they hold enough points; what is left are cells.
    fn divide(&mut self, points: &[LitPoint], most_points: usize, (facing, region): (u32, Region), members: Vec<u32>) {
        if members.is_empty() {
            return;
        }
        let axis = (0..3).fold(0, |best, axis| if length(region[axis]) > length(region[best]) { axis } else { best });
        let [first, end] = region[axis];
        if members.len() <= most_points || end - first < 2 {
            return self.add_cell(facing, region, members);
        }
        let middle = first + (end - first) / 2;
        let is_before = |number: &u32| self.place(points[*number as usize].point).is_some_and(|place| place[axis] < middle);
        let (before, behind): (Vec<u32>, Vec<u32>) = members.into_iter().partition(is_before);
        for (range, part) in [([first, middle], before), ([middle, end], behind)] {
            let mut half = region;
            half[axis] = range;
            self.divide(points, most_points, (facing, half), part);
        }
    }

    fn add_cell(&mut self, facing: u32, [xs, ys, zs]: Region, members: Vec<u32>) {
        self.cells.push(members);
        let number = self.cells.len() as u32;
        let [width, height, depth] = self.counts;
        for z in zs[0]..zs[1] {
            for y in ys[0]..ys[1] {
                let row = ((facing * depth + z) * height + y) * width;
                self.index[(row + xs[0]) as usize..(row + xs[1]) as usize].fill(number);
            }
        }
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
        let mut words = self.origin.as_vec3().to_array().map(f32::to_bits).to_vec();
        words.push((self.inverse as f32).to_bits());
        words.extend(self.counts);
        words.push(LIGHT_CELLS_HEADER_WORDS + self.index.len() as u32);
        debug_assert_eq!(words.len(), HEADER);
        let index: Vec<u32> =
            self.index.iter().map(|&number| number.checked_sub(1).map_or(0, |cell| numbers[cell as usize])).collect();
        words.extend((0..SPREAD).fold(index, |index, _| self.spread(&index)));
        words.extend(lists);
        LightCells { words }
    }
}

impl Division {
    /// The numbers of cells in the boxes, with those of neighbours where there is none: light is sampled there as well, only less often.
    fn spread(&self, index: &[u32]) -> Vec<u32> {
        let [width, height, depth] = self.counts.map(|count| count as usize);
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

/// The box around all points but a few.
fn bounds(points: &[LitPoint]) -> [DVec3; 2] {
    let left_out = (OUTLIERS * points.len() as f64) as usize;
    let along = |axis: usize| {
        let mut places: Vec<f64> = points.iter().map(|point| point.point[axis]).collect();
        places.sort_unstable_by(f64::total_cmp);
        let end = |place: usize| places.get(place).copied().unwrap_or_default();
        [end(left_out), end((places.len().saturating_sub(1)).saturating_sub(left_out))]
    };
    let [x, y, z] = [along(0), along(1), along(2)];
    [DVec3::new(x[0], y[0], z[0]), DVec3::new(x[1], y[1], z[1])]
}
