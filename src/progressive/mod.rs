//! Rendering until something other than a number of samples is reached: a time, an error, and with more samples where the noise is.
//!
//! A picture is rendered in **steps** that each cover the whole film, so that it is whole whenever it ends. What steps bring is
//! averaged on the host with weights that never depend on what was seen.
//!
//! - With an error to reach, every step renders several **streams** of samples, each with random numbers of its own. Streams are
//!   independent whatever the sampler, so what they differ by tells the error of their mean ([`error`]).
//! - With samples that follow the noise, steps belong to **phases**. A phase distributes its samples by what the phases before it
//!   saw ([`allocation`]) and has random numbers of its own: given the past, each of its pixels has the right mean, so the weighted
//!   sum of phases has it too. Were samples counted equally instead, pixels whose first samples happened to be dark would
//!   get few more and stay dark: that estimator is biased.

pub mod allocation;
pub mod error;
pub mod picture;
pub mod schedule;

use std::io;
use std::ops::Range;
use std::time::Instant;

use crate::film::Band;
use crate::render::{Allocation, Batch, Observer, RenderError, RenderReport, RenderRequest, Renderer};
use crate::sampling::hash::mix;
use error::{ErrorEstimate, ErrorEstimator};
use picture::Picture;
use schedule::{Clock, Phase, Phases};

/// Independent renderings whose mean is the picture, where its error must be known.
pub const STREAMS: u32 = 8;

/// What a render may spend, and what it shall reach.
#[derive(Debug, Clone, PartialEq)]
pub struct Goal {
    /// Absolute indices of the samples that a pixel gets at most (on average, where they follow the noise).
    pub samples: Range<u32>,
    /// No step begins that would end later.
    pub deadline: Option<Instant>,
    /// Relative mean squared error (as `gpt compare` measures it) that the picture shall have at most, with 95 % confidence.
    pub target_error: Option<f64>,
    /// More samples where the picture is noisier; the renderer must have been made for it.
    pub adaptive: bool,
}

/// Why a render ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    Samples,
    TimeLimit,
    TargetError,
    Interrupted,
}

/// What became of a render.
#[derive(Debug, Clone)]
pub struct Outcome {
    pub report: RenderReport,
    pub stop: Stop,
    /// The error as last estimated, where there was one to reach.
    pub error: Option<ErrorEstimate>,
}

/// Renders the whole film of `size` and hands it over as bands from the top. `Band::samples` of an adaptive picture are the samples per
/// pixel that its phases spent on average.
///
/// # Errors
/// What the renderer reports.
pub fn render(
    renderer: &mut dyn Renderer,
    size: [u32; 2],
    seed: u32,
    goal: &Goal,
    observer: &dyn Observer,
    on_band: &mut dyn FnMut(Band) -> io::Result<()>,
) -> Result<Outcome, RenderError> {
    let start = Instant::now();
    let mut work = Work::new(renderer, size, seed, goal, observer);
    let stop = work.run()?;
    work.picture.deliver(on_band)?;
    let mut report = work.report;
    report.render_seconds = start.elapsed().as_secs_f64();
    report.interrupted = stop == Stop::Interrupted;
    Ok(Outcome { report, stop, error: work.error })
}

/// A render under way.
struct Work<'a> {
    renderer: &'a mut dyn Renderer,
    observer: &'a dyn Observer,
    goal: &'a Goal,
    size: [u32; 2],
    seed: u32,
    streams: u32,
    clock: Clock,
    picture: Picture,
    estimator: Option<ErrorEstimator>,
    error: Option<ErrorEstimate>,
    report: RenderReport,
}

impl<'a> Work<'a> {
    fn new(renderer: &'a mut dyn Renderer, size: [u32; 2], seed: u32, goal: &'a Goal, observer: &'a dyn Observer) -> Self {
        let streams = if goal.target_error.is_some() { STREAMS } else { 1 };
        Self {
            renderer,
            observer,
            goal,
            size,
            seed,
            streams,
            clock: Clock::new(goal.deadline),
            picture: Picture::new(size, goal.adaptive),
            estimator: goal.target_error.map(|_| ErrorEstimator::new(size, streams)),
            error: None,
            report: RenderReport::default(),
        }
    }

    fn run(&mut self) -> Result<Stop, RenderError> {
        let per_stream = (self.goal.samples.len() as u32 / self.streams).max(1);
        for phase in Phases::new(per_stream, self.streams, self.goal.adaptive) {
            let allocation = (phase.share > 1).then(|| {
                let (mean, second_moment) = self.picture.moments();
                allocation::allocate(self.size, &mean, &second_moment, phase.share)
            });
            if let Some(stop) = self.run_phase(&phase, allocation.as_ref())? {
                return Ok(stop);
            }
        }
        Ok(Stop::Samples)
    }

