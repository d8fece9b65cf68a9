//! The setting `clamp`: samples that are too bright are darkened, and what that takes is counted.

use crate::film::KernelLayer;
use crate::renderer::state::{CLAMP_UNITS, MOST_CLAMP_UNITS};
use crate::spectrum::Spectrum;

/// Clamping of one pixel in one pass.
pub struct Clamp {
    /// The brightest channel that a sample may have; infinite where nothing is clamped.
    limit: f64,
    /// Samples that were brighter.
    pub samples: u64,
    /// The luminance that they lost.
    taken: f64,
}

impl Clamp {
    /// Clamps the picture, and the layer of squares, which are those of its samples; other layers are left as
    /// they are.
    pub fn new(setting: f64, layer: Option<KernelLayer>) -> Self {
        let applies = setting > 0.0 && matches!(layer, None | Some(KernelLayer::Squares));
        Self { limit: if applies { setting } else { f64::INFINITY }, samples: 0, taken: 0.0 }
    }

    /// The sample, no brighter than allowed, in its own colour. One that is not finite is left to the film.
    pub fn darken(&mut self, radiance: Spectrum) -> Spectrum {
        let brightest = radiance.max_component();
        if !(brightest > self.limit && radiance.is_finite()) {
            return radiance;
        }
        let darkened = radiance * (self.limit / brightest);
        self.samples += 1;
        self.taken += (radiance - darkened).luminance();
        darkened
    }

    /// The luminance that was taken, as the film counts it.
    pub fn units(&self) -> u64 {
        (self.taken / self.limit * CLAMP_UNITS).min(MOST_CLAMP_UNITS) as u64
    }
}
