//! The coarse cells that a ray crosses, one after the other, with the bounds of the values there.
//!
//! The arithmetic, which shaders can do the same way: the ray is taken to index space, where it is at `origin + distance * direction` with the
//! distance of the medium's space. It crosses a plane `x = p` at `(p - origin.x) / direction.x`, and never where `direction.x` is 0. The grid's
//! box is between the largest distance to its three near planes and the smallest to its three far ones. The first cell is that of the point where
//! the ray enters, clamped to the grid. A cell ends at the nearest of the three planes ahead, `min((c + 1) * s, n)` where the direction grows
//! and `c * s` where it falls, each computed from the number of the cell so that no error adds up; then the cell's number on that axis
//! changes by one. A distance below the one before it, which rounding may give, counts as that one, and a cell without length is left out.
//! Segments thus tile the ray, each ending with the very number that the next begins with.

use glam::DVec3;

use super::majorant::Majorants;
use super::placed::{Outside, Volume};

/// A part of a ray over which values have the same bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Distance at which it begins, in lengths of the ray's direction.
    pub entry: f64,
    /// Distance at which it ends; above `entry`.
    pub exit: f64,
    /// No value in it is smaller.
    pub minimum: f64,
    /// No value in it is larger: a majorant.
    pub maximum: f64,
    /// The coarse cell; None outside of the grid.
    pub cell: Option<[u32; 3]>,
}

/// An iterator over the segments of a ray, from near to far.
#[derive(Debug, Clone)]
pub struct Crossing<'v> {
    volume: &'v Volume,
    majorants: &'v Majorants,
    /// The ray in index space.
    origin: DVec3,
    direction: DVec3,
    /// Distance up to which segments were reported, and the one at which they end.
    at: f64,
    end: f64,
    /// Distances at which the ray is in the grid's box; equal ones: it is not.
    within: [f64; 2],
    /// The coarse cell that comes next.
    cell: [i64; 3],
}

impl Volume {
    /// The segments of the ray from `origin` along `direction` in the medium's space, between the distances `entry` and `exit`, the latter perhaps
    /// infinite. `majorants` are those of this volume's grid and filter.
    pub fn crossing<'v>(
        &'v self,
        majorants: &'v Majorants,
        [origin, direction]: [DVec3; 2],
        [entry, exit]: [f64; 2],
    ) -> Crossing<'v> {
        let origin = self.to_index.transform_point3(origin);
        let direction = self.to_index.transform_vector3(direction);
        let size = self.grid.resolution().map(f64::from);
        let (mut near, mut far) = (entry, exit);
        for axis in 0..3 {
            let (start, step) = (origin[axis], direction[axis]);
            if step == 0.0 {
                if !(0.0..=size[axis]).contains(&start) {
                    far = near;
                }
                continue;
            }
            let [first, second] = [(0.0 - start) / step, (size[axis] - start) / step];
            near = near.max(first.min(second));
            far = far.min(first.max(second));
        }
        // A ray that misses the box is outside of it from end to end.
        let within = if near < far { [near, far] } else { [exit, exit] };
        let side = f64::from(majorants.side());
        let point = origin + direction * within[0];
        let cell = std::array::from_fn(|axis| {
            let last = i64::from(majorants.resolution()[axis]) - 1;
            ((point[axis] / side).floor() as i64).clamp(0, last)
        });
        Crossing { volume: self, majorants, origin, direction, at: entry, end: exit, within, cell }
    }
}

impl Crossing<'_> {
    /// The segment outside of the box that ends here.
    fn outside(&mut self, exit: f64) -> Segment {
        let scale = self.volume.scale;
        let [minimum, maximum] = match self.volume.outside {
            Outside::Border => self.majorants.overall().map(f64::from),
            Outside::Constant(value) => [value.min_component(), value.max_component()],
        };
        let entry = std::mem::replace(&mut self.at, exit);
        Segment { entry, exit, minimum: minimum * scale, maximum: maximum * scale, cell: None }
    }

    /// Distance at which the ray leaves the current cell along an axis.
    fn leaves(&self, axis: usize) -> f64 {
        let (step, side) = (self.direction[axis], i64::from(self.majorants.side()));
        if step == 0.0 {
            return f64::INFINITY;
        }
        let size = i64::from(self.volume.grid.resolution()[axis]);
        let plane = if step > 0.0 { ((self.cell[axis] + 1) * side).min(size) } else { self.cell[axis] * side };
        (plane as f64 - self.origin[axis]) / step
    }
}

impl Iterator for Crossing<'_> {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        let [near, far] = self.within;
        if self.at < near {
            return Some(self.outside(near));
        }
        while self.at < far {
            let distances: [f64; 3] = std::array::from_fn(|axis| self.leaves(axis));
            let nearest = |first: usize, second: usize| if distances[second] < distances[first] { second } else { first };
            let axis = nearest(nearest(0, 1), 2);
            let (entry, cell) = (self.at, self.cell.map(|cell| cell as u32));
            self.cell[axis] += if self.direction[axis] > 0.0 { 1 } else { -1 };
            let is_last = !(0..i64::from(self.majorants.resolution()[axis])).contains(&self.cell[axis]);
            self.at = if is_last { far } else { distances[axis].clamp(entry, far) };
            if self.at > entry {
                let [minimum, maximum] = self.majorants.of_cell(cell).map(|bound| f64::from(bound) * self.volume.scale);
                return Some(Segment { entry, exit: self.at, minimum, maximum, cell: Some(cell) });
            }
        }
        (self.at < self.end).then(|| self.outside(self.end))
    }
}