    /// The steps of a phase. None: all of it is done and the goal is not reached.
    fn run_phase(&mut self, phase: &Phase, allocation: Option<&Allocation>) -> Result<Option<Stop>, RenderError> {
        let samples_per_request = f64::from(phase.share * self.streams);
        let mut done = 0;
        while done < phase.requests {
            let wanted = self.wanted_requests(samples_per_request);
            let Some(requests) = self.clock.fitting(wanted, phase.requests - done, samples_per_request) else {
                return Ok(Some(Stop::TimeLimit));
            };
            let started = Instant::now();
            for stream in 0..self.streams {
                if !self.render_stream(phase, stream, done..done + requests, allocation)? {
                    return Ok(Some(Stop::Interrupted));
                }
            }
            self.clock.learn(f64::from(requests) * samples_per_request, started.elapsed());
            done += requests;
            if self.is_good_enough() {
                return Ok(Some(Stop::TargetError));
            }
        }
        Ok(None)
    }

    /// One stream's part of a step; false where it was interrupted.
    fn render_stream(
        &mut self,
        phase: &Phase,
        stream: u32,
        requests: Range<u32>,
        allocation: Option<&Allocation>,
    ) -> Result<bool, RenderError> {
        let first = self.goal.samples.start;
        let request = RenderRequest { rows: 0..self.size[1], samples: first + requests.start..first + requests.end };
        // The first is the scene's own, so that a render that only time ends is the beginning of the one that nothing ends.
        let own = phase.index * self.streams + stream;
        let seed = if own == 0 { self.seed } else { mix(self.seed ^ mix(own)) };
        let batch = Batch { request: &request, seed: Some(seed), allocation };
        let total = u64::from(self.size[0]) * u64::from(self.size[1]) * self.goal.samples.len() as u64;
        let observer = Offset { observer: self.observer, before: self.report.samples, total: total.max(self.report.samples) };
        let (picture, estimator) = (&mut self.picture, &mut self.estimator);
        let report = self.renderer.render_batch(&batch, &observer, &mut |band| {
            // A band with fewer samples than were asked for was interrupted; where pixels have different numbers, it is no mean.
            if allocation.is_none() || band.samples == requests.len() as u32 {
                let weight = band.samples as f32 * phase.share as f32;
                if let Some(estimator) = estimator {
                    estimator.add(stream, &band, weight);
                }
                picture.add(&band, weight);
            }
            Ok(())
        })?;
        let interrupted = report.interrupted;
        add_report(&mut self.report, report);
        Ok(!interrupted)
    }

    /// Requests of the next step if there is time enough: many enough that looking costs little, few enough not to overshoot.
    fn wanted_requests(&self, samples_per_request: f64) -> u32 {
        let done = self.picture.samples();
        let growth = match (&self.error, self.goal.target_error) {
            (Some(error), Some(target)) => (error.upper / target).clamp(schedule::LEAST_GROWTH, 2.0) - 1.0,
            _ if self.goal.deadline.is_some() => schedule::GROWTH,
            // Nothing is to be looked at before the phase is over.
            _ => f64::INFINITY,
        };
        ((done * growth / samples_per_request) as u32).max(1)
    }

    fn is_good_enough(&mut self) -> bool {
        let (Some(estimator), Some(target)) = (&mut self.estimator, self.goal.target_error) else { return false };
        let estimate = estimator.look();
        self.error = Some(estimate);
        estimate.upper <= target
    }
}

/// Adds what a further batch did; the caller times the whole.
fn add_report(sum: &mut RenderReport, batch: RenderReport) {
    *sum = RenderReport {
        rays: sum.rays + batch.rays,
        samples: sum.samples + batch.samples,
        non_finite_samples: sum.non_finite_samples + batch.non_finite_samples,
        peak_device_bytes: sum.peak_device_bytes.max(batch.peak_device_bytes),
        ..batch
    };
}

/// Tells an observer of one batch as a part of the whole.
struct Offset<'a> {
    observer: &'a dyn Observer,
    before: u64,
    total: u64,
}

impl Observer for Offset<'_> {
    fn progress(&self, done: u64, _total: u64) {
        self.observer.progress(self.before + done, self.total.max(self.before + done));
    }

    fn stop_requested(&self) -> bool {
        self.observer.stop_requested()
    }
}
