//! Scattering by a surface's BSDF, or by a medium's phase function, and by a guide together.
//!
//! A share g of the directions is drawn by the guide and the rest by the BSDF. Whichever drew it, a direction that other lobes than delta
//! lobes can have counts f·|cosθ| over the density of both together, g·p_guide + (1 − g)·p_bsdf, and light sampling is weighed against the
//! same sum. A sample of a delta lobe counts 1/(1 − g) times as much, as the guide leaves it to the BSDF. Directions of the guide that lead
//! below the surface bring nothing.

use glam::DVec3;

use super::bsdf::{Bsdf, BsdfSample, Density, Evaluation, View};
use super::intersect::Surface;
use super::phase::Scattering;
use crate::sampling::Guide;
use crate::sampling::guide::GuideCell;
use crate::sampling::guide::table::GUIDED_SHARE;
use crate::sampling::sampler::LARGEST_NUMBER;

/// A medium's phase function, and the guide where it takes part.
#[derive(Debug, Clone, Copy)]
pub struct GuidedPhase<'a> {
    pub scattering: Scattering<'a>,
    /// With the share of directions that it draws.
    guide: Option<(GuideCell<'a>, f64)>,
}

impl<'a> GuidedPhase<'a> {
    pub fn new(guide: Option<&'a Guide>, position: DVec3, scattering: Scattering<'a>) -> Self {
        let share = guide.map_or(0.0, |_| f64::from(GUIDED_SHARE) * scattering.phase.evenness());
        let cell = guide.filter(|_| share > 0.0).and_then(|guide| guide.cell_in_medium(position));
        Self { scattering, guide: cell.map(|cell| (cell, share)) }
    }

    /// The value of the phase function, and the density with which wi is drawn.
    pub fn evaluate(&self, wi: DVec3) -> Evaluation {
        let alone = self.scattering.evaluate(wi);
        let Some((cell, share)) = &self.guide else { return alone };
        Evaluation { pdf: (1.0 - share) * alone.pdf + share * cell.pdf(wi), ..alone }
    }

    /// How many times its density a direction would have without the guide, where that is its density with it.
    pub fn unguided(&self, wi: DVec3, density: Density) -> f64 {
        match (&self.guide, density) {
            (Some(_), Density::SolidAngle(pdf)) => self.scattering.evaluate(wi).pdf / pdf,
            _ => 1.0,
        }
    }

    /// Draws wi: `u_lobe` chooses between the guide and the phase function's lobes, `u1` and `u2` the direction.
    pub fn sample(&self, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let Some((cell, share)) = &self.guide else { return self.scattering.sample(u_lobe, u1, u2) };
        let wi = if u_lobe < *share {
            cell.sample(u1, u2)
        } else {
            let left = ((u_lobe - share) / (1.0 - share)).clamp(0.0, LARGEST_NUMBER);
            self.scattering.sample(left, u1, u2)?.wi
        };
        let Evaluation { value, pdf } = self.evaluate(wi);
        let sample = BsdfSample { wi, weight: value / pdf, density: Density::SolidAngle(pdf), eta: 1.0, is_null: false };
        (pdf > 0.0).then_some(sample)
    }
}

/// A surface's BSDF, and the guide where it takes part.
#[derive(Debug, Clone, Copy)]
pub struct GuidedBsdf<'a> {
    bsdf: &'a Bsdf,
    /// With the share of directions that it draws.
    guide: Option<(GuideCell<'a>, f64)>,
}

impl<'a> GuidedBsdf<'a> {
    pub fn new(guide: Option<&'a Guide>, surface: &Surface, bsdf: &'a Bsdf) -> Self {
        let share = guide.map_or(0.0, |_| f64::from(GUIDED_SHARE) * bsdf.guided_probability());
        let cell = guide.filter(|_| share > 0.0).and_then(|guide| guide.cell(surface.point.position, bsdf.view.normal()));
        Self { bsdf, guide: cell.map(|cell| (cell, share)) }
    }

    /// Directions of light samples can be scattered.
    pub fn has_non_delta_lobe(&self) -> bool {
        self.bsdf.has_non_delta_lobe()
    }

    /// The surface as the path sees it.
    pub fn view(&self) -> &'a View {
        &self.bsdf.view
    }

    /// [`GuideCell::sent_on`] of the guide; None where there is no guide.
    pub fn sent_on(&self) -> Option<[f64; 2]> {
        self.guide.as_ref().map(|(cell, _)| cell.sent_on())
    }

    /// The non-delta lobes' f·|cosθi|, and the density with which wi is drawn.
    pub fn evaluate(&self, wi: DVec3) -> Evaluation {
        let alone = self.bsdf.evaluate(wi);
        Evaluation { pdf: self.pdf(wi, alone.pdf), ..alone }
    }

    /// How many times its density a direction would have without the guide, where that is its density with it.
    pub fn unguided(&self, wi: DVec3, density: Density) -> f64 {
        match (&self.guide, density) {
            (None, _) => 1.0,
            (Some((_, share)), Density::Delta) => 1.0 / (1.0 - share),
            (Some(_), Density::SolidAngle(pdf)) => self.bsdf.evaluate(wi).pdf / pdf,
        }
    }

    /// The density of a direction that the BSDF alone draws with density `of_bsdf`.
    fn pdf(&self, wi: DVec3, of_bsdf: f64) -> f64 {
        let Some((cell, share)) = &self.guide else { return of_bsdf };
        let of_guide = if self.bsdf.view.reflects(wi) { cell.pdf(wi) } else { 0.0 };
        (1.0 - share) * of_bsdf + share * of_guide
    }

    /// Draws wi: `u_lobe` chooses between the guide and the BSDF's lobes, `u1` and `u2` the direction. None where nothing is scattered.
    pub fn sample(&self, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let Some((cell, share)) = &self.guide else { return self.bsdf.sample(u_lobe, u1, u2) };
        if u_lobe < *share {
            let wi = cell.sample(u1, u2);
            if !self.bsdf.view.reflects(wi) {
                return None;
            }
            let Evaluation { value, pdf } = self.evaluate(wi);
            let sample = BsdfSample { wi, weight: value / pdf, density: Density::SolidAngle(pdf), eta: 1.0, is_null: false };
            return (pdf > 0.0 && !value.is_black()).then_some(sample);
        }
        let left = ((u_lobe - share) / (1.0 - share)).clamp(0.0, LARGEST_NUMBER);
        let sample = self.bsdf.sample(left, u1, u2)?;
        match sample.density {
            Density::Delta => Some(BsdfSample { weight: sample.weight / (1.0 - share), ..sample }),
            Density::SolidAngle(alone) => {
                let pdf = self.pdf(sample.wi, alone);
                Some(BsdfSample { weight: sample.weight * (alone / pdf), density: Density::SolidAngle(pdf), ..sample })
            }
        }
    }
}
