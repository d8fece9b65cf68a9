//! Renders in steps, whose batches are averaged on the host.

use std::io;
use std::ops::Range;
use std::time::{Duration, Instant};

use super::allocation::{MOST_DOUBLINGS, allocate};
use super::batch_sums::BatchSums;
use super::doublings::Doublings;
use super::error::ErrorEstimator;
use super::goal::{Goal, Outcome, STREAMS, Stop, stop_of};
use super::keeping::StepBatch;
use super::schedule::{self, AdaptiveStage, Clock, stages};
use super::watching::Watch;
use crate::film::Band;
use crate::render::checkpoint::Checkpoint;
use crate::render::checkpoint::saved::{Saved, StepPosition, StepsState};
use crate::render::error_estimate::ErrorEstimate;
use crate::renderer::sink::keep_between;
use crate::renderer::state::{BatchState, Tally};
use crate::renderer::{Batch, Observer, RenderError, RenderReport, RenderRequest, Renderer};
use crate::sampling::hash::mix;

/// Samples of each stream that are rendered of the same pixels.
struct StepSamples<'a> {
    /// Counted from the first of the goal.
    samples: Range<u32>,
    /// Which pixels take part; None: all.
    selection: Option<&'a [bool]>,
    /// The share of the pixels that take part.
    share: f64,
}

/// A render under way.
pub struct Work<'a> {
    renderer: &'a mut dyn Renderer,
    observer: &'a dyn Observer,
    goal: &'a Goal,
    size: [u32; 2],
    seed: u32,
    streams: u32,
    clock: Clock,
    picture: BatchSums,
    estimator: Option<ErrorEstimator>,
    error: Option<ErrorEstimate>,
    report: RenderReport,
    checkpoint: Option<&'a mut Checkpoint>,
    /// The position in its steps.
    place: StepPosition,
    /// How often each pixel's share was doubled before the stage under way.
    levels: Vec<u8>,
    /// The state of an earlier render, until this one is at the same position.
    resume: Option<Resume>,
}

/// The position from which a render goes on.
struct Resume {
    place: StepPosition,
    doublings: Option<Doublings>,
    batch: BatchState,
}

impl<'a> Work<'a> {
    /// Nothing is rendered yet.
    pub fn new(renderer: &'a mut dyn Renderer, size: [u32; 2], seed: u32, goal: &'a Goal, observer: &'a dyn Observer) -> Self {
        let streams = if goal.target_error.is_some() { STREAMS } else { 1 };
        let clock = Clock::new(goal.deadline.filter(|_| !renderer.holds_whole_film()));
        Self {
            renderer,
            observer,
            goal,
            size,
            seed,
            streams,
            clock,
            picture: BatchSums::new(size),
            estimator: goal.target_error.map(|_| ErrorEstimator::new(size, streams)),
            error: None,
            report: RenderReport::default(),
            checkpoint: None,
            place: StepPosition::default(),
            levels: Vec::new(),
            resume: None,
        }
    }

    /// Keeps its states in the checkpoint.
    pub fn keep_in(&mut self, checkpoint: Option<&'a mut Checkpoint>) {
        self.checkpoint = checkpoint;
    }

    /// Hands over the picture as far as it is.
    ///
    /// # Errors
    /// Errors of the receiver.
    pub fn deliver(&self, on_band: &mut dyn FnMut(Band) -> io::Result<()>) -> io::Result<()> {
        self.picture.deliver(on_band)
    }

    /// The outcome of the render.
    pub fn outcome(self, stop: Stop, took: Duration) -> Outcome {
        let report = RenderReport { render_seconds: took.as_secs_f64(), interrupted: stop == Stop::Interrupted, ..self.report };
        Outcome { report, stop, error: self.error, interval: None }
    }

