//! Rendering until something other than a number of samples is reached: a time, an error, and with more samples where the noise is.
//!
//! Where only time may end a render early, the renderer itself goes over the film until then ([`Batch::deadline`]). Else a picture is rendered in **steps**, the first of which covers the whole film, so that it is whole whenever it ends. What steps bring is
//! averaged on the host.
//!
//! - With an error to reach, every step renders several **streams** of samples, each with random numbers of its own. Streams are
//!   independent whatever the sampler, so what they differ by tells the error of their mean ([`error`]).
//! - With samples that follow the noise, steps belong to **stages** ([`schedule`]). A stage gives every pixel its share, and then some of them
//!   more, by what their neighbours' samples show ([`allocation`]). A pixel has the first samples of one sequence, as many as that makes, and
//!   what it shows is their plain mean: what its own samples saw never decides how many more it gets. Did it, pixels whose first samples
//!   happened to be dark would get few more and stay dark: that estimator is biased.

pub mod allocation;
pub mod doublings;
pub mod error;
pub mod picture;
pub mod schedule;

use std::io;
use std::ops::Range;
use std::time::Instant;

use crate::film::Band;
use crate::renderer::{Batch, Observer, RenderError, RenderReport, RenderRequest, Renderer};
use crate::sampling::hash::mix;
use allocation::{MOST_DOUBLINGS, allocate};
use doublings::Doublings;
use error::{ErrorEstimate, ErrorEstimator};
use picture::Picture;
use schedule::{Clock, Stage, stages};

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
/// pixel that were spent on average.
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
    let in_sweeps = goal.deadline.is_none() || renderer.holds_whole_film();
    if goal.target_error.is_none() && !goal.adaptive && in_sweeps {
        let request = RenderRequest { rows: 0..size[1], samples: goal.samples.clone() };
        let batch = Batch { seed: Some(seed), deadline: goal.deadline, ..Batch::of(&request) };
        return render_sweeps(renderer, &batch, observer, on_band);
    }
    let start = Instant::now();
    let mut work = Work::new(renderer, size, seed, goal, observer);
    let stop = work.run();
    // What was rendered before a device was lost is not.
    if matches!(stop, Ok(_) | Err(RenderError::DeviceLost(_))) {
        work.picture.deliver(on_band)?;
    }
    let stop = stop?;
    let mut report = work.report;
    report.render_seconds = start.elapsed().as_secs_f64();
    report.interrupted = stop == Stop::Interrupted;
    Ok(Outcome { report, stop, error: work.error })
}

/// Where nothing but time may end a render before its last sample, the device's film has it all: the picture is, bit for bit, the one that no
/// limit would have given, as far as it goes.
fn render_sweeps(
    renderer: &mut dyn Renderer,
    batch: &Batch<'_>,
    observer: &dyn Observer,
    on_band: &mut dyn FnMut(Band) -> io::Result<()>,
) -> Result<Outcome, RenderError> {
    let report = renderer.render_batch(batch, observer, on_band)?;
    let stop = stop_of(&report).unwrap_or(Stop::Samples);
    Ok(Outcome { report, stop, error: None })
}

/// Why a batch ended early, if it did.
fn stop_of(report: &RenderReport) -> Option<Stop> {
    match (report.interrupted, report.out_of_time) {
        (true, _) => Some(Stop::Interrupted),
        (_, true) => Some(Stop::TimeLimit),
        _ => None,
    }
}

