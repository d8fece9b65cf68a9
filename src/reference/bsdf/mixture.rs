//! All lobes of a surface together.

use glam::DVec3;

use super::blend;
use super::diffuse::Diffuse;
use super::lobe::Lobe;
use super::lookup::Lookup;
use super::phong_study::PhongStudy;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::reference::intersect::{Surface, UvSet};
use crate::reference::work;
use crate::sampling::sampler::LARGEST_NUMBER;
use crate::scene::{BlendMode, MaterialId, Scene};
use crate::spectrum::Spectrum;

/// The scattering at one hit: the lobes of all materials that the surface blends, parameters looked up, seen from one direction.
///
/// f = Σ wᵢ fᵢ. Sampling chooses lobe i with probability Pᵢ ∝ wᵢ·sᵢ, sᵢ being `Scatter::sampling_weight`, and lets it draw wi. A
/// delta lobe is the only one to find its wi, so its sample counts wᵢ fᵢ|cosθ| / (Pᵢ pdfᵢ). Another lobe's wi can be drawn by every
/// other non-delta lobe too: its density is Σ Pⱼ pdfⱼ over all of them, and the sample counts Σ wⱼ fⱼ|cosθ| over that density. So a
/// choice among non-delta lobes adds no noise of its own beyond how well the densities fit, and two that are alike are as one.
///
/// With [`BlendMode::Pick`] one material is chosen by its weight before anything else, and is then the surface's only one.
#[derive(Debug, Clone, PartialEq)]
pub struct Bsdf {
    pub view: View,
    lobes: Lobes,
    /// The sum of all lobes' weights, each times about the share of light that the lobe scatters.
    total: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct WeightedLobe {
    lobe: Lobe,
    weight: f64,
    /// Probability of being sampled; until all lobes are known, in proportion to it.
    probability: f64,
}

/// Lobes that can be sampled, in order. Most surfaces have one, and need no list for it.
#[derive(Debug, Clone, Default, PartialEq)]
struct Lobes {
    first: Option<WeightedLobe>,
    others: Vec<WeightedLobe>,
}

impl Lobes {
    /// Black lobes are left out: they are never sampled and add nothing.
    fn push(&mut self, lobe: Lobe, weight: f64) {
        let probability = weight * lobe.sampling_weight();
        if probability > 0.0 {
            let weighted = WeightedLobe { lobe, weight, probability };
            if self.first.is_none() { self.first = Some(weighted) } else { self.others.push(weighted) }
        }
    }

    fn iter(&self) -> impl Iterator<Item = &WeightedLobe> {
        self.first.iter().chain(&self.others)
    }

    /// With probabilities that add up to 1, and what they added up to before.
    fn normalized(mut self) -> (Self, f64) {
        let sum: f64 = self.iter().map(|weighted| weighted.probability).sum();
        self.first.iter_mut().chain(&mut self.others).for_each(|weighted| weighted.probability /= sum);
        (self, sum)
    }
}

impl Bsdf {
    /// `u_blend` picks the material where one is picked.
    pub fn new(scene: &Scene, surface: &Surface, wo: DVec3, u_blend: f64) -> Self {
        let view = View::new(wo, surface.point.normal, surface.shading_normal)
            .with_carried(surface.carried)
            .with_unperturbed_normal(surface.unperturbed_normal)
            .with_coat_normal(surface.coat_normal)
            .with_hemisphere(scene.render.hemisphere)
            .with_phong(PhongStudy::from(&scene.render))
            .with_tangents(surface.tangents)
            .with_second_tangents(surface.tangents_of(UvSet::Second));
        let view = if surface.is_mirrored { view.with_mirrored_normal(surface.shading_normal) } else { view };
        let lookup = Lookup::new(scene, surface, &view);
        let material = surface.owner.material;
        if scene.render.blend == BlendMode::Pick {
            let picked = pick(&lookup, material, u_blend).filter(|(_, two_sided)| *two_sided || view.front);
            let picked = picked.and_then(|(part, _)| Lobe::of(&scene.materials[part].kind, &lookup));
            return Self::mixture(view, picked.map(|lobe| (lobe, 1.0)));
        }
        let mut lobes = Collected::default();
        blend::for_each_sided_part(&lookup, material, |part, weight, two_sided| {
            if (two_sided || view.front)
                && let Some(lobe) = Lobe::of(&scene.materials[part].kind, &lookup)
            {
                lobes.push(lobe, weight);
            }
        });
        Self::of_lobes(view, lobes)
    }

    /// A surface of the given lobes, each with its weight.
    pub(super) fn mixture(view: View, lobes: impl IntoIterator<Item = (Lobe, f64)>) -> Self {
        let mut collected = Collected::default();
        lobes.into_iter().for_each(|(lobe, weight)| collected.push(lobe, weight));
        Self::of_lobes(view, collected)
    }