    /// Goes on from the state of an earlier render; None where it is of another picture.
    pub fn go_on_from(&mut self, saved: Saved) -> Option<()> {
        let StepsState { place, tally, radiance, counts, row_samples, streams, looks, error, doublings, levels, .. } =
            saved.steps?;
        self.picture = BatchSums::with_sums(self.size, radiance, counts, row_samples)?;
        self.estimator = match self.estimator.take() {
            Some(estimator) => Some(estimator.with_sums(streams, looks)?),
            None => None,
        };
        self.error = error;
        self.report.rays = tally.rays;
        self.report.samples = tally.samples;
        self.report.non_finite_samples = tally.non_finite_samples;
        self.report.clamped_samples = tally.clamped_samples;
        self.report.clamped_units = tally.clamped_units;
        let doublings = if doublings.is_empty() { None } else { Some(Doublings::with_means(self.size, doublings)?) };
        let pixels = self.size[0] as usize * self.size[1] as usize;
        if doublings.is_some() && levels.len() != pixels {
            return None;
        }
        self.levels = levels;
        self.resume = Some(Resume { place, doublings, batch: saved.batch });
        Some(())
    }

    /// Renders until the goal is reached or cannot be.
    ///
    /// # Errors
    /// Errors of the renderer.
    pub fn run(&mut self) -> Result<Stop, RenderError> {
        let per_stream = (self.goal.samples.len() as u32 / self.streams).max(1);
        let stages = if self.goal.adaptive { stages(per_stream, self.streams) } else { Vec::new() };
        if self.resume.as_ref().is_some_and(|resume| resume.doublings.is_none() != stages.is_empty()) {
            return Err(RenderError::Internal("the checkpoint does not fit the render's stages".to_owned()));
        }
        let ended = if stages.is_empty() {
            self.run_samples(&StepSamples { samples: 0..per_stream, selection: None, share: 1.0 }, None)?
        } else {
            self.run_stages(&stages)?
        };
        Ok(ended.unwrap_or(Stop::Samples))
    }

    /// Gives more samples to the pixels that need them by what the first samples of all pixels show, stage by
    /// stage. None: all are done and the goal is not reached.
    fn run_stages(&mut self, stages: &[AdaptiveStage]) -> Result<Option<Stop>, RenderError> {
        let pixels = self.size[0] as usize * self.size[1] as usize;
        let (mut at, kept) = match &mut self.resume {
            Some(resume) => (Some(resume.place), resume.doublings.take()),
            None => (None, None),
        };
        let mut doublings = kept.unwrap_or_else(|| Doublings::new(self.size));
        // How often each pixel's share of the stage is doubled by what it has.
        let mut levels = if at.is_some() { self.levels.clone() } else { vec![0_u8; pixels] };
        let first_stage = at.map_or(0, |place| place.stage);
        for (index, &AdaptiveStage { floor, budget }) in stages.iter().enumerate().skip(first_stage) {
            // The first interval that is not over.
            let resumed = at.take().map(|place| place.interval);
            let first = resumed.unwrap_or(0);
            self.place.stage = index;
            self.levels.clone_from(&levels);
            let half = floor / 2;
            if index == 0 && first == 0 {
                let part = StepSamples { samples: 0..half, selection: None, share: 1.0 };
                if let Some(stop) = self.run_samples(&part, Some((&mut doublings, 0)))? {
                    return Ok(Some(stop));
                }
            } else if resumed.is_none() {
                doublings.double();
            }
            if first <= 1 {
                let lacks_half: Vec<bool> = levels.iter().map(|level| *level == 0).collect();
                if let Some(stop) = self.run_selected(half..floor, &lacks_half, &mut doublings, 1)? {
                    return Ok(Some(stop));
                }
            }
            levels.iter_mut().for_each(|level| *level = level.saturating_sub(1));
            let wanted = allocate(self.size, doublings.halves(), f64::from(budget) / f64::from(floor), &levels);
            for level in 0..MOST_DOUBLINGS {
                // Indices of samples end somewhere.
                let Some(end) = floor.checked_mul(2 << level) else { break };
                let interval = usize::from(level) + 2;
                if interval < first {
                    continue;
                }
                let lacks: Vec<bool> = levels.iter().zip(&wanted).map(|(has, wanted)| *has <= level && level < *wanted).collect();
                if let Some(stop) = self.run_selected(end / 2..end, &lacks, &mut doublings, interval)? {
                    return Ok(Some(stop));
                }
            }
            levels = wanted;
            self.picture.settle(budget * self.streams);
        }
        Ok(None)
    }

