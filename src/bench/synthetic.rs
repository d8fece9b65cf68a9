//! Estimators whose variance, bias and speed are known, so that the bench itself can be tested.

use super::subject::{BenchError, Run, Subject};
use crate::output::Image;
use crate::statistics::random::SplitMix64;

/// A picture of a ramp with normal noise, made in a time that is written down and not spent.
pub struct Synthetic {
    pub size: [u32; 2],
    /// Standard deviation of one sample.
    pub sigma: f64,
    /// Added to every value, whatever the samples.
    pub bias: f64,
    pub seconds_per_sample: f64,
    /// Spent on every picture besides.
    pub overhead: f64,
    /// Relative standard deviation of a run's time.
    pub time_noise: f64,
    /// The machine's present factor of run times, shared between subjects that run in turn.
    pub machine: std::rc::Rc<std::cell::Cell<f64>>,
    pub clock: SplitMix64,
}

impl Default for Synthetic {
    fn default() -> Self {
        Self {
            size: [64, 48],
            sigma: 0.2,
            bias: 0.0,
            seconds_per_sample: 1e-3,
            overhead: 0.0,
            time_noise: 0.0,
            machine: std::rc::Rc::new(std::cell::Cell::new(1.0)),
            clock: SplitMix64::new(77),
        }
    }
}

impl Synthetic {
    /// The converged value of a pixel.
    pub fn truth(&self, pixel: usize) -> f32 {
        0.25 + 0.5 * pixel as f32 / (self.size[0] * self.size[1]) as f32
    }

    /// The converged picture.
    pub fn converged(&self) -> Image {
        let [width, height] = self.size;
        let pixels = (0..(width * height) as usize).map(|pixel| [self.truth(pixel); 3]).collect();
        Image { width, height, pixels }
    }
}

impl Subject for Synthetic {
    fn render(&mut self, seed: u32, spp: u32) -> Result<Run, BenchError> {
        let mut random = SplitMix64::new(u64::from(seed) << 32 | u64::from(spp));
        let deviation = self.sigma / f64::from(spp).sqrt();
        let mut picture = self.converged();
        for pixel in &mut picture.pixels {
            *pixel = pixel.map(|truth| (f64::from(truth) + self.bias + deviation * random.normal()) as f32);
        }
        // The machine gets slower by a few per cent from run to run and then recovers, as shared machines do.
        let machine = self.machine.get();
        self.machine.set(if machine > 1.5 { 1.0 } else { machine * 1.004 });
        let noise = (self.time_noise * self.clock.normal()).exp();
        let seconds = (self.overhead + self.seconds_per_sample * f64::from(spp)) * machine * noise;
        let samples = u64::from(spp) * picture.pixels.len() as u64;
        Ok(Run { picture, seconds, rays: 3 * samples, samples, non_finite_samples: 0, build_seconds: 0.0, compile_seconds: 0.0 })
    }
}
