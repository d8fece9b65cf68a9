//! Intervals from sums.

use rayon::prelude::*;
use serde::Serialize;

use super::boundary::BernsteinBoundary;
use super::options::{IntervalBasis, IntervalOptions, IntervalScope, TILE};
use super::sums::{IntervalSums, PixelSums};

/// Ends of an interval, in each of three channels.
const ENDS: f64 = 6.0;
/// The share of the picture's value that counts where a pixel or a tile is darker.
const DARKEST: f64 = 0.1;
/// Samples are taken to be no brighter than so many times the brightest that was seen, where nothing better is known.
const BRIGHTER_THAN_SEEN: f64 = 2.0;

/// The low and the high end, channel by channel.
pub type Ends = [[f64; 3]; 2];

/// The intervals of a render, as one look found them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct IntervalEstimate {
    /// The quantities whose widths count.
    pub of: IntervalScope,
    /// The probability that all of them hold, at all looks together.
    pub confidence: f64,
    /// The assumption on which upper ends stand.
    pub by: IntervalBasis,
    /// The brightest that a sample can be, where that is known.
    pub sample_bound: Option<[f64; 3]>,
    /// A sample that was brighter than its bound, by channel: the bound is wrong, and intervals stand on what was seen.
    pub refuted_by: Option<(usize, f64)>,
    /// Half the width of the widest interval, as a share of its value or of a tenth of the picture's.
    pub widest: f64,
    /// Share of the quantities whose intervals are as narrow as they are to become; 1 where nothing was asked for.
    pub narrow_enough: f64,
    /// The interval of the picture's mean, by itself at the same confidence.
    pub picture_low: [f64; 3],
    pub picture_high: [f64; 3],
    /// Samples per pixel.
    pub samples: u32,
}

impl IntervalEstimate {
    /// True if all intervals are as narrow as was asked for.
    pub fn reaches(&self, target: Option<f64>) -> bool {
        target.is_some_and(|target| self.widest <= target)
    }
}

/// Makes intervals of the sums of one render.
pub struct Estimator {
    options: IntervalOptions,
    sample_bound: Option<[f64; 3]>,
}

/// The sums of the pixels of a tile, of the picture, or of one pixel.
#[derive(Clone, Copy, Default)]
struct Unit {
    pixels: f64,
    sums: PixelSums,
    scale: [f64; 3],
}

impl Unit {
    fn of(sums: &IntervalSums, pixel: &PixelSums) -> Self {
        Self { pixels: 1.0, sums: *pixel, scale: sums.scale(pixel) }
    }

    fn with(mut self, other: Self) -> Self {
        self.pixels += other.pixels;
        for channel in 0..3 {
            self.sums.warm_up[channel] += other.sums.warm_up[channel];
            self.sums.sum[channel] += other.sums.sum[channel];
            self.sums.squares[channel] += other.sums.squares[channel];
            self.scale[channel] = self.scale[channel].max(other.scale[channel]);
        }
        self
    }

    /// The mean of all samples.
    fn mean(&self, samples: u32) -> [f64; 3] {
        let count = self.pixels * f64::from(samples.max(1));
        std::array::from_fn(|channel| (self.sums.warm_up[channel] + self.sums.sum[channel]) / count)
    }
}

/// The means by which ends of intervals are found.
struct Ground {
    /// The boundary of each end, of so many intervals together.
    boundary: BernsteinBoundary,
    /// The brightest that a sample can be.
    bound: [f64; 3],
    /// The bound follows from the scene, so that no mean is above it.
    is_certain: bool,
}

impl Estimator {
    /// `sample_bound`: the brightest that a sample can be, by channel, where intervals are to stand on it.
    pub fn new(options: IntervalOptions, sample_bound: Option<[f64; 3]>) -> Self {
        Self { options, sample_bound }
    }

    /// The bound, unless a sample was brighter; else what was seen.
    fn ground(&self, sums: &IntervalSums, units: usize) -> Ground {
        let alpha = (1.0 - self.options.confidence) / (ENDS * units.max(1) as f64);
        let trusted = self.sample_bound.filter(|bound| sums.brighter_than(*bound).is_none());
        let seen = || sums.brightest().map(|brightest| BRIGHTER_THAN_SEEN * brightest);
        let boundary = BernsteinBoundary::new(alpha);
        Ground { boundary, bound: trusted.unwrap_or_else(seen), is_certain: trusted.is_some() }
    }

