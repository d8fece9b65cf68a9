//! Renders a film with the reference integrator, on all cores.

use std::ops::{Add, Range};
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::clamp::Clamp;
use super::film::{BAND_ROWS, BandSums, BatchSamples, Group, PixelSum, are_even};
use crate::film::{KernelLayer, MOST_FILM_PIXELS};
use crate::learn::{self, Effort, Reasons, Settled};
use crate::reference::coverage::FirstOwners;
use crate::reference::integrator::Integrator;
use crate::reference::intersect::Ray;
use crate::reference::layer::{LayerVisitor, ObjectMeasure};
use crate::reference::rounding::Rounding;
use crate::reference::trace::{PathTrace, PathVisitor, RayCounter};
use crate::renderer::sink::{Sink, keep_between};
use crate::renderer::state::{BatchState, MOST_SAMPLES_PER_ITERATION, Tally};
use crate::renderer::{
    Batch, CAUTION, Change, Decision, Ending, Observer, RenderError, RenderReport, RenderRequest, Renderer, Stopping,
};
use crate::sampling::{PathSampler, Sampling, SequencePoint};
use crate::scene::Scene;
use crate::spectrum::Spectrum;

/// Vertices after which it is looked again whether a path should be given up.
const VERTICES_BETWEEN_LOOKS: u32 = 4096;
/// A pass over one band should take this long: the observer is asked after each.
const PASS_DURATION: Duration = Duration::from_millis(150);

/// The reference integrator as a renderer.
#[derive(Debug, Clone)]
pub struct ReferenceRenderer {
    integrator: Integrator,
    /// The layer that is made in place of the picture.
    layer: Option<KernelLayer>,
    /// The measure of layers of objects.
    object: ObjectMeasure,
    /// Most pixels whose samples go together: [`MOST_FILM_PIXELS`] but for tests.
    pixels_in_memory: u64,
    /// The render's length, by which it learns.
    effort: Effort,
    /// Why settings are what they are that the scene leaves open.
    because: Reasons,
    /// Paths were traced before the first sample to learn about the scene.
    depends_on_view: bool,
    learn_seconds: f64,
    build_seconds: f64,
    /// Passes done and how long they took, to size the next.
    timed_samples: f64,
    timed_seconds: f64,
}

/// Counts rays, and gives up paths that do not end when the render is to.
struct PathLimiter<'a> {
    rays: u64,
    stopping: &'a Stopping<'a>,
    gave_up: Option<Ending>,
}

impl PathVisitor for PathLimiter<'_> {
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

/// Counts of a pass.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    samples: u64,
    rays: u64,
    non_finite: u64,
    clamped: u64,
    clamped_units: u64,
    /// Paths were given up.
    gave_up: Option<Ending>,
}

impl Add for Counts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            samples: self.samples + other.samples,
            rays: self.rays + other.rays,
            non_finite: self.non_finite + other.non_finite,
            clamped: self.clamped + other.clamped,
            clamped_units: self.clamped_units + other.clamped_units,
            gave_up: self.gave_up.or(other.gave_up),
        }
    }
}

impl ReferenceRenderer {
    /// Builds what is needed to trace paths. Fails on what the reference cannot render.
    pub fn new(scene: &Scene) -> Result<Self, RenderError> {
        Self::of_layer(scene, None)
    }

    /// [`ReferenceRenderer::new`] to make a layer in place of the picture, of a scene that is [made
    /// ready](crate::reference::layer::layer_scene) for it.
    pub fn of_layer(scene: &Scene, layer: Option<KernelLayer>) -> Result<Self, RenderError> {
        Self::of_length(scene, layer, Effort::default())
    }

    /// [`ReferenceRenderer::of_layer`] for a render of this length, by which it learns.
    pub fn of_length(scene: &Scene, layer: Option<KernelLayer>, effort: Effort) -> Result<Self, RenderError> {
        let start = Instant::now();
        let Settled { scene, because, depends_on_view, integrator, seconds: learn_seconds, .. } = learn::settle(scene, effort)?;
        let mut integrator = integrator.map_or_else(|| Integrator::new(&scene), Ok)?;
        integrator.hide_other_groups();
        Ok(Self {
            object: ObjectMeasure::new(integrator.scene()),
            integrator,
            layer,
            effort,
            because,
            depends_on_view,
            pixels_in_memory: MOST_FILM_PIXELS,
            learn_seconds,
            build_seconds: start.elapsed().as_secs_f64() - learn_seconds,
            timed_samples: 0.0,
            timed_seconds: 0.0,
        })
    }

