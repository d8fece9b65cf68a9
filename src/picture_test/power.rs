//! How many samples it takes to find a change of a stated size with a stated probability, at the level that all tiles together allow.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal};

use super::settings::TestSettings;
use crate::compare::image_tests::Layout;
use crate::compare::{TileSettings, sidak};
use crate::output::Image;

/// Share of the tiles with light in which the change has to be found. In the rest, which is dark and noisy, larger ones are.
pub const SHARE_OF_TILES: f64 = 0.95;

/// The change that a number of samples finds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Detection {
    /// Samples per pixel of a render.
    pub samples: u32,
    /// The change that is found with the stated power in [`SHARE_OF_TILES`] of the tiles; infinite where none is.
    pub change: f64,
    /// Share of the tiles in which the change that was asked for is found.
    pub share: f64,
    /// Tiles with light.
    pub tiles: usize,
}

/// A tile's mean and the variance of a sample of it: of the mean over the tile's pixels of one sample each.
#[derive(Debug, Clone, Copy)]
struct TileNoise {
    mean: f64,
    variance: f64,
}

/// The noise of a picture, tile by tile.
pub struct NoiseOfTiles {
    /// The channel of each tile in which changes are found soonest.
    tiles: Vec<TileNoise>,
    /// Standard errors by which a change has to stand out.
    distance: f64,
    margin: f64,
}

impl NoiseOfTiles {
    /// The noise of a picture with these variances of its samples.
    pub fn new(mean: &Image, variances: &[[f32; 3]], settings: &TestSettings) -> Self {
        let layout = Layout { width: mean.width, height: mean.height };
        let regions = layout.tiles(settings.tile);
        // The level is corrected as in the test: half for the tiles and half for the whole, and the tiles in
        // each channel.
        let level = sidak(sidak(settings.false_alarms, 2), 3 * regions.len());
        let distance = quantile(1.0 - 0.5 * level) + quantile(settings.power);
        let noise = |region, channel: usize| {
            let (mut sum, mut variance, mut pixels) = (0.0, 0.0, 0.0);
            for pixel in layout.pixels(region) {
                sum += f64::from(mean.pixels[pixel][channel]);
                variance += f64::from(variances[pixel][channel]);
                pixels += 1.0;
            }
            TileNoise { mean: sum / pixels, variance: variance / (pixels * pixels) }
        };
        let best = |region| {
            let channels = (0..3).map(|channel| noise(region, channel)).filter(|noise| noise.mean > 0.0);
            channels.min_by(|a, b| a.relative().total_cmp(&b.relative()))
        };
        let tiles = regions.into_iter().filter_map(best).collect();
        Self { tiles, distance, margin: TileSettings::default().relative_margin }
    }

    /// The change that a render of so many samples finds against a picture of `golden` samples.
    pub fn detection(&self, samples: u32, golden: u32, wanted: f64) -> Detection {
        let factor = 1.0 / f64::from(samples) + 1.0 / f64::from(golden);
        let mut changes: Vec<f64> =
            self.tiles.iter().map(|tile| self.distance * (tile.variance * factor).sqrt() / tile.mean + self.margin).collect();
        changes.sort_unstable_by(f64::total_cmp);
        let found = changes.partition_point(|change| *change <= wanted);
        let share = if changes.is_empty() { 1.0 } else { found as f64 / changes.len() as f64 };
        let change = changes.get(rank(changes.len())).copied().unwrap_or(0.0);
        Detection { samples, change, share, tiles: changes.len() }
    }

    /// The fewest samples that find a change against a picture of `golden` samples; None where no number does.
    pub fn fewest_samples(&self, change: f64, golden: u32) -> Option<f64> {
        let mut samples: Vec<f64> = self
            .tiles
            .iter()
            .map(|tile| {
                let allowed = ((change - self.margin).max(0.0) * tile.mean / self.distance).powi(2);
                let left = allowed - tile.variance / f64::from(golden);
                if tile.variance == 0.0 {
                    1.0
                } else if left > 0.0 {
                    tile.variance / left
                } else {
                    f64::INFINITY
                }
            })
            .collect();
        samples.sort_unstable_by(f64::total_cmp);
        let fewest = samples.get(rank(samples.len())).copied().unwrap_or(1.0);
        fewest.is_finite().then_some(fewest)
    }
}

impl TileNoise {
    /// Relative variance, by which channels are ordered.
    fn relative(&self) -> f64 {
        self.variance / (self.mean * self.mean)
    }
}

/// Which of so many sorted tiles is the last of the share that counts.
fn rank(tiles: usize) -> usize {
    ((tiles as f64 * SHARE_OF_TILES).ceil() as usize).clamp(1, tiles.max(1)) - 1
}

/// Quantile of the standard normal distribution.
fn quantile(probability: f64) -> f64 {
    Normal::standard().inverse_cdf(probability)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(settings: &TestSettings) -> NoiseOfTiles {
        let mean = Image { width: 32, height: 16, pixels: vec![[0.5, 0.4, 0.0]; 512] };
        NoiseOfTiles::new(&mean, &vec![[0.25, 0.04, 0.0]; 512], settings)
    }

    /// 8 tiles of 64 pixels; green is the best channel: a standard deviation of 0.2 on a mean of 0.4.
    #[test]
    fn samples_follow_from_noise_level_and_power() {
        let settings = TestSettings { change: 0.02, ..TestSettings::default() };
        let level: f64 = 1.0 - (1.0 - (1.0 - 0.99f64.sqrt())).powf(1.0 / 24.0);
        let distance = quantile(1.0 - level / 2.0) + 2.326_347_874;
        let expected = (distance * 0.5 / 8.0 / (0.02 - 1e-4)).powi(2);
        let found = noise(&settings).fewest_samples(0.02, u32::MAX).expect("it can be found");
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} instead of {expected}");
        // A golden picture of as many samples doubles what it takes; of half as many, nothing finds it.
        let doubled = noise(&settings).fewest_samples(0.02, (2.0 * expected) as u32 + 1).expect("it can be found");
        assert!((doubled / expected - 2.0).abs() < 0.01, "{doubled}");
        assert_eq!(noise(&settings).fewest_samples(0.02, (0.9 * expected) as u32), None);
        let detection = noise(&settings).detection(found.ceil() as u32, u32::MAX, 0.02);
        assert!(detection.share == 1.0 && (detection.change / 0.02 - 1.0).abs() < 0.01, "{detection:?}");
        let fewer = noise(&settings).detection((found / 2.0) as u32, u32::MAX, 0.02);
        assert!(fewer.share == 0.0 && fewer.change > 0.025, "{fewer:?}");
    }

    #[test]
    fn what_has_no_light_asks_for_nothing() {
        let black = Image { width: 8, height: 8, pixels: vec![[0.0; 3]; 64] };
        let noise = NoiseOfTiles::new(&black, &[[1.0; 3]; 64], &TestSettings::default());
        assert_eq!(noise.fewest_samples(0.01, 100), Some(1.0));
        assert_eq!(noise.detection(1, 1, 0.01).tiles, 0);
    }
}
