//! Renders a film with the reference integrator, on all cores.

use std::ops::{Add, Range};
use std::time::{Duration, Instant};

use glam::DVec3;
use rayon::prelude::*;

use super::integrator::Integrator;
use super::intersect::Ray;
use super::rounding::Rounding;
use super::trace::{PathTrace, PathVisitor, RayCounter};
use crate::film::Band;
use crate::math::luminance;
use crate::renderer::{Batch, Ending, Observer, RenderError, RenderReport, RenderRequest, Renderer, Stopping};
use crate::sampling::{PathSampler, Sampling, SequencePoint};
use crate::scene::{RenderSettings, Scene};

/// Rows of a band.
const BAND_ROWS: u32 = 64;
/// Pictures up to this many pixels (8K) are rendered in several passes over all bands, so that an interrupted render has every pixel;
/// larger ones band by band, so that memory stays bounded.
const PIXELS_IN_MEMORY: u64 = 1 << 25;
/// Vertices after which it is looked again whether a path should be given up.
const VERTICES_BETWEEN_LOOKS: u32 = 4096;
/// Sweeps are planned to take so much of the time that is left.
const CAUTION: f64 = 0.95;
/// A pass over one band should take this long: the observer is asked after each.
const PASS_DURATION: Duration = Duration::from_millis(150);
/// Most samples per pixel of one pass, which bounds the table of the sequence's points.
const SAMPLES_PER_PASS: u32 = 1024;

/// The reference integrator as a renderer.
#[derive(Debug, Clone)]
pub struct ReferenceRenderer {
    integrator: Integrator,
    build_seconds: f64,
    /// Passes done and how long they took, to size the next.
    timed_samples: f64,
    timed_seconds: f64,
}

/// Sums over the samples of one pixel. In f64, a million samples leave a relative error below 1e-10.
#[derive(Debug, Clone, Copy, Default)]
struct PixelSum {
    radiance: DVec3,
    squared_luminance: f64,
    samples: u32,
}

/// Rows in the making.
struct BandSums {
    first_row: u32,
    rows: u32,
    pixels: Vec<PixelSum>,
}

/// Counts rays, and gives up paths that do not end when the render is to.
struct Watched<'a> {
    rays: u64,
    stopping: &'a Stopping<'a>,
    gave_up: Option<Ending>,
}

impl PathVisitor for Watched<'_> {
    fn ray(&mut self, _ray: &Ray) {
        self.rays += 1;
    }

    fn gives_up(&mut self, vertices: u32) -> bool {
        if vertices.is_multiple_of(VERTICES_BETWEEN_LOOKS) {
            self.gave_up = self.stopping.gives_up_paths();
        }
        self.gave_up.is_some()
    }
}

/// What the samples of a batch have in common.
struct BatchSamples<'a> {
    range: Range<u32>,
    sampling: Sampling,
    selection: Option<&'a [bool]>,
    stopping: Stopping<'a>,
}

impl<'a> BatchSamples<'a> {
    fn new(batch: &Batch<'a>, settings: &RenderSettings, observer: &'a dyn Observer) -> Self {
        let scenes = Sampling::from(settings);
        let sampling = Sampling { seed: batch.seed.unwrap_or(scenes.seed), ..scenes };
        Self {
            range: batch.request.samples.clone(),
            sampling,
            selection: batch.selection,
            stopping: Stopping::new(observer, batch.deadline),
        }
    }

    fn takes_part(&self, pixel: usize) -> bool {
        self.selection.is_none_or(|selection| selection[pixel])
    }
}

/// What a pass counted.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    samples: u64,
    rays: u64,
    non_finite: u64,
    /// Paths were given up.
    gave_up: Option<Ending>,
}

impl Add for Tally {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            samples: self.samples + other.samples,
            rays: self.rays + other.rays,
            non_finite: self.non_finite + other.non_finite,
            gave_up: self.gave_up.or(other.gave_up),
        }
    }
}

impl ReferenceRenderer {
    /// Builds what is needed to trace paths. Fails on what the reference cannot render.
    pub fn new(scene: &Scene) -> Result<Self, RenderError> {
        let start = Instant::now();
        let integrator = Integrator::new(scene)?;
        Ok(Self { integrator, build_seconds: start.elapsed().as_secs_f64(), timed_samples: 0.0, timed_seconds: 0.0 })
    }

    /// What one sample of one pixel sees, as it is before the film refuses what is not finite.
    pub fn radiance_of_sample(&self, x: u32, y: u32, sample: u32) -> [f64; 3] {
        self.follow(x, y, sample, &mut RayCounter::default()).to_array()
    }

    /// One path with all that happened along it.
    pub fn trace(&self, x: u32, y: u32, sample: u32) -> PathTrace {
        let mut trace = PathTrace::default();
        trace.radiance = self.follow(x, y, sample, &mut trace);
        trace
    }

    /// What one sample of one pixel sees with every intermediate result rounded as `rounding` does it.
    pub fn rounded_radiance(&self, x: u32, y: u32, sample: u32, rounding: &mut Rounding) -> DVec3 {
        self.follow(x, y, sample, rounding)
    }

