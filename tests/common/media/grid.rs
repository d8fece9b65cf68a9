//! Optical depths of grids of density along straight lines, exact but for rounding.
//!
//! Places are in the grid's index space: value (i, j, k) stands at the point (i, j, k). A renderer's convention is a map into this space; an optical
//! depth then scales by how much the map stretches the line.

/// How values are read between the points at which they are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    Nearest,
    Trilinear,
}

/// Values beyond the grid's own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outside {
    /// The values at the border go on.
    Clamped,
    Zero,
}

/// A grid of values; the first index runs fastest.
#[derive(Debug, Clone)]
pub struct Grid {
    pub size: [usize; 3],
    pub values: Vec<f64>,
    pub interpolation: Interpolation,
    pub outside: Outside,
}

impl Grid {
    fn stored(&self, index: [i64; 3]) -> f64 {
        let mut place = [0; 3];
        for axis in 0..3 {
            let last = self.size[axis] as i64 - 1;
            if self.outside == Outside::Zero && !(0..=last).contains(&index[axis]) {
                return 0.0;
            }
            place[axis] = index[axis].clamp(0, last) as usize;
        }
        self.values[place[0] + self.size[0] * (place[1] + self.size[1] * place[2])]
    }

    /// The density at a point.
    pub fn density(&self, point: [f64; 3]) -> f64 {
        match self.interpolation {
            Interpolation::Nearest => self.stored(point.map(|x| x.round() as i64)),
            Interpolation::Trilinear => {
                let corner = point.map(|x| x.floor() as i64);
                let part: [f64; 3] = std::array::from_fn(|axis| point[axis] - corner[axis] as f64);
                let of = |bits: usize| {
                    let upper: [bool; 3] = std::array::from_fn(|axis| bits >> axis & 1 == 1);
                    let weight: f64 = (0..3).map(|axis| if upper[axis] { part[axis] } else { 1.0 - part[axis] }).product();
                    weight * self.stored(std::array::from_fn(|axis| corner[axis] + i64::from(upper[axis])))
                };
                (0..8).map(of).sum()
            }
        }
    }

    /// The integral of the density over origin + t · direction, t from `from` to `to`, with respect to t. The line is cut where it goes from one
    /// cell to the next. Within a cell the density is a polynomial of degree 3 of t, for which Gauss's rule of two points is exact.
    pub fn integral(&self, origin: [f64; 3], direction: [f64; 3], [from, to]: [f64; 2]) -> f64 {
        let at = |t: f64| -> [f64; 3] { std::array::from_fn(|axis| origin[axis] + t * direction[axis]) };
        let shift = if self.interpolation == Interpolation::Nearest { 0.5 } else { 0.0 };
        let mut cuts = vec![from, to];
        for axis in 0..3 {
            let ends = [at(from)[axis] + shift, at(to)[axis] + shift];
            let [low, high] = [ends[0].min(ends[1]).ceil() as i64, ends[0].max(ends[1]).floor() as i64];
            if direction[axis] != 0.0 {
                cuts.extend((low..=high).map(|plane| (plane as f64 - shift - origin[axis]) / direction[axis]));
            }
        }
        cuts.retain(|cut| (from..=to).contains(cut));
        cuts.sort_by(f64::total_cmp);
        let offset = 0.5 / 3f64.sqrt();
        cuts.windows(2)
            .map(|pair| {
                let (middle, length) = (0.5 * (pair[0] + pair[1]), pair[1] - pair[0]);
                0.5 * length * (self.density(at(middle - offset * length)) + self.density(at(middle + offset * length)))
            })
            .sum()
    }
}
