//! Choice of a point of the unit square with a density that is constant over each cell of a grid.
//!
//! The cumulative weights are integers, so that every device chooses the same cell and the stated density is exactly the density of
//! what is drawn, whatever was lost in rounding the weights. The inverse of a cumulative distribution keeps the samples' order, and so
//! the evenness of a sequence, which an alias table would not.

/// Length of the line that borders divide: the upper 31 of 32 random bits are a point of it.
const LINE: u32 = 1 << 31;

/// A density over [0, 1)², constant in each of `width` × `height` cells of equal size.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GridDistribution {
    pub width: u32,
    pub height: u32,
    /// Borders of the rows on a line of length 2³¹: `height` + 1 of them, from 0 to 2³¹.
    pub rows: Vec<u32>,
    /// Likewise, row by row, the `width` + 1 borders of the row's cells. All 0 where the row has no weight.
    pub columns: Vec<u32>,
}

/// A point of the unit square that was drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridSample {
    pub u: f64,
    pub v: f64,
    /// Per unit of the square's area.
    pub density: f64,
}

impl GridDistribution {
    /// `weights` are those of the cells, row by row, finite and not negative. A cell has a density above 0 if and only if its weight
    /// is above 0. None where no weight is.
    pub fn new(width: u32, height: u32, weights: &[f64]) -> Option<Self> {
        let rows: Vec<&[f64]> = weights.chunks_exact(width as usize).collect();
        let row_weights: Vec<f64> = rows.iter().map(|row| row.iter().sum()).collect();
        let columns = rows.iter().flat_map(|row| borders(row)).collect();
        (row_weights.iter().sum::<f64>() > 0.0).then(|| Self { width, height, rows: borders(&row_weights), columns })
    }

    /// The point that 32 uniform bits each for u and v make.
    pub fn sample(&self, bits_u: u32, bits_v: u32) -> GridSample {
        let (row, v) = inverse(&self.rows, bits_v >> 1);
        let (column, u) = inverse(self.row(row), bits_u >> 1);
        GridSample {
            u: (column as f64 + u) / f64::from(self.width),
            v: (row as f64 + v) / f64::from(self.height),
            density: self.cell_density(row, column),
        }
    }

    /// Density with which [`GridDistribution::sample`] draws the point, per unit of the square's area.
    pub fn density(&self, u: f64, v: f64) -> f64 {
        let cell = |x: f64, count: u32| ((x * f64::from(count)) as usize).min(count as usize - 1);
        self.cell_density(cell(v, self.height), cell(u, self.width))
    }

    fn row(&self, row: usize) -> &[u32] {
        let length = self.width as usize + 1;
        &self.columns[row * length..(row + 1) * length]
    }

    fn cell_density(&self, row: usize, column: usize) -> f64 {
        let share = |borders: &[u32], index: usize| f64::from(borders[index + 1] - borders[index]) / f64::from(LINE);
        share(&self.rows, row) * share(self.row(row), column) * f64::from(self.width) * f64::from(self.height)
    }
}

/// Cumulative weights scaled to the line. Whatever has a weight gets a part of it, be it the smallest; what has none gets none.
fn borders(weights: &[f64]) -> Vec<u32> {
    let total: f64 = weights.iter().sum();
    if total <= 0.0 {
        return vec![0; weights.len() + 1];
    }
    let positive = weights.iter().filter(|&&weight| weight > 0.0).count() as u32;
    let shared = f64::from(LINE - positive);
    let (mut sum, mut count) = (0.0, 0);
    let following = weights.iter().map(|&weight| {
        sum += weight;
        count += u32::from(weight > 0.0);
        if count == positive { LINE } else { (sum / total * shared) as u32 + count }
    });
    std::iter::once(0).chain(following).collect()
}

/// The interval that holds the point, and where in it the point lies, in (0, 1).
fn inverse(borders: &[u32], point: u32) -> (usize, f64) {
    let index = borders.partition_point(|&border| border <= point) - 1;
    let (low, high) = (borders[index], borders[index + 1]);
    (index, (f64::from(point - low) + 0.5) / f64::from(high - low))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(width: u32, height: u32, weights: &[f64]) {
        let grid = GridDistribution::new(width, height, weights).expect("some weight is positive");
        let total: f64 = weights.iter().sum();
        let cells = f64::from(width * height);
        let mut integral = 0.0;
        for (index, weight) in weights.iter().enumerate() {
            let (x, y) = (index as u32 % width, index as u32 / width);
            let density = grid.density((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height));
            integral += density / cells;
            assert_eq!(density > 0.0, *weight > 0.0, "{weights:?}");
            assert!((density / cells - weight / total).abs() < 1e-6, "{density} for {weight} of {total}");
        }
        assert!((integral - 1.0).abs() < 1e-12, "{integral}");
        for bits in (0..=u32::MAX).step_by(9_999_991) {
            let point = grid.sample(bits, bits.wrapping_mul(0x9e37_79b9));
            assert_eq!(point.density, grid.density(point.u, point.v), "{point:?}");
            assert!(point.density > 0.0 && point.u < 1.0 && point.v < 1.0);
        }
        for bits in [0, u32::MAX] {
            assert!(grid.sample(bits, bits).density > 0.0);
        }
    }

    #[test]
    fn densities_are_those_of_the_weights_at_any_resolution() {
        check(1, 1, &[3.0]);
        check(2, 1, &[1.0, 2.0]);
        check(1, 3, &[0.0, 2.0, 0.0]);
        check(3, 2, &[1.0, 0.0, 5.0, 0.0, 0.0, 1e-30]);
        let weights: Vec<f64> = (0..40 * 30).map(|i| f64::from(i * 7919 % 1000)).collect();
        check(40, 30, &weights);
        let mut single = vec![0.0; 64];
        single[37] = 1e-12;
        check(8, 8, &single);
        assert_eq!(GridDistribution::new(2, 2, &[0.0; 4]), None);
    }

    #[test]
    fn frequencies_follow_the_weights() {
        let weights = [1.0, 0.0, 5.0, 0.25, 0.0, 3.75];
        let grid = GridDistribution::new(3, 2, &weights).expect("some weight is positive");
        let mut counts = [0_u32; 6];
        for i in 0..512_u32 {
            for j in 0..512_u32 {
                let point = grid.sample(i << 23 | 0x3f_ffff, j << 23 | 0x3f_ffff);
                counts[(point.v * 2.0) as usize * 3 + (point.u * 3.0) as usize] += 1;
            }
        }
        for (count, weight) in counts.into_iter().zip(weights) {
            assert!((f64::from(count) / f64::from(512 * 512) - weight / 10.0).abs() < 4e-3, "{counts:?}");
        }
    }
}