    /// With a film of so many pixels at a time: those of larger pictures are rendered band by band.
    #[must_use]
    pub fn with_film_pixels(self, pixels: u64) -> Self {
        Self { pixels_in_memory: pixels.min(MOST_FILM_PIXELS), ..self }
    }

    /// The decisions that the settings leave open.
    fn decisions(&self) -> Vec<Decision> {
        let settings = &self.integrator.scene().render;
        let guided = self.integrator.guide().is_some();
        let strategy = self.integrator.light_strategy();
        let Reasons { light_choice, light_samples, directions, .. } = &self.because;
        let of_choice = light_choice.iter().map(|because| Decision::about_light_choice(strategy, because));
        let of_lights =
            light_samples.iter().map(|because| Decision::about_light_samples(settings.several_light_samples(), because));
        let of_directions = directions.iter().map(|because| Decision::about_directions(guided, because));
        of_choice.chain(of_lights).chain(of_directions).collect()
    }

    /// The numbers, from 1, of the shape and of its material that the ray through a pixel's centre meets when
    /// the shutter opens.
    pub fn ids(&self, x: u32, y: u32) -> [u32; 2] {
        self.integrator.owner_at_centre(x, y).map_or([0; 2], |owner| [owner.shape as u32 + 1, owner.material as u32 + 1])
    }

    /// Shape and material, by their numbers in the scene, of what stops a pixel's samples, with the share of
    /// a sample that each stops. Null surfaces let a part through. The scene is that of a layer of first
    /// surfaces ([`crate::reference::layer::layer_scene`]).
    pub fn owners(&self, x: u32, y: u32, points: &[SequencePoint]) -> Vec<([usize; 2], f64)> {
        let Scene { film, render, .. } = self.integrator.scene();
        let (sampling, pixel) = (Sampling::from(render), y.wrapping_mul(film.size[0]).wrapping_add(x));
        let owners = |point| {
            let mut first = FirstOwners::default();
            self.integrator.radiance(x, y, &PathSampler::new(&sampling, pixel, point), &mut first);
            first.shares.into_iter().map(|(owner, share)| ([owner.shape, owner.material], share))
        };
        points.iter().flat_map(owners).collect()
    }

    /// The radiance of one sample of one pixel, before the film refuses what is not finite.
    pub fn radiance_of_sample(&self, x: u32, y: u32, sample: u32) -> [f64; 3] {
        self.follow(x, y, sample, &mut RayCounter::default()).to_rgb()
    }

    /// One path with all that happened along it.
    pub fn trace(&self, x: u32, y: u32, sample: u32) -> PathTrace {
        let mut trace = PathTrace::default();
        trace.radiance = self.follow(x, y, sample, &mut trace);
        trace
    }

    /// The radiance of one sample of one pixel with every intermediate result rounded as `rounding` does it.
    pub fn rounded_radiance(&self, x: u32, y: u32, sample: u32, rounding: &mut Rounding) -> Spectrum {
        self.follow(x, y, sample, rounding)
    }

    fn follow<V: PathVisitor>(&self, x: u32, y: u32, sample: u32, visitor: &mut V) -> Spectrum {
        let Scene { film, render, .. } = self.integrator.scene();
        let sampling = Sampling::from(render);
        let point = SequencePoint::new(&sampling, sample);
        let sampler = PathSampler::new(&sampling, y.wrapping_mul(film.size[0]).wrapping_add(x), &point);
        self.integrator.radiance(x, y, &sampler, visitor)
    }

