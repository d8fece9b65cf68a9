//! How a band's samples are cut into passes, each sized by the time the last ones took.

use std::time::Duration;

use crate::plan::{MAX_SAMPLES_PER_PASS, StageMode};

/// The time that a submission should take: short enough for any driver's watchdog and for a prompt Ctrl-C,
/// long enough to hide its own cost.
const TARGET: Duration = Duration::from_millis(200);
/// Samples per pixel and pass that let a fused kernel's lanes start new paths without waiting for each other.
const FUSED_SAMPLES: u32 = 16;
/// Fewest pixels of a pass, if there are as many.
const FEWEST_PIXELS: u32 = 64;
/// Parts of a band whose paths' costs are kept apart: the sky costs a fraction of what stands below it.
const REGIONS: usize = 32;
/// Paths of a probe, and of the one before all others, whose time also contains the driver's compiler.
const PROBE_PATHS: u32 = 256;
const WARM_UP_PATHS: u32 = 64;
/// Regions that are probed, evenly over the band.
const PROBES: usize = 8;
/// Bands are probed from so many paths on.
const WORTH_A_PROBE: u64 = 8_192;
/// A pass may take so many times the paths of the largest one that was timed.
const GROWTH: f64 = 8.0;

/// A run of pixels of the band, or of the list of its pixels, and of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pass {
    pub first_pixel: u32,
    pub pixel_count: u32,
    /// Absolute index.
    pub first_sample: u32,
    pub sample_count: u32,
    /// None of these pixels had samples before this iteration.
    pub film_is_empty: bool,
}

impl Pass {
    pub fn paths(&self) -> u64 {
        u64::from(self.pixel_count) * u64::from(self.sample_count)
    }
}

/// Limits of passes beside time.
#[derive(Debug, Clone, Copy)]
pub struct PassLimits {
    pub stages: StageMode,
    /// Paths in flight, of the wavefront.
    pub paths: u32,
    /// Pixels of a dispatch.
    pub pixels: u32,
    /// Lanes that trace samples of one pixel side by side.
    pub lanes: Option<u32>,
}

/// Iterations over a band: every iteration gives each pixel the same number of further samples, in one or several passes.
#[derive(Debug)]
pub struct PassSizer {
    limits: PassLimits,
    /// Seconds a path took when one was last timed, by the region of the band.
    seconds_per_path: [Option<f64>; REGIONS],
    /// Paths of the largest pass that was timed.
    largest: f64,
}

impl PassSizer {
    pub fn new(limits: PassLimits) -> Self {
        Self { limits, seconds_per_path: [None; REGIONS], largest: f64::from(PROBE_PATHS) }
    }

    /// Short passes that come before the first iteration over a band, to be timed: no pass shall be long because nothing was known. Their samples
    /// are traced again by the iteration, over them.
    pub fn probes(&self, band_pixels: u32, first_sample: u32, samples: u32) -> Vec<Pass> {
        let known = self.seconds_per_path.iter().any(Option::is_some);
        if known || u64::from(band_pixels) * u64::from(samples) < WORTH_A_PROBE {
            return Vec::new();
        }
        let probe = |first_pixel: u32, paths: u32| {
            let pixel_count = paths.min(band_pixels - first_pixel);
            Pass { first_pixel, pixel_count, first_sample, sample_count: 1, film_is_empty: true }
        };
        let places = (0..PROBES as u64).map(|index| (u64::from(band_pixels) * (2 * index + 1) / (2 * PROBES as u64)) as u32);
        std::iter::once(probe(0, WARM_UP_PATHS)).chain(places.map(|pixel| probe(pixel, PROBE_PATHS))).collect()
    }

    /// Learns from a finished pass over a band of so many pixels: where it took longer than was expected of its regions, each of them does.
    pub fn learn(&mut self, band_pixels: u32, pass: &Pass, took: Duration) {
        let seconds = took.as_secs_f64().max(1e-5);
        let end = pass.first_pixel + pass.pixel_count;
        let regions = region(band_pixels, pass.first_pixel)..=region(band_pixels, end - 1);
        let unknown = self.largest_seconds_per_path().unwrap_or(seconds / pass.paths() as f64);
        let pixels_in = |index: usize| {
            f64::from(region_end(band_pixels, index).min(end) - region_start(band_pixels, index).max(pass.first_pixel))
        };
        let costs = regions.clone().map(|index| pixels_in(index) * self.seconds_per_path[index].unwrap_or(unknown));
        let expected = costs.sum::<f64>() * f64::from(pass.sample_count);
        for cost in &mut self.seconds_per_path[regions] {
            *cost = Some(cost.unwrap_or(unknown) * seconds / expected.max(f64::MIN_POSITIVE));
        }
        self.largest = self.largest.max(pass.paths() as f64);
    }

