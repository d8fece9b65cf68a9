//! Participating media.

use std::sync::Arc;

use glam::DVec3;

use super::converter::Converter;
use super::directives::unknown;
use super::light::rgb;
use super::parameter::{Entity, Kind};
use super::spectrum::SpectrumKind;
use super::text::Spot;
use super::world::PlacedEntity;
use crate::load::error::{SceneError, show};
use crate::load::file::colour::Rgb;
use crate::load::file::medium::{HenyeyGreensteinKeys, MediumEntry, PhaseEntry};
use crate::load::file::reference::FileOr;
use crate::load::file::value::{Checked, Exactly, Located, MeanCosine, NonNegative, Rule};
use crate::load::file::volume::VolumeEntry;
use crate::load::import::measured_media;
use crate::load::memory;
use crate::load::volume::{self, MOST_VOLUME_BYTES, PlacedGrid};
use crate::observer::{Role, integrate, planck};
use crate::scene::VoxelGrid;
use crate::spectrum::Spectrum;

/// The integral of the CIE's ȳ over the wavelength in nanometres, by which light that no photometric value divides is brighter.
const INTEGRAL_OF_Y: f64 = 106.856_895;
/// Gas below this temperature in kelvin gives off no light there.
const COLDEST: f64 = 100.0;
/// Voxels of grids are numbers up to this, as many as memory may hold.
const VOXEL_BYTES: u64 = 64;

