//! Participating media: what fills shapes and the space around the sensor.
//!
//! - here: how dense a medium is, `homogeneous` and `heterogeneous`.
//! - `phase`: its phase function.
//! - `boundary`: which of them a shape names as `interior` and `exterior`; `import::Enclosures` says what follows.
//! - `volume`: values in space, `constvolume` and `gridvolume`.

mod boundary;
mod phase;
#[cfg(test)]
mod tests;
mod volume;

use std::num::NonZeroU32;
use std::rc::Rc;

use self::volume::Parameter;
use super::converter::Converter;
use super::plugin::Plugin;
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::medium::MediumEntry;
use crate::load::file::value::{Checked, Exactly, LARGEST, Located, NonNegative};
use crate::load::file::volume::{OutsideName, VolumeEntry};
use crate::load::import::measured_media;
use crate::spectrum::Spectrum;

impl Converter<'_> {
    /// Reports that media of a plugin are left out. Whether they are.
    fn leaves_media_out(&mut self, plugin: &Plugin) -> bool {
        let Some(integrator) = self.media.blind.clone() else { return false };
        let what = format!("medium beside {integrator}");
        self.drop(
            plugin,
            &what,
            "it is left out, as there: that integrator goes through media as if they were empty; volpath does not",
        );
        true
    }

    /// The medium that a sensor is within.
    pub fn medium_around(&mut self, sensor: &Rc<Plugin>) -> Result<Option<Located<String>>, SceneError> {
        let Some(medium) = sensor.first_of("medium").cloned() else { return Ok(None) };
        if self.leaves_media_out(sensor) {
            return Ok(None);
        }
        let name = self.medium(&medium)?;
        let place = medium.at();
        self.media.enclosures.around_camera = Some(name.clone());
        Ok(Some(place.at(name)))
    }

    /// The name of a medium, which is made once.
    fn medium(&mut self, plugin: &Rc<Plugin>) -> Result<String, SceneError> {
        if let Some(known) = self.media.names.get(&Rc::as_ptr(plugin)) {
            return Ok(known.clone());
        }
        plugin.visited.set(true);
        // They say how it is sampled, not what it is.
        plugin.without_effect(&["id", "sample_emitters", "has_spectral_extinction", "method", "strategy", "sampling_weight"]);
        let mut entry = match plugin.name.as_str() {
            "homogeneous" => MediumEntry { phase: self.phase_of(plugin)?, ..self.homogeneous(plugin)? },
            "heterogeneous" => MediumEntry { phase: self.phase_of(plugin)?, ..self.heterogeneous(plugin)? },
            other => {
                let what = format!("medium `{other}`");
                plugin.properties.iter().for_each(|property| property.used.set(true));
                plugin.children.iter().for_each(|child| child.used.set(true));
                self.drop(plugin, &what, "it takes and gives no light");
                MediumEntry::default()
            }
        };
        let wanted = if plugin.id.is_empty() { plugin.name.clone() } else { plugin.id.clone() };
        let name = self.scene.free_medium_name(&wanted);
        entry.name = plugin.at().at(name.clone());
        self.scene.file.medium.push(entry);
        self.media.names.insert(Rc::as_ptr(plugin), name.clone());
        Ok(name)
    }

    /// A medium that is the same everywhere: by what is scattered and absorbed, or by what is lost and the share of it that is scattered. That share
    /// may differ from place to place.
    fn homogeneous(&mut self, plugin: &Rc<Plugin>) -> Result<MediumEntry, SceneError> {
        let scale = self.plain_number(plugin, "scale", 1.0)?;
        if let Some(name) = plugin.text("material")? {
            // They are given per millimetre.
            let [absorption, scattering] = measured_media::coefficients(name).ok_or_else(|| {
                plugin
                    .error(format!("nothing is known of the medium `{name}`"))
                    .with_help(format!("there are {}", measured_media::names().join(", ")))
            })?;
            return of_coefficients(plugin, absorption * scale, scattering * scale);
        }
        if plugin.has("sigma_s") || plugin.has("sigma_a") {
            let absorption = self.volume_mean(plugin, "sigma_a", 0.0)? * scale;
            let scattering = self.volume_mean(plugin, "sigma_s", 0.0)? * scale;
            return of_coefficients(plugin, absorption, scattering);
        }
        let extinction = self.volume_mean(plugin, "sigma_t", 1.0)? * scale;
        let everywhere = Box::new(plugin.at().at(VolumeEntry { outside: Some(OutsideName::Border), ..one_voxel(plugin)? }));
        self.with_albedo(plugin, extinction, None, everywhere)
    }

    /// A medium whose density differs from place to place. There is none outside of the density's box.
    fn heterogeneous(&mut self, plugin: &Rc<Plugin>) -> Result<MediumEntry, SceneError> {
        let scale = self.plain_number(plugin, "scale", 1.0)?;
        // Versions before 2 called it by another name.
        let name = if plugin.has("density") { "density" } else { "sigma_t" };
        let (extinction, density) = match self.volume_parameter(plugin, name, 1.0)? {
            Parameter::Constant { value, to_world } => {
                let transform = self.transform(&to_world, plugin)?;
                (value * scale, VolumeEntry { transform, ..one_voxel(plugin)? })
            }
            Parameter::Grid(grid) => {
                let (mut density, tint) = self.density_entry(&grid)?;
                if scale != 1.0 {
                    density.scale = Some(plugin.at().at(plugin.possible(Checked::of(scale))?));
                }
                (tint, density)
            }
        };
        let density = Box::new(plugin.at().at(density));
        self.with_albedo(plugin, extinction, Some(density.clone()), density)
    }

    /// A medium that loses so much light where its density is 1. With an albedo that differs from place to place it has the density `otherwise`
    /// where it has no other.
    fn with_albedo(
        &mut self,
        plugin: &Rc<Plugin>,
        extinction: Spectrum,
        density: Option<Box<Located<VolumeEntry>>>,
        otherwise: Box<Located<VolumeEntry>>,
    ) -> Result<MediumEntry, SceneError> {
        match self.volume_parameter(plugin, "albedo", 0.75)? {
            Parameter::Constant { value: albedo, .. } => {
                if albedo.max_component() > 1.0 + 1e-6 {
                    self.approximate(plugin, "albedo of a medium above 1", "1 is taken, since more would make energy");
                }
                let scattering = extinction * albedo.clamp(Spectrum::BLACK, Spectrum::WHITE);
                Ok(MediumEntry { density, ..of_coefficients(plugin, extinction - scattering, scattering)? })
            }
            Parameter::Grid(grid) => {
                let place = plugin.at();
                let albedo = self.grid_entry(&grid, OutsideName::Border)?;
                let free = extinction.map(|lost| if lost > 1.0 / LARGEST { 1.0 / lost } else { LARGEST });
                Ok(MediumEntry {
                    density: Some(density.unwrap_or(otherwise)),
                    albedo_grid: Some(Box::new(grid.place().at(albedo))),
                    mean_free_path: Some(place.at(plugin.possible(Rgb::of(free))?)),
                    ..MediumEntry::default()
                })
            }
        }
    }
}

/// A medium by what it absorbs and scatters per unit length.
fn of_coefficients(plugin: &Plugin, absorption: Spectrum, scattering: Spectrum) -> Result<MediumEntry, SceneError> {
    let value = |value: Spectrum| -> Result<Option<Located<Rgb<NonNegative>>>, SceneError> {
        Ok(Some(plugin.at().at(plugin.possible(Rgb::of(value))?)))
    };
    Ok(MediumEntry { absorption: value(absorption)?, scattering: value(scattering)?, ..MediumEntry::default() })
}

/// A density of 1 in the unit cube.
fn one_voxel(plugin: &Plugin) -> Result<VolumeEntry, SceneError> {
    let place = plugin.at();
    let values = Some(place.at(vec![plugin.possible(Checked::of(1.0))?]));
    let resolution = Some(place.at(Exactly([NonZeroU32::MIN; 3])));
    Ok(VolumeEntry { resolution, values, ..VolumeEntry::default() })
}