    /// Samples per pixel of the next iteration.
    pub fn iteration_samples(&self, band_pixels: u32, samples_done: u32, samples_left: u32) -> u32 {
        let PassLimits { stages, paths: capacity, lanes, .. } = self.limits;
        let whole_band = self.paths(self.mean_seconds_per_path(), TARGET) / f64::from(band_pixels);
        let samples = match stages {
            StageMode::Wavefront => whole_band.min(f64::from(capacity / band_pixels)),
            // The first iterations are short so that an interrupted render has all its pixels.
            StageMode::Fused => {
                let filling = FUSED_SAMPLES.min(samples_done.max(1));
                let in_time = self.paths(self.largest_seconds_per_path(), TARGET) / f64::from(FEWEST_PIXELS);
                whole_band.max(f64::from(filling).min(in_time))
            }
        };
        let samples = (samples as u32).clamp(1, MAX_SAMPLES_PER_PASS);
        // After the first sample, as many as fill the lanes.
        let filling = match lanes {
            Some(lanes) if samples_done > 0 => (samples / lanes).max(1) * lanes - samples_done % lanes,
            _ => samples,
        };
        filling.min(samples_left)
    }

    /// Samples per pixel that an iteration over the band can have to end within the time.
    pub fn samples_within(&self, band_pixels: u32, time: Duration) -> u32 {
        (time.as_secs_f64() / (self.mean_seconds_per_path().unwrap_or(0.0) * f64::from(band_pixels)).max(1e-9)) as u32
    }

    /// Pixels of the next pass of an iteration with this many samples each, from `first_pixel` on.
    pub fn pass_pixels(&self, iteration_samples: u32, band_pixels: u32, first_pixel: u32) -> u32 {
        let pixels_left = band_pixels - first_pixel;
        let limit = match self.limits.stages {
            // An iteration that another device began may be longer than this one's paths.
            StageMode::Wavefront => self.limits.pixels.min((self.limits.paths / iteration_samples).max(1)),
            StageMode::Fused => self.limits.pixels,
        };
        let wanted = self.pixels_in_time(iteration_samples, band_pixels, first_pixel);
        let pixels = wanted.max(FEWEST_PIXELS).min(limit).min(pixels_left);
        // A small rest is taken along rather than left for a pass of its own.
        if pixels_left - pixels < pixels / 4 && pixels_left <= limit { pixels_left } else { pixels }
    }

    /// Pixels from `first_pixel` on that take the target time together, by what their regions took.
    fn pixels_in_time(&self, iteration_samples: u32, band_pixels: u32, first_pixel: u32) -> u32 {
        let samples = f64::from(iteration_samples);
        let most = (self.largest * GROWTH / samples) as u32;
        let Some(unknown) = self.largest_seconds_per_path() else { return PROBE_PATHS / iteration_samples };
        let (mut pixel, mut time) = (first_pixel, TARGET.as_secs_f64());
        for region in region(band_pixels, first_pixel)..REGIONS {
            let end = region_end(band_pixels, region);
            let seconds_per_pixel = self.seconds_per_path[region].unwrap_or(unknown) * samples;
            let fitting = time / seconds_per_pixel;
            if fitting < f64::from(end - pixel) {
                pixel += fitting as u32;
                break;
            }
            time -= f64::from(end - pixel) * seconds_per_pixel;
            pixel = end;
        }
        (pixel - first_pixel).min(most)
    }

    /// Paths that should take the time, if one takes so long.
    fn paths(&self, seconds: Option<f64>, time: Duration) -> f64 {
        let most = self.largest * GROWTH;
        seconds.map_or(f64::from(PROBE_PATHS), |seconds| time.as_secs_f64() / seconds).min(most)
    }

