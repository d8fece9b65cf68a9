//! Materials as glTF has them, before they are written: the principled one, how far it is there, and what it gives off.

use super::Writer;
use crate::scene::{BlendWeight, ColorInput, MaterialId, MaterialKind, MediumId, Principled, TextureId};
use crate::scene_writer::weights;

/// Depth of blends within blends that is looked into.
const MOST_DEPTH: usize = 100;

/// A material of glTF in terms of ours.
#[derive(Debug, Clone)]
pub struct Draft {
    pub surface: Principled,
    pub alpha: Alpha,
    pub emission: Option<ColorInput>,
    pub normal_map: Option<TextureId>,
    /// The surface is there from behind too.
    pub double_sided: bool,
    pub interior: Option<MediumId>,
}

/// The part of a surface that is there.
#[derive(Debug, Clone, PartialEq)]
pub enum Alpha {
    Opaque,
    /// The surface by a share, and what is behind it by the rest.
    Blend(Share),
    /// The surface where the share is at least the number.
    Mask(Share, f64),
}

/// A number from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub enum Share {
    Constant(f64),
    /// A function of a texture's texels; if `is_rest`, the rest to 1.
    Texels {
        weight: BlendWeight,
        is_rest: bool,
    },
}

impl Writer<'_> {
    /// The draft that stands for a material; None where nothing is to be seen.
    pub fn draft(&mut self, id: MaterialId, depth: usize) -> Option<Draft> {
        let scene = self.scene;
        let material = &scene.materials[id];
        let place = self.place_of(id);
        let made = match &material.kind {
            MaterialKind::Pass => None,
            MaterialKind::Blend { materials, weight } => self.draft_of_blend(*materials, weight, &place, depth),
            kind => {
                let surface = self.nearest(kind, &place);
                let opaque = Alpha::Opaque;
                Some(Draft { surface, alpha: opaque, emission: None, normal_map: None, double_sided: true, interior: None })
            }
        };
        let is_nothing = made.is_none();
        if is_nothing && material.interior.is_some() {
            self.drop("medium within an invisible surface", &place, "nothing is there");
        }
        let scatters = !matches!(material.kind, MaterialKind::Emissive | MaterialKind::Pass);
        if !material.two_sided && scatters {
            self.approximate("two_sided = false", &place, "its back scatters light too");
        }
        made.map(|made| Draft {
            normal_map: material.normal_map.or(made.normal_map),
            interior: material.interior.or(made.interior),
            ..made
        })
    }

    fn draft_of_blend(&mut self, parts: [MaterialId; 2], weight: &BlendWeight, place: &str, depth: usize) -> Option<Draft> {
        if depth > MOST_DEPTH {
            return None;
        }
        let [first, second] = parts;
        let is_nothing = |part: MaterialId| matches!(self.scene.materials[part].kind, MaterialKind::Pass);
        match [is_nothing(first), is_nothing(second)] {
            [true, true] => None,
            [false, true] if *weight == BlendWeight::Front => {
                let made = self.draft(first, depth + 1)?;
                Some(Draft { double_sided: false, ..made })
            }
            [is_rest, _] if is_rest || is_nothing(second) => {
                let made = self.draft(if is_rest { second } else { first }, depth + 1)?;
                let alpha = self.alpha(weight, is_rest, place);
                let alpha = self.both(made.alpha, alpha, place);
                Some(Draft { alpha, ..made })
            }
            _ => {
                let share = weights::constant(weight).unwrap_or_else(|| weights::mean(weight).0);
                let instead = if share >= 0.5 { "its first part alone is there" } else { "its second part alone is there" };
                self.approximate("blend of two materials", place, instead);
                self.draft(if share >= 0.5 { first } else { second }, depth + 1)
            }
        }
    }

    /// The share by which the first part of a blend is there, or the second one if `is_rest`.
    fn alpha(&mut self, weight: &BlendWeight, is_rest: bool, place: &str) -> Alpha {
        if let Some(share) = weights::constant(weight) {
            let share = if is_rest { 1.0 - share } else { share };
            return if share == 1.0 { Alpha::Opaque } else { Alpha::Blend(Share::Constant(share)) };
        }
        if let (BlendWeight::Threshold { tau, of }, false) = (weight, is_rest)
            && weights::of_texels(of).is_some()
            && !weights::has_threshold(of)
        {
            return Alpha::Mask(Share::Texels { weight: (**of).clone(), is_rest: false }, *tau);
        }
        if weights::of_texels(weight).is_some() {
            if weights::has_threshold(weight) {
                self.approximate("threshold of a weight", place, "texels are interpolated behind it");
            }
            return Alpha::Blend(Share::Texels { weight: weight.clone(), is_rest });
        }
        let (share, instead) = weights::mean(weight);
        self.approximate(format!("weight {}", weights::name(weight)), place, instead);
        let share = if is_rest { 1.0 - share } else { share };
        if share == 1.0 { Alpha::Opaque } else { Alpha::Blend(Share::Constant(share)) }
    }

    /// A surface that is there by two shares.
    fn both(&mut self, a: Alpha, b: Alpha, place: &str) -> Alpha {
        match (a, b) {
            (Alpha::Opaque, other) | (other, Alpha::Opaque) => other,
            (Alpha::Blend(Share::Constant(a)), Alpha::Blend(Share::Constant(b))) => Alpha::Blend(Share::Constant(a * b)),
            (first, second) => {
                self.approximate("opacity within an opacity", place, "one of them alone counts");
                let is_constant = matches!(first, Alpha::Blend(Share::Constant(_)));
                if is_constant { second } else { first }
            }
        }
    }

    pub fn place_of(&self, id: MaterialId) -> String {
        format!("material `{}`", self.materials.get(id))
    }
}
