//! The media that bodies of a scene enclose.

use std::sync::Arc;

use super::material::{Material, MaterialId, MaterialKind};
use super::medium::{Medium, Phase};
use super::medium_grids::MediumGrids;
use super::model::Scene;
use super::texture::ColorInput;
use crate::spectrum::Spectrum;

/// The longest distance that counts within a medium: that of light which leaves the scene is infinite.
pub const FARTHEST: f64 = 1e20;

/// A place of a light nearer to a ray than this, by its distance from the ray's origin, is on it: no angles about it are drawn.
pub const LEAST_ASIDE: f64 = 1e-4;

/// Surfaces that a shadow ray goes through at most where they bound media.
pub const MOST_CROSSINGS: u32 = 4096;

/// Places at most at which a ray looks up the density of one medium on its way. A ray that needs more, through what is a million times denser in one
/// place than beside it, brings nothing.
pub const MOST_LOOKUPS: u32 = 1 << 16;

/// Light of which a smaller share than this is left along a shadow ray goes on by chance.
pub const FAINT: f64 = 1.0 / 16.0;

/// The medium within a body, as paths know it.
#[derive(Debug, Clone, PartialEq)]
pub struct Filling {
    /// Share of light that is lost, per unit length.
    pub extinction: Spectrum,
    /// Share of light that is scattered, per unit length.
    pub scattering: Spectrum,
    /// Radiance that is given off, per unit length.
    pub emission: Spectrum,
    /// How light that is scattered is spread over directions.
    pub phase: Phase,
    /// Grids by which the numbers above are multiplied from place to place.
    pub grids: Option<Arc<MediumGrids>>,
    /// Light samples reach it: the camera is within it, or a null surface bounds it.
    pub is_lit: bool,
}

impl Filling {
    /// Absorbs and does nothing else.
    fn absorbing(extinction: Spectrum) -> Self {
        let (scattering, emission) = (Spectrum::BLACK, Spectrum::BLACK);
        Self { extinction, scattering, emission, phase: Phase::isotropic(), grids: None, is_lit: false }
    }

    fn of(medium: &Medium) -> Self {
        let Medium { scattering, emission, .. } = *medium;
        let (phase, grids) = (medium.phase.clone(), medium.grids.clone());
        Self { extinction: medium.extinction(), scattering, emission, phase, grids, is_lit: false }
    }

    /// Attenuation per unit length and density by which places are drawn where light passes and is not scattered.
    pub fn tracking_rate(&self) -> f64 {
        let emits = !self.emission.is_black();
        let for_emission = self.grids.as_ref().filter(|_| emits).map_or(0.0, |grids| grids.emission_rate());
        self.extinction.max_component().max(for_emission)
    }

    /// Takes and gives nothing.
    pub fn is_clear(&self) -> bool {
        self.extinction.is_black() && self.emission.is_black()
    }

    /// Some of the light is scattered.
    pub fn scatters(&self) -> bool {
        !self.scattering.is_black()
    }
}

/// The media of a scene, and the one behind a surface of each material. Media have numbers from 1; 0 stands for none.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Media {
    /// Each medium; that of number 1 is the first.
    pub fillings: Vec<Filling>,
    /// By material, the number of the medium that its surfaces enclose; 0: they bound none. Empty where the scene has no media.
    behind: Vec<usize>,
    /// By material: some rays go straight on through its surfaces, into the medium that it names or out of it. Empty where the scene has no media.
    is_open: Vec<bool>,
    /// The number of the medium that the camera is within; 0: none.
    pub around_camera: usize,
}

impl Media {
    /// The media of a scene: those that its materials enclose, those below surfaces, absorbing bodies of glass, and where there are some, a clear one for all other bodies
    /// that let light in through a boundary: within another body they take its place. A blend has the medium of the first part that is not clear.
    pub fn of(scene: &Scene) -> Self {
        let own = |material: &Material| match (&material.kind, material.interior) {
            (_, Some(id)) => Some(Filling::of(&scene.media[id])),
            (MaterialKind::Principled(principled), None) if principled.attenuation.is_some() => {
                principled.attenuation.map(|attenuation| Filling::absorbing(attenuation.extinction()))
            }
            (MaterialKind::Principled(principled), None) if principled.subsurface.is_some() => {
                principled.subsurface.map(|subsurface| Filling::of(&subsurface.medium()))
            }
            (MaterialKind::Principled(principled), None) => (!principled.thin
                && principled.transmission != ColorInput::grey(0.0))
            .then_some(Filling::absorbing(Spectrum::BLACK)),
            (MaterialKind::Glass { thin, .. } | MaterialKind::RoughGlass { thin, .. }, None) => {
                (!thin).then_some(Filling::absorbing(Spectrum::BLACK))
            }
            _ => None,
        };
        let mut inside: Vec<Option<Filling>> = scene.materials.iter().map(own).collect();
        let around_camera = scene.camera_medium.map(|id| Filling::of(&scene.media[id]));
        if inside.iter().flatten().chain(&around_camera).all(Filling::is_clear) {
            return Self::default();
        }
        of_blends(scene, &mut inside);
        let mut media = Self::default();
        media.around_camera = around_camera.map_or(0, |filling| media.number(filling));
        media.behind = inside.into_iter().map(|filling| filling.map_or(0, |filling| media.number(filling))).collect();
        let lets_through = scene.materials_that(|material| matches!(material.kind, MaterialKind::Pass));
        media.is_open =
            scene.materials.iter().zip(lets_through).map(|(of, lets_through)| of.interior.is_some() && lets_through).collect();
        let lit = media.behind.iter().zip(&media.is_open).filter_map(|(&number, &is_open)| is_open.then_some(number));
        for number in lit.chain([media.around_camera]) {
            if number != 0 {
                media.fillings[number - 1].is_lit = true;
            }
        }
        media
    }

