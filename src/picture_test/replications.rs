//! Renders of one scene, each with random numbers of its own.

use std::ops::Range;

use super::error::PictureTestError;
use crate::film::Band;
use crate::output::Image;
use crate::renderer::{Batch, Observer, RenderRequest, Renderer};
use crate::sampling::hash::mix;

/// The purpose of a render; renders for different purposes share no random numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// A part of a golden picture.
    Golden,
    /// The first look at a scene.
    Screening,
    /// The second look at what the first found.
    Confirmation,
}

/// The seed of a render, of a purpose and a number.
pub fn seed_of(base: u32, purpose: Purpose, number: u32) -> u32 {
    let purpose = match purpose {
        Purpose::Golden => 0x676f_6c64,
        Purpose::Screening => 0x7363_7265,
        Purpose::Confirmation => 0x636f_6e66,
    };
    mix(mix(base ^ purpose).wrapping_add(number))
}

/// Mean and scatter of renders, pixel by pixel, updated one render at a time (Welford 1962).
#[derive(Debug, Clone)]
pub struct Replications {
    /// Width and height of the rows that are rendered.
    pub width: u32,
    pub rows: Range<u32>,
    /// Samples per pixel of each render.
    pub samples: u32,
    count: u32,
    mean: Vec<[f64; 3]>,
    squared_deviations: Vec<[f64; 3]>,
    /// Seconds that the renders took.
    pub seconds: f64,
    /// Samples that were not finite.
    pub non_finite_samples: u64,
    /// The device as people call it.
    pub device: String,
}

impl Replications {
    /// None yet, of these rows of a picture of this width.
    pub fn new(width: u32, rows: Range<u32>, samples: u32) -> Self {
        let pixels = width as usize * rows.len();
        let (mean, squared_deviations) = (vec![[0.0; 3]; pixels], vec![[0.0; 3]; pixels]);
        Self {
            width,
            rows,
            samples,
            count: 0,
            mean,
            squared_deviations,
            seconds: 0.0,
            non_finite_samples: 0,
            device: String::new(),
        }
    }

    /// Renders once more.
    ///
    /// # Errors
    /// Errors of the device; [`PictureTestError::Interrupted`].
    pub fn render(&mut self, renderer: &mut dyn Renderer, seed: u32, observer: &dyn Observer) -> Result<(), PictureTestError> {
        renderer.set_samples_per_pixel(self.samples);
        let request = RenderRequest { rows: self.rows.clone(), samples: 0..self.samples };
        let batch = Batch { seed: Some(seed), ..Batch::of(&request) };
        let mut pixels: Vec<[f32; 3]> = Vec::with_capacity(self.mean.len());
        let report = renderer.render_batch(&batch, observer, &mut |band: Band| {
            pixels.extend(band.mean);
            Ok(())
        })?;
        if report.interrupted || pixels.len() != self.mean.len() {
            return Err(PictureTestError::Interrupted);
        }
        self.seconds += report.render_seconds;
        self.non_finite_samples += report.non_finite_samples;
        self.device = report.device;
        self.add(&pixels);
        Ok(())
    }

    /// Takes in the pixels of a render.
    pub fn add(&mut self, pixels: &[[f32; 3]]) {
        self.count += 1;
        let sums = self.mean.iter_mut().zip(&mut self.squared_deviations);
        for ((mean, squares), pixel) in sums.zip(pixels) {
            for channel in 0..3 {
                let value = f64::from(pixel[channel]);
                let deviation = value - mean[channel];
                mean[channel] += deviation / f64::from(self.count);
                squares[channel] += deviation * (value - mean[channel]);
            }
        }
    }

    /// How many there are.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Their mean.
    pub fn mean(&self) -> Image {
        let pixels = self.mean.iter().map(|pixel| pixel.map(|value| value as f32)).collect();
        Image { width: self.width, height: self.rows.len() as u32, pixels }
    }

    /// Variance of their mean, pixel by pixel.
    pub fn variances(&self) -> Vec<[f32; 3]> {
        self.scatter(1.0 / f64::from(self.count))
    }

    /// Variance of a sample: that of one render's mean times its samples. For points that fill space evenly it is smaller than samples by
    /// themselves vary.
    pub fn variances_of_a_sample(&self) -> Vec<[f32; 3]> {
        self.scatter(f64::from(self.samples))
    }

    fn scatter(&self, factor: f64) -> Vec<[f32; 3]> {
        let factor = factor / (f64::from(self.count) - 1.0).max(1.0);
        self.squared_deviations.iter().map(|pixel| pixel.map(|squares| (squares * factor) as f32)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_scatter_are_those_of_the_renders() {
        let mut renders = Replications::new(2, 0..1, 5);
        for value in [1.0, 2.0, 6.0] {
            renders.add(&[[value, 0.5, 0.0], [2.0; 3]]);
        }
        assert_eq!(renders.mean().pixels, [[3.0, 0.5, 0.0], [2.0; 3]]);
        // The variance of 1, 2 and 6 is 7.
        assert_eq!(renders.variances_of_a_sample(), [[35.0, 0.0, 0.0], [0.0; 3]]);
        assert!((renders.variances()[0][0] - 7.0 / 3.0).abs() < 1e-6);
    }

    #[test]
    fn seeds_are_apart() {
        let mut seeds: Vec<u32> = [Purpose::Golden, Purpose::Screening, Purpose::Confirmation]
            .into_iter()
            .flat_map(|purpose| (0..8).flat_map(move |base| (0..64).map(move |number| seed_of(base, purpose, number))))
            .collect();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), 3 * 8 * 64);
    }
}