    /// Samples of the pixels that lack them: interval number `interval` of the doublings.
    fn run_selected(
        &mut self,
        samples: Range<u32>,
        lacks: &[bool],
        doublings: &mut Doublings,
        interval: usize,
    ) -> Result<Option<Stop>, RenderError> {
        let selected = lacks.iter().filter(|selected| **selected).count();
        if selected == 0 {
            return Ok(None);
        }
        let share = selected as f64 / lacks.len() as f64;
        let selection = Some(lacks).filter(|lacks| selected < lacks.len());
        self.run_samples(&StepSamples { samples, selection, share }, Some((doublings, interval)))
    }

    /// The steps of a part. None: all of it is done and the goal is not reached.
    fn run_samples(
        &mut self,
        part: &StepSamples<'_>,
        mut doublings: Option<(&mut Doublings, usize)>,
    ) -> Result<Option<Stop>, RenderError> {
        let samples_per_request = f64::from(self.streams) * part.share;
        let mut resume = self.resume.take();
        let mut next = resume.as_ref().map_or(part.samples.start, |resume| resume.place.next);
        while next < part.samples.end {
            let (requests, first_stream) = match &resume {
                Some(resume) => (resume.place.requests, resume.place.stream),
                None => {
                    let wanted = self.wanted_requests(samples_per_request);
                    let Some(requests) = self.clock.fitting(wanted, part.samples.end - next, samples_per_request) else {
                        return Ok(Some(Stop::TimeLimit));
                    };
                    (requests, 0)
                }
            };
            let is_resumed = resume.is_some();
            let started = Instant::now();
            for stream in first_stream..self.streams {
                (self.place.next, self.place.requests, self.place.stream) = (next, requests, stream);
                let batch = resume.take().map(|resume| resume.batch);
                let ended = self.render_stream(next..next + requests, part, &mut doublings, batch.as_ref())?;
                if ended.is_some() {
                    return Ok(ended);
                }
            }
            if !is_resumed {
                self.clock.learn(f64::from(requests) * samples_per_request, started.elapsed());
            }
            next += requests;
            if self.is_good_enough() {
                return Ok(Some(Stop::TargetError));
            }
        }
        Ok(None)
    }

