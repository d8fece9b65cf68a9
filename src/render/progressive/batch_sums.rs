//! The picture as the weighted mean of batches, row by row, so that an interrupted batch counts where it got to.

use std::io;

use crate::film::Band;

/// Rows handed over at once.
const BAND_ROWS: usize = 64;

/// Weighted sums over batches: 16 bytes a pixel. Batches are few (they grow with what is done), so f32 keeps six digits of radiance.
pub struct BatchSums {
    width: usize,
    height: usize,
    /// Per pixel: the sum of means, each by its number of samples.
    radiance: Vec<[f32; 3]>,
    /// Per pixel: the number of samples.
    counts: Vec<u32>,
    /// Per row: the samples per pixel that are spent, on average over the film where pixels have different numbers.
    samples: Vec<f64>,
}

impl BatchSums {
    pub fn new([width, height]: [u32; 2]) -> Self {
        let (width, height) = (width as usize, height as usize);
        let pixels = width * height;
        Self { width, height, radiance: vec![[0.0; 3]; pixels], counts: vec![0; pixels], samples: vec![0.0; height] }
    }

    /// Adds the means of a band's samples, of the pixels that took part; `share` of the film's pixels did.
    pub fn add(&mut self, band: &Band, selection: Option<&[bool]>, share: f64) {
        let first_row = band.first_row as usize;
        let first = first_row * self.width;
        for (pixel, mean) in band.mean.iter().enumerate() {
            if selection.is_none_or(|selection| selection[first + pixel]) {
                let count = band.counts.as_ref().map_or(band.samples, |counts| counts[pixel]);
                for (sum, mean) in self.radiance[first + pixel].iter_mut().zip(mean) {
                    *sum += count as f32 * mean;
                }
                self.counts[first + pixel] = self.counts[first + pixel].saturating_add(count);
            }
        }
        let spent = f64::from(band.samples) * share;
        self.samples[first_row..first_row + band.rows as usize].iter_mut().for_each(|sum| *sum += spent);
    }

    /// Makes [`BatchSums::new`] with sums of earlier batches; None where they are of another size.
    pub fn with_sums([width, height]: [u32; 2], radiance: Vec<[f32; 3]>, counts: Vec<u32>, samples: Vec<f64>) -> Option<Self> {
        let (width, height) = (width as usize, height as usize);
        let fits = radiance.len() == width * height && counts.len() == radiance.len() && samples.len() == height;
        fits.then_some(Self { width, height, radiance, counts, samples })
    }

    /// Per pixel: the sum of means, each by its number of samples.
    pub fn radiance(&self) -> &[[f32; 3]] {
        &self.radiance
    }

    /// Per pixel: the number of samples.
    pub fn counts(&self) -> &[u32] {
        &self.counts
    }

    /// Per row: the samples per pixel that are spent.
    pub fn row_samples(&self) -> &[f64] {
        &self.samples
    }

    /// Samples per pixel of the row that has fewest.
    pub fn samples(&self) -> f64 {
        self.samples.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// All samples that were to be spent are: so many per pixel, but for those that numbers of samples in powers of two leave over.
    pub fn settle(&mut self, samples: u32) {
        self.samples.fill(f64::from(samples));
    }

    /// Hands over the rows that have samples, from the top.
    ///
    /// # Errors
    /// Errors of the receiver.
    pub fn deliver(&self, on_band: &mut dyn FnMut(Band) -> io::Result<()>) -> io::Result<()> {
        let with_counts = self.counts.iter().any(|count| *count != self.counts[0]);
        let mut row = 0;
        while row < self.height {
            // A band has one number of samples.
            let samples = self.samples[row];
            let alike = self.samples[row..].iter().take(BAND_ROWS).take_while(|other| **other == samples).count();
            let pixels = row * self.width..(row + alike) * self.width;
            if self.counts[pixels].iter().any(|count| *count > 0) {
                on_band(self.band(row, alike, samples, with_counts))?;
            }
            row += alike;
        }
        Ok(())
    }

    fn band(&self, first_row: usize, rows: usize, samples: f64, with_counts: bool) -> Band {
        let pixels = first_row * self.width..(first_row + rows) * self.width;
        let counts = &self.counts[pixels.clone()];
        let mean = |(sum, count): (&[f32; 3], &u32)| sum.map(|sum| if *count > 0 { sum / *count as f32 } else { 0.0 });
        Band {
            first_row: first_row as u32,
            width: self.width as u32,
            rows: rows as u32,
            samples: samples as u32,
            counts: with_counts.then(|| counts.to_vec()),
            mean: self.radiance[pixels].iter().zip(counts).map(mean).collect(),
            ..Band::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(first_row: u32, rows: u32, samples: u32, value: f32) -> Band {
        let pixels = 2 * rows as usize;
        Band {
            first_row,
            width: 2,
            rows,
            samples,
            counts: None,
            mean: vec![[value; 3]; pixels],
            second_moment: vec![value; pixels],
            ..Band::default()
        }
    }

    #[test]
    fn rows_are_weighted_means_of_what_reached_them() {
        let mut picture = BatchSums::new([2, 4]);
        picture.add(&band(0, 4, 1, 1.0), None, 1.0);
        picture.add(&band(0, 2, 3, 5.0), None, 1.0);
        assert_eq!(picture.samples(), 1.0);
        let mut bands = Vec::new();
        let mut collect = |band| {
            bands.push(band);
            Ok(())
        };
        picture.deliver(&mut collect).unwrap();
        let rows: Vec<_> = bands.iter().map(|band| (band.first_row, band.rows, band.samples, band.mean[0][0])).collect();
        assert_eq!(rows, [(0, 2, 4, 4.0), (2, 2, 1, 1.0)]);
        assert_eq!(bands.iter().flat_map(|band| band.counts.clone().unwrap()).collect::<Vec<_>>(), [4, 4, 4, 4, 1, 1, 1, 1]);
    }

    #[test]
    fn pixels_that_took_no_part_keep_their_mean() {
        let mut picture = BatchSums::new([2, 1]);
        picture.add(&band(0, 1, 2, 1.0), None, 1.0);
        picture.add(&band(0, 1, 6, 5.0), Some(&[false, true]), 0.5);
        assert_eq!(picture.samples(), 5.0);
        let mut means = Vec::new();
        let mut collect = |band: Band| {
            means.extend(band.mean.iter().map(|mean| mean[0]));
            Ok(())
        };
        picture.deliver(&mut collect).unwrap();
        assert_eq!(means, [1.0, 4.0]);
    }

    /// A batch that ended in the middle of an iteration counts, pixel by pixel, as far as it got.
    #[test]
    fn pixels_are_weighed_by_their_own_samples() {
        let mut picture = BatchSums::new([2, 1]);
        picture.add(&band(0, 1, 2, 1.0), None, 1.0);
        picture.add(&Band { counts: Some(vec![6, 0]), ..band(0, 1, 0, 5.0) }, None, 1.0);
        let mut found = None;
        let mut take = |band: Band| {
            found = Some((band.mean, band.counts, band.samples));
            Ok(())
        };
        picture.deliver(&mut take).unwrap();
        assert_eq!(found, Some((vec![[4.0; 3], [1.0; 3]], Some(vec![8, 2]), 2)));
    }

    #[test]
    fn rows_without_samples_are_not_delivered() {
        let mut picture = BatchSums::new([2, 3]);
        picture.add(&band(0, 1, 1, 1.0), None, 1.0);
        let mut rows = 0;
        let mut count = |band: Band| {
            rows += band.rows;
            Ok(())
        };
        picture.deliver(&mut count).unwrap();
        assert_eq!(rows, 1);
    }
}