/// Samples of each stream that are rendered of the same pixels.
struct Part<'a> {
    /// Counted from the first of the goal.
    samples: Range<u32>,
    /// Which pixels take part; None: all.
    selection: Option<&'a [bool]>,
    /// What share of the pixels that is.
    share: f64,
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
            picture: Picture::new(size),
            estimator: goal.target_error.map(|_| ErrorEstimator::new(size, streams)),
            error: None,
            report: RenderReport::default(),
        }
    }

    fn run(&mut self) -> Result<Stop, RenderError> {
        let per_stream = (self.goal.samples.len() as u32 / self.streams).max(1);
        let may_end_early = self.goal.deadline.is_some() || self.goal.target_error.is_some();
        let stages = if self.goal.adaptive { stages(per_stream, self.streams, may_end_early) } else { Vec::new() };
        let ended = if stages.is_empty() {
            self.run_samples(&Part { samples: 0..per_stream, selection: None, share: 1.0 }, None)?
        } else {
            self.run_stages(&stages)?
        };
        Ok(ended.unwrap_or(Stop::Samples))
    }

    /// What the first samples of all pixels show decides which pixels get more, stage by stage. None: all are done and the goal is not
    /// reached.
    fn run_stages(&mut self, stages: &[Stage]) -> Result<Option<Stop>, RenderError> {
        let pixels = self.size[0] as usize * self.size[1] as usize;
        let mut doublings = Doublings::new(self.size);
        // How often each pixel's share of the stage is doubled by what it has.
        let mut levels = vec![0_u8; pixels];
        for (index, &Stage { floor, budget }) in stages.iter().enumerate() {
            let half = floor / 2;
            if index == 0 {
                if let Some(stop) =
                    self.run_samples(&Part { samples: 0..half, selection: None, share: 1.0 }, Some((&mut doublings, 0)))?
                {
                    return Ok(Some(stop));
                }
            } else {
                doublings.double();
            }
            let lacks_half: Vec<bool> = levels.iter().map(|level| *level == 0).collect();
            if let Some(stop) = self.run_selected(half..floor, &lacks_half, &mut doublings, 1)? {
                return Ok(Some(stop));
            }
            levels.iter_mut().for_each(|level| *level = level.saturating_sub(1));
            let wanted = allocate(self.size, doublings.halves(), f64::from(budget) / f64::from(floor), &levels);
            for level in 0..MOST_DOUBLINGS {
                // Indices of samples end somewhere.
                let Some(end) = floor.checked_mul(2 << level) else { break };
                let lacks: Vec<bool> = levels.iter().zip(&wanted).map(|(has, wanted)| *has <= level && level < *wanted).collect();
                if let Some(stop) = self.run_selected(end / 2..end, &lacks, &mut doublings, usize::from(level) + 2)? {
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
        self.run_samples(&Part { samples, selection, share }, Some((doublings, interval)))
    }

    /// The steps of a part. None: all of it is done and the goal is not reached.
    fn run_samples(
        &mut self,
        part: &Part<'_>,
        mut doublings: Option<(&mut Doublings, usize)>,
    ) -> Result<Option<Stop>, RenderError> {
        let samples_per_request = f64::from(self.streams) * part.share;
        let mut next = part.samples.start;
        while next < part.samples.end {
            let wanted = self.wanted_requests(samples_per_request);
            let Some(requests) = self.clock.fitting(wanted, part.samples.end - next, samples_per_request) else {
                return Ok(Some(Stop::TimeLimit));
            };
            let started = Instant::now();
            for stream in 0..self.streams {
                let ended = self.render_stream(stream, next..next + requests, part, &mut doublings)?;
                if ended.is_some() {
                    return Ok(ended);
                }
            }
            self.clock.learn(f64::from(requests) * samples_per_request, started.elapsed());
            next += requests;
            if self.is_good_enough() {
                return Ok(Some(Stop::TargetError));
            }
        }
        Ok(None)
    }

    /// One stream's part of a step; why it ended early, if it did.
    fn render_stream(
        &mut self,
        stream: u32,
        samples: Range<u32>,
        part: &Part<'_>,
        doublings: &mut Option<(&mut Doublings, usize)>,
    ) -> Result<Option<Stop>, RenderError> {
        let first = self.goal.samples.start;
        // Of what this part brings to a pixel's means.
        let part_of_mean = samples.len() as f32 / (part.samples.len() as u32 * self.streams) as f32;
        let request = RenderRequest { rows: 0..self.size[1], samples: first + samples.start..first + samples.end };
        // The first is the scene's own, so that a render that only time ends is the beginning of the one that nothing ends.
        let seed = if stream == 0 { self.seed } else { mix(self.seed ^ mix(stream)) };
        let batch = Batch { request: &request, seed: Some(seed), selection: part.selection, deadline: self.goal.deadline };
        let total = u64::from(self.size[0]) * u64::from(self.size[1]) * self.goal.samples.len() as u64;
        let observer = Offset { observer: self.observer, before: self.report.samples, total: total.max(self.report.samples) };
        let (picture, estimator) = (&mut self.picture, &mut self.estimator);
        let report = self.renderer.render_batch(&batch, &observer, &mut |band| {
            if let Some(estimator) = estimator {
                estimator.add(stream, &band, part.selection);
            }
            if let Some((doublings, interval)) = doublings {
                doublings.add(*interval, &band, part_of_mean);
            }
            picture.add(&band, part.selection, part.share);
            Ok(())
        })?;
        let ended = stop_of(&report);
        add_report(&mut self.report, report);
        Ok(ended)
    }

    /// Requests of the next step if there is time enough: many enough that looking costs little, few enough not to overshoot.
    fn wanted_requests(&self, samples_per_request: f64) -> u32 {
        let done = self.picture.samples();
        let growth = match (&self.error, self.goal.target_error) {
            (Some(error), Some(target)) => (error.upper / target).clamp(schedule::LEAST_GROWTH, 2.0) - 1.0,
            _ if self.goal.deadline.is_some() => schedule::GROWTH,
            // Nothing is to be looked at before the part is over.
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
