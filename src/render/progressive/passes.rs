//! Renders with intervals: one sample of each pixel after the other, each independent of all others, so that every one of them tells how samples vary.

use std::io;
use std::time::Instant;

use super::goal::{Goal, Outcome, Stop, stop_of};
use super::steps::{Offset, add_report};
use crate::confidence::estimate::Estimator;
use crate::confidence::sums::{IntervalSums, WARM_UP};
use crate::confidence::{IntervalGoal, IntervalScope};
use crate::film::Band;
use crate::render::checkpoint::Checkpoint;
use crate::render::checkpoint::saved::{Saved, StepPosition, StepsState};
use crate::renderer::state::{BatchState, Tally};
use crate::renderer::{Batch, Observer, RenderError, RenderReport, RenderRequest, Renderer};

/// Rows handed over at once.
const BAND_ROWS: u32 = 64;
/// The samples grow by this share before intervals are looked at again: looking goes over all pixels, and may be as long as a few samples.
const GROWTH: f64 = 0.04;
/// Intervals of pixels take longer to look at than those of the picture.
const GROWTH_OF_MANY: f64 = 0.2;

/// A render under way.
pub struct Passes<'a> {
    pub renderer: &'a mut dyn Renderer,
    pub size: [u32; 2],
    pub seed: u32,
    pub goal: &'a Goal,
    pub interval: &'a IntervalGoal,
    pub observer: &'a dyn Observer,
    pub checkpoint: Option<&'a mut Checkpoint>,
}

