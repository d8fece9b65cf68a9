//! Metals.

use super::Widths;
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::material::{MaterialEntry, conductor};
use crate::load::import::Input;
use crate::load::pbrt::converter::Converter;
use crate::load::pbrt::named_spectra::{self, NamedMetal};
use crate::load::pbrt::parameter::{Entity, Kind};
use crate::load::pbrt::spectrum::SpectrumKind;
use crate::load::pbrt::texture_entry::Use;
use crate::spectrum::Spectrum;

/// Reflectances are at most this there, where an index of refraction stands for one.
const LARGEST: f64 = 0.9999;
/// An index of 0 is a perfect mirror, which a small one is as well.
const SMALLEST: f64 = 1e-4;

impl Converter<'_> {
    pub(super) fn metal(&mut self, entity: &Entity) -> Result<MaterialEntry, SceneError> {
        let keys = self.metal_keys(entity, "", 1.0)?;
        let Widths { alpha, alpha_u, alpha_v } = self.widths(entity, "")?;
        Ok(MaterialEntry::from(conductor::Keys { alpha, alpha_u, alpha_v, ..keys }))
    }

    /// The index of refraction of a metal, whose parameters have this prefix, below what has the index `above`.
    pub(super) fn metal_keys(&mut self, entity: &Entity, prefix: &str, above: f64) -> Result<conductor::Keys, SceneError> {
        let place = entity.spot.place();
        let mut keys = conductor::Keys::default();
        let [eta_name, k_name] = ["eta", "k"].map(|name| format!("{prefix}{name}"));
        if let Some(node) = self.spectrum_node(entity, "reflectance", SpectrumKind::Albedo)? {
            if entity.has(&eta_name) || entity.has(&k_name) {
                let message = format!("a metal has either `reflectance` or `{eta_name}` and `{k_name}`");
                return Err(entity.spot_of("reflectance").error(message));
            }
            match self.input(&node, Use::Albedo, entity.spot_of("reflectance"))? {
                // An absorption index that reflects so much along the normal beside an index of 1.
                Input::Constant(reflectance) => {
                    let reflectance = reflectance.map(|share| share.min(LARGEST));
                    let k = reflectance.map(|share| 2.0 * (share / (1.0 - share)).sqrt());
                    keys.eta = Some(place.at(entity.possible(Rgb::of(Spectrum::WHITE / above))?));
                    keys.k = Some(place.at(entity.possible(Rgb::of(k / above))?));
                }
                texture @ Input::Texture(..) => {
                    let instead = "it reflects more at grazing angles by Schlick's approximation";
                    self.approximate(entity.spot_of("reflectance"), "texture of the reflectance of a metal", instead);
                    keys.reflectance = Some(place.at(entity.possible(texture.colour(&place))?));
                }
            }
            return Ok(keys);
        }
        let [eta_metal, k_metal] = [(&eta_name, "eta"), (&k_name, "k")].map(|(name, part)| named_metal(entity, name, part));
        if let (Some(metal), true) = (eta_metal, eta_metal == k_metal && above == 1.0)
            && let NamedMetal::Preset(preset) = metal
        {
            keys.preset = Some(place.at(preset));
            return Ok(keys);
        }
        // Copper where nothing is said.
        let (copper_eta, copper_k) = self.constants_of(NamedMetal::Preset(conductor::MetalEntry::Copper));
        let [mut eta, mut k] = [copper_eta, copper_k];
        for (value, name, metal, part) in [(&mut eta, &eta_name, eta_metal, 0), (&mut k, &k_name, k_metal, 1)] {
            if let Some(metal) = metal {
                let (of_eta, of_k) = self.constants_of(metal);
                *value = if part == 0 { of_eta } else { of_k };
            } else if let Some(colour) = self.plain_colour(entity, name, SpectrumKind::Unbounded)? {
                *value = colour;
            }
        }
        keys.eta = Some(place.at(entity.possible(Rgb::of((eta / above).max(Spectrum::grey(SMALLEST))))?));
        keys.k = Some(place.at(entity.possible(Rgb::of(k / above))?));
        Ok(keys)
    }
}

/// The metal that a spectrum names. Nothing where none is written: that is copper.
fn named_metal(entity: &Entity, name: &str, part: &str) -> Option<NamedMetal> {
    if !entity.has(name) {
        return named_spectra::metal(&format!("metal-Cu-{part}"), part);
    }
    match entity.find(name, &[Kind::Spectrum])?.texts() {
        [spectrum] => named_spectra::metal(spectrum, part),
        _ => None,
    }
}
