//! Phase functions: how a medium scatters light. `shaders/shading/medium/phase.wgsl` is the same in f32.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::bsdf::{BsdfSample, Density, Evaluation};
use crate::math::Frame;
use crate::scene::{Phase, PhaseKind};
use crate::spectrum::Spectrum;

/// A medium's phase function where a path arrived along −wo. Its value is its density: samples have the weight 1.
#[derive(Debug, Clone, Copy)]
pub struct Scattering<'a> {
    pub phase: &'a Phase,
    pub wo: DVec3,
    /// No light sample finds a light here.
    pub is_dark: bool,
}

impl Scattering<'_> {
    /// The share of light that is scattered into a direction, per steradian, and the density with which it is drawn.
    pub fn evaluate(&self, wi: DVec3) -> Evaluation {
        let pdf = self.phase.0.iter().map(|lobe| lobe.weight * pdf_solid_angle(lobe.kind, self.wo, wi)).sum();
        Evaluation { value: Spectrum::grey(pdf), pdf }
    }

    /// Draws wi: `u_lobe` chooses one of the lobes, `u1` the angle with the direction before, `u2` the way around it.
    pub fn sample(&self, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let mut left = u_lobe;
        let chosen = self.phase.0.iter().find(|lobe| {
            left -= lobe.weight;
            left < 0.0
        });
        let kind = chosen.or(self.phase.0.last())?.kind;
        let (off_peak, is_ahead) = off_peak(kind, u1);
        let sine = (off_peak * (2.0 - off_peak)).max(0.0).sqrt();
        let along = if is_ahead { 1.0 - off_peak } else { off_peak - 1.0 };
        let (sine_around, cosine_around) = (TAU * u2).sin_cos();
        let local = DVec3::new(sine * cosine_around, sine * sine_around, along);
        let wi = Frame::around(-self.wo).to_world(local);
        let Evaluation { value, pdf } = self.evaluate(wi);
        (pdf > 0.0).then_some(BsdfSample { wi, weight: value / pdf, density: Density::SolidAngle(pdf), eta: 1.0, is_null: false })
    }
}

/// Density by solid angle of a direction. The angle with the way before comes from a difference of directions, which resolves narrow lobes.
fn pdf_solid_angle(kind: PhaseKind, wo: DVec3, wi: DVec3) -> f64 {
    match kind {
        PhaseKind::HenyeyGreenstein { g } => {
            let from_peak = if g >= 0.0 { wi + wo } else { wi - wo };
            let narrow = 1.0 - g.abs();
            let squared = narrow * narrow + g.abs() * from_peak.length_squared();
            (1.0 - g * g) / (4.0 * PI * squared * squared.sqrt())
        }
        PhaseKind::Rayleigh => {
            let cosine = wo.dot(wi);
            3.0 / (16.0 * PI) * (1.0 + cosine * cosine)
        }
    }
}

/// 1 less the cosine of the angle with the lobe's peak, at a share of the lobe, and true where the peak lies ahead and not behind.
fn off_peak(kind: PhaseKind, u: f64) -> (f64, bool) {
    match kind {
        // The inversion of Henyey and Greenstein's lobe, by the share from the peak on, so that nothing cancels near it.
        PhaseKind::HenyeyGreenstein { g } => {
            let from_peak = if g >= 0.0 { 1.0 - u } else { u };
            let (narrow, wide) = (1.0 - g.abs(), 1.0 + g.abs());
            let within = wide - 2.0 * g.abs() * from_peak;
            let off_peak = narrow * from_peak * (wide * narrow / within + narrow) / within;
            (off_peak.clamp(0.0, 2.0), g >= 0.0)
        }
        // The root of cos³ + 3·cos = 8u − 4
        PhaseKind::Rayleigh => {
            let half = 4.0 * u - 2.0;
            let cube = (half.abs() + (half * half + 1.0).sqrt()).cbrt();
            ((1.0 - (cube - 1.0 / cube) * half.signum()).clamp(0.0, 2.0), true)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::PhaseLobe;

    fn phases() -> Vec<Phase> {
        let kinds = [0.0, 0.6, -0.6, 0.99, -0.99].map(|g| PhaseKind::HenyeyGreenstein { g });
        let mut phases: Vec<Phase> = kinds.into_iter().chain([PhaseKind::Rayleigh]).map(Phase::of).collect();
        phases.push(Phase(vec![
            PhaseLobe { weight: 0.3, kind: kinds[1] },
            PhaseLobe { weight: 0.5, kind: PhaseKind::Rayleigh },
            PhaseLobe { weight: 0.2, kind: kinds[2] },
        ]));
        phases
    }

    /// Density by solid angle of a direction whose cosine with the direction before is `cosine`, by the formulas as they are published.
    fn pdf_by_cosine(Phase(lobes): &Phase, cosine: f64) -> f64 {
        let of_kind = |kind: PhaseKind| match kind {
            PhaseKind::HenyeyGreenstein { g } => (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cosine).powf(1.5)),
            PhaseKind::Rayleigh => 3.0 / (16.0 * PI) * (1.0 + cosine * cosine),
        };
        lobes.iter().map(|lobe| lobe.weight * of_kind(lobe.kind)).sum()
    }

    /// The share of directions on either side of each cosine, by samples and by the density.
    #[test]
    fn samples_follow_the_density() {
        let wo = DVec3::new(0.3, -0.5, 0.8).normalize();
        for phase in phases() {
            let scattering = Scattering { phase: &phase, wo, is_dark: false };
            let side = 200;
            let mut below = [0.0; 16];
            let number = |index: i32| (f64::from(index) + 0.5) / f64::from(side);
            for lobe in 0..40 {
                for row in 0..side {
                    let sample = scattering.sample((f64::from(lobe) + 0.5) / 40.0, number(row), 0.37).expect("a direction");
                    let cosine = -sample.wi.dot(wo);
                    for (bin, below) in below.iter_mut().enumerate() {
                        *below += f64::from(u8::from(cosine < edge(bin))) / f64::from(40 * side);
                    }
                }
            }
            for (bin, below) in below.iter().enumerate() {
                let steps = 200_000;
                let width = (edge(bin) + 1.0) / f64::from(steps);
                let integral: f64 =
                    (0..steps).map(|step| pdf_by_cosine(&phase, -1.0 + (f64::from(step) + 0.5) * width) * width * TAU).sum();
                assert!((below - integral).abs() < 0.01, "{phase:?} below {}: {below} and not {integral}", edge(bin));
            }
        }
    }

    fn edge(bin: usize) -> f64 {
        -1.0 + 2.0 * (bin as f64 + 1.0) / 16.0
    }

    /// The density by directions is that by cosines.
    #[test]
    fn densities_agree() {
        for phase in phases() {
            let wo = DVec3::Z;
            for step in 0..200 {
                let cosine = -1.0 + f64::from(step) / 100.0;
                let wi = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, -cosine);
                let [one, other] =
                    [Scattering { phase: &phase, wo, is_dark: false }.evaluate(wi).pdf, pdf_by_cosine(&phase, cosine)];
                assert!((one / other - 1.0).abs() < 1e-9, "{phase:?} at {cosine}: {one} and {other}");
            }
        }
    }
}
