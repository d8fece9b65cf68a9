//! How samples are cut into phases and steps.

use std::time::{Duration, Instant};

/// Steps before a deadline add this much of what is done.
pub const GROWTH: f64 = 0.25;
/// And at least this factor is rendered before the error is looked at again.
pub const LEAST_GROWTH: f64 = 1.05;

/// With a deadline, a step lasts at least this long, lest steps be nothing but overhead.
const SHORTEST_STEP: Duration = Duration::from_millis(200);
/// A step must be expected to end within this part of the time left.
const CAUTION: f64 = 0.95;

/// Fewest and most samples per pixel of the first phase, whose samples show where the noise is.
const PILOT_SAMPLES: (u32, u32) = (8, 32);
/// The first phase is this part of all.
const PILOT_SHARE: u32 = 16;
/// Each further phase ends at this many times the samples of the ones before it, so that what is known gets better and
/// little is spent by knowing less.
const PHASE_GROWTH: u32 = 4;
/// Samples per pixel that a request of a later phase is worth on average: the calmest pixel gets 1, half of that.
const SHARE: u32 = 2;

/// Samples that are distributed in one way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Phase {
    pub index: u32,
    /// Samples that a request asks for.
    pub requests: u32,
    /// Samples per pixel that one of them is worth on average; 1: every pixel gets one.
    pub share: u32,
}

/// The phases of a stream, one after the other. They depend on numbers of samples alone, never on what was seen.
#[derive(Debug)]
pub struct Phases {
    samples: u32,
    done: u32,
    end_of_first: u32,
    index: u32,
}

impl Phases {
    /// Of `samples` samples in each of `streams`; one phase unless the samples shall follow the noise.
    pub fn new(samples: u32, streams: u32, adaptive: bool) -> Self {
        let (fewest, most) = PILOT_SAMPLES;
        let pilot = ((samples.saturating_mul(streams) / PILOT_SHARE).clamp(fewest, most) / streams).max(1).min(samples);
        // Later phases take whole requests; the first takes along what would be left over.
        let pilot = pilot + (samples - pilot) % SHARE;
        Self { samples, done: 0, end_of_first: if adaptive { pilot } else { samples }, index: 0 }
    }
}

impl Iterator for Phases {
    type Item = Phase;

    fn next(&mut self) -> Option<Phase> {
        let left = self.samples - self.done;
        if left == 0 {
            return None;
        }
        let phase = if self.index == 0 {
            Phase { index: 0, requests: self.end_of_first, share: 1 }
        } else {
            let wanted = (PHASE_GROWTH - 1).saturating_mul(self.done);
            // A rest that is short beside the phase is no phase of its own.
            let samples = if left - wanted.min(left) < wanted / 2 { left } else { wanted };
            Phase { index: self.index, requests: samples.div_ceil(SHARE), share: SHARE }
        };
        self.done += phase.requests * phase.share;
        self.index += 1;
        Some(phase)
    }
}

/// Keeps steps within the time.
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

    fn phases(samples: u32, streams: u32, adaptive: bool) -> Vec<(u32, u32)> {
        Phases::new(samples, streams, adaptive).map(|phase| (phase.requests, phase.share)).collect()
    }

    #[test]
    fn phases_grow_and_add_up() {
        assert_eq!(phases(100, 1, false), [(100, 1)]);
        assert_eq!(phases(256, 1, true), [(16, 1), (24, 2), (96, 2)]);
        assert_eq!(phases(64, 8, true), [(4, 1), (6, 2), (24, 2)]);
        for samples in 1..5_000 {
            for streams in [1, 8] {
                let spent: u32 = phases(samples, streams, true).iter().map(|(requests, share)| requests * share).sum();
                assert_eq!(spent, samples);
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
