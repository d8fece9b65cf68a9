//! Which intervals are wanted.

use gpt_scene::choices;

use crate::scene::{Guiding, PixelSampler, RenderSettings, SamplerKind};

choices! {
    /// The quantities of which each has an interval, all of them at the stated confidence together.
    pub enum IntervalScope {
        /// The mean of the picture.
        Picture = "picture",
        /// The means of tiles of 16 by 16 pixels.
        Tiles = "tiles",
        /// Every pixel.
        Pixels = "pixels",
    }

    /// The assumption on which upper ends of intervals stand. Lower ends stand on none, because light is never negative.
    pub enum IntervalBasis {
        /// No sample is brighter than a bound that follows from the scene, or from --clamp: the interval holds, whatever else the samples do.
        Bound = "bound",
        /// No sample is more than twice as bright as the brightest that was seen so far, anywhere in the picture: light that is brighter, and so rare that
        /// none of it has been seen, is not in the interval.
        Seen = "seen",
    }
}

/// Pixels along a side of a tile.
pub const TILE: u32 = 16;
/// The confidence where none is asked for.
pub const DEFAULT_CONFIDENCE: f64 = 0.99;
/// The fewest samples per pixel of a render with intervals.
pub const FEWEST_SAMPLES: u32 = 16;

/// The intervals of a render of one scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntervalGoal {
    /// The options, with the assumption that was settled.
    pub options: IntervalOptions,
    /// The brightest that a sample can be, by channel, where they stand on that.
    pub sample_bound: Option<[f64; 3]>,
}

/// The intervals that are asked for, and how narrow they are to become.
///
/// ```no_run
/// use gpt::Render;
///
/// let interval = gpt::IntervalOptions { target: Some(0.01), confidence: 0.99, ..Default::default() };
/// let options = gpt::RenderOptions { interval: Some(interval), samples: Some(1 << 20), ..Default::default() };
/// let image = gpt::Scene::load("cornell")?.render(&options)?;
/// println!("{:?}", image.outcome().and_then(|outcome| outcome.interval.as_ref()));
/// # Ok::<(), gpt::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntervalOptions {
    /// The render ends once half the width of each interval is at most this share of its value, or of a tenth of the picture's where that is more. None:
    /// intervals end no render.
    pub target: Option<f64>,
    /// The probability that all intervals hold, at all looks together.
    pub confidence: f64,
    pub of: IntervalScope,
    /// The assumption that was asked for. None: the scene's bound, where it has one.
    pub by: Option<IntervalBasis>,
    /// The bounds of every pixel are wanted, as layers.
    pub layers: bool,
}

impl Default for IntervalOptions {
    fn default() -> Self {
        Self { target: None, confidence: DEFAULT_CONFIDENCE, of: IntervalScope::Picture, by: None, layers: false }
    }
}

impl IntervalOptions {
    /// Samples become independent of each other, which intervals need. A guide has no bound, so none is learned unless it was asked for.
    pub fn apply(&self, settings: &mut RenderSettings) {
        settings.sampler = SamplerKind::Independent;
        settings.pixel_sampler = PixelSampler::SameAsPath;
        if settings.guiding == Guiding::Auto && self.by != Some(IntervalBasis::Seen) {
            settings.guiding = Guiding::Off;
        }
    }

    /// A number that is out of its range, in a sentence.
    pub fn mistake(&self) -> Option<String> {
        match self.target {
            Some(target) if !(target.is_finite() && target > 0.0) => {
                return Some(format!("target_interval is a share above 0, not {target}"));
            }
            _ => {}
        }
        let is_probability = self.confidence >= 0.5 && self.confidence < 1.0;
        (!is_probability).then(|| format!("confidence is at least 0.5 and below 1, not {}", self.confidence))
    }
}
