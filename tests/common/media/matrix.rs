//! Square matrices, as small as a quadrature of angles.

/// A matrix of numbers, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    pub size: usize,
    values: Vec<f64>,
}

impl Matrix {
    pub fn new(size: usize, value: impl Fn(usize, usize) -> f64) -> Self {
        Self { size, values: (0..size * size).map(|place| value(place / size, place % size)).collect() }
    }

    pub fn diagonal(values: &[f64]) -> Self {
        Self::new(values.len(), |row, column| if row == column { values[row] } else { 0.0 })
    }

    pub fn identity(size: usize) -> Self {
        Self::diagonal(&vec![1.0; size])
    }

    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.size + column]
    }

    /// `self` + `factor` · `other`.
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        let values = self.values.iter().zip(&other.values).map(|(a, b)| a + factor * b).collect();
        Self { size: self.size, values }
    }

    pub fn times(&self, other: &Self) -> Self {
        let mut values = vec![0.0; self.values.len()];
        for (row, out) in self.values.chunks(self.size).zip(values.chunks_mut(self.size)) {
            for (factor, line) in row.iter().zip(other.values.chunks(self.size)) {
                out.iter_mut().zip(line).for_each(|(out, value)| *out += factor * value);
            }
        }
        Self { size: self.size, values }
    }

    /// The X of `self` · X = `right`, by elimination with row pivots.
    pub fn solve(&self, right: &Self) -> Self {
        let size = self.size;
        let mut rows: Vec<Vec<f64>> = (0..size)
            .map(|row| {
                (0..size).map(|column| self.at(row, column)).chain((0..size).map(|column| right.at(row, column))).collect()
            })
            .collect();
        for step in 0..size {
            let pivot = (step..size).max_by(|&a, &b| rows[a][step].abs().total_cmp(&rows[b][step].abs())).unwrap_or(step);
            rows.swap(step, pivot);
            let line = rows[step].clone();
            for row in &mut rows[step + 1..] {
                let factor = row[step] / line[step];
                if factor != 0.0 {
                    row[step..].iter_mut().zip(&line[step..]).for_each(|(value, above)| *value -= factor * above);
                }
            }
        }
        for step in (0..size).rev() {
            let diagonal = rows[step][step];
            rows[step][size..].iter_mut().for_each(|value| *value /= diagonal);
            let line = rows[step][size..].to_vec();
            for row in &mut rows[..step] {
                let factor = row[step];
                row[size..].iter_mut().zip(&line).for_each(|(value, below)| *value -= factor * below);
            }
        }
        Self { size, values: rows.into_iter().flat_map(|row| row[size..].to_vec()).collect() }
    }

    /// The largest absolute value.
    pub fn largest(&self) -> f64 {
        self.values.iter().fold(0.0, |largest, value| value.abs().max(largest))
    }

    /// The sums of the rows: the response to 1 everywhere.
    pub fn row_sums(&self) -> Vec<f64> {
        self.values.chunks(self.size).map(|row| row.iter().sum()).collect()
    }
}
