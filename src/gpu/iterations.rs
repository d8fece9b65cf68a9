//! The iterations over a band, pass by pass.

use std::time::Instant;

use super::band::{BandProgress, BatchContext};
use super::buffers::STATISTICS_BYTES;
use super::film;
use super::passes::Pass;
use super::pipeline::Pipeline;
use super::renderer::GpuRenderer;
use super::snapshot::Snapshot;
use crate::plan::bindings::Binding;
use crate::renderer::sink::{Sink, keep_between};
use crate::renderer::state::{BatchState, FilmState, Tally};
use crate::renderer::{CAUTION, Ending, RenderError};

/// A device that had memory enough to begin, and then has not, fails as one that is lost does: what was rendered is saved, and it may do better another
/// time.
fn midway(error: RenderError) -> RenderError {
    match error {
        RenderError::DoesNotFit(message) => RenderError::DeviceLost(message),
        error => error,
    }
}

impl GpuRenderer {
    fn run_pass(&self, band: &BandProgress, pass: &Pass, context: &BatchContext<'_>) -> Result<Option<Ending>, RenderError> {
        self.pipeline.write_pass(band.first_row, pass, &context.sampling);
        self.pipeline.run_pass(pass, &context.stopping)
    }

    /// Times short passes, so that the first iteration has none that take long.
    fn probe(&mut self, band: &BandProgress, context: &BatchContext<'_>) -> Result<Option<Ending>, RenderError> {
        let probes = self.sizer.probes(band.pixels, context.samples.start, context.samples.len() as u32);
        for (index, pass) in probes.iter().enumerate() {
            let start = Instant::now();
            let ended = self.run_pass(band, pass, context)?;
            if ended.is_some() {
                return Ok(ended);
            }
            // The driver compiles when it first runs a kernel.
            if index > 0 {
                self.sizer.learn(band.pixels, pass, start.elapsed());
            }
        }
        if !probes.is_empty() {
            // Iterations count again what the probes counted.
            self.pipeline.write(Binding::Statistics, &[0; STATISTICS_BYTES as usize]);
        }
        Ok(None)
    }

    /// Samples per pixel of the next iteration; None: there is no time for one.
    fn next_iteration(&self, band: &BandProgress, context: &BatchContext<'_>) -> Option<u32> {
        let done = band.done;
        let left = context.samples.len() as u32 - done;
        let wanted = self.sizer.iteration_samples(band.pixels, done, left);
        match context.stopping.time_left() {
            None => Some(wanted),
            // A picture has a sample in every pixel, however little time there is.
            Some(_) if done == 0 => Some(1),
            Some(time) => {
                Some(self.sizer.samples_within(band.pixels, time.mul_f64(CAUTION)).min(wanted)).filter(|samples| *samples > 0)
            }
        }
    }

    /// How far the batch is, with the band's sums.
    fn state(&self, band: &BandProgress, context: &BatchContext<'_>) -> Result<BatchState, RenderError> {
        let Pipeline { device, buffers, .. } = &*self.pipeline;
        let film = match band.reached {
            0 => FilmState::empty(),
            _ => film::read_band(device, &buffers.film, [self.size[0], band.rows])?,
        };
        Ok(band.state(context.batch, self.size[0], film, self.tally(band.samples_done, context)?))
    }

    /// Renders the samples of the band's pixels that take part; why it ended early, if it did. `begun`: what the band has already.
    fn render_band(
        &mut self,
        band: &mut BandProgress,
        context: &BatchContext<'_>,
        begun: &BatchState,
        snapshot: &mut Snapshot,
        sink: &mut dyn Sink,
    ) -> Result<Option<Ending>, RenderError> {
        let samples = if band.pixels > 0 { context.samples.len() as u32 } else { 0 };
        let ended = if samples > 0 { self.probe(band, context)? } else { None };
        // Probes leave their samples in the film.
        if !begun.film.is_empty() {
            let Pipeline { device, buffers, .. } = &*self.pipeline;
            film::write_band(device, &buffers.film, [self.size[0], band.rows], &begun.film)?;
            band.resume(begun, context.batch, self.size[0]);
        }
        if ended.is_some() {
            return Ok(ended);
        }
        while band.done < samples {
            if band.next_pixel == 0 {
                let Some(iteration) = self.next_iteration(band, context) else { return Ok(Some(Ending::OutOfTime)) };
                band.iteration = iteration;
            }
            let ended = self.run_iteration(band, context, snapshot, sink)?;
            if ended.is_some() {
                return Ok(ended);
            }
        }
        Ok(None)
    }