    /// The number of a medium, which is added where there is none like it.
    fn number(&mut self, filling: Filling) -> usize {
        let known = self.fillings.iter().position(|other| *other == filling);
        1 + known.unwrap_or_else(|| {
            self.fillings.push(filling);
            self.fillings.len() - 1
        })
    }

    /// The medium of a number; None where that is 0.
    pub fn filling(&self, number: usize) -> Option<&Filling> {
        number.checked_sub(1).map(|index| &self.fillings[index])
    }

    /// The number of the medium that surfaces of a material enclose; 0: they bound none.
    pub fn behind(&self, material: MaterialId) -> usize {
        self.behind.get(material).copied().unwrap_or(0)
    }

    /// Some rays go straight on through surfaces of a material, into a medium or out of it.
    pub fn is_open(&self, material: MaterialId) -> bool {
        self.is_open.get(material).copied().unwrap_or(false)
    }

    /// Shadow rays go from surface to surface: some null surface bounds a medium, or a medium differs from place to place, so that light along them is
    /// worth the way only where nothing opaque stands on it.
    pub fn order_shadow_rays(&self) -> bool {
        self.is_open.contains(&true) || self.fillings.iter().any(|filling| filling.grids.is_some())
    }

    /// Some medium gives off light.
    pub fn emit(&self) -> bool {
        self.fillings.iter().any(|filling| !filling.emission.is_black())
    }
}

/// Gives blends the medium inside their parts.
fn of_blends(scene: &Scene, inside: &mut [Option<Filling>]) {
    // Parts before wholes, each material once. One that is a part of itself is for the check of the scene to refuse.
    let mut is_entered = vec![false; inside.len()];
    let mut to_visit = Vec::new();
    for root in 0..inside.len() {
        to_visit.push((root, false));
        while let Some((id, parts_are_known)) = to_visit.pop() {
            let MaterialKind::Blend { materials: [first, second], .. } = scene.materials[id].kind else { continue };
            if parts_are_known {
                if inside[id].is_none() {
                    let parts = || [first, second].into_iter().filter_map(|part| inside[part].clone());
                    inside[id] = parts().find(|filling| !filling.is_clear()).or_else(|| parts().next());
                }
            } else if !std::mem::replace(&mut is_entered[id], true) {
                to_visit.extend([(id, true), (first, false), (second, false)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::load_toml_str;

    fn media(materials: &str) -> (Scene, Media) {
        let scene = format!(
            "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvfov = 40\n[[light]]\ntype = 'environment'\nradiance = 1\n{materials}"
        );
        let scene = load_toml_str(&scene, "media", std::path::Path::new("")).expect("a scene");
        let media = Media::of(&scene);
        (scene, media)
    }

    const AMBER: &str = "[[material]]\nname = 'amber'\ntype = 'principled'\ntransmission = 1\nattenuation_color = [1, 0.5, 0.1]\n\
                         attenuation_distance = 2\n";
    const GLASS: &str =
        "[[material]]\nname = 'glass'\ntype = 'glass'\n[[material]]\nname = 'pane'\ntype = 'glass'\nthin = true\n";

    #[test]
    fn clear_bodies_count_only_beside_absorbing_ones() {
        assert_eq!(media(GLASS).1, Media::default());
        let (scene, both) = media(&format!("{AMBER}{GLASS}"));
        let number =
            |name: &str| both.behind(scene.materials.iter().position(|material| material.name == name).expect("it is there"));
        assert_eq!(both.fillings.len(), 2);
        assert!(number("amber") != 0 && number("glass") != 0 && number("amber") != number("glass"));
        assert_eq!(number("pane"), 0);
        assert_eq!(both.fillings[number("glass") - 1].extinction, Spectrum::BLACK);
    }

    #[test]
    fn a_blend_has_the_medium_of_its_absorbing_part() {
        let blend = "[[material]]\nname = 'mixed'\ntype = 'blend'\nmaterials = ['glass', 'amber']\nweight = { type = 'constant', value = 0.5 }\n";
        let (scene, media) = media(&format!("{AMBER}{GLASS}{blend}"));
        let number =
            |name: &str| media.behind(scene.materials.iter().position(|material| material.name == name).expect("it is there"));
        assert_eq!(number("mixed"), number("amber"));
    }
}
