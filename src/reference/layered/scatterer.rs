//! A surface's BSDF with the stack that it may have.
//!
//! The lobes and the stack of a blend share what they scatter: the stack is chosen with probability P and draws wi by a walk, the lobes draw with the
//! rest. A direction counts for whichever drew it alone, since nobody knows the density of walks; so the sum of both is unbiased. Where it is weighed against a light
//! sample, the density is P times about that of walks, plus the rest times that of the lobes: the same function of wi for both samples.

use glam::DVec3;

use super::layers::LayersOfMaterials;
use super::stack::Stack;
use crate::reference::bsdf::{Bsdf, BsdfSample, Density, Evaluation, Lookup, View, blend, pick};
use crate::reference::guided::GuidedBsdf;
use crate::reference::intersect::Surface;
use crate::reference::tracking::Stream;
use crate::sampling::Guide;
use crate::sampling::hash::mix;
use crate::sampling::sampler::{LARGEST_NUMBER, uniform};
use crate::scene::{BlendMode, LayerModel, MaterialId, Scene};

/// The lobes of a surface with a guide, or with one of its stacks.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceScatterer<'a> {
    lobes: GuidedBsdf<'a>,
    stack: Option<WeightedStack<'a>>,
}

/// The stack that was chosen of a surface's.
#[derive(Debug, Clone, Copy)]
struct WeightedStack<'a> {
    stack: Stack<'a>,
    /// Its weight in the blend, over the probability of its choice among stacks.
    weight: f64,
    /// The probability with which it draws wi.
    probability: f64,
    /// Key of the numbers of walks that draw wi.
    key: u32,
}

impl<'a> SurfaceScatterer<'a> {
    /// `u_blend` picks the part of a blend where one is picked; `key` is that of numbers for stacks.
    pub fn new(
        (scene, layers): (&'a Scene, &'a LayersOfMaterials),
        guide: Option<&'a Guide>,
        (surface, bsdf): (&'a Surface, &'a Bsdf),
        u_blend: f64,
        key: u32,
    ) -> Self {
        let stack = if layers.is_empty() { None } else { WeightedStack::new((scene, layers), (surface, bsdf), u_blend, key) };
        let guide = guide.filter(|_| stack.is_none());
        Self { lobes: GuidedBsdf::new(guide, surface, bsdf), stack }
    }

    /// The surface as the path sees it.
    pub fn view(&self) -> &'a View {
        self.lobes.view()
    }

    /// [`GuidedBsdf::sent_on`]
    pub fn sent_on(&self) -> Option<[f64; 2]> {
        self.lobes.sent_on()
    }

    /// [`GuidedBsdf::unguided`]
    pub fn unguided(&self, wi: DVec3, density: Density) -> f64 {
        self.lobes.unguided(wi, density)
    }

    /// Directions of light samples can be scattered.
    pub fn has_non_delta_lobe(&self) -> bool {
        self.lobes.has_non_delta_lobe() || self.stack.is_some_and(|chosen| chosen.stack.layers.most_breadth > 0.0)
    }

    /// The value towards a direction, delta lobes left out, and about the density with which it is drawn. `key` is that of the numbers by which stacks
    /// estimate it.
    pub fn evaluate(&self, wi: DVec3, key: u32) -> Evaluation {
        let lobes = self.lobes.evaluate(wi);
        let Some(chosen) = &self.stack else { return lobes };
        let Evaluation { value, pdf } = chosen.evaluate(self.view(), wi, key);
        let value = value * (chosen.weight * self.view().shadowing(wi));
        Evaluation { value: lobes.value + value, pdf: chosen.shared_pdf(lobes.pdf, pdf) }
    }

    /// About the density with which a direction is drawn, delta lobes left out.
    pub fn pdf(&self, wi: DVec3) -> f64 {
        let lobes = self.lobes.evaluate(wi).pdf;
        self.stack.as_ref().map_or(lobes, |chosen| chosen.shared_pdf(lobes, chosen.pdf(self.view(), wi)))
    }

    /// Draws wi: `u_lobe` chooses between the stack and the lobes. None where nothing is scattered.
    pub fn sample(&self, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let Some(chosen) = &self.stack else { return self.lobes.sample(u_lobe, u1, u2) };
        let probability = chosen.probability;
        if u_lobe >= probability {
            let left = ((u_lobe - probability) / (1.0 - probability)).clamp(0.0, LARGEST_NUMBER);
            let sample = self.lobes.sample(left, u1, u2)?;
            let density = match sample.density {
                Density::Delta => Density::Delta,
                Density::SolidAngle(pdf) => Density::SolidAngle(chosen.shared_pdf(pdf, chosen.pdf(self.view(), sample.wi))),
            };
            return Some(BsdfSample { weight: sample.weight / (1.0 - probability), density, ..sample });
        }
        let own = (u_lobe / probability).min(LARGEST_NUMBER);
        let sample = chosen.sample(self.view(), [own, u1, u2])?;
        let density = match sample.density {
            Density::Delta => Density::Delta,
            Density::SolidAngle(_) => {
                let lobes = if probability < 1.0 { self.lobes.evaluate(sample.wi).pdf } else { 0.0 };
                Density::SolidAngle(chosen.shared_pdf(lobes, chosen.pdf(self.view(), sample.wi)))
            }
        };
        let weight = sample.weight * (chosen.weight / probability * self.view().shadowing(sample.wi));
        Some(BsdfSample { weight, density, ..sample })
    }
}

