//! The picture as the weighted mean of batches, row by row, so that an interrupted batch counts where it got to.

use std::io;

use crate::film::Band;

/// Rows handed over at once.
const BAND_ROWS: usize = 64;

/// Weighted sums over batches: 12 bytes a pixel, 16 where second moments are wanted. Batches are few (they grow with what is done), so
/// f32 keeps six digits.
pub struct Picture {
    width: usize,
    height: usize,
    radiance: Vec<[f32; 3]>,
    /// Sum of weighted means of the squared luminance; empty where nobody asks.
    squares: Vec<f32>,
    /// Per row: the sum of weights, which is the samples per pixel.
    weights: Vec<f32>,
}

impl Picture {
    pub fn new([width, height]: [u32; 2], with_second_moments: bool) -> Self {
        let (width, height) = (width as usize, height as usize);
        Self {
            width,
            height,
            radiance: vec![[0.0; 3]; width * height],
            squares: if with_second_moments { vec![0.0; width * height] } else { Vec::new() },
            weights: vec![0.0; height],
        }
    }

    /// Adds the means of a band.
    pub fn add(&mut self, band: &Band, weight: f32) {
        let first_row = band.first_row as usize;
        let first = first_row * self.width;
        for (sum, mean) in self.radiance[first..].iter_mut().zip(&band.mean) {
            for (sum, mean) in sum.iter_mut().zip(mean) {
                *sum += weight * mean;
            }
        }
        for (sum, mean) in self.squares.iter_mut().skip(first).zip(&band.second_moment) {
            *sum += weight * mean;
        }
        self.weights[first_row..first_row + band.rows as usize].iter_mut().for_each(|sum| *sum += weight);
    }

    /// Samples per pixel of the row that has fewest.
    pub fn samples(&self) -> f64 {
        f64::from(self.weights.iter().copied().fold(f32::INFINITY, f32::min))
    }

    /// Mean radiance and mean squared luminance per pixel.
    pub fn moments(&self) -> (Vec<[f32; 3]>, Vec<f32>) {
        let scale = |index: usize| 1.0 / self.weights[index / self.width];
        let mean = self.radiance.iter().enumerate().map(|(index, sum)| sum.map(|value| value * scale(index))).collect();
        let second_moment = self.squares.iter().enumerate().map(|(index, sum)| sum * scale(index)).collect();
        (mean, second_moment)
    }

    /// Hands over the rows that have samples, from the top.
    ///
    /// # Errors
    /// What the receiver says.
    pub fn deliver(&self, on_band: &mut dyn FnMut(Band) -> io::Result<()>) -> io::Result<()> {
        let mut row = 0;
        while row < self.height {
            // A band has one number of samples.
            let weight = self.weights[row];
            let alike = self.weights[row..].iter().take(BAND_ROWS).take_while(|other| **other == weight).count();
            if weight > 0.0 {
                on_band(self.band(row, alike, weight))?;
            }
            row += alike;
        }
        Ok(())
    }

    fn band(&self, first_row: usize, rows: usize, weight: f32) -> Band {
        let pixels = first_row * self.width..(first_row + rows) * self.width;
        Band {
            first_row: first_row as u32,
            width: self.width as u32,
            rows: rows as u32,
            samples: weight as u32,
            mean: self.radiance[pixels.clone()].iter().map(|sum| sum.map(|value| value / weight)).collect(),
            second_moment: self.squares.get(pixels).unwrap_or_default().iter().map(|sum| sum / weight).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(first_row: u32, rows: u32, samples: u32, value: f32) -> Band {
        let pixels = 2 * rows as usize;
        Band { first_row, width: 2, rows, samples, mean: vec![[value; 3]; pixels], second_moment: vec![value; pixels] }
    }

    #[test]
    fn rows_are_weighted_means_of_what_reached_them() {
        let mut picture = Picture::new([2, 4], true);
        picture.add(&band(0, 4, 1, 1.0), 1.0);
        picture.add(&band(0, 2, 3, 5.0), 3.0);
        assert_eq!(picture.samples(), 1.0);
        let mut bands = Vec::new();
        let mut collect = |band| {
            bands.push(band);
            Ok(())
        };
        picture.deliver(&mut collect).unwrap();
        let rows: Vec<_> = bands.iter().map(|band| (band.first_row, band.rows, band.samples, band.mean[0][0])).collect();
        assert_eq!(rows, [(0, 2, 4, 4.0), (2, 2, 1, 1.0)]);
        assert_eq!(picture.moments().1, [4.0, 4.0, 4.0, 4.0, 1.0, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn rows_without_samples_are_not_delivered() {
        let mut picture = Picture::new([2, 3], false);
        picture.add(&band(0, 1, 1, 1.0), 1.0);
        let mut rows = 0;
        let mut count = |band: Band| {
            rows += band.rows;
            Ok(())
        };
        picture.deliver(&mut count).unwrap();
        assert_eq!(rows, 1);
    }
}