    fn largest_seconds_per_path(&self) -> Option<f64> {
        self.seconds_per_path.iter().copied().flatten().reduce(f64::max)
    }

    fn mean_seconds_per_path(&self) -> Option<f64> {
        let timed = self.seconds_per_path.iter().copied().flatten();
        let (sum, count) = timed.fold((0.0, 0.0), |(sum, count), seconds| (sum + seconds, count + 1.0));
        (count > 0.0).then(|| sum / count)
    }
}

/// The first pixel of a region, and the one after its last.
fn region_start(band_pixels: u32, region: usize) -> u32 {
    (u64::from(band_pixels) * region as u64).div_ceil(REGIONS as u64) as u32
}

fn region_end(band_pixels: u32, region: usize) -> u32 {
    region_start(band_pixels, region + 1)
}

/// The region of a band in which this pixel is.
fn region(band_pixels: u32, pixel: u32) -> usize {
    (u64::from(pixel) * REGIONS as u64 / u64::from(band_pixels.max(1))).min(REGIONS as u64 - 1) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits(stages: StageMode, lanes: Option<u32>) -> PassLimits {
        PassLimits { stages, paths: 1 << 18, pixels: 1 << 22, lanes }
    }

    #[test]
    fn every_pixel_gets_every_sample_once_whatever_the_times() {
        for (stages, lanes) in [(StageMode::Wavefront, None), (StageMode::Fused, None), (StageMode::Fused, Some(8))] {
            let mut sizer = PassSizer::new(limits(stages, lanes));
            let (band, spp) = (300_000_u32, 37);
            let mut counts = vec![0; band as usize];
            let mut done = 0;
            let mut random = 1_u32;
            while done < spp {
                let samples = sizer.iteration_samples(band, done, spp - done);
                let mut first = 0;
                while first < band {
                    let pixels = sizer.pass_pixels(samples, band, first);
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
                    sizer.learn(band, &pass, Duration::from_micros(u64::from(random % 400_000)));
                }
                done += samples;
            }
            assert!(counts.iter().all(|&count| count == spp));
        }
    }

    /// A device on which paths of the band's first half take a microsecond, and those of the other half `slow` seconds.
    fn longest_pass(stages: StageMode, slow: f64, probe: bool) -> f64 {
        let (band, spp) = (2_000_000_u32, 64);
        let seconds = |pass: &Pass| {
            let end = pass.first_pixel + pass.pixel_count;
            let fast_pixels = end.min(band / 2) - pass.first_pixel.min(band / 2);
            let slow_pixels = pass.pixel_count - fast_pixels;
            f64::from(pass.sample_count) * (1e-6 * f64::from(fast_pixels) + slow * f64::from(slow_pixels))
        };
        let mut sizer = PassSizer::new(limits(stages, None));
        let mut longest = 0.0_f64;
        for pass in sizer.probes(band, 0, spp).iter().filter(|_| probe) {
            longest = longest.max(seconds(pass));
            sizer.learn(band, pass, Duration::from_secs_f64(seconds(pass)));
        }
        let mut done = 0;
        while done < spp {
            let samples = sizer.iteration_samples(band, done, spp - done);
            let mut first = 0;
            while first < band {
                let pixel_count = sizer.pass_pixels(samples, band, first);
                let pass =
                    Pass { first_pixel: first, pixel_count, first_sample: done, sample_count: samples, film_is_empty: done == 0 };
                longest = longest.max(seconds(&pass));
                sizer.learn(band, &pass, Duration::from_secs_f64(seconds(&pass)));
                first += pixel_count;
            }
            done += samples;
        }
        longest
    }

    /// From the first one on, and where the sky above is a thousand times cheaper than what is below.
    #[test]
    fn no_pass_takes_longer_than_a_second() {
        for stages in [StageMode::Wavefront, StageMode::Fused] {
            for slow in [1e-7, 1e-6, 3e-5, 1e-3] {
                let longest = longest_pass(stages, slow, true);
                assert!(longest < 1.0, "{stages:?}, {slow} s a path: {longest} s");
            }
        }
        // The control: without probes, the first pass over the lower half is as large as those over the sky.
        assert!(longest_pass(StageMode::Fused, 1e-3, false) > 1.0);
    }
}
