//! The media that bodies of a scene enclose.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;

use super::light::{Light, LightStrength};
use super::light_groups::LightGroupId;
use super::light_links::ReceiverId;
use super::material::{Material, MaterialId, MaterialKind};
use super::medium::{Medium, MediumId, Phase};
use super::medium_grids::MediumGrids;
use super::model::Scene;
use super::shape::{Enclosure, Shape};
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
    pub is_light_sampled: bool,
    /// No light is within its bodies, and their surfaces bend all light that goes in or out: no light sample within them finds one.
    pub is_dark: bool,
    /// The light group of what is given off. Media that differ in it alone are not one.
    pub light_group: LightGroupId,
    /// The group of receivers to which places belong where it scatters light.
    pub receiver: ReceiverId,
}

impl Filling {
    /// Absorbs and does nothing else.
    fn absorbing(extinction: Spectrum) -> Self {
        let (scattering, emission) = (Spectrum::BLACK, Spectrum::BLACK);
        Self {
            extinction,
            scattering,
            emission,
            phase: Phase::isotropic(),
            grids: None,
            is_light_sampled: false,
            is_dark: false,
            light_group: 0,
            receiver: 0,
        }
    }

    /// A medium of a scene.
    pub fn of(medium: &Medium) -> Self {
        let Medium { scattering, emission, .. } = *medium;
        let (phase, grids) = (medium.phase.clone(), medium.grids.clone());
        Self {
            extinction: medium.extinction(),
            scattering,
            emission,
            phase,
            grids,
            is_light_sampled: false,
            is_dark: false,
            light_group: 0,
            receiver: 0,
        }
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
        let of_scene = |id: MediumId| Filling {
            light_group: scene.light_groups.of_medium(id),
            receiver: scene.light_links.of_medium(id),
            ..Filling::of(&scene.media[id])
        };
        let own = |material: &Material| match (&material.kind, material.interior) {
            (_, Some(id)) => Some(of_scene(id)),
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
        let inside: Vec<Option<Filling>> = scene.materials.iter().map(own).collect();
        let around_camera = scene.camera_medium.map(of_scene);
        if inside.iter().flatten().chain(&around_camera).all(Filling::is_clear) {
            return Self::default();
        }
        let inside = scene.with_that_of_parts(inside, |filling| !filling.is_clear());
        let mut media = Self::default();
        media.around_camera = around_camera.map_or(0, |filling| media.number(filling));
        media.behind = inside.into_iter().map(|filling| filling.map_or(0, |filling| media.number(filling))).collect();
        let lets_through = scene.materials_that(|material| matches!(material.kind, MaterialKind::Pass));
        media.is_open =
            scene.materials.iter().zip(lets_through).map(|(of, lets_through)| of.interior.is_some() && lets_through).collect();
        let open = media.behind.iter().zip(&media.is_open).filter_map(|(&number, &is_open)| is_open.then_some(number));
        for number in open.chain([media.around_camera]) {
            if number != 0 {
                media.fillings[number - 1].is_light_sampled = true;
            }
        }
        let dark = dark_media(scene, &media);
        for (filling, is_dark) in media.fillings.iter_mut().zip(dark) {
            filling.is_dark = is_dark;
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

    /// Some medium scatters light.
    pub fn scatter(&self) -> bool {
        self.fillings.iter().any(Filling::scatters)
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

/// By medium: no light is within its bodies, and no light sample gets through their surfaces. Bodies that are not closed for sure, that move or stand
/// in groups are not looked at.
fn dark_media(scene: &Scene, media: &Media) -> Vec<bool> {
    let mut is_dark: Vec<bool> = media.fillings.iter().map(|filling| filling.scatters() && !filling.is_light_sampled).collect();
    if !is_dark.contains(&true) {
        return is_dark;
    }
    let lets_through = scene.materials_that(|material| matches!(material.kind, MaterialKind::Pass));
    let is_light = |shape: &&Shape| shape.materials().any(|material| scene.emits(material));
    let moves = |shape: &Shape| shape.motion.is_some();
    // None: it may be anywhere.
    let mut lights: Vec<Option<[DVec3; 2]>> =
        scene.shapes.iter().filter(is_light).map(|shape| shape.bounds().filter(|_| !moves(shape))).collect();
    let stand = scene.lights.iter().filter_map(Light::delta).filter(|light| matches!(light.strength, LightStrength::Power(_)));
    lights.extend(stand.map(|light| Some([light.position; 2])));
    if scene.groups.iter().flat_map(|group| &group.shapes).any(|shape| is_light(&shape)) {
        lights.push(None);
    }
    let may_be_within = |body: [DVec3; 2]| {
        let meets = |[low, high]: [DVec3; 2]| low.cmple(body[1]).all() && high.cmpge(body[0]).all();
        lights.iter().any(|light| light.is_none_or(meets))
    };
    let keeps_out = |shape: &Shape| {
        // Edges of a large mesh take longest to look at.
        let is_body = || shape.geometry.enclosure() == Enclosure::Body;
        let is_at_rest = !moves(shape) && shape.face_materials_agree() && !lets_through[shape.material];
        is_at_rest && shape.bounds().is_some_and(|bounds| !may_be_within(bounds)) && is_body()
    };
    let of_groups = scene.groups.iter().flat_map(|group| &group.shapes);
    for (shape, is_alone) in scene.shapes.iter().map(|shape| (shape, true)).chain(of_groups.map(|shape| (shape, false))) {
        for number in shape.materials().map(|material| media.behind(material)).collect::<BTreeSet<_>>() {
            if number != 0 && is_dark[number - 1] && !(is_alone && keeps_out(shape)) {
                is_dark[number - 1] = false;
            }
        }
    }
    is_dark
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

    /// Emitters within a body, and surfaces that let light samples through, are looked for.
    #[test]
    fn media_are_dark_where_no_light_is_within() {
        let body = "[[medium]]\nname = 'milk'\nscattering = 2\n[[material]]\nname = 'milk'\ntype = 'glass'\ninterior = 'milk'\n\
                    [[material]]\nname = 'lamp'\ntype = 'emissive'\nradiance = 1\n[[material]]\nname = 'gone'\ntype = 'pass'\n";
        let ball = "[[shape]]\ntype = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'milk'\n";
        let emitter = |x: f64| format!("[[shape]]\ntype = 'sphere'\ncenter = [{x:?}, 0, 0]\nradius = 0.1\nmaterial = 'lamp'\n");
        let point = "[[light]]\ntype = 'point'\nposition = [0.5, 0.5, 0.5]\nintensity = 1\n";
        let tube = "[[shape]]\ntype = 'cylinder'\nfrom = [0, 0, 0]\nto = [0, 1, 0]\nradius = 1\nmaterial = 'milk'\n";
        let translucent = "[[material]]\nname = 'translucent'\ntype = 'blend'\nmaterials = ['milk', 'gone']\nweight = { type = 'constant', value = 0.5 }\n\
                    [[shape]]\ntype = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'translucent'\n";
        let is_dark = |shapes: &str| media(&format!("{body}{shapes}")).1.fillings.iter().any(|filling| filling.is_dark);
        assert!(is_dark(ball) && is_dark(&format!("{ball}{}", emitter(3.0))));
        for bright in [
            format!("{ball}{}", emitter(0.5)),
            format!("{ball}{point}"),
            tube.to_owned(),
            translucent.to_owned(),
            format!("{ball}{tube}"),
        ] {
            assert!(!is_dark(&bright), "{bright}");
        }
    }
}