    /// The part of a step of the stream at whose place the render is; why it ended early, if it did.
    fn render_stream(
        &mut self,
        samples: Range<u32>,
        part: &StepSamples<'_>,
        doublings: &mut Option<(&mut Doublings, usize)>,
        resume: Option<&BatchState>,
    ) -> Result<Option<Stop>, RenderError> {
        let first = self.goal.samples.start;
        // The share of this part in a pixel's means.
        let part_of_mean = samples.len() as f32 / (part.samples.len() as u32 * self.streams) as f32;
        let request = RenderRequest { rows: 0..self.size[1], samples: first + samples.start..first + samples.end };
        // The first is the scene's own, so that a render that only time ends is the beginning of the one that nothing ends.
        let stream = self.place.stream;
        let seed = if stream == 0 { self.seed } else { mix(self.seed ^ mix(stream)) };
        let goal = self.goal;
        let batch = Batch { seed: Some(seed), selection: part.selection, deadline: goal.deadline, resume, ..Batch::of(&request) };
        let total = u64::from(self.size[0]) * u64::from(self.size[1]) * goal.samples.len() as u64;
        let observer = Offset { observer: self.observer, before: self.report.samples, total: total.max(self.report.samples) };
        self.place.interval = doublings.as_ref().map_or(0, |(_, interval)| *interval);
        let RenderReport { rays, samples, non_finite_samples, clamped_samples, clamped_units, .. } = self.report;
        let mut sink = StepBatch {
            checkpoint: self.checkpoint.as_deref_mut(),
            watch: Watch { observer: &observer, batch: &batch, width: self.size[0], region: None },
            picture: &mut self.picture,
            estimator: self.estimator.as_mut(),
            error: self.error,
            doublings: doublings.as_mut().map(|(doublings, _)| &mut **doublings),
            levels: &self.levels,
            place: self.place,
            tally: Tally { rays, samples, non_finite_samples, clamped_samples, clamped_units },
            selection: part.selection,
            share: part.share,
            part_of_mean,
        };
        // Between two batches, where every pixel has samples.
        if resume.is_none() && samples > 0 {
            let stops = self.observer.stop_requested();
            keep_between(&mut sink, stops, &BatchState::before(request.rows.clone(), Tally::default()))?;
            if stops {
                return Ok(Some(Stop::Interrupted));
            }
        }
        let report = self.renderer.render_into(&batch, &observer, &mut sink)?;
        let ended = stop_of(&report);
        add_report(&mut self.report, report);
        if self.observer.wants_rows() {
            let mut bands = Vec::new();
            // Collecting them cannot fail.
            let _ = self.picture.deliver(&mut |band| {
                bands.push(band);
                Ok(())
            });
            bands.into_iter().for_each(|band| self.observer.rows_so_far(band));
        }
        Ok(ended)
    }

    /// Requests of the next step if there is time enough: many enough that looking costs little, few enough not to overshoot. They depend on samples
    /// and what they showed alone, unless the clock runs.
    fn wanted_requests(&self, samples_per_request: f64) -> u32 {
        let done = self.picture.samples();
        let growth = match (&self.error, self.goal.target_error) {
            (Some(error), Some(target)) => (error.upper / target).clamp(schedule::LEAST_GROWTH, 2.0) - 1.0,
            _ if self.clock.runs() => schedule::GROWTH,
            // Nothing is to be looked at before the part is over.
            _ => f64::INFINITY,
        };
        ((done * growth / samples_per_request) as u32).max(1)
    }

    fn is_good_enough(&mut self) -> bool {
        let (Some(estimator), Some(target)) = (&mut self.estimator, self.goal.target_error) else { return false };
        let estimate = estimator.look();
        self.error = Some(estimate);
        self.observer.error_so_far(estimate.mean, estimate.upper);
        estimate.upper <= target
    }
}

/// Adds what a further batch did; the caller times the whole.
pub(super) fn add_report(sum: &mut RenderReport, batch: RenderReport) {
    *sum = RenderReport {
        rays: sum.rays + batch.rays,
        samples: sum.samples + batch.samples,
        non_finite_samples: sum.non_finite_samples + batch.non_finite_samples,
        clamped_samples: sum.clamped_samples + batch.clamped_samples,
        clamped_units: sum.clamped_units + batch.clamped_units,
        peak_device_bytes: sum.peak_device_bytes.max(batch.peak_device_bytes),
        ..batch
    };
}

/// Tells an observer of one batch as a part of the whole.
pub(super) struct Offset<'a> {
    pub observer: &'a dyn Observer,
    pub before: u64,
    pub total: u64,
}

impl Observer for Offset<'_> {
    fn progress(&self, done: u64, _total: u64) {
        self.observer.progress(self.before + done, self.total.max(self.before + done));
    }

    fn stop_requested(&self) -> bool {
        self.observer.stop_requested()
    }

    fn is_abandoned(&self) -> bool {
        self.observer.is_abandoned()
    }

    fn wants_rows(&self) -> bool {
        self.observer.wants_rows()
    }

    fn rows_so_far(&self, rows: Band) {
        self.observer.rows_so_far(rows);
    }
}