    /// The counts when a band begins that is not the first, and the reason if the render ends before it;
    /// `begun` is the state without the counts.
    pub(super) fn between_bands(
        &self,
        begun: &BatchState,
        context: &BatchContext<'_>,
        sink: &mut dyn Sink,
    ) -> Result<(Tally, Option<Ending>), RenderError> {
        let counted = self.tally(0, context);
        // Finished bands count where the device is lost; its counts are gone.
        let tally = *counted.as_ref().unwrap_or(&Tally { samples: context.finished.get(), ..context.before });
        let ended = context.stopping.between_bands();
        keep_between(sink, ended.is_some() || counted.is_err(), &BatchState { tally, ..begun.clone() })?;
        Ok((counted?, ended))
    }

    /// Renders a band and hands it over, as far as it got; why it ended early, if it did. Where the device is lost, that is what was read of
    /// it before. `begun`: what the band has already.
    pub(super) fn render_and_deliver(
        &mut self,
        band: &mut BandProgress,
        context: &BatchContext<'_>,
        begun: &BatchState,
        is_cut: bool,
        sink: &mut dyn Sink,
    ) -> Result<Option<Ending>, RenderError> {
        let (batch, width) = (context.batch, self.size[0]);
        let mut snapshot = Snapshot::new();
        let rendered = self.render_band(band, context, begun, &mut snapshot, sink);
        let has_begun = band.samples_done > 0 || context.finished.get() > 0 || context.before.samples > 0;
        let ended = match rendered.map_err(|error| if has_begun { midway(error) } else { error }) {
            Err(error @ RenderError::DeviceLost(_)) => {
                // Bands that were finished before count, where nothing of this one was read.
                keep_between(sink, true, snapshot.state().unwrap_or(begun))?;
                snapshot.deliver(width, batch, 0, &mut |band| sink.band(band))?;
                return Err(error);
            }
            ended => ended?,
        };
        if ended == Some(Ending::Interrupted) && sink.takes_states() {
            sink.state(self.state(band, context)?)?;
        }
        if band.reached > 0 || band.pixels == 0 {
            // Pixels of a layer of surfaces count the samples that met something.
            let counts_hits = self.plan().switches.enabled.contains("LAYER_OF_SURFACES");
            let mut reached = band.reached(is_cut || band.is_uneven() || counts_hits);
            if counts_hits {
                reached.least = 0;
            }
            let mut next_row = band.first_row;
            let delivered = self.deliver_band(&reached, batch, &mut |band| {
                next_row = band.first_row + band.rows;
                sink.band(band)
            });
            if let Err(error) = delivered.map_err(midway) {
                if matches!(error, RenderError::DeviceLost(_)) {
                    // Rows of the band that were handed over are not handed over again.
                    if next_row == band.first_row {
                        keep_between(sink, true, snapshot.state().unwrap_or(begun))?;
                    }
                    snapshot.deliver(width, batch, next_row, &mut |band| sink.band(band))?;
                }
                return Err(error);
            }
        }
        Ok(ended)
    }

    /// The passes that are left of the iteration under way.
    fn run_iteration(
        &mut self,
        band: &mut BandProgress,
        context: &BatchContext<'_>,
        snapshot: &mut Snapshot,
        sink: &mut dyn Sink,
    ) -> Result<Option<Ending>, RenderError> {
        while band.next_pixel < band.pixels {
            let pass = Pass {
                first_pixel: band.next_pixel,
                pixel_count: self.sizer.pass_pixels(band.iteration, band.pixels, band.next_pixel),
                first_sample: context.samples.start + band.done,
                sample_count: band.iteration,
                film_is_empty: band.done == 0,
            };
            let start = Instant::now();
            let ended = self.run_pass(band, &pass, context)?;
            if ended.is_some() {
                return Ok(ended);
            }
            self.sizer.learn(band.pixels, &pass, start.elapsed());
            band.next_pixel += pass.pixel_count;
            band.reached = band.reached.max(band.next_pixel);
            band.samples_done += pass.paths();
            (context.progress)(band.samples_done);
            let is_whole = band.reached == band.pixels;
            if band.next_pixel == band.pixels {
                band.done += band.iteration;
                (band.iteration, band.next_pixel) = (0, 0);
            }
            let is_over = band.done == context.samples.len() as u32;
            if is_over {
                return Ok(None);
            }
            if let Some(ending) = context.stopping.after_pass(is_whole) {
                return Ok(Some(ending));
            }
            let is_wanted = sink.wants_state();
            if is_wanted || (is_whole && snapshot.is_due()) {
                let state = snapshot.take(band.reached(true), || self.state(band, context))?;
                if is_wanted {
                    sink.state(state.clone())?;
                }
            }
            if band.next_pixel == 0 {
                return Ok(None);
            }
        }
        Ok(None)
    }
}