    /// Adds one sample of a pixel per point to its sum.
    fn sample_pixel(&self, x: u32, y: u32, batch: &BatchSamples<'_>, points: &[SequencePoint], sum: &mut PixelSum) -> Counts {
        let sampling = &batch.sampling;
        let pixel = y.wrapping_mul(self.integrator.scene().film.size[0]).wrapping_add(x);
        let mut limiter = PathLimiter { rays: 0, stopping: &batch.stopping, gave_up: None };
        let (mut samples, mut traced, mut non_finite) = (0, 0_u64, 0);
        let mut clamp = Clamp::new(self.integrator.scene().render.clamp, self.layer);
        let depth = self.integrator.depth_measure();
        for point in points {
            let sampler = PathSampler::new(sampling, pixel, point);
            let mut radiance = Spectrum::BLACK;
            if let Some(layer) = self.layer {
                let mut visitor = LayerVisitor::new(layer, depth, &mut limiter).of_pixel(&self.object, [x, y]);
                let found = clamp.darken(self.integrator.radiance(x, y, &sampler, &mut visitor));
                let Some(value) = visitor.value(found) else {
                    traced += 1;
                    continue;
                };
                radiance += value;
            } else {
                radiance += clamp.darken(self.integrator.radiance(x, y, &sampler, &mut limiter));
            }
            if limiter.gave_up.is_some() {
                break;
            }
            (samples, traced) = (samples + 1, traced + 1);
            // Normals and positions may well be negative.
            if is_acceptable(if self.layer.is_some() { radiance.map(f64::abs) } else { radiance }) {
                sum.radiance += radiance;
                sum.squared_luminance += radiance.luminance().powi(2);
            } else {
                non_finite += 1;
            }
        }
        sum.samples += samples;
        let (clamped, clamped_units) = (clamp.samples, clamp.units());
        Counts { samples: traced, rays: limiter.rays, non_finite, clamped, clamped_units, gave_up: limiter.gave_up }
    }

    /// One pass over a band: the samples `range` of the request, but for its first pixels, which have them.
    fn sample_band(&mut self, band: &mut BandSums, batch: &BatchSamples<'_>, range: &Range<u32>, have_them: usize) -> Counts {
        let start = Instant::now();
        let width = self.integrator.scene().film.size[0] as usize;
        let points: Vec<_> = range.clone().map(|sample| SequencePoint::new(&batch.sampling, sample)).collect();
        let this = &*self;
        let first_row = band.first_row;
        let sample_row = |(row, y): (&mut [PixelSum], u32)| {
            let sample = |(x, sum): (usize, &mut PixelSum)| {
                let has_them = (y - first_row) as usize * width + x < have_them;
                if has_them || !batch.takes_part(y as usize * width + x) {
                    return Counts::default();
                }
                this.sample_pixel(x as u32, y, batch, &points, sum)
            };
            row.iter_mut().enumerate().map(sample).fold(Counts::default(), Counts::add)
        };
        let rows = band.pixels.par_chunks_mut(width).zip(band.first_row..band.first_row + band.rows);
        let tally = rows.map(sample_row).reduce(Counts::default, Counts::add);
        self.timed_samples += tally.samples as f64;
        self.timed_seconds += start.elapsed().as_secs_f64();
        tally
    }

    /// The samples of the next pass over bands of `pixels` pixels, which starts at sample `first`.
    fn next_samples(&self, pixels: usize, batch: &BatchSamples<'_>, first: u32) -> Range<u32> {
        let rate = if self.timed_seconds > 0.0 { self.timed_samples / self.timed_seconds } else { 0.0 };
        let fitting = rate * PASS_DURATION.as_secs_f64() / pixels.max(1) as f64;
        first..first + (fitting as u32).clamp(1, MOST_SAMPLES_PER_ITERATION).min(batch.range.end - first)
    }

    /// Samples that an iteration over so many pixels can have to end within the time.
    fn samples_within(&self, pixels: usize, time: Duration) -> u32 {
        (time.as_secs_f64() * self.timed_samples / self.timed_seconds.max(1e-9) / pixels.max(1) as f64) as u32
    }