    fn of_lobes(view: View, collected: Collected) -> Self {
        let (lobes, total) = collected.finish().normalized();
        Self { view, lobes, total }
    }

    /// The sum of all lobes' weights, each times about the share of light that the lobe scatters.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Says that light sampling can contribute.
    pub fn has_non_delta_lobe(&self) -> bool {
        self.lobes.iter().any(|weighted| !weighted.lobe.is_delta())
    }

    /// The probability of lobes that scatter in all directions, whose samples a guide may replace.
    pub fn guided_probability(&self) -> f64 {
        self.lobes.iter().map(|weighted| weighted.lobe.broad_share() * weighted.probability).sum()
    }

    /// The non-delta lobes' f·|cosθi| and density.
    pub fn evaluate(&self, wi: DVec3) -> Evaluation {
        if !self.lobes.others.is_empty() {
            work::add(work::PART * self.lobes.others.len() as u64);
        }
        let mut sum = Evaluation::default();
        for weighted in self.lobes.iter() {
            let Evaluation { value, pdf } = weighted.lobe.evaluate(&self.view, wi);
            sum.value += value * weighted.weight;
            sum.pdf += pdf * weighted.probability;
        }
        sum.value *= self.view.shadowing(wi);
        sum
    }

    /// Draws wi: `u_lobe` chooses among lobes, `u1` and `u2` the direction. None where nothing is scattered.
    pub fn sample(&self, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let (chosen, u_own) = self.choose(u_lobe)?;
        let sample = chosen.lobe.sample(&self.view, u_own, u1, u2)?;
        // Light that goes straight on through a null surface meets no normal.
        let shadowing = if sample.is_null { 1.0 } else { self.view.shadowing(sample.wi) };
        if self.lobes.others.is_empty() {
            return Some(BsdfSample { weight: sample.weight * (chosen.weight * shadowing), ..sample });
        }
        match sample.density {
            Density::Delta => {
                Some(BsdfSample { weight: sample.weight * (chosen.weight / chosen.probability * shadowing), ..sample })
            }
            Density::SolidAngle(_) => {
                let Evaluation { value, pdf } = self.evaluate(sample.wi);
                (pdf > 0.0).then(|| BsdfSample { weight: value / pdf, density: Density::SolidAngle(pdf), ..sample })
            }
        }
    }

    /// The lobe to sample, and what is left of the random number for the lobe's own choice: uniform again. A lone lobe gets the
    /// number as it is.
    fn choose(&self, u: f64) -> Option<(&WeightedLobe, f64)> {
        if self.lobes.others.is_empty() {
            return self.lobes.first.as_ref().map(|lone| (lone, u));
        }
        let last = self.lobes.others.len();
        let mut before = 0.0;
        for (index, weighted) in self.lobes.iter().enumerate() {
            if u < before + weighted.probability || index == last {
                return Some((weighted, ((u - before) / weighted.probability).clamp(0.0, LARGEST_NUMBER)));
            }
            before += weighted.probability;
        }
        None
    }
}

/// Lobes being collected. The diffuse ones become one, of the weighted mean reflectance, and the first: a blend of Lambert surfaces
/// is a Lambert surface.
#[derive(Default)]
struct Collected {
    diffuse: Option<Spectrum>,
    others: Lobes,
}

impl Collected {
    fn push(&mut self, lobe: Lobe, weight: f64) {
        match lobe {
            Lobe::Diffuse(Diffuse { reflectance }) => {
                let sum = self.diffuse.get_or_insert(Spectrum::BLACK);
                *sum += reflectance * weight;
            }
            _ => self.others.push(lobe, weight),
        }
    }

    fn finish(self) -> Lobes {
        let Some(reflectance) = self.diffuse else { return self.others };
        let mut lobes = Lobes::default();
        lobes.push(Lobe::Diffuse(Diffuse { reflectance }), 1.0);
        self.others.iter().for_each(|weighted| lobes.push(weighted.lobe, weighted.weight));
        lobes
    }
}

/// The part whose share of [0, 1), as long as its weight, holds `u`.
pub fn pick(lookup: &Lookup<'_>, material: MaterialId, u: f64) -> Option<(MaterialId, bool)> {
    let (mut before, mut picked) = (0.0, None);
    blend::for_each_sided_part(lookup, material, |part, weight, two_sided| {
        if !lookup.scene.materials[part].is_blend() {
            // The last one also gets what rounding leaves.
            if u >= before || picked.is_none() {
                picked = Some((part, two_sided));
            }
            before += weight;
        }
    });
    picked
}
