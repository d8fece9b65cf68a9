//! How a band's samples are cut into passes, each sized by the time the last ones took.

use std::time::Duration;

use crate::plan::{MAX_SAMPLES_PER_PASS, StageMode};

/// What a submission should take: short enough for any driver's watchdog and for a prompt Ctrl-C, long enough to hide its own cost.
const TARGET: Duration = Duration::from_millis(200);
/// Paths of the first pass, whose time also contains the driver's compiler.
const FIRST_PASS: f64 = 32_768.0;
/// Samples per pixel and pass that let a fused kernel's lanes start new paths without waiting for each other.
const FUSED_SAMPLES: u32 = 16;

/// A run of pixels of the band, or of the list of its pixels, and of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pass {
    pub first_pixel: u32,
    pub pixel_count: u32,
    /// Absolute index.
    pub first_sample: u32,
    pub sample_count: u32,
    /// None of these pixels had samples before this sweep.
    pub film_is_empty: bool,
}

impl Pass {
    pub fn paths(&self) -> u64 {
        u64::from(self.pixel_count) * u64::from(self.sample_count)
    }
}

/// Sweeps over a band: every sweep gives each pixel the same number of further samples, in one or several passes.
#[derive(Debug)]
pub struct PassSizer {
    stages: StageMode,
    capacity: u32,
    /// Lanes that trace samples of one pixel side by side.
    lanes: Option<u32>,
    /// Paths that should take the target time.
    paths: f64,
}

impl PassSizer {
    pub fn new(stages: StageMode, capacity: u32, lanes: Option<u32>) -> Self {
        Self { stages, capacity, lanes, paths: FIRST_PASS }
    }

    /// Learns from a finished pass.
    pub fn learn(&mut self, pass: &Pass, took: Duration) {
        let rate = pass.paths() as f64 / took.as_secs_f64().max(1e-4);
        let wanted = rate * TARGET.as_secs_f64();
        self.paths = wanted.clamp(self.paths / 8.0, self.paths * 4.0).max(64.0);
    }

    /// Samples per pixel of the next sweep.
    pub fn sweep_samples(&self, band_pixels: u32, samples_done: u32, samples_left: u32) -> u32 {
        let whole_band = (self.paths / f64::from(band_pixels)).floor();
        let samples = match self.stages {
            StageMode::Wavefront => whole_band.min(f64::from(self.capacity / band_pixels)),
            // The first sweeps are short so that an interrupted render has all its pixels.
            StageMode::Fused => whole_band.max(f64::from(FUSED_SAMPLES.min(samples_done.max(1)))),
        };
        let samples = (samples as u32).clamp(1, MAX_SAMPLES_PER_PASS);
        // After the first sample, as many as fill the lanes.
        let filling = match self.lanes {
            Some(lanes) if samples_done > 0 => (samples / lanes).max(1) * lanes - samples_done % lanes,
            _ => samples,
        };
        filling.min(samples_left)
    }

    /// Pixels of the next pass of a sweep with this many samples each.
    pub fn pass_pixels(&self, sweep_samples: u32, pixels_left: u32) -> u32 {
        let limit = match self.stages {
            StageMode::Wavefront => self.capacity / sweep_samples,
            StageMode::Fused => u32::MAX,
        };
        let wanted = (self.paths / f64::from(sweep_samples)).max(64.0) as u32;
        let pixels = wanted.min(limit).min(pixels_left);
        // A small rest is taken along rather than left for a pass of its own.
        if pixels_left - pixels < pixels / 4 && pixels_left <= limit { pixels_left } else { pixels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_gets_every_sample_once_whatever_the_times() {
        for (stages, lanes) in [(StageMode::Wavefront, None), (StageMode::Fused, None), (StageMode::Fused, Some(8))] {
            let mut sizer = PassSizer::new(stages, 1 << 18, lanes);
            let (band, spp) = (300_000_u32, 37);
            let mut counts = vec![0; band as usize];
            let mut done = 0;
            let mut random = 1_u32;
            while done < spp {
                let samples = sizer.sweep_samples(band, done, spp - done);
                let mut first = 0;
                while first < band {
                    let pixels = sizer.pass_pixels(samples, band - first);
                    let pass = Pass {
                        first_pixel: first,
                        pixel_count: pixels,
                        first_sample: done,
                        sample_count: samples,
                        film_is_empty: done == 0,
                    };
                    assert!(pixels > 0 && (stages == StageMode::Fused || pass.paths() <= 1 << 18));
                    counts[first as usize..(first + pixels) as usize].iter_mut().for_each(|count| *count += samples);
                    first += pixels;
                    random = crate::sampling::hash::mix(random + 1);
                    sizer.learn(&pass, Duration::from_micros(u64::from(random % 400_000)));
                }
                done += samples;
            }
            assert!(counts.iter().all(|&count| count == spp));
        }
    }
}
