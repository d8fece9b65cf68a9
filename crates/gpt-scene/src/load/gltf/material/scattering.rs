//! Bodies that scatter light (KHR_materials_volume_scatter, a draft of November 2025).

use super::Surface;
use crate::load::file::colour::Rgb;
use crate::load::file::material::principled;
use crate::load::file::medium::{HenyeyGreensteinKeys, MediumEntry, PhaseEntry};
use crate::load::file::value::{Checked, MeanCosine, Rule};
use crate::scene::Attenuation;

const SCATTER: &str = "KHR_materials_volume_scatter";

impl Surface<'_, '_> {
    /// Scattering within a volume: the attenuation says what is lost, and the extension which share of that is scattered.
    pub(super) fn scattering(&mut self, keys: &mut principled::Keys) -> Result<(), String> {
        let Some(written) = self.colour(SCATTER, "multiscatterColor") else { return Ok(()) };
        let (Some(color), Some(distance)) = (keys.attenuation_color.take(), keys.attenuation_distance.take()) else {
            self.report_scattering("the volume takes no light, of which some could be scattered");
            return Ok(());
        };
        let seen = self.colour_within(written, [0.0, 1.0], "multiscatterColor");
        if seen.is_black() {
            (keys.attenuation_color, keys.attenuation_distance) = (Some(color), Some(distance));
            return Ok(());
        }
        let extinction = Attenuation { color: color.value.0, distance: distance.value.0 }.extinction();
        let scattering = extinction * seen.map(single_scattering_albedo);
        let cosine = self.number(SCATTER, "scatterAnisotropy", 0.0);
        let cosine = self.within(cosine, [MeanCosine::MINIMUM, MeanCosine::MAXIMUM], "scatterAnisotropy");
        let place = self.place();
        let name = self.material.name.clone().unwrap_or_else(|| self.key.clone());
        let name = place.at(self.importer.scene.free_medium_name(&name));
        keys.interior = Some(name.clone());
        self.importer.scene.file.medium.push(MediumEntry {
            name,
            absorption: Some(place.at(Rgb::of(extinction - scattering)?)),
            scattering: Some(place.at(Rgb::of(scattering)?)),
            phase: Some(PhaseEntry::HenyeyGreenstein(HenyeyGreensteinKeys { g: Checked::of(cosine)? })),
            ..MediumEntry::default()
        });
        Ok(())
    }

    /// Reports that nothing is scattered, where the file says that something is.
    pub(super) fn report_scattering(&mut self, why: &str) {
        if self.colour(SCATTER, "multiscatterColor").is_some_and(|colour| !colour.is_black()) {
            self.drop(SCATTER, &format!("nothing is scattered: {why}"));
        }
    }
}

/// The share of lost light that is scattered at each event, of a medium that shows this colour after many: the fit of Kulla and Conty (2017) for
/// isotropic scattering, as the extension has it.
pub fn single_scattering_albedo(seen: f64) -> f64 {
    let root = (9.59217 + 41.6808 * seen + 17.7126 * seen * seen).sqrt();
    (1.0 - (4.09712 + 4.20863 * seen - root).powi(2)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brighter_bodies_scatter_more_of_the_light() {
        let albedo = [0.0, 0.25, 0.5, 1.0].map(single_scattering_albedo);
        assert!(albedo.is_sorted() && albedo[0] < 1e-4 && albedo[3] > 0.9999, "{albedo:?}");
        // Another fit, of van de Hulst, from the albedo of one event to what is seen.
        let shown = |albedo: f64| {
            let root = (1.0 - albedo).sqrt();
            (1.0 - root) * (1.0 - 0.139 * root) / (1.0 + 1.17 * root)
        };
        for seen in [0.25, 0.5, 0.75] {
            let found = shown(single_scattering_albedo(seen));
            assert!((found - seen).abs() < 0.01, "{seen}: {found}");
            // The control: what is seen is not the albedo of one event.
            assert!((shown(seen) - seen).abs() > 0.05);
        }
    }
}
