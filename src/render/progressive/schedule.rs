//! How samples are cut into stages and steps.

use std::time::{Duration, Instant};

use crate::renderer::CAUTION;

/// Steps before a deadline add this much of what is done.
pub const GROWTH: f64 = 0.25;
/// And at least this factor is rendered before the error is looked at again.
pub const LEAST_GROWTH: f64 = 1.05;

/// With a deadline, a step lasts at least this long, lest steps be nothing but overhead.
const SHORTEST_STEP: Duration = Duration::from_millis(200);

/// The first stage has at least so many samples per pixel, all streams together.
const FEWEST_SAMPLES: u32 = 16;
/// Halves of what all pixels get, in each stream, need a sample each; and half of all samples goes where the noise is.
const FEWEST_ADAPTIVE_SAMPLES: u32 = 4;

/// Samples that are distributed at once. Their numbers are those of each stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AdaptiveStage {
    /// Samples that every pixel has, those of earlier stages included; even, and twice the last stage's.
    pub floor: u32,
    /// Samples per pixel that are spent at the end of the stage, on average.
    pub budget: u32,
}

/// The stages of `samples` samples per pixel in each of `streams` that follow the noise. Each has twice the samples of the one before, so that whenever
/// the render ends, what is spent is distributed by about the best that is known. None where samples are too few. They depend on numbers of samples
/// alone, never on what was seen, and not on what may end the render: a limit that is not reached changes nothing.
pub fn stages(samples: u32, streams: u32) -> Vec<AdaptiveStage> {
    if samples < FEWEST_ADAPTIVE_SAMPLES {
        return Vec::new();
    }
    // Half of every pixel's samples, in the last stage.
    let half = samples / FEWEST_ADAPTIVE_SAMPLES;
    let mut doublings = 0;
    while (2 * (half >> (doublings + 1))).saturating_mul(streams) >= FEWEST_SAMPLES {
        doublings += 1;
    }
    let stage = |number: u32| {
        let floor = (2 * (half >> doublings)) << number;
        AdaptiveStage { floor, budget: if number == doublings { samples } else { 2 * floor } }
    };
    (0..=doublings).map(stage).collect()
}

/// Keeps steps within the time, where a step goes over one part of the film after the other: cut off, it would leave the last of them without samples.
/// Elsewhere the renderer ends a step where it is, and there is no clock.
#[derive(Debug)]
pub struct Clock {
    deadline: Option<Instant>,
    /// Samples per pixel and second of the last step.
    rate: Option<f64>,
}

impl Clock {
    pub fn new(deadline: Option<Instant>) -> Self {
        Self { deadline, rate: None }
    }

    /// True where steps are to be kept within some time.
    pub fn runs(&self) -> bool {
        self.deadline.is_some()
    }

    /// Learns from a step of so many samples per pixel.
    pub fn learn(&mut self, samples: f64, took: Duration) {
        self.rate = Some(samples / took.as_secs_f64().max(1e-6));
    }

    /// How many requests the next step has, of `left` ones, where `wanted` would be good. None: there is no time even for one. The
    /// first step is always granted one, because there shall be a picture.
    pub fn fitting(&self, wanted: u32, left: u32, samples_per_request: f64) -> Option<u32> {
        let Some(deadline) = self.deadline else { return Some(wanted.min(left)) };
        let Some(rate) = self.rate else { return Some(1) };
        let requests_in = |seconds: f64| (rate * seconds / samples_per_request) as u32;
        let possible = requests_in(CAUTION * deadline.saturating_duration_since(Instant::now()).as_secs_f64());
        let worthwhile = requests_in(SHORTEST_STEP.as_secs_f64());
        (possible > 0).then(|| wanted.max(worthwhile).min(possible).min(left))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(samples: u32, streams: u32) -> Vec<(u32, u32)> {
        stages(samples, streams).iter().map(|stage| (stage.floor, stage.budget)).collect()
    }

    #[test]
    fn stages_double_and_end_with_all_samples() {
        assert_eq!(numbers(3, 1), []);
        assert_eq!(numbers(4, 1), [(2, 4)]);
        assert_eq!(numbers(256, 1), [(16, 32), (32, 64), (64, 128), (128, 256)]);
        assert_eq!(numbers(35, 8), [(2, 4), (4, 8), (8, 16), (16, 35)]);
        for samples in FEWEST_ADAPTIVE_SAMPLES..5_000 {
            for streams in [1, 8] {
                let stages = stages(samples, streams);
                assert!(stages.windows(2).all(|pair| pair[1].floor == 2 * pair[0].floor && pair[0].budget <= pair[1].floor));
                assert!(stages.iter().all(|stage| stage.floor >= 2 && stage.floor % 2 == 0 && stage.budget >= 2 * stage.floor));
                assert_eq!(stages.last().map(|stage| stage.budget), Some(samples));
            }
        }
    }

    #[test]
    fn steps_keep_within_the_time() {
        let mut clock = Clock::new(Some(Instant::now() + Duration::from_secs(10)));
        assert_eq!(clock.fitting(100, 200, 1.0), Some(1), "nothing is known of the speed");
        clock.learn(1.0, Duration::from_secs(1));
        assert!((1..=9).contains(&clock.fitting(100, 200, 1.0).unwrap_or(0)));
        assert_eq!(clock.fitting(1, 200, 1.0), Some(1));
        clock.learn(1000.0, Duration::from_secs(1));
        assert_eq!(clock.fitting(1, 2000, 1.0), Some(200), "shorter steps are nothing but overhead");
        assert_eq!(clock.fitting(1, 7, 1.0), Some(7), "the phase has no more");
        clock.learn(1.0, Duration::from_secs(11));
        assert_eq!(clock.fitting(100, 200, 1.0), None, "one request would take longer than is left");
        assert_eq!(Clock::new(None).fitting(100, 200, 1.0), Some(100));
    }
}
