//! Russian roulette: which paths go on, and by how much more those count.
//!
//! Without a guide a path goes on by its throughput. With one, throughput says little: a direction that the guide prefers is drawn with a high density, so the
//! throughput behind it is low although it leads to the light. There a path goes on by what it is expected to bring yet, beside what it was
//! expected to bring at its first guided surface (adjoint-driven roulette, Vorba and Křivánek 2016): the guide knows what surfaces send on.
//! `shaders/shading/path/roulette.wgsl` is the same in f32.

use crate::sampling::guide::table::{LEAST_SURVIVAL, SURVIVAL_FACTOR};
use crate::sampling::roulette::{CERTAIN_ROULETTE_DEPTH, LARGEST_SURVIVAL};
use crate::spectrum::Spectrum;

fn largest_survival(depth: u32) -> f64 {
    if depth < CERTAIN_ROULETTE_DEPTH { 1.0 } else { LARGEST_SURVIVAL }
}

/// The chance to survive by a throughput without the scaling of radiance by refraction.
pub fn survival(throughput: Spectrum, depth: u32) -> f64 {
    throughput.max_component().min(largest_survival(depth))
}

/// The light that a guided path was expected to bring at its first surface with a guide.
#[derive(Debug, Clone, Copy, Default)]
pub struct Expectation(Option<f64>);

impl Expectation {
    /// The chance to survive at a surface where the path arrives with a throughput, of which the surface sends on, on average: light that comes by way of its
    /// scattering, and all light. The first one sets what later ones are compared with, and ends no path. Nor do surfaces without a guide.
    pub fn survival(&mut self, arriving: Spectrum, sent_on: Option<[f64; 2]>, depth: u32) -> f64 {
        let largest = largest_survival(depth);
        let Some([by_scattering, all]) = sent_on else { return largest };
        let Some(first) = self.0 else {
            let expected = arriving.sum() * all;
            self.0 = (expected > 0.0).then_some(expected);
            return largest;
        };
        let expected = arriving.sum() * by_scattering;
        (f64::from(SURVIVAL_FACTOR) * expected / first).sqrt().max(f64::from(LEAST_SURVIVAL)).min(largest)
    }
}
