//! One material's way of scattering, its parameters looked up.

use glam::DVec3;

use super::conductor::{Conductor, Fresnel};
use super::diffuse::Diffuse;
use super::glass::Dielectric;
use super::glossy::Glossy;
use super::microfacet::{Ggx, SMALLEST_ALPHA};
use super::mirror::Mirror;
use super::phong::Phong;
use super::phong_glass::PhongGlass;
use super::rough_glass::RoughGlass;
use super::{BsdfSample, Density, Evaluation, Lookup, View};
use crate::scene::{ConductorFresnel, MaterialKind, MicrofacetDistribution};

/// An index of refraction nearer to 1 than this bends no ray that rounding would not: rough glass then scatters as smooth glass.
const SMALLEST_BEND: f64 = 1e-4;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lobe {
    Diffuse(Diffuse),
    Mirror(Mirror),
    Glossy(Glossy),
    Phong(Phong),
    Glass(Dielectric),
    RoughGlass(RoughGlass),
    PhongGlass(PhongGlass),
    Conductor(Conductor),
    /// The ray goes on as if nothing were there.
    Pass,
}

impl Lobe {
    /// None for what scatters nothing: emissive materials, and blends, which scatter by their parts.
    pub fn new(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let color = |input| lookup.color(input);
        let exponent = |input| lookup.scalar(input).max(0.0);
        Some(match kind {
            MaterialKind::Diffuse { reflectance } => Self::Diffuse(Diffuse { reflectance: color(reflectance) }),
            MaterialKind::Mirror { reflectance } => Self::Mirror(Mirror { reflectance: color(reflectance) }),
            MaterialKind::Glossy { reflectance, exponent: n } => {
                Self::Glossy(Glossy { reflectance: color(reflectance), exponent: exponent(n) })
            }
            MaterialKind::Phong { diffuse, specular, exponent: n } => {
                Self::Phong(Phong { diffuse: color(diffuse), specular: color(specular), exponent: exponent(n) })
            }
            MaterialKind::Glass { ior, reflectance, transmittance } => {
                Self::Glass(Dielectric { ior: *ior, reflectance: color(reflectance), transmittance: color(transmittance) })
            }
            MaterialKind::RoughGlass { ior, alpha, distribution, reflectance, transmittance } => {
                let dielectric = Dielectric { ior: *ior, reflectance: color(reflectance), transmittance: color(transmittance) };
                match distribution {
                    MicrofacetDistribution::Ggx => rough_glass(dielectric, lookup.scalar(alpha)),
                    MicrofacetDistribution::Phong => Self::PhongGlass(PhongGlass { dielectric, exponent: exponent(alpha) }),
                }
            }
            MaterialKind::Conductor { fresnel, alpha } => {
                let fresnel = match fresnel {
                    ConductorFresnel::Complex { eta, k } => Fresnel::Complex { eta: *eta, k: *k },
                    ConductorFresnel::Reflectance(reflectance) => Fresnel::Schlick(color(reflectance)),
                };
                Self::Conductor(Conductor { fresnel, alpha: lookup.scalar(alpha) })
            }
            MaterialKind::Pass => Self::Pass,
            MaterialKind::Emissive | MaterialKind::Blend { .. } => return None,
        })
    }

    /// About the share of light it scatters, by which lobes are chosen; where it is 0, the lobe is black.
    pub fn sampling_weight(&self) -> f64 {
        let dielectric = |d: &Dielectric| d.reflectance.max(d.transmittance).max_element();
        match self {
            Self::Diffuse(Diffuse { reflectance })
            | Self::Mirror(Mirror { reflectance })
            | Self::Glossy(Glossy { reflectance, .. }) => reflectance.max_element(),
            Self::Phong(phong) => (phong.diffuse + phong.specular).max_element(),
            Self::Glass(glass) => dielectric(glass),
            Self::RoughGlass(glass) => dielectric(&glass.dielectric),
            Self::PhongGlass(glass) => dielectric(&glass.dielectric),
            Self::Conductor(conductor) => conductor.fresnel.at(1.0).max_element(),
            Self::Pass => 1.0,
        }
    }

    /// Scatters into one or two directions only, which no other strategy can find.
    pub fn is_delta(&self) -> bool {
        match self {
            Self::Mirror(_) | Self::Glass(_) | Self::Pass => true,
            Self::Conductor(conductor) => conductor.is_smooth_surface(),
            Self::Diffuse(_) | Self::Glossy(_) | Self::Phong(_) | Self::RoughGlass(_) | Self::PhongGlass(_) => false,
        }
    }

    pub fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        match self {
            Self::Diffuse(diffuse) => diffuse.evaluate(view, wi),
            Self::Glossy(glossy) => glossy.evaluate(view, wi),
            Self::Phong(phong) => phong.evaluate(view, wi),
            Self::RoughGlass(glass) => glass.evaluate(view, wi),
            Self::PhongGlass(glass) => glass.evaluate(view, wi),
            Self::Conductor(conductor) => conductor.evaluate(view, wi),
            Self::Mirror(_) | Self::Glass(_) | Self::Pass => Evaluation::default(),
        }
    }

    /// `u_lobe` chooses between the ways a lobe has, reflection and transmission or diffuse and specular.
    pub fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        match self {
            Self::Diffuse(diffuse) => diffuse.sample(view, u1, u2),
            Self::Mirror(mirror) => mirror.sample(view),
            Self::Glossy(glossy) => glossy.sample(view, u1, u2),
            Self::Phong(phong) => phong.sample(view, u_lobe, u1, u2),
            Self::Glass(glass) => glass.sample_smooth(view, u_lobe),
            Self::RoughGlass(glass) => glass.sample(view, u_lobe, u1, u2),
            Self::PhongGlass(glass) => glass.sample(view, u_lobe, u1, u2),
            Self::Conductor(conductor) => conductor.sample(view, u1, u2),
            Self::Pass => {
                let sample = BsdfSample { passes: true, ..BsdfSample::reflected(-view.wo, Density::Delta) };
                Some(BsdfSample { weight: DVec3::ONE, ..sample })
            }
        }
    }
}

fn rough_glass(dielectric: Dielectric, alpha: f64) -> Lobe {
    if alpha < SMALLEST_ALPHA || (dielectric.ior - 1.0).abs() < SMALLEST_BEND {
        Lobe::Glass(dielectric)
    } else {
        Lobe::RoughGlass(RoughGlass { dielectric, ggx: Ggx { alpha } })
    }
}
