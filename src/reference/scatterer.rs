//! The place where a path scatters, and how: a surface with its BSDF, or a place within a medium with its phase function.

use glam::DVec3;

use super::bsdf::{Bsdf, BsdfSample, Density, Evaluation};
use super::guided::GuidedPhase;
use super::intersect::{Surface, SurfacePoint};
use super::layered::SurfaceScatterer;
use super::medium::MediumStack;
use crate::scene::{Media, ReceiverId};

/// The place where a path scatters.
#[derive(Debug, Clone, Copy)]
pub enum Interaction<'a> {
    /// On a surface; whether wo is on its front.
    Surface { surface: &'a Surface, front: bool },
    /// Within a medium, which belongs to a receiver.
    Medium(SurfacePoint, ReceiverId),
}

impl<'a> Interaction<'a> {
    pub fn surface(surface: &'a Surface, bsdf: &Bsdf) -> Self {
        Self::Surface { surface, front: bsdf.view.front }
    }

    /// A place within a medium, at which a path arrives along −wo. As a point of a surface it faces wo, and nothing keeps rays from leaving it.
    pub fn medium(position: DVec3, wo: DVec3, receiver: ReceiverId) -> Self {
        Self::Medium(SurfacePoint { position, normal: wo, error: 0.0 }, receiver)
    }

    pub fn point(&self) -> &SurfacePoint {
        match self {
            Self::Surface { surface, .. } => &surface.point,
            Self::Medium(point, _) => point,
        }
    }

    /// The receiver that it belongs to, by those of all shapes and instances; 0 where there are none of them.
    pub fn receiver(&self, of_shapes: &[ReceiverId]) -> ReceiverId {
        match self {
            Self::Surface { surface, .. } => of_shapes.get(surface.owner.shape).copied().unwrap_or(0),
            Self::Medium(_, receiver) => *receiver,
        }
    }

    /// Rays that go straight on here enter or leave a medium.
    pub fn is_open_boundary(&self, media: &Media) -> bool {
        matches!(self, Self::Surface { surface, .. } if media.is_open(surface.owner.material))
    }

    /// The media around rays that leave towards a direction, given those around the ray that arrived.
    pub fn media_towards(&self, stack: MediumStack, media: &Media, direction: DVec3) -> MediumStack {
        match self {
            Self::Surface { surface, front } => stack.towards(media, surface, *front, direction),
            Self::Medium(..) => stack,
        }
    }
}

/// How light is scattered there. Values are f·|cosθi| of surfaces, and those of the phase function within media.
#[derive(Debug, Clone, Copy)]
pub enum Scatterer<'a> {
    Surface(SurfaceScatterer<'a>),
    Medium(GuidedPhase<'a>),
}

impl Scatterer<'_> {
    /// The value towards a direction, delta lobes left out, and the density with which it is drawn.
    /// `key` is that of the numbers by which stacks of layers estimate the value.
    pub fn evaluate(&self, wi: DVec3, key: u32) -> Evaluation {
        match self {
            Self::Surface(bsdf) => bsdf.evaluate(wi, key),
            Self::Medium(phase) => phase.evaluate(wi),
        }
    }

    /// The density with which a direction is drawn, delta lobes left out; of stacks of layers, about that.
    pub fn pdf(&self, wi: DVec3) -> f64 {
        match self {
            Self::Surface(bsdf) => bsdf.pdf(wi),
            Self::Medium(phase) => phase.evaluate(wi).pdf,
        }
    }

    /// Draws wi; None where nothing is scattered.
    pub fn sample(&self, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        match self {
            Self::Surface(bsdf) => bsdf.sample(u_lobe, u1, u2),
            Self::Medium(phase) => phase.sample(u_lobe, u1, u2),
        }
    }

    /// Directions of light samples can be scattered.
    pub fn has_non_delta_lobe(&self) -> bool {
        match self {
            Self::Surface(bsdf) => bsdf.has_non_delta_lobe(),
            // No light sample within a dark medium finds a light
            Self::Medium(phase) => !phase.scattering.is_dark,
        }
    }

    /// The direction back along the path.
    pub fn wo(&self) -> DVec3 {
        match self {
            Self::Surface(bsdf) => bsdf.view().wo,
            Self::Medium(phase) => phase.scattering.wo,
        }
    }

    /// [`SurfaceScatterer::sent_on`] of surfaces with a guide.
    pub fn sent_on(&self) -> Option<[f64; 2]> {
        match self {
            Self::Surface(bsdf) => bsdf.sent_on(),
            Self::Medium(_) => None,
        }
    }

    /// [`SurfaceScatterer::unguided`]
    pub fn unguided(&self, wi: DVec3, density: Density) -> f64 {
        match self {
            Self::Surface(bsdf) => bsdf.unguided(wi, density),
            Self::Medium(phase) => phase.unguided(wi, density),
        }
    }
}
