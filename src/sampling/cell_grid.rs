//! A grid of boxes over a scene, for each way that a surface can face: what the tables of a guide and of cells of lights begin with.
//!
//! Words of such a table, because each word that a kernel loads costs: where the grid begins, and the inverse size of its boxes, as the bits of
//! f32; how many boxes it has along x, y and z; the table's first word behind the index; then the index, a word for each facing and box, x
//! first, then y, z and the facing. `shaders/shading/cell_grid.wgsl` is the device's half, and computes the same bits.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Words before the index.
pub const GRID_HEADER_WORDS: u32 = 8;
/// Ways that a surface can face.
pub const FACINGS: usize = 6;
/// By these the components of a normal are weighed where the largest says which way it faces: none of 45° lies on a border.
pub const FACING_WEIGHT_Y: f32 = 1.0078125;
pub const FACING_WEIGHT_Z: f32 = 1.015625;
/// Share of the points that lie outside the grid along each axis on either side: far ones would make its boxes too large.
const OUTLIERS: f64 = 0.002;

/// Boxes of one facing, a range along each axis.
pub type Region = [[u32; 2]; 3];

/// The place and the size of the boxes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellGrid {
    origin: Vec3,
    inverse: f32,
    counts: [u32; 3],
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

impl CellGrid {
    /// Around all points but a few, with so many boxes at most for each facing; the same of the same points.
    pub fn around(points: impl ParallelIterator<Item = DVec3> + Clone, most_boxes: usize) -> Self {
        let [low, high] = bounds(points);
        let size = (high - low).max(DVec3::ZERO);
        // Flat scenes have some depth all the same; and no wall stands on the border between two boxes by a round number.
        let extent = (size.max(DVec3::splat(size.max_element() * 1e-3)) * 1.017).max(DVec3::splat(1e-6));
        let origin = (low - extent * 0.00731).as_vec3();
        let mut side = (extent.element_product() / most_boxes as f64).cbrt();
        let counts = loop {
            let counts = (extent / side).ceil().max(DVec3::ONE);
            if counts.element_product() <= most_boxes as f64 {
                break counts.to_array().map(|count| count as u32);
            }
            side *= 1.03;
        };
        Self { origin, inverse: (1.0 / side) as f32, counts }
    }

    /// That of a table.
    pub fn of_table(words: &[u32]) -> Self {
        let number = |word: usize| f32::from_bits(words[word]);
        Self { origin: Vec3::new(number(0), number(1), number(2)), inverse: number(3), counts: [words[4], words[5], words[6]] }
    }

    /// A table up to its cells, given the index.
    pub fn table(&self, index: &[u32]) -> Vec<u32> {
        let mut words = self.origin.to_array().map(f32::to_bits).to_vec();
        words.push(self.inverse.to_bits());
        words.extend(self.counts);
        words.push(GRID_HEADER_WORDS + index.len() as u32);
        words.extend(index);
        words
    }

    /// How many boxes there are along each axis.
    pub fn counts(&self) -> [u32; 3] {
        self.counts
    }

    /// All boxes.
    pub fn region(&self) -> Region {
        self.counts.map(|count| [0, count])
    }

    /// An index of 0 for all boxes of so many facings.
    pub fn empty_index(&self, facings: usize) -> Vec<u32> {
        vec![0; facings * self.counts.iter().product::<u32>() as usize]
    }

    /// The box that a point is in. In f32, as the device has it: of a point far from where the grid begins, it loses more than the error of
    /// the point, and such errors alone are those by which verification explains that two devices come to different boxes.
    pub fn place(&self, position: DVec3) -> Option<[u32; 3]> {
        let place = (position.as_vec3() - self.origin) * self.inverse;
        let inside = |axis: usize| place[axis] >= 0.0 && place[axis] < self.counts[axis] as f32;
        (0..3).all(inside).then(|| place.to_array().map(|place| place as u32))
    }

    /// Position in the index of the box of a point on a surface that faces so.
    pub fn index_of(&self, facing: u32, position: DVec3) -> Option<usize> {
        let [x, y, z] = self.place(position)?;
        Some(self.row(facing, y, z) + x as usize)
    }

    /// Writes a number for all boxes of a region.
    pub fn fill(&self, index: &mut [u32], facing: u32, [xs, ys, zs]: Region, number: u32) {
        for z in zs[0]..zs[1] {
            for y in ys[0]..ys[1] {
                let row = self.row(facing, y, z);
                index[row + xs[0] as usize..row + xs[1] as usize].fill(number);
            }
        }
    }

    fn row(&self, facing: u32, y: u32, z: u32) -> usize {
        let [width, height, depth] = self.counts;
        (((facing * depth + z) * height + y) * width) as usize
    }
}

/// The box around all points but a few.
fn bounds(points: impl ParallelIterator<Item = DVec3> + Clone) -> [DVec3; 2] {
    let along = |axis: usize| {
        let mut places: Vec<f64> = points.clone().map(|point| point[axis]).collect();
        let left_out = (OUTLIERS * places.len() as f64) as usize;
        let last = places.len().saturating_sub(1).saturating_sub(left_out);
        [left_out, last]
            .map(|place| if places.is_empty() { 0.0 } else { *places.select_nth_unstable_by(place, f64::total_cmp).1 })
    };
    let [x, y, z] = [along(0), along(1), along(2)];
    [DVec3::new(x[0], y[0], z[0]), DVec3::new(x[1], y[1], z[1])]
}