impl Passes<'_> {
    /// Renders from the state of an earlier render, or from the start, and hands over the picture.
    ///
    /// # Errors
    /// Errors of the renderer and of the receiver.
    pub fn render(
        mut self,
        resume: Option<Saved>,
        on_band: &mut dyn FnMut(Band) -> io::Result<()>,
    ) -> Result<Outcome, RenderError> {
        let start = Instant::now();
        let mut report = RenderReport::default();
        let mut sums = IntervalSums::new(self.size);
        if let Some(saved) = resume {
            let misfit = || RenderError::Internal("the checkpoint does not fit the intervals".to_owned());
            let StepsState { place, tally, intervals, shared, .. } = saved.steps.ok_or_else(misfit)?;
            sums = IntervalSums::resumed(self.size, intervals, place.next, shared).ok_or_else(misfit)?;
            report = RenderReport {
                rays: tally.rays,
                samples: tally.samples,
                non_finite_samples: tally.non_finite_samples,
                clamped_samples: tally.clamped_samples,
                clamped_units: tally.clamped_units,
                ..report
            };
        }
        let estimator = Estimator::new(self.interval.options, self.interval.sample_bound);
        let mut unfinished = Vec::new();
        let stop = self.sample(&mut sums, &estimator, &mut report, &mut unfinished);
        // Samples rendered before a device was lost are kept.
        if matches!(stop, Ok(_) | Err(RenderError::DeviceLost(_))) {
            if sums.samples() == 0 {
                unfinished.into_iter().try_for_each(on_band)?;
            } else {
                self.deliver(&sums, &estimator, on_band)?;
            }
        }
        let stop = stop?;
        let report =
            RenderReport { render_seconds: start.elapsed().as_secs_f64(), interrupted: stop == Stop::Interrupted, ..report };
        Ok(Outcome { report, stop, error: None, interval: Some(estimator.look(&sums)) })
    }

    /// Adds samples until the goal is reached or cannot be. `unfinished` has the rows of a sample that not all pixels have.
    fn sample(
        &mut self,
        sums: &mut IntervalSums,
        estimator: &Estimator,
        report: &mut RenderReport,
        unfinished: &mut Vec<Band>,
    ) -> Result<Stop, RenderError> {
        let [width, height] = self.size;
        let samples = self.goal.samples.clone();
        let mut next_look = sums.samples().max(WARM_UP);
        while sums.samples() < samples.len() as u32 {
            if self.observer.stop_requested() {
                self.keep(sums, report, true);
                return Ok(Stop::Interrupted);
            }
            self.keep(sums, report, false);
            let number = samples.start + sums.samples();
            let request = RenderRequest { rows: 0..height, samples: number..number + 1 };
            let batch = Batch { seed: Some(self.seed), deadline: self.goal.deadline, ..Batch::of(&request) };
            let mut pixels = vec![[0.0; 3]; width as usize * height as usize];
            unfinished.clear();
            let observer = Offset {
                observer: self.observer,
                before: report.samples,
                total: u64::from(width) * u64::from(height) * samples.len() as u64,
            };
            let of_pass = self.renderer.render_into(&batch, &observer, &mut |band: Band| {
                let first = band.first_row as usize * width as usize;
                pixels[first..first + band.mean.len()].copy_from_slice(&band.mean);
                if sums.samples() == 0 {
                    unfinished.push(band);
                }
                Ok(())
            })?;
            if let Some(stop) = stop_of(&of_pass) {
                // Pixels without the sample would differ from those with it in when they were looked at, so it does not count.
                self.keep(sums, report, true);
                if sums.samples() == 0 {
                    add_report(report, of_pass);
                }
                return Ok(stop);
            }
            add_report(report, of_pass);
            sums.add(&pixels);
            if self.observer.wants_rows() {
                self.deliver_means(sums, &mut |band| {
                    self.observer.rows_so_far(band);
                    Ok(())
                })?;
            }
            if sums.samples() >= next_look {
                let growth = if self.interval.options.of == IntervalScope::Picture { GROWTH } else { GROWTH_OF_MANY };
                next_look = sums.samples() + ((f64::from(sums.samples()) * growth) as u32).max(1);
                let found = estimator.look(sums);
                self.observer.interval_so_far(&found);
                if found.reaches(self.interval.options.target) {
                    return Ok(Stop::TargetInterval);
                }
            }
        }
        Ok(Stop::Samples)
    }

    /// Saves the state, if it is time for that or the render ends early.
    fn keep(&mut self, sums: &IntervalSums, report: &RenderReport, ends: bool) {
        let Some(checkpoint) = &mut self.checkpoint else { return };
        if sums.samples() == 0 || !(ends || checkpoint.is_due()) {
            return;
        }
        let RenderReport { rays, samples, non_finite_samples, clamped_samples, clamped_units, .. } = *report;
        let tally = Tally { rays, samples, non_finite_samples, clamped_samples, clamped_units };
        let steps = StepsState {
            place: StepPosition { next: sums.samples(), ..StepPosition::default() },
            tally,
            intervals: sums.pixels().to_vec(),
            shared: sums.shared(),
            ..StepsState::default()
        };
        checkpoint.keep(BatchState::before(0..self.size[1], Tally::default()), Some(steps));
    }

    /// Hands over the picture, with the bounds of its pixels where they are wanted.
    fn deliver(
        &self,
        sums: &IntervalSums,
        estimator: &Estimator,
        on_band: &mut dyn FnMut(Band) -> io::Result<()>,
    ) -> io::Result<()> {
        let found = estimator.look(sums);
        let picture_ends = Some([found.picture_low, found.picture_high]);
        if !self.interval.options.layers {
            return self.deliver_means(sums, &mut |band| on_band(Band { picture_ends, ..band }));
        }
        let ends = estimator.pixels(sums);
        self.deliver_means(sums, &mut |band| {
            let first = band.first_row as usize * self.size[0] as usize;
            let ends = &ends[first..first + band.mean.len()];
            let low = ends.iter().map(|[low, _]| low.map(rounded_down)).collect();
            let high = ends.iter().map(|[_, high]| high.map(rounded_up)).collect();
            on_band(Band { low, high, picture_ends, ..band })
        })
    }

    fn deliver_means(&self, sums: &IntervalSums, on_band: &mut dyn FnMut(Band) -> io::Result<()>) -> io::Result<()> {
        let [width, height] = self.size;
        for first_row in (0..height).step_by(BAND_ROWS as usize) {
            let rows = BAND_ROWS.min(height - first_row);
            let pixels = (first_row * width) as usize..((first_row + rows) * width) as usize;
            let mean = pixels.map(|pixel| sums.mean(pixel).map(|mean| mean as f32)).collect();
            on_band(Band { first_row, width, rows, samples: sums.samples(), mean, ..Band::default() })?;
        }
        Ok(())
    }
}

/// The largest number of single precision that is no more.
fn rounded_down(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) > value { nearest.next_down() } else { nearest }
}

/// The smallest one that is no less.
fn rounded_up(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) < value { nearest.next_up() } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_rounded_outwards() {
        for value in [0.1, 1.0 / 3.0, 1.0, 0.0, f64::INFINITY] {
            assert!(f64::from(rounded_down(value)) <= value && f64::from(rounded_up(value)) >= value);
        }
        assert_eq!((rounded_down(0.5), rounded_up(0.5)), (0.5, 0.5));
    }
}
