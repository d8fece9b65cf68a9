//! Participating media: what fills a body or the space around the camera, takes light away, scatters it and gives some off.

use std::sync::Arc;

use super::medium_grids::MediumGrids;
use crate::spectrum::Spectrum;

/// Index into [`crate::scene::Scene::media`].
pub type MediumId = usize;

/// A medium: homogeneous, or as its grids say.
#[derive(Debug, Clone, PartialEq)]
pub struct Medium {
    /// Name by which materials and the camera refer to it.
    pub name: String,
    /// Share of light that is absorbed, per unit length.
    pub absorption: Spectrum,
    /// Share of light that is scattered, per unit length.
    pub scattering: Spectrum,
    /// Radiance that is given off, per unit length.
    pub emission: Spectrum,
    /// How light that is scattered is spread over directions.
    pub phase: Phase,
    /// Grids by which the numbers above are multiplied from place to place; None: they hold everywhere.
    pub grids: Option<Arc<MediumGrids>>,
}

impl Medium {
    /// Share of light that is lost to a ray, per unit length: what is absorbed and what is scattered.
    pub fn extinction(&self) -> Spectrum {
        self.absorption + self.scattering
    }
}

impl Medium {
    /// A sentence about a number that is out of range.
    pub(super) fn check(&self) -> Result<(), String> {
        for (what, value) in [("absorption", self.absorption), ("scattering", self.scattering), ("emission", self.emission)] {
            if !value.is_finite() || value.min_component() < 0.0 {
                return Err(format!("its {what} must be finite and not negative"));
            }
        }
        let sum: f64 = self.phase.0.iter().map(|lobe| lobe.weight).sum();
        if self.phase.0.iter().any(|lobe| lobe.weight.is_nan() || lobe.weight < 0.0) || (sum - 1.0).abs() > 1e-6 {
            return Err(format!("the weights of its phase function must be from 0 to 1 and sum up to 1, not to {sum}"));
        }
        let is_wrong = |lobe: &PhaseLobe| matches!(lobe.kind, PhaseKind::HenyeyGreenstein { g } if g.is_nan() || g.abs() >= 1.0);
        if self.phase.0.iter().any(is_wrong) {
            return Err("the mean cosine of its phase function must be above -1 and below 1".into());
        }
        self.grids.as_ref().map_or(Ok(()), |grids| grids.check())
    }
}

/// A phase function: a mean of [lobes](PhaseLobe), whose weights sum up to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase(pub Vec<PhaseLobe>);

/// A part of a phase function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseLobe {
    /// The share of light that it scatters.
    pub weight: f64,
    pub kind: PhaseKind,
}

/// The shape of a phase function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PhaseKind {
    /// Henyey and Greenstein 1941, by the mean cosine between the directions before and after, within (−1, 1); 0: isotropic.
    HenyeyGreenstein { g: f64 },
    /// Scattering by what is much smaller than the wavelength: 3/(16π)·(1 + cos²).
    Rayleigh,
}

impl PhaseKind {
    /// About how evenly light is spread over directions, from 0 to 1.
    pub fn evenness(&self) -> f64 {
        match self {
            Self::HenyeyGreenstein { g } => 1.0 - g.abs(),
            Self::Rayleigh => 1.0,
        }
    }
}

impl Phase {
    /// All directions alike.
    pub fn isotropic() -> Self {
        Self::of(PhaseKind::HenyeyGreenstein { g: 0.0 })
    }

    /// About how evenly light is spread over directions, from 0 to 1: a guide, which knows the light and not the lobes, draws so much more of them.
    pub fn evenness(&self) -> f64 {
        self.0.iter().map(|lobe| lobe.weight * lobe.kind.evenness()).sum()
    }

    /// Mean cosine between the directions before and after light is scattered.
    pub fn mean_cosine(&self) -> f64 {
        let of_kind = |kind: PhaseKind| if let PhaseKind::HenyeyGreenstein { g } = kind { g } else { 0.0 };
        self.0.iter().map(|lobe| lobe.weight * of_kind(lobe.kind)).sum()
    }

    /// True of one lobe of Henyey and Greenstein's.
    pub fn is_henyey_greenstein(&self) -> bool {
        matches!(self.0.as_slice(), [PhaseLobe { kind: PhaseKind::HenyeyGreenstein { .. }, .. }])
    }

    /// A phase function of one lobe.
    pub fn of(kind: PhaseKind) -> Self {
        Self(vec![PhaseLobe { weight: 1.0, kind }])
    }
}