impl Converter<'_> {
    /// The name of the medium that has this name there; None of nothing, and where no integrator sees it.
    pub fn medium(&mut self, name: &str, spot: &Spot) -> Result<Option<String>, SceneError> {
        if name.is_empty() {
            return Ok(None);
        }
        let world = self.world.clone();
        let placed = world.media.get(name).ok_or_else(|| unknown("medium", name, spot, world.media.keys()))?;
        if let Some(known) = self.media.get(name) {
            return Ok(Some(known.clone()));
        }
        if let Some(integrator) = &self.blind {
            let what = format!("medium beside {integrator}");
            let instead = "it is left out, as there: that integrator goes through media as if they were empty; volpath does not";
            self.drop(&placed.entity.spot, what, instead);
            placed.entity.all_without_effect();
            return Ok(None);
        }
        let entry = self.medium_entry(placed)?;
        self.report_unused(&placed.entity);
        let made = self.add_medium(&placed.entity.spot, name, entry);
        self.media.insert(name.to_owned(), made.clone());
        Ok(Some(made))
    }

    fn add_medium(&mut self, spot: &Spot, wanted: &str, mut entry: MediumEntry) -> String {
        let name = self.scene.free_medium_name(wanted);
        entry.name = spot.place().at(name.clone());
        self.scene.file.medium.push(entry);
        name
    }

    fn medium_entry(&mut self, placed: &PlacedEntity) -> Result<MediumEntry, SceneError> {
        let PlacedEntity { entity, maps, .. } = placed;
        if maps[0] != maps[1] {
            self.approximate(&entity.spot, "motion of a medium", "it rests where its transform begins");
        }
        match entity.name.as_str() {
            "homogeneous" => {
                let preset = entity.text("preset")?.map(str::to_owned);
                let coefficients = match preset.and_then(|preset| self.measured(entity, "preset", &preset)) {
                    Some(measured) => measured,
                    None => self.coefficients(entity)?,
                };
                let scale = entity.float_or("scale", 1.0)?;
                let [absorption, scattering] = coefficients.map(|value| value * scale);
                let emission = self.emission(entity)?.map(|light| light * absorption);
                let strength = entity.float_or("Lescale", 1.0)?;
                let emission = emission.map(|light| rgb(entity, light * strength)).transpose()?;
                Ok(MediumEntry { emission, ..of_coefficients(entity, [absorption, scattering])? })
            }
            "uniformgrid" => self.uniform_grid(placed),
            "rgbgrid" => self.rgb_grid(placed),
            "nanovdb" => self.nano_vdb(placed),
            other => {
                entity.all_without_effect();
                self.drop(&entity.spot, format!("MakeNamedMedium `{other}`"), "it takes and gives no light");
                Ok(MediumEntry::default())
            }
        }
    }

    /// A medium that is the same everywhere, beside those that have names.
    pub(super) fn homogeneous(
        &mut self,
        entity: &Entity,
        wanted: &str,
        coefficients: [Spectrum; 2],
        g: f64,
    ) -> Result<String, SceneError> {
        let phase = phase(entity, g)?;
        let entry = MediumEntry { phase, ..of_coefficients_alone(entity, coefficients)? };
        Ok(self.add_medium(&entity.spot, wanted, entry))
    }

    /// Absorption and scattering of a medium by its name; None of one of which nothing is known here, which is reported.
    pub(super) fn measured(&mut self, entity: &Entity, parameter: &str, name: &str) -> Option<[Spectrum; 2]> {
        let found = measured_media::coefficients(name);
        if found.is_none() {
            let instead = format!("what else is said counts; known are {}", measured_media::names().join(", "));
            self.drop(entity.spot_of(parameter), format!("medium of the name `{name}`"), instead);
        }
        found
    }

    fn coefficients(&mut self, entity: &Entity) -> Result<[Spectrum; 2], SceneError> {
        let absorption = self.spectrum(entity, "sigma_a", SpectrumKind::Unbounded)?.unwrap_or(Spectrum::WHITE);
        let scattering = self.spectrum(entity, "sigma_s", SpectrumKind::Unbounded)?.unwrap_or(Spectrum::WHITE);
        Ok([absorption, scattering])
    }

    /// The light by which absorption is multiplied.
    fn emission(&mut self, entity: &Entity) -> Result<Option<Spectrum>, SceneError> {
        let light = self.spectrum(entity, "Le", SpectrumKind::Illuminant)?;
        Ok(light.filter(|light| !light.is_black()).map(|light| light * self.exposure))
    }

    fn uniform_grid(&mut self, placed: &PlacedEntity) -> Result<MediumEntry, SceneError> {
        let entity = &placed.entity;
        let scale = entity.float_or("scale", 1.0)?;
        let coefficients = self.coefficients(entity)?.map(|value| value * scale);
        let density = self.grid(placed, "density", Kind::Float, 1, |values| values)?;
        let density = density.ok_or_else(|| entity.error("a uniformgrid needs \"float density\""))?;
        let plain = of_coefficients(entity, coefficients)?;
        let temperatures = entity.list("temperature", Kind::Float, 1)?.to_vec();
        let (emission, emission_grid) = if temperatures.is_empty() {
            let strengths = self.grid(placed, "Lescale", Kind::Float, 1, |values| values)?;
            let emission = self.emission(entity)?.map(|light| light * coefficients[0]);
            (emission, strengths.filter(|_| emission.is_some()))
        } else {
            if entity.has("Le") {
                return Err(entity.spot_of("Le").error("a grid has either `Le` or `temperature`"));
            }
            let glow = glow_of(entity)?;
            let light = |values: Vec<f32>| values.iter().flat_map(|kelvin| glow.at(f64::from(*kelvin)).to_f32()).collect();
            let grid = self.grid(placed, "temperature", Kind::Float, 3, light)?;
            (Some(coefficients[0] * self.exposure), grid)
        };
        self.border(entity);
        let emission = emission.map(|light| rgb(entity, light)).transpose()?;
        Ok(MediumEntry { density: Some(Box::new(density)), emission, emission_grid: emission_grid.map(Box::new), ..plain })
    }

    /// Voxels of red, green and blue: how much is lost, and which share of that is scattered.
    fn rgb_grid(&mut self, placed: &PlacedEntity) -> Result<MediumEntry, SceneError> {
        let entity = &placed.entity;
        let scale = entity.float_or("scale", 1.0)?;
        let voxels = |name: &str| entity.list(name, Kind::Rgb, 3).map(<[f64]>::to_vec);
        let (absorption, scattering, light) = (voxels("sigma_a")?, voxels("sigma_s")?, voxels("Le")?);
        let count = absorption.len().max(scattering.len());
        if count == 0 {
            return Err(entity.error("an rgbgrid needs \"rgb sigma_a\" or \"rgb sigma_s\""));
        }
        if [&absorption, &scattering, &light].iter().any(|voxels| !voxels.is_empty() && voxels.len() != count) {
            return Err(entity.error("the grids of an rgbgrid have different numbers of voxels"));
        }
        let of = |voxels: &[f64], index: usize| voxels.get(index).copied().unwrap_or(1.0);
        let lost = |index: usize| of(&absorption, index) + of(&scattering, index);
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        let density = (0..count).map(|index| lost(index) as f32).collect();
        let albedo = (0..count).map(|index| share(of(&scattering, index), lost(index)) as f32).collect();
        let density = self.grid_of(placed, 3, density, "sigma_a")?;
        let albedo = self.grid_of(placed, 3, albedo, "sigma_s")?;
        let strength = entity.float_or("Lescale", 1.0)? * INTEGRAL_OF_Y * self.exposure * scale;
        let emission_grid = if light.is_empty() {
            None
        } else {
            let glow = (0..count).map(|index| (light[index] * share(of(&absorption, index), lost(index))) as f32).collect();
            Some(Box::new(self.grid_of(placed, 3, glow, "Le")?))
        };
        self.border(entity);
        let emission = emission_grid.is_some().then(|| rgb(entity, Spectrum::grey(strength))).transpose()?;
        if scale.is_nan() || scale <= 0.0 {
            return Ok(MediumEntry::default());
        }
        Ok(MediumEntry {
            mean_free_path: Some(entity.spot.place().at(entity.possible(Rgb::of(Spectrum::grey(1.0 / scale)))?)),
            density: Some(Box::new(density)),
            albedo_grid: Some(Box::new(albedo)),
            emission,
            emission_grid,
            phase: phase(entity, entity.float_or("g", 0.0)?)?,
            ..MediumEntry::default()
        })
    }

    /// Grids of a file.
    fn nano_vdb(&mut self, placed: &PlacedEntity) -> Result<MediumEntry, SceneError> {
        let PlacedEntity { entity, maps, .. } = placed;
        let scale = entity.float_or("scale", 1.0)?;
        let coefficients = self.coefficients(entity)?.map(|value| value * scale);
        let written = entity.text("filename")?.ok_or_else(|| entity.error("a nanovdb medium needs \"string filename\""))?;
        let spot = entity.spot_of("filename");
        let path = self.files.find(&self.folder, written);
        let path = path.ok_or_else(|| spot.error(format!("there is no file {written}")))?.path;
        let place = entity.spot.place();
        let grid = entity.text("gridname")?.unwrap_or("density").to_owned();
        let transform = self.transform(&maps[0], &entity.spot)?;
        let density = VolumeEntry {
            file: Some(place.at(FileOr::OnDisk(path.clone()))),
            grid: Some(place.at(grid)),
            transform: transform.clone(),
            ..VolumeEntry::default()
        };
        let mut entry = MediumEntry { density: Some(Box::new(place.at(density))), ..of_coefficients(entity, coefficients)? };
        let strength = entity.float_or("Lescale", 1.0)? * self.exposure;
        let name = entity.text("temperaturename")?.unwrap_or("temperature").to_owned();
        let most = MOST_VOLUME_BYTES.min(memory::available() / 2);
        let content = self.files.read(&path, most).map_err(|error| spot.error(format!("{}: {error}", show(&path))))?;
        let glow = glow_of(entity)?;
        // A file without temperatures gives off no light.
        if let Ok(PlacedGrid { grid, to_index, .. }) = volume::read(&content, Some(&name), memory::available() / 2)
            && grid.channels() == 1
        {
            let values = grid.values().iter().flat_map(|kelvin| glow.at(f64::from(*kelvin)).to_f32()).collect();
            let light = spot.possible(VoxelGrid::new(grid.resolution(), 3, values))?;
            let to_box = to_index.inverse();
            let corner = |point: DVec3| spot.possible(Exactly::of(to_box.transform_point3(point).to_array()));
            let size = DVec3::from_array(grid.resolution().map(f64::from));
            entry.emission_grid = Some(Box::new(place.at(VolumeEntry {
                file: Some(place.at(FileOr::InMemory(Arc::new(light)))),
                bounds: Some(place.at(Exactly([corner(DVec3::ZERO)?, corner(size)?]))),
                transform,
                ..VolumeEntry::default()
            })));
            entry.emission = Some(rgb(entity, coefficients[0] * strength)?);
        }
        Ok(entry)
    }

    /// A list of a number for each voxel as a grid of so many channels; None where it is not written.
    fn grid(
        &mut self,
        placed: &PlacedEntity,
        name: &str,
        kind: Kind,
        channels: usize,
        values: impl FnOnce(Vec<f32>) -> Vec<f32>,
    ) -> Result<Option<Located<VolumeEntry>>, SceneError> {
        let list = placed.entity.list(name, kind, 1)?;
        if list.is_empty() {
            return Ok(None);
        }
        let values = values(list.iter().map(|value| *value as f32).collect());
        self.grid_of(placed, channels, values, name).map(Some)
    }

    /// Values of voxels in the box from `p0` to `p1`.
    fn grid_of(
        &mut self,
        placed: &PlacedEntity,
        channels: usize,
        values: Vec<f32>,
        name: &str,
    ) -> Result<Located<VolumeEntry>, SceneError> {
        let PlacedEntity { entity, maps, .. } = placed;
        let spot = entity.spot_of(name);
        let sides = [entity.integer_or("nx", 1)?, entity.integer_or("ny", 1)?, entity.integer_or("nz", 1)?];
        let resolution = sides.map(|side| u32::try_from(side).unwrap_or(0));
        let voxels = resolution.iter().fold(1_u64, |product, side| product.saturating_mul(u64::from(*side)));
        if voxels != (values.len() / channels) as u64 || voxels == 0 {
            let [x, y, z] = sides;
            let message = format!("`{name}` has {} values for a grid of {x} x {y} x {z} voxels", values.len() / channels);
            return Err(spot.error(message));
        }
        if voxels * VOXEL_BYTES > memory::available() {
            return Err(spot.error(format!("there is no memory for a grid of {voxels} voxels")));
        }
        let grid = spot.possible(VoxelGrid::new(resolution, channels, values))?;
        let corners = [entity.point_or("p0", DVec3::ZERO)?, entity.point_or("p1", DVec3::ONE)?];
        let place = entity.spot.place();
        let corner = |point: DVec3| entity.possible(Exactly::of(point.to_array()));
        Ok(place.at(VolumeEntry {
            file: Some(place.at(FileOr::InMemory(Arc::new(grid)))),
            bounds: Some(place.at(Exactly([corner(corners[0].min(corners[1]))?, corner(corners[0].max(corners[1]))?]))),
            transform: self.transform(&maps[0], &entity.spot)?,
            ..VolumeEntry::default()
        }))
    }

    fn border(&mut self, entity: &Entity) {
        let instead = "it keeps its value within half a voxel of its border; there it fades";
        self.approximate(&entity.spot, "border of the grid of a medium", instead);
    }
}

