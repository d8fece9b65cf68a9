//! The media that bodies of a scene enclose.

use super::material::{MaterialId, MaterialKind};
use super::model::Scene;
use super::texture::ColorInput;
use crate::spectrum::Spectrum;

/// The longest distance that counts within a medium: that of light which leaves the scene is infinite.
pub const FARTHEST: f64 = 1e20;

/// The media of a scene, and the one behind a surface of each material. Media have numbers from 1; 0 stands for none.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Media {
    /// The extinction of each medium, per unit length; that of number 1 is the first.
    pub extinctions: Vec<Spectrum>,
    /// By material, the number of the medium that its surfaces enclose; 0: they bound none. Empty where the scene has no media.
    behind: Vec<usize>,
}

impl Media {
    /// The media of the absorbing bodies of a scene, and where there are some, a clear one for all other bodies that let light in through a
    /// boundary: within an absorbing body they take its place. A blend has the medium of the first part that absorbs, else a clear one.
    pub fn of(scene: &Scene) -> Self {
        let own = |kind: &MaterialKind| match kind {
            MaterialKind::Principled(principled) if principled.attenuation.is_some() => {
                principled.attenuation.map(|attenuation| attenuation.extinction())
            }
            MaterialKind::Principled(principled) => {
                (!principled.thin && principled.transmission != ColorInput::grey(0.0)).then_some(Spectrum::BLACK)
            }
            MaterialKind::Glass { thin, .. } | MaterialKind::RoughGlass { thin, .. } => (!thin).then_some(Spectrum::BLACK),
            _ => None,
        };
        let mut inside: Vec<Option<Spectrum>> = scene.materials.iter().map(|material| own(&material.kind)).collect();
        if inside.iter().flatten().all(|&extinction| extinction == Spectrum::BLACK) {
            return Self::default();
        }
        of_blends(scene, &mut inside);
        let mut media = Self::default();
        for extinction in inside {
            let number = extinction.map_or(0, |extinction| media.number(extinction));
            media.behind.push(number);
        }
        media
    }

    /// The number of the medium with this extinction, which is added where there is none.
    fn number(&mut self, extinction: Spectrum) -> usize {
        let known = self.extinctions.iter().position(|&other| other == extinction);
        1 + known.unwrap_or_else(|| {
            self.extinctions.push(extinction);
            self.extinctions.len() - 1
        })
    }

    /// The extinction within the medium of a number; 0 where that is none.
    pub fn extinction(&self, number: usize) -> Spectrum {
        number.checked_sub(1).map_or(Spectrum::BLACK, |index| self.extinctions[index])
    }

    /// The number of the medium that surfaces of a material enclose; 0: they bound none.
    pub fn behind(&self, material: MaterialId) -> usize {
        self.behind.get(material).copied().unwrap_or(0)
    }
}

/// Gives blends the extinction inside their parts.
fn of_blends(scene: &Scene, inside: &mut [Option<Spectrum>]) {
    // Parts before wholes, each material once. One that is a part of itself is for the check of the scene to refuse.
    let mut is_entered = vec![false; inside.len()];
    let mut to_visit = Vec::new();
    for root in 0..inside.len() {
        to_visit.push((root, false));
        while let Some((id, parts_are_known)) = to_visit.pop() {
            let MaterialKind::Blend { materials: [first, second], .. } = scene.materials[id].kind else { continue };
            if parts_are_known {
                let absorbs = |extinction: &Spectrum| *extinction != Spectrum::BLACK;
                let absorbing = inside[first].filter(absorbs).or(inside[second].filter(absorbs));
                inside[id] = absorbing.or(inside[first]).or(inside[second]);
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
        assert_eq!(both.extinctions.len(), 2);
        assert!(number("amber") != 0 && number("glass") != 0 && number("amber") != number("glass"));
        assert_eq!(number("pane"), 0);
        assert_eq!(both.extinctions[number("glass") - 1], Spectrum::BLACK);
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