    /// The intervals of what was asked for.
    pub fn look(&self, sums: &IntervalSums) -> IntervalEstimate {
        let IntervalOptions { of, confidence, target, .. } = self.options;
        let picture = picture_of(sums);
        let ground = self.ground(sums, 1);
        let picture_ends = ground.ends(sums, &picture);
        let brightest = picture.mean(sums.samples()).into_iter().fold(0.0, f64::max);
        let width = |unit: &Unit, [low, high]: Ends| {
            let own = unit.mean(sums.samples()).into_iter().fold(DARKEST * brightest, f64::max);
            let half = (0..3).map(|channel| 0.5 * (high[channel] - low[channel])).fold(0.0, f64::max);
            if half == 0.0 { 0.0 } else { half / own }
        };
        let limit = target.unwrap_or(f64::INFINITY);
        let (widest, narrow_enough) = match of {
            IntervalScope::Picture => {
                let widest = width(&picture, picture_ends);
                (widest, f64::from(u8::from(widest <= limit)))
            }
            IntervalScope::Tiles | IntervalScope::Pixels => {
                let units = if of == IntervalScope::Tiles { tiles_of(sums) } else { pixels_of(sums) };
                let ground = self.ground(sums, units.len());
                let widths = units.par_iter().map(|unit| width(unit, ground.ends(sums, unit)));
                let both = widths.map(|width| (width, usize::from(width <= limit)));
                let (widest, narrow) = both.reduce(|| (0.0, 0), |a, b| (f64::max(a.0, b.0), a.1 + b.1));
                (widest, narrow as f64 / units.len().max(1) as f64)
            }
        };
        let [picture_low, picture_high] = picture_ends;
        IntervalEstimate {
            of,
            confidence,
            by: if ground.is_certain { IntervalBasis::Bound } else { IntervalBasis::Seen },
            sample_bound: self.sample_bound,
            refuted_by: self.sample_bound.and_then(|bound| sums.brighter_than(bound)),
            widest,
            narrow_enough,
            picture_low,
            picture_high,
            samples: sums.samples(),
        }
    }

    /// The intervals of all pixels, which hold together at the confidence that was asked for.
    pub fn pixels(&self, sums: &IntervalSums) -> Vec<Ends> {
        let ground = self.ground(sums, sums.pixels().len());
        let of = |pixel: &PixelSums| ground.ends(sums, &Unit::of(sums, pixel));
        sums.pixels().par_iter().map(of).collect()
    }
}

impl Ground {
    /// The interval of a unit. It holds the mean of all samples, too, in which the first ones count.
    fn ends(&self, sums: &IntervalSums, unit: &Unit) -> Ends {
        let mean = unit.mean(sums.samples());
        let mut ends = [mean; 2];
        let count = unit.pixels * f64::from(sums.counted());
        for channel in 0..3 {
            let (sum, squares) = (unit.sums.sum[channel], unit.sums.squares[channel]);
            // A sample is no farther below a prediction than the prediction is above 0, and no farther above it than the bound.
            let farthest = [unit.scale[channel], self.bound[channel]];
            let within = |scale: f64| if scale > 0.0 { scale * self.boundary.deviation(squares / (scale * scale)) } else { 0.0 };
            let [below, above] = farthest.map(within);
            let most = if self.is_certain { self.bound[channel] } else { f64::INFINITY };
            let [low, high] = if count > 0.0 { [(sum - below) / count, (sum + above) / count] } else { [0.0, most] };
            ends[0][channel] = low.max(0.0).min(mean[channel]);
            ends[1][channel] = high.min(most).max(mean[channel]);
        }
        ends
    }
}

fn picture_of(sums: &IntervalSums) -> Unit {
    let chunks = sums.pixels().par_chunks(1 << 14);
    let of_chunk = |chunk: &[PixelSums]| chunk.iter().fold(Unit::default(), |unit, pixel| unit.with(Unit::of(sums, pixel)));
    // Added in order, so that threads decide nothing.
    let parts: Vec<Unit> = chunks.map(of_chunk).collect();
    parts.into_iter().fold(Unit::default(), Unit::with)
}

fn pixels_of(sums: &IntervalSums) -> Vec<Unit> {
    sums.pixels().par_iter().map(|pixel| Unit::of(sums, pixel)).collect()
}

