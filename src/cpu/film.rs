//! The CPU's film: sums in double precision, in bands that are sampled together.

use std::ops::Range;
use std::sync::Arc;

use crate::film::{Band, rounded};
use crate::renderer::state::{BatchState, FilmState, Tally};
use crate::renderer::{Batch, Observer, Stopping};
use crate::sampling::Sampling;
use crate::scene::Scene;
use crate::spectrum::Spectrum;

/// Rows of a band.
pub const BAND_ROWS: u32 = 64;

/// Sums over the samples of one pixel. In f64, a million samples leave a relative error below 1e-10.
#[derive(Debug, Clone, Copy, Default)]
pub struct PixelSum {
    pub radiance: Spectrum,
    pub squared_luminance: f64,
    pub samples: u32,
}

/// Rows in the making.
pub struct BandSums {
    pub first_row: u32,
    pub rows: u32,
    pub pixels: Vec<PixelSum>,
}

/// Facts that all samples of a batch share.
pub struct BatchSamples<'a> {
    pub range: Range<u32>,
    pub sampling: Sampling,
    pub batch: &'a Batch<'a>,
    pub width: u32,
    pub stopping: Stopping<'a>,
}

impl<'a> BatchSamples<'a> {
    pub fn new(batch: &'a Batch<'a>, scene: &Scene, observer: &'a dyn Observer) -> Self {
        let scenes = Sampling::from(&scene.render);
        let sampling = Sampling { seed: batch.seed.unwrap_or(scenes.seed), ..scenes };
        Self {
            range: batch.request.samples.clone(),
            sampling,
            batch,
            width: scene.film.size[0],
            stopping: Stopping::new(observer, batch.deadline),
        }
    }

    pub fn takes_part(&self, pixel: usize) -> bool {
        self.batch.takes_part(pixel, self.width)
    }
}

/// Bands over which samples go together.
pub struct Group {
    pub bands: Vec<BandSums>,
    /// The first sample of the iteration under way, its number of samples (0: it is not begun), and how many of
    /// the pixels, from the first, have them.
    pub next: u32,
    pub iteration: u32,
    pub reached: u32,
}

impl Group {
    /// The rows of the picture, without samples or with those of a state.
    pub fn new(rows: Range<u32>, batch: &BatchSamples<'_>, resume: Option<&BatchState>) -> Self {
        let width = batch.width as usize;
        let first = rows.start as usize * width;
        let sum = |pixel: usize| match resume {
            Some(state) if batch.takes_part(first + pixel) && (state.done > 0 || pixel < state.reached as usize) => {
                let ([r, g, b, squared_luminance], samples) = state.film.double(pixel);
                PixelSum { radiance: Spectrum::new(r, g, b), squared_luminance, samples }
            }
            _ => PixelSum::default(),
        };
        let new_band = |first_row: u32| {
            let band_rows = BAND_ROWS.min(rows.end - first_row);
            let start = (first_row - rows.start) as usize * width;
            BandSums { first_row, rows: band_rows, pixels: (start..start + width * band_rows as usize).map(sum).collect() }
        };
        let bands = rows.clone().step_by(BAND_ROWS as usize).map(new_band).collect();
        let pixels = (rows.len() * width) as u32;
        let (done, iteration, reached) =
            resume.map_or((0, 0, 0), |state| (state.done, state.iteration, state.reached.min(pixels)));
        Self { bands, next: batch.range.start + done, iteration, reached }
    }

    /// The group as a state to go on from.
    pub fn state(&self, batch: &BatchSamples<'_>, tally: Tally) -> BatchState {
        let pixels = || self.bands.iter().flat_map(|band| &band.pixels);
        let sum = |sum: &PixelSum| sum.radiance.extend(sum.squared_luminance).to_array();
        let film = FilmState::Double { sums: pixels().map(sum).collect(), samples: pixels().map(|sum| sum.samples).collect() };
        let first_row = self.bands.first().map_or(0, |band| band.first_row);
        BatchState {
            rows: first_row..self.bands.last().map_or(first_row, |band| band.first_row + band.rows),
            done: self.next - batch.range.start,
            iteration: if self.reached > 0 { self.iteration } else { 0 },
            reached: self.reached,
            film: Arc::new(film),
            tally,
        }
    }
}

impl BandSums {
    pub fn finish(&self, width: u32, batch: &BatchSamples<'_>, with_counts: bool) -> Band {
        let scale = |sum: &PixelSum| 1.0 / f64::from(sum.samples.max(1));
        let (mean, remainder) = self.pixels.iter().map(|sum| rounded((sum.radiance * scale(sum)).to_rgb())).unzip();
        Band {
            first_row: self.first_row,
            width,
            rows: self.rows,
            samples: self.counts(batch, width).fold(batch.range.len() as u32, u32::min),
            counts: with_counts.then(|| self.pixels.iter().map(|sum| sum.samples).collect()),
            mean,
            remainder,
            second_moment: self.pixels.iter().map(|sum| (sum.squared_luminance * scale(sum)) as f32).collect(),
            ..Band::default()
        }
    }

    pub fn has_samples(&self) -> bool {
        self.pixels.iter().any(|sum| sum.samples > 0)
    }

    /// Samples of the pixels that take part.
    pub fn counts(&self, batch: &BatchSamples<'_>, width: u32) -> impl Iterator<Item = u32> {
        let first = (self.first_row * width) as usize;
        let pixels = self.pixels.iter().enumerate();
        pixels.filter(move |(pixel, _)| batch.takes_part(first + pixel)).map(|(_, sum)| sum.samples)
    }
}

/// Says that all pixels that take part have the same number of samples.
pub fn are_even(bands: &[BandSums], batch: &BatchSamples<'_>, width: u32) -> bool {
    let mut counts = bands.iter().flat_map(|band| band.counts(batch, width));
    let first = counts.next();
    counts.all(|count| Some(count) == first)
}