    fn follow<V: PathVisitor>(&self, x: u32, y: u32, sample: u32, visitor: &mut V) -> DVec3 {
        let Scene { film, render, .. } = self.integrator.scene();
        let sampling = Sampling::from(render);
        let point = SequencePoint::new(&sampling, sample);
        let sampler = PathSampler::new(&sampling, y.wrapping_mul(film.size[0]).wrapping_add(x), &point);
        self.integrator.radiance(x, y, &sampler, visitor)
    }

    /// Adds one sample of a pixel per point to its sum.
    fn sample_pixel(&self, x: u32, y: u32, batch: &BatchSamples<'_>, points: &[SequencePoint], sum: &mut PixelSum) -> Tally {
        let sampling = &batch.sampling;
        let pixel = y.wrapping_mul(self.integrator.scene().film.size[0]).wrapping_add(x);
        let mut watched = Watched { rays: 0, stopping: &batch.stopping, gave_up: None };
        let (mut samples, mut non_finite) = (0, 0);
        for point in points {
            let sampler = PathSampler::new(sampling, pixel, point);
            let radiance = self.integrator.radiance(x, y, &sampler, &mut watched);
            if watched.gave_up.is_some() {
                break;
            }
            samples += 1;
            if is_acceptable(radiance) {
                sum.radiance += radiance;
                sum.squared_luminance += luminance(radiance).powi(2);
            } else {
                non_finite += 1;
            }
        }
        sum.samples += samples;
        Tally { samples: u64::from(samples), rays: watched.rays, non_finite, gave_up: watched.gave_up }
    }

    /// One pass over a band: the samples `range` of the request.
    fn sample_band(&mut self, band: &mut BandSums, batch: &BatchSamples<'_>, range: &Range<u32>) -> Tally {
        let start = Instant::now();
        let width = self.integrator.scene().film.size[0] as usize;
        let points: Vec<_> = range.clone().map(|sample| SequencePoint::new(&batch.sampling, sample)).collect();
        let this = &*self;
        let sample_row = |(row, y): (&mut [PixelSum], u32)| {
            let sample = |(x, sum): (usize, &mut PixelSum)| {
                if !batch.takes_part(y as usize * width + x) {
                    return Tally::default();
                }
                this.sample_pixel(x as u32, y, batch, &points, sum)
            };
            row.iter_mut().enumerate().map(sample).fold(Tally::default(), Tally::add)
        };
        let rows = band.pixels.par_chunks_mut(width).zip(band.first_row..band.first_row + band.rows);
        let tally = rows.map(sample_row).reduce(Tally::default, Tally::add);
        self.timed_samples += tally.samples as f64;
        self.timed_seconds += start.elapsed().as_secs_f64();
        tally
    }

    /// The samples of the next pass over bands of `pixels` pixels, which starts at sample `first`.
    fn next_samples(&self, pixels: usize, batch: &BatchSamples<'_>, first: u32) -> Range<u32> {
        let rate = if self.timed_seconds > 0.0 { self.timed_samples / self.timed_seconds } else { 0.0 };
        let fitting = rate * PASS_DURATION.as_secs_f64() / pixels.max(1) as f64;
        first..first + (fitting as u32).clamp(1, SAMPLES_PER_PASS).min(batch.range.end - first)
    }

    /// Samples that a sweep over so many pixels can have to end within the time.
    fn samples_within(&self, pixels: usize, time: Duration) -> u32 {
        (time.as_secs_f64() * self.timed_samples / self.timed_seconds.max(1e-9) / pixels.max(1) as f64) as u32
    }

    /// Renders all samples of a group of bands, pass by pass; why it ended early, if it did.
    fn render_group(&mut self, bands: &mut [BandSums], batch: &BatchSamples<'_>, progress: &mut Progress) -> Option<Ending> {
        let largest = bands.iter().map(|band| band.pixels.len()).max().unwrap_or(0);
        let all = bands.iter().map(|band| band.pixels.len()).sum();
        let mut next = batch.range.start;
        while next < batch.range.end {
            let mut range = self.next_samples(largest, batch, next);
            let is_first = next == batch.range.start;
            if let Some(time) = batch.stopping.time_left() {
                let fitting = if is_first { 1 } else { self.samples_within(all, time.mul_f64(CAUTION)) };
                if fitting == 0 {
                    return Some(Ending::OutOfTime);
                }
                range.end = range.end.min(range.start.saturating_add(fitting));
            }
            let last = bands.len() - 1;
            for (index, band) in bands.iter_mut().enumerate() {
                let tally = self.sample_band(band, batch, &range);
                progress.add(tally);
                if tally.gave_up.is_some() {
                    return tally.gave_up;
                }
                let is_last = range.end == batch.range.end && index == last;
                if !is_last && let Some(ending) = batch.stopping.after_pass(!is_first || index == last) {
                    return Some(ending);
                }
            }
            next = range.end;
        }
        None
    }
}

