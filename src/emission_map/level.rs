//! A grid of values over the unit square, and means over parts of it.

use glam::DVec2;

use crate::scene::TextureWrap;

/// Values row by row from the top, each of a cell of equal size.
#[derive(Debug, Clone)]
pub struct Level {
    pub width: usize,
    pub height: usize,
    pub values: Vec<f64>,
}

impl Level {
    fn at(&self, x: i64, y: i64, wrap: [TextureWrap; 2]) -> f64 {
        self.values[wrap[1].index(y, self.height) * self.width + wrap[0].index(x, self.width)]
    }

    /// So many times as fine, an even number, with the means of what is interpolated between the middles of cells: in each fine cell it is linear
    /// along either axis, so its mean is the value in the middle.
    pub fn interpolated(&self, times: usize, wrap: [TextureWrap; 2]) -> Self {
        let (width, height) = (times * self.width, times * self.height);
        // The cell before a fine cell's middle, and how far behind the middle of that cell it lies.
        let place = |fine: usize| {
            let at = (fine as f64 + 0.5) / times as f64 - 0.5;
            (at.floor() as i64, at - at.floor())
        };
        let value = |(x, along): (i64, f64), (y, down): (i64, f64)| {
            let row = |y: i64| (1.0 - along) * self.at(x, y, wrap) + along * self.at(x + 1, y, wrap);
            (1.0 - down) * row(y) + down * row(y + 1)
        };
        let values = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| value(place(x), place(y))).collect();
        Self { width, height, values }
    }

    /// With the mean over each cell of what is interpolated between the middles of cells.
    pub fn spread(&self, wrap: [TextureWrap; 2]) -> Self {
        let weighted = |before: f64, here: f64, after: f64| (before + 6.0 * here + after) / 8.0;
        let across = |x: i64, y: i64| weighted(self.at(x - 1, y, wrap), self.at(x, y, wrap), self.at(x + 1, y, wrap));
        let value = |x: i64, y: i64| weighted(across(x, y - 1), across(x, y), across(x, y + 1));
        let all = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x as i64, y as i64)));
        Self { values: all.map(|(x, y)| value(x, y)).collect(), ..*self }
    }

    /// This one, and then half as many cells along each axis again and again, down to one.
    pub fn coarser_ones(self) -> Vec<Self> {
        let mut levels = vec![self];
        while let Some(finest) = levels.last().filter(|level| level.width > 1 || level.height > 1) {
            let size = [finest.width, finest.height].map(|side| (side / 2).max(1));
            levels.push(finest.gathered(size));
        }
        levels
    }

    /// The means over cells of another grid, one as large or larger.
    fn gathered(&self, [width, height]: [usize; 2]) -> Self {
        let mut values = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let rows = shares(y, height, self.height);
                let of_row = |row: usize| {
                    shares(x, width, self.width)
                        .map(|(column, share)| share * self.values[row * self.width + column])
                        .sum::<f64>()
                };
                values.push(rows.map(|(row, share)| share * of_row(row)).sum());
            }
        }
        Self { width, height, values }
    }

    /// The mean over a convex part of the plane, which the square is repeated over as `wrap` says. Of a part without area, over its box. None where
    /// it lies over more than `most` cells along either axis.
    pub fn mean_over(&self, corners: &[DVec2], wrap: [TextureWrap; 2], most: f64) -> Option<f64> {
        let size = DVec2::new(self.width as f64, self.height as f64);
        let placed: Vec<DVec2> = corners.iter().map(|corner| *corner * size).collect();
        let low = placed.iter().copied().reduce(DVec2::min)?;
        let high = placed.iter().copied().reduce(DVec2::max)?;
        let (first, last) = (low.floor(), high.floor());
        // Beyond 2⁴⁰ cells numbers of cells are not exact; not finite ones fail too.
        let is_small = (last - first).max_element() < most && low.abs().max(high.abs()).max_element() < 1e12;
        if !is_small {
            return None;
        }
        let [x, y] = [first.x as i64..=last.x as i64, first.y as i64..=last.y as i64];
        let cells = || y.clone().flat_map(|y| x.clone().map(move |x| (x, y)));
        let (mut sum, mut area) = (0.0, 0.0);
        let mut part = Vec::new();
        for (x, y) in cells() {
            let overlap = clipped_area(&placed, DVec2::new(x as f64, y as f64), &mut part);
            if overlap > 0.0 {
                sum += overlap * self.at(x, y, wrap);
                area += overlap;
            }
        }
        if area > 1e-12 * (high - low).max_element().powi(2) {
            return Some(sum / area);
        }
        let count = cells().count() as f64;
        Some(cells().map(|(x, y)| self.at(x, y, wrap)).sum::<f64>() / count)
    }
}

/// The cells of the finer of two grids that lie in one of the coarser, and the share of it that each has.
fn shares(index: usize, coarse: usize, fine: usize) -> impl Iterator<Item = (usize, f64)> {
    // In units of 1 / (coarse · fine), so that borders are integers.
    let (low, high) = (index * fine, (index + 1) * fine);
    (low / coarse..high.div_ceil(coarse)).map(move |cell| {
        let common = high.min((cell + 1) * coarse) - low.max(cell * coarse);
        (cell, common as f64 / fine as f64)
    })
}

/// The area that a convex polygon has in common with the cell of side 1 at `low` (Sutherland and Hodgman 1974). `part` is working space.
fn clipped_area(polygon: &[DVec2], low: DVec2, part: &mut Vec<DVec2>) -> f64 {
    part.clear();
    part.extend(polygon.iter().map(|corner| *corner - low));
    let mut next: [DVec2; 12] = [DVec2::ZERO; 12];
    for (axis, is_upper) in [(0, false), (0, true), (1, false), (1, true)] {
        let inside = |point: DVec2| if is_upper { 1.0 - point[axis] } else { point[axis] };
        let mut count = 0;
        for index in 0..part.len() {
            let (here, after) = (part[index], part[(index + 1) % part.len()]);
            let (of_here, of_after) = (inside(here), inside(after));
            if of_here >= 0.0 {
                next[count] = here;
                count += 1;
            }
            if (of_here < 0.0) != (of_after < 0.0) {
                next[count] = here + (after - here) * (of_here / (of_here - of_after));
                count += 1;
            }
        }
        part.clear();
        part.extend_from_slice(&next[..count]);
    }
    let cross = |index: usize| part[index].perp_dot(part[(index + 1) % part.len()]);
    0.5 * (0..part.len()).map(cross).sum::<f64>().abs()
}