impl<'a> WeightedStack<'a> {
    fn new(
        (scene, layers): (&'a Scene, &'a LayersOfMaterials),
        (surface, bsdf): (&'a Surface, &'a Bsdf),
        u_blend: f64,
        key: u32,
    ) -> Option<Self> {
        let (view, material) = (&bsdf.view, surface.owner.material);
        let lookup = Lookup::new(scene, surface, view);
        let stack = |id| layers.of(id).map(|layers| Stack::new(scene, surface, layers, view));
        if scene.render.blend == BlendMode::Pick {
            let picked = pick(&lookup, material, u_blend).filter(|&(_, two_sided)| two_sided || view.front);
            return picked.and_then(|(id, _)| stack(id)).map(|stack| Self { stack, weight: 1.0, probability: 1.0, key });
        }
        // One of several stacks is chosen by its weight, and stands for all.
        let mut total = 0.0;
        let each = |visit: &mut dyn FnMut(MaterialId, f64)| {
            blend::for_each_sided_part(&lookup, material, |id, weight, two_sided| {
                if layers.of(id).is_some() && (two_sided || view.front) {
                    visit(id, weight);
                }
            });
        };
        each(&mut |_, weight| total += weight);
        let (mut below, mut chosen) = (0.0, None);
        let u = total * uniform(mix(key));
        each(&mut |id, weight| {
            if weight > 0.0 && (chosen.is_none() || u >= below) {
                chosen = Some(id);
            }
            below += weight;
        });
        let probability = if bsdf.total() > 0.0 { total / (total + bsdf.total()) } else { 1.0 };
        stack(chosen?).map(|stack| Self { stack, weight: total, probability, key })
    }

    fn evaluate(&self, view: &View, wi: DVec3, key: u32) -> Evaluation {
        if !self.leads_out(view, wi) {
            return Evaluation::default();
        }
        match self.stack.layers.model {
            LayerModel::Straight => self.stack.evaluate_straight(view.wo, wi),
            LayerModel::Walk => {
                let value = self.stack.estimate(view.wo, wi, &mut Stream::new(key));
                Evaluation { value, pdf: self.stack.about_pdf(view.wo, wi) }
            }
        }
    }

    fn pdf(&self, view: &View, wi: DVec3) -> f64 {
        match self.stack.layers.model {
            _ if !self.leads_out(view, wi) => 0.0,
            LayerModel::Straight => self.stack.evaluate_straight(view.wo, wi).pdf,
            LayerModel::Walk => self.stack.about_pdf(view.wo, wi),
        }
    }

    fn sample(&self, view: &View, numbers: [f64; 3]) -> Option<BsdfSample> {
        let sample = match self.stack.layers.model {
            LayerModel::Straight => self.stack.draw_straight(view.wo, numbers),
            LayerModel::Walk => self.stack.walk(view.wo, numbers, &mut Stream::new(mix(self.key ^ DRAW))),
        };
        sample.filter(|sample| self.leads_out(view, sample.wi))
    }

    /// The surface and its normal agree on which side a direction is.
    fn leads_out(&self, view: &View, wi: DVec3) -> bool {
        view.reflects(wi) || view.transmits(wi)
    }

    /// The density of a direction that the lobes and the stack draw with these.
    fn shared_pdf(&self, lobes: f64, stack: f64) -> f64 {
        (1.0 - self.probability) * lobes + self.probability * stack
    }
}

/// Tells the numbers of walks that draw from those that choose a stack.
const DRAW: u32 = 0x5851_f42d;