    /// Renders all samples of a group of bands, pass by pass, from `place` on; why it ended early, if it did.
    fn render_group(
        &mut self,
        group: &mut Group,
        batch: &BatchSamples<'_>,
        progress: &mut Progress<'_>,
        sink: &mut dyn Sink,
    ) -> Result<Option<Ending>, RenderError> {
        let largest = group.bands.iter().map(|band| band.pixels.len()).max().unwrap_or(0);
        let all = group.bands.iter().map(|band| band.pixels.len()).sum();
        while group.next < batch.range.end {
            if group.iteration == 0 {
                group.iteration = self.next_samples(largest, batch, group.next).len() as u32;
                if let Some(time) = batch.stopping.time_left() {
                    let is_first = group.next == batch.range.start;
                    // Nothing is known of the speed of a render that goes on.
                    let fitting =
                        if is_first || self.timed_samples == 0.0 { 1 } else { self.samples_within(all, time.mul_f64(CAUTION)) };
                    if fitting == 0 {
                        group.iteration = 0;
                        return Ok(Some(Ending::OutOfTime));
                    }
                    group.iteration = group.iteration.min(fitting);
                }
            }
            let ended = self.run_iteration(group, batch, progress, sink)?;
            if ended.is_some() {
                return Ok(ended);
            }
        }
        Ok(None)
    }

    /// Renders the rest of the iteration under way.
    fn run_iteration(
        &mut self,
        group: &mut Group,
        batch: &BatchSamples<'_>,
        progress: &mut Progress<'_>,
        sink: &mut dyn Sink,
    ) -> Result<Option<Ending>, RenderError> {
        let range = group.next..group.next + group.iteration;
        let is_first = range.start == batch.range.start;
        let mut before = 0;
        for index in 0..group.bands.len() {
            let pixels = group.bands[index].pixels.len();
            let have_them = (group.reached as usize).saturating_sub(before);
            before += pixels;
            if have_them >= pixels {
                continue;
            }
            // A band that is given up half done is no state to go on from.
            let untouched = sink.takes_states().then(|| group.bands[index].pixels.clone());
            let tally = self.sample_band(&mut group.bands[index], batch, &range, have_them);
            progress.add(tally);
            if tally.gave_up == Some(Ending::Interrupted)
                && let Some(untouched) = untouched
            {
                let half_done = std::mem::replace(&mut group.bands[index].pixels, untouched);
                sink.state(group.state(batch, progress.tally(tally)))?;
                group.bands[index].pixels = half_done;
            }
            if tally.gave_up.is_some() {
                return Ok(tally.gave_up);
            }
            group.reached = before as u32;
            let is_last_band = index + 1 == group.bands.len();
            if is_last_band {
                (group.next, group.iteration, group.reached) = (range.end, 0, 0);
            }
            if is_last_band && range.end == batch.range.end {
                return Ok(None);
            }
            let ended = batch.stopping.after_pass(!is_first || is_last_band);
            let breaks_off = ended == Some(Ending::Interrupted) && sink.takes_states();
            if breaks_off || sink.wants_state() {
                sink.state(group.state(batch, progress.tally(Counts::default())))?;
            }
            if ended.is_some() {
                return Ok(ended);
            }
        }
        Ok(None)
    }
}

/// The work done so far, and the observer that is told.
struct Progress<'a> {
    observer: &'a dyn Observer,
    total: u64,
    report: RenderReport,
}

impl Progress<'_> {
    fn add(&mut self, tally: Counts) {
        self.report.rays += tally.rays;
        self.report.non_finite_samples += tally.non_finite;
        self.report.clamped_samples += tally.clamped;
        self.report.clamped_units += tally.clamped_units;
        self.report.samples += tally.samples;
        self.observer.progress(self.report.samples, self.total);
    }

    /// Counts so far, but for these.
    fn tally(&self, without: Counts) -> Tally {
        Tally {
            rays: self.report.rays - without.rays,
            samples: self.report.samples - without.samples,
            non_finite_samples: self.report.non_finite_samples - without.non_finite,
            clamped_samples: self.report.clamped_samples - without.clamped,
            clamped_units: self.report.clamped_units - without.clamped_units,
        }
    }
}

/// A film takes radiance that is finite, in f32 too, and not negative.
fn is_acceptable(radiance: Spectrum) -> bool {
    // Its square goes into the second moment.
    let square = radiance.luminance().powi(2) as f32;
    radiance.to_f32().into_iter().all(f32::is_finite) && square.is_finite() && radiance.min_component() >= 0.0
}

