//! The contract of every lobe.
//!
//! All directions have unit length and point away from the surface; wo is where the light goes (back along the path), wi where it
//! comes from.

use glam::DVec3;

use super::lookup::Lookup;
use super::view::View;
use crate::scene::MaterialKind;
use crate::spectrum::Spectrum;

/// One way to scatter light, its parameters looked up for one hit.
pub trait Scatter: Sized {
    /// The lobe by which a material scatters; None where that is not one of this type.
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self>;

    /// About the share of light it scatters, by which lobes are chosen; where it is 0, the lobe is black.
    fn sampling_weight(&self) -> f64;

    /// Scatters into one or two directions only, which no other strategy can find.
    fn is_delta(&self) -> bool {
        false
    }

    /// f(wo, wi)·|cosθi|, and the density with which [`Scatter::sample`] draws wi. Zero for a delta lobe.
    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation;

    /// Draws wi. `u_lobe` chooses between the ways a lobe has, reflection and transmission or diffuse and specular; `u1` and `u2` the
    /// direction. None where nothing is scattered.
    fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample>;
}

/// How densely a direction was sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Density {
    /// The only direction a lobe (or the camera) has; no other strategy can find it.
    Delta,
    /// Per steradian.
    SolidAngle(f64),
}

/// A direction drawn from a BSDF.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BsdfSample {
    pub wi: DVec3,
    /// f·|cosθi| / density.
    pub weight: Spectrum,
    pub density: Density,
    /// Index of refraction on wi's side over that on wo's side: 1 for a reflection. Radiance is scaled by 1/eta² when light
    /// crosses, which is part of `weight`.
    pub eta: f64,
    /// The ray goes straight on through a null surface: the path's depth stays.
    pub is_null: bool,
}

impl BsdfSample {
    /// A direction on wo's side; the weight is still to be filled in.
    pub(super) fn reflected(wi: DVec3, density: Density) -> Self {
        Self { wi, weight: Spectrum::BLACK, density, eta: 1.0, is_null: false }
    }
}

/// f·|cosθi| and density of one pair of directions.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Evaluation {
    pub value: Spectrum,
    /// Per steradian.
    pub pdf: f64,
}