/// Black bodies there: the largest value of each spectrum is 1, and no photometric value divides it.
struct Glow {
    offset: f64,
    scale: f64,
}

impl Glow {
    fn at(&self, value: f64) -> Spectrum {
        let kelvin = (value - self.offset) * self.scale;
        if kelvin.is_nan() || kelvin <= COLDEST {
            return Spectrum::BLACK;
        }
        let most = planck(2_897_772.1 / kelvin, kelvin);
        let light = integrate(Role::Light, |wavelength| planck(wavelength, kelvin) / most);
        (light * INTEGRAL_OF_Y).max(Spectrum::BLACK)
    }
}

fn glow_of(entity: &Entity) -> Result<Glow, SceneError> {
    let cutoff = entity.float_or("temperaturecutoff", 0.0)?;
    Ok(Glow { offset: entity.float_or("temperatureoffset", cutoff)?, scale: entity.float_or("temperaturescale", 1.0)? })
}

/// A medium by what it absorbs and scatters per unit length, with its phase function.
fn of_coefficients(entity: &Entity, coefficients: [Spectrum; 2]) -> Result<MediumEntry, SceneError> {
    let phase = phase(entity, entity.float_or("g", 0.0)?)?;
    Ok(MediumEntry { phase, ..of_coefficients_alone(entity, coefficients)? })
}

fn of_coefficients_alone(entity: &Entity, [absorption, scattering]: [Spectrum; 2]) -> Result<MediumEntry, SceneError> {
    let value = |value: Spectrum| -> Result<Option<Located<Rgb<NonNegative>>>, SceneError> {
        Ok(Some(entity.spot.place().at(entity.possible(Rgb::of(value))?)))
    };
    Ok(MediumEntry { absorption: value(absorption)?, scattering: value(scattering)?, ..MediumEntry::default() })
}

/// Henyey's and Greenstein's function of this mean cosine; None of the isotropic one.
fn phase(entity: &Entity, g: f64) -> Result<Option<PhaseEntry>, SceneError> {
    if g == 0.0 {
        return Ok(None);
    }
    let g = entity.possible(Checked::of(g.clamp(MeanCosine::MINIMUM, MeanCosine::MAXIMUM)))?;
    Ok(Some(PhaseEntry::HenyeyGreenstein(HenyeyGreensteinKeys { g })))
}