/// What is done so far, and who is told.
struct Progress<'a> {
    observer: &'a dyn Observer,
    total: u64,
    report: RenderReport,
}

impl Progress<'_> {
    fn add(&mut self, tally: Tally) {
        self.report.rays += tally.rays;
        self.report.non_finite_samples += tally.non_finite;
        self.report.samples += tally.samples;
        self.observer.progress(self.report.samples, self.total);
    }
}

/// Whether all pixels that take part have the same number of samples.
fn are_even(bands: &[BandSums], batch: &BatchSamples<'_>, width: u32) -> bool {
    let mut counts = bands.iter().flat_map(|band| band.counts(batch, width));
    let first = counts.next();
    counts.all(|count| Some(count) == first)
}

/// A film takes radiance that is finite, in f32 too, and not negative.
fn is_acceptable(radiance: DVec3) -> bool {
    // Its square goes into the second moment.
    let square = luminance(radiance).powi(2) as f32;
    radiance.as_vec3().is_finite() && square.is_finite() && radiance.min_element() >= 0.0
}

impl BandSums {
    fn finish(&self, width: u32, batch: &BatchSamples<'_>, with_counts: bool) -> Band {
        let scale = |sum: &PixelSum| 1.0 / f64::from(sum.samples.max(1));
        Band {
            first_row: self.first_row,
            width,
            rows: self.rows,
            samples: self.counts(batch, width).fold(batch.range.len() as u32, u32::min),
            counts: with_counts.then(|| self.pixels.iter().map(|sum| sum.samples).collect()),
            mean: self.pixels.iter().map(|sum| (sum.radiance * scale(sum)).as_vec3().to_array()).collect(),
            second_moment: self.pixels.iter().map(|sum| (sum.squared_luminance * scale(sum)) as f32).collect(),
        }
    }

    fn has_samples(&self) -> bool {
        self.pixels.iter().any(|sum| sum.samples > 0)
    }

    /// Samples of the pixels that take part.
    fn counts(&self, batch: &BatchSamples<'_>, width: u32) -> impl Iterator<Item = u32> {
        let first = (self.first_row * width) as usize;
        let pixels = self.pixels.iter().enumerate();
        pixels.filter(move |(pixel, _)| batch.takes_part(first + pixel)).map(|(_, sum)| sum.samples)
    }
}

impl Renderer for ReferenceRenderer {
    fn device(&self) -> &str {
        "CPU reference"
    }

    fn holds_whole_film(&self) -> bool {
        let [width, height] = self.integrator.scene().film.size;
        u64::from(width) * u64::from(height) <= PIXELS_IN_MEMORY
    }

    fn set_samples_per_pixel(&mut self, spp: u32) {
        self.integrator.set_samples_per_pixel(spp);
    }

    fn render_batch(
        &mut self,
        batch: &Batch<'_>,
        observer: &dyn Observer,
        on_band: &mut dyn FnMut(Band) -> std::io::Result<()>,
    ) -> Result<RenderReport, RenderError> {
        let start = Instant::now();
        let [width, height] = self.integrator.scene().film.size;
        let RenderRequest { rows, .. } = batch.request;
        let samples = BatchSamples::new(batch, &self.integrator.scene().render, observer);
        if rows.end > height {
            return Err(RenderError::Internal(format!("rows up to {} of a picture of {height} rows", rows.end)));
        }
        let pixels = u64::from(width) * rows.len() as u64;
        let report = RenderReport { device: self.device().into(), build_seconds: self.build_seconds, ..RenderReport::default() };
        let mut progress = Progress { observer, total: batch.total_samples(width), report };
        let first_rows: Vec<u32> = rows.clone().step_by(BAND_ROWS as usize).collect();
        let bands_at_once = if pixels <= PIXELS_IN_MEMORY { first_rows.len() } else { 1 };
        for group in first_rows.chunks(bands_at_once.max(1)) {
            let new_band = |&first_row: &u32| {
                let band_rows = BAND_ROWS.min(rows.end - first_row);
                let pixels = vec![PixelSum::default(); width as usize * band_rows as usize];
                BandSums { first_row, rows: band_rows, pixels }
            };
            let mut bands: Vec<BandSums> = group.iter().map(new_band).collect();
            let ended = self.render_group(&mut bands, &samples, &mut progress);
            // Where memory holds a part of the picture only, earlier parts cannot know that a later one ends in the middle of a sweep.
            let with_counts = bands.len() < first_rows.len() || !are_even(&bands, &samples, width);
            let is_worth_delivering = |band: &&BandSums| ended.is_none() || band.has_samples();
            bands.iter().filter(is_worth_delivering).try_for_each(|band| on_band(band.finish(width, &samples, with_counts)))?;
            if ended.is_some() {
                progress.report.interrupted = ended == Some(Ending::Interrupted);
                progress.report.out_of_time = ended == Some(Ending::OutOfTime);
                break;
            }
        }
        progress.report.render_seconds = start.elapsed().as_secs_f64();
        Ok(progress.report)
    }
}

#[cfg(test)]
mod tests;
