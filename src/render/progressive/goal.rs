//! The goal of a render, and its outcome.

use std::ops::Range;
use std::time::Instant;

use crate::confidence::{IntervalEstimate, IntervalGoal};
use crate::render::error_estimate::ErrorEstimate;
use crate::renderer::RenderReport;

/// Independent renderings whose mean is the picture, where its error must be known.
pub const STREAMS: u32 = 8;

/// The limits of a render, and the error that it shall reach.
#[derive(Debug, Clone, PartialEq)]
pub struct Goal {
    /// Absolute indices of the samples that a pixel gets at most (on average, where they follow the noise).
    pub samples: Range<u32>,
    /// The region that is rendered, first column and row, width and height; only of renders that nothing ends early.
    pub region: Option<[u32; 4]>,
    /// No step begins that would end later.
    pub deadline: Option<Instant>,
    /// Relative mean squared error (as `gpt compare` measures it) that the picture shall have at most, by the estimate with a margin for chance.
    pub target_error: Option<f64>,
    /// More samples where the picture is noisier; the renderer must have been made for it.
    pub adaptive: bool,
    /// Intervals that hold the truth, of samples that are independent of each other; only of renders of the whole picture, with no error to reach.
    pub interval: Option<IntervalGoal>,
}

/// Why a render ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// All samples are done.
    Samples,
    /// The time was up.
    TimeLimit,
    /// The error is as small as was asked for.
    TargetError,
    /// The intervals are as narrow as was asked for.
    TargetInterval,
    /// The observer asked for the end.
    Interrupted,
}

impl Stop {
    /// The name in statistics.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Samples => "samples",
            Self::TimeLimit => "time_limit",
            Self::TargetError => "target_error",
            Self::TargetInterval => "target_interval",
            Self::Interrupted => "interrupted",
        }
    }
}

/// The outcome of a render.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The report of the renderer.
    pub report: RenderReport,
    /// Why it ended.
    pub stop: Stop,
    /// The error as last estimated, where there was one to reach.
    pub error: Option<ErrorEstimate>,
    /// The intervals at the end, where some were asked for.
    pub interval: Option<IntervalEstimate>,
}

/// Why a batch ended early, if it did.
pub fn stop_of(report: &RenderReport) -> Option<Stop> {
    match (report.interrupted, report.out_of_time) {
        (true, _) => Some(Stop::Interrupted),
        (_, true) => Some(Stop::TimeLimit),
        _ => None,
    }
}