impl Renderer for ReferenceRenderer {
    fn device(&self) -> &str {
        "CPU reference"
    }

    fn with_scene(mut self: Box<Self>, scene: &Scene, change: Change) -> Result<Box<dyn Renderer>, RenderError> {
        let start = Instant::now();
        // Learning may depend on what the camera sees.
        if change == Change::Camera && !self.depends_on_view && self.integrator.set_camera(scene) {
            self.learn_seconds = 0.0;
            self.build_seconds = start.elapsed().as_secs_f64();
            return Ok(self);
        }
        let (layer, effort) = (self.layer, self.effort);
        drop(self);
        Ok(Box::new(Self::of_length(scene, layer, effort)?))
    }

    fn holds_whole_film(&self) -> bool {
        let [width, height] = self.integrator.scene().film.size;
        u64::from(width) * u64::from(height) <= self.pixels_in_memory
    }

    fn set_samples_per_pixel(&mut self, spp: u32) {
        self.integrator.set_samples_per_pixel(spp);
    }

    fn render_into(
        &mut self,
        batch: &Batch<'_>,
        observer: &dyn Observer,
        sink: &mut dyn Sink,
    ) -> Result<RenderReport, RenderError> {
        let start = Instant::now();
        let [width, height] = self.integrator.scene().film.size;
        let RenderRequest { rows, .. } = batch.request;
        let samples = BatchSamples::new(batch, self.integrator.scene(), observer);
        if rows.end > height {
            return Err(RenderError::Internal(format!("rows up to {} of a picture of {height} rows", rows.end)));
        }
        let is_whole = u64::from(width) * rows.len() as u64 <= self.pixels_in_memory;
        let before = batch.resume.map(|state| state.tally).unwrap_or_default();
        let report = RenderReport {
            device: self.device().into(),
            learn_seconds: self.learn_seconds,
            build_seconds: self.build_seconds,
            rays: before.rays,
            samples: before.samples,
            non_finite_samples: before.non_finite_samples,
            clamped_samples: before.clamped_samples,
            clamped_units: before.clamped_units,
            decisions: self.decisions(),
            ..RenderReport::default()
        };
        let mut progress = Progress { observer, total: batch.total_samples(width), report };
        let begin = batch.resume.map_or(rows.start, |state| state.rows.start);
        let mut first_row = begin;
        while first_row < rows.end {
            let resume = batch.resume.filter(|state| state.rows.start == first_row && !state.film.is_empty());
            let mut end = if is_whole { rows.end } else { rows.end.min(first_row + BAND_ROWS) };
            end = resume.map_or(end, |state| end.min(state.rows.end));
            if first_row > begin {
                progress.report.interrupted = samples.stopping.between_bands().is_some();
                let begun = BatchState::before(first_row..end, progress.tally(Counts::default()));
                keep_between(sink, progress.report.interrupted, &begun)?;
                if progress.report.interrupted {
                    break;
                }
            }
            let mut group = Group::new(first_row..end, &samples, resume);
            let ended = self.render_group(&mut group, &samples, &mut progress, sink)?;
            let bands = group.bands;
            // Earlier parts of a picture cannot know that a later one ends in the middle of an iteration.
            // Pixels of a layer of surfaces count the samples that met something.
            let counts_hits = self.layer.is_some_and(KernelLayer::is_of_surfaces);
            let with_counts = ((end - first_row) as usize) < rows.len() || counts_hits || !are_even(&bands, &samples, width);
            let is_worth_delivering = |band: &&BandSums| ended.is_none() || band.has_samples();
            bands.iter().filter(is_worth_delivering).try_for_each(|band| sink.band(band.finish(width, &samples, with_counts)))?;
            if ended.is_some() {
                progress.report.interrupted = ended == Some(Ending::Interrupted);
                progress.report.out_of_time = ended == Some(Ending::OutOfTime);
                break;
            }
            first_row = end;
        }
        progress.report.render_seconds = start.elapsed().as_secs_f64();
        Ok(progress.report)
    }
}

#[cfg(test)]
mod tests;