fn tiles_of(sums: &IntervalSums) -> Vec<Unit> {
    let [columns, rows] = [sums.width(), sums.height()].map(|side| side.div_ceil(TILE) as usize);
    let mut tiles = vec![Unit::default(); columns * rows];
    for (index, pixel) in sums.pixels().iter().enumerate() {
        let [x, y] = [index as u32 % sums.width(), index as u32 / sums.width()].map(|place| (place / TILE) as usize);
        let tile = &mut tiles[y * columns + x];
        *tile = tile.with(Unit::of(sums, pixel));
    }
    tiles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::random::SplitMix64;

    fn estimator(of: IntervalScope, confidence: f64, sample_bound: Option<[f64; 3]>) -> Estimator {
        Estimator::new(IntervalOptions { of, confidence, ..IntervalOptions::default() }, sample_bound)
    }

    /// Pixels of different brightness, whose samples are dark but for a share of them; at each doubling of the samples, intervals at 90 % are
    /// looked at. The truth is the product of share and brightness.
    fn misses(of: IntervalScope, bound: Option<[f64; 3]>, chance: f64, runs: u64) -> u32 {
        let estimator = estimator(of, 0.9, bound);
        let mut missed = 0;
        for run in 0..runs {
            let mut random = SplitMix64::new((run + 1) << 24);
            let mut sums = IntervalSums::new([8, 4]);
            let truth: Vec<f64> = (0..32).map(|pixel| chance * f64::from(1 + pixel % 4)).collect();
            let mut misses = false;
            for count in 1..=512_u32 {
                let sample = |pixel: u32| [if random.uniform() < chance { 1.0 + (pixel % 4) as f32 } else { 0.0 }; 3];
                let samples: Vec<[f32; 3]> = (0..32).map(sample).collect();
                sums.add(&samples);
                if !count.is_power_of_two() {
                    continue;
                }
                let holds = |[low, high]: Ends, truth: f64| low[0] <= truth && truth <= high[0];
                misses |= if of == IntervalScope::Pixels {
                    !estimator.pixels(&sums).into_iter().zip(&truth).all(|(ends, truth)| holds(ends, *truth))
                } else {
                    let found = estimator.look(&sums);
                    !holds([found.picture_low, found.picture_high], truth.iter().sum::<f64>() / 32.0)
                };
            }
            missed += u32::from(misses);
        }
        missed
    }

    /// With a bound, intervals miss no more often than they may, be light rare or not; without one they do where it is rare, which is the control.
    #[test]
    fn intervals_with_a_bound_hold_whether_light_is_rare_or_not() {
        let most = |runs: f64| (0.1 * runs + 3.0 * (0.09 * runs).sqrt()) as u32;
        for chance in [0.3, 1e-3] {
            for of in [IntervalScope::Picture, IntervalScope::Pixels] {
                let missed = misses(of, Some([4.0; 3]), chance, 100);
                assert!(missed <= most(100.0), "{of:?} with chance {chance}: {missed} of 100");
            }
        }
        assert!(misses(IntervalScope::Picture, None, 0.3, 100) <= most(100.0));
        let control = misses(IntervalScope::Pixels, None, 1e-3, 100);
        assert!(control > most(100.0), "pixels of rare light without a bound: {control} of 100");
    }

    /// They become as narrow as one over the root of the samples, and those of many pixels together are wider than one alone.
    #[test]
    fn intervals_become_narrow() {
        let mut sums = IntervalSums::new([32, 32]);
        let mut random = SplitMix64::new(7);
        let mut widths = Vec::new();
        for count in 1..=1024_u32 {
            let samples: Vec<[f32; 3]> = (0..1024).map(|_| [2.0 * random.uniform() as f32; 3]).collect();
            sums.add(&samples);
            if [64, 1024].contains(&count) {
                let look = |of| estimator(of, 0.99, Some([2.0; 3])).look(&sums).widest;
                widths.push([IntervalScope::Picture, IntervalScope::Tiles, IntervalScope::Pixels].map(look));
            }
        }
        let [few, many] = [widths[0], widths[1]];
        assert!(few[0] < 0.02 && few[0] < few[1] && few[1] < few[2], "{widths:?}");
        // The widths of pixels' intervals are as yet made by the bound, whose part shrinks faster.
        assert!((0..3).all(|of| (2.5..9.0).contains(&(few[of] / many[of]))), "{widths:?}");
    }

    /// A sample beyond its bound is reported, and intervals no longer stand on it.
    #[test]
    fn a_wrong_bound_is_found() {
        let mut sums = IntervalSums::new([2, 2]);
        (0..20).for_each(|_| sums.add(&[[1.0; 3]; 4]));
        let by = |bound: f64| estimator(IntervalScope::Picture, 0.99, Some([bound; 3])).look(&sums);
        assert_eq!((by(1.0).by, by(1.0).refuted_by), (IntervalBasis::Bound, None));
        assert_eq!((by(0.9).by, by(0.9).refuted_by), (IntervalBasis::Seen, Some((0, 1.0))));
    }
}
