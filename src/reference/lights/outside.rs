//! Light from outside the scene: how bright it is in a direction, and how directions to it are drawn.

use std::fmt::Debug;
use std::sync::Arc;

use glam::DVec3;

use crate::reference::warp;
use crate::sampling::sampler::uniform;
use crate::spectrum::Spectrum;

/// Everything outside the scene.
#[derive(Debug, Clone)]
pub enum Outside {
    /// Equal radiance from everywhere; black where there is no environment.
    Constant(Spectrum),
    Varying(Arc<dyn Environment>),
}

/// Radiance that differs from direction to direction.
pub trait Environment: Debug + Send + Sync {
    /// Radiance that arrives against a direction of length 1.
    fn radiance(&self, wi: DVec3) -> Spectrum;

    /// Draws a direction by 32 bits each. None where no light comes from there.
    fn sample(&self, bits_u: u32, bits_v: u32) -> Option<EnvironmentSample>;

    /// Density of [`Environment::sample`] per steradian.
    fn pdf(&self, wi: DVec3) -> f64;

    /// Luminance averaged over all directions.
    fn mean_luminance(&self) -> f64;
}

/// A direction that was drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnvironmentSample {
    pub wi: DVec3,
    pub radiance: Spectrum,
    /// Per steradian.
    pub pdf: f64,
}

impl Outside {
    /// Constant ones add up; one that varies stands alone.
    pub fn of(parts: impl Iterator<Item = Self>) -> Self {
        let mut constant = Spectrum::BLACK;
        for part in parts {
            match part {
                Self::Constant(radiance) => constant += radiance,
                Self::Varying(_) => return part,
            }
        }
        Self::Constant(constant)
    }

    /// Radiance that arrives against a direction of length 1.
    pub fn radiance(&self, wi: DVec3) -> Spectrum {
        match self {
            Self::Constant(radiance) => *radiance,
            Self::Varying(environment) => environment.radiance(wi),
        }
    }

    /// Draws a direction by 32 bits each.
    pub fn sample(&self, bits_u: u32, bits_v: u32) -> Option<EnvironmentSample> {
        match self {
            Self::Constant(radiance) => {
                let wi = warp::uniform_sphere(uniform(bits_u), uniform(bits_v));
                Some(EnvironmentSample { wi, radiance: *radiance, pdf: warp::UNIFORM_SPHERE_PDF })
            }
            Self::Varying(environment) => environment.sample(bits_u, bits_v),
        }
    }

    /// Density of [`Outside::sample`] per steradian.
    pub fn pdf(&self, wi: DVec3) -> f64 {
        match self {
            Self::Constant(_) => warp::UNIFORM_SPHERE_PDF,
            Self::Varying(environment) => environment.pdf(wi),
        }
    }

    /// Luminance averaged over all directions.
    pub fn mean_luminance(&self) -> f64 {
        match self {
            Self::Constant(radiance) => radiance.luminance(),
            Self::Varying(environment) => environment.mean_luminance(),
        }
    }

    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }
}
