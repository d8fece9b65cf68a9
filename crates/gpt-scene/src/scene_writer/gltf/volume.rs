//! Media within bodies that let light in.

use serde_json::{Map, Value, json};

use super::Writer;
use crate::load::single_scattering_albedo;
use crate::scene::{Attenuation, ColorInput, Dispersion, MediumId, Phase, Principled};
use crate::spectrum::Spectrum;

/// Fraunhofer's lines C, d and F, in micrometres, by which Abbe's number is defined.
const LINES: [f64; 3] = [0.6563, 0.5876, 0.4861];
/// KHR_materials_dispersion over Abbe's number.
const DISPERSION: f64 = 20.0;

impl Writer<'_> {
    /// The extensions about what is within a surface: its volume, what that scatters, and its dispersion.
    pub fn volume(&mut self, surface: &Principled, interior: Option<MediumId>, place: &str) -> Map<String, Value> {
        let mut extensions = Map::new();
        if !has_volume(surface, interior) {
            if interior.is_some() {
                self.drop("medium within a surface that lets no light in", place, "nothing is within");
            }
            return extensions;
        }
        let mut volume = json!({ "thicknessFactor": 1.0 });
        let mut scatter = None;
        let attenuation = match interior {
            Some(id) => {
                let (attenuation, scattered) = self.medium(id, place);
                scatter = scattered;
                attenuation
            }
            None => surface.attenuation,
        };
        if let Some(Attenuation { color, distance }) = attenuation {
            volume["attenuationColor"] = json!(color.to_rgb());
            volume["attenuationDistance"] = json!(distance);
        }
        extensions.insert(self.uses("KHR_materials_volume").to_owned(), volume);
        if let Some(scatter) = scatter {
            extensions.insert(self.uses("KHR_materials_volume_scatter").to_owned(), scatter);
        }
        if let Some(dispersion) = surface.dispersion.filter(|_| surface.transmission != ColorInput::grey(0.0)) {
            let abbe = match dispersion {
                Dispersion::Abbe(abbe) => abbe,
                formula => {
                    self.approximate("formula of dispersion", place, "Abbe's number of it is taken");
                    let [red, middle, blue] = LINES.map(|line| formula.index(surface.ior, line));
                    (middle - 1.0) / (blue - red)
                }
            };
            if abbe.is_finite() && abbe > 0.0 {
                extensions.insert(self.uses("KHR_materials_dispersion").to_owned(), json!({ "dispersion": DISPERSION / abbe }));
            }
        }
        extensions
    }

    /// A medium as what is lost on a way, and how that is scattered.
    fn medium(&mut self, id: MediumId, place: &str) -> (Option<Attenuation>, Option<Value>) {
        let medium = &self.scene.media[id];
        if medium.grids.is_some() {
            self.approximate("grid of a medium", place, "it is as dense everywhere as its numbers say");
        }
        if !medium.emission.is_black() {
            self.drop("emission of a medium", place, "it gives off no light");
        }
        let extinction = medium.extinction();
        if extinction.is_black() {
            return (None, None);
        }
        let distance = 1.0 / extinction.max_component();
        let attenuation = Attenuation { color: (extinction * -distance).exp(), distance };
        if medium.scattering.is_black() {
            return (Some(attenuation), None);
        }
        let ([scattered, lost], mut seen) = ([medium.scattering, extinction].map(Spectrum::to_rgb), [0.0; 3]);
        for channel in 0..3 {
            seen[channel] = if lost[channel] > 0.0 { shown(scattered[channel] / lost[channel]) } else { 0.0 };
        }
        let g = self.mean_cosine(&medium.phase, place);
        (Some(attenuation), Some(json!({ "multiscatterColor": seen, "scatterAnisotropy": g })))
    }

    fn mean_cosine(&mut self, phase: &Phase, place: &str) -> f64 {
        if !phase.is_henyey_greenstein() {
            self.approximate("phase function", place, "Henyey and Greenstein's of the same mean cosine is taken");
        }
        phase.mean_cosine()
    }
}

/// Something is within the bodies that the surface encloses, or light is bent as it gets into them.
pub fn has_volume(surface: &Principled, interior: Option<MediumId>) -> bool {
    let [passes, scatters_on] = [surface.transmission, surface.diffuse_transmission].map(|share| share != ColorInput::grey(0.0));
    let is_filled = surface.attenuation.is_some() || interior.is_some();
    !surface.thin && (passes || scatters_on && is_filled)
}

/// The colour after many events of which each scatters this share: the inverse of what the importer takes it for, which ascends.
fn shown(albedo: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if single_scattering_albedo(middle) < albedo { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
