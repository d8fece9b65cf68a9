//! Values in space: `constvolume`, and grids of voxels by `gridvolume`.
//!
//! A grid fills the unit cube, or with `use_grid_bbox` the box that its file states, and `to_world` places that. A medium is only where the box of
//! its density is; other values go on beyond their boxes as they are at the border.

use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use crate::load::error::{SceneError, show};
use crate::load::file::reference::FileOr;
use crate::load::file::value::Exactly;
use crate::load::file::volume::{OutsideName, VolumeEntry, VolumeFilterName};
use crate::load::memory;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::plugin::Plugin;
use crate::load::place::Place;
use crate::load::volume::{self, MOST_VOLUME_BYTES, PlacedGrid};
use crate::math::is_upright;
use crate::scene::VoxelGrid;
use crate::spectrum::Spectrum;

/// A parameter of a medium.
pub enum Parameter {
    /// One value everywhere within a box, which this map makes of the unit cube.
    Constant {
        value: Spectrum,
        to_world: DAffine3,
    },
    Grid(Grid),
}

/// Values of a file that a plugin places.
pub struct Grid {
    plugin: Rc<Plugin>,
    path: PathBuf,
    placed: PlacedGrid,
}

impl Grid {
    pub fn place(&self) -> Place {
        self.plugin.at()
    }

    /// The mean of its voxels.
    pub fn mean(&self) -> Spectrum {
        let grid = &self.placed.grid;
        let channels = grid.channels();
        let sum =
            |channel: usize| grid.values().iter().skip(channel).step_by(channels).map(|value| f64::from(*value)).sum::<f64>();
        let voxels = (grid.values().len() / channels) as f64;
        match channels {
            3 => Spectrum::new(sum(0), sum(1), sum(2)) / voxels,
            _ => Spectrum::grey(sum(0) / voxels),
        }
    }
}

impl Converter<'_> {
    /// A parameter that is a number, a colour or a volume.
    pub(super) fn volume_parameter(&mut self, plugin: &Rc<Plugin>, name: &str, default: f64) -> Result<Parameter, SceneError> {
        let Some(volume) = plugin.child(name).filter(|child| child.kind == "volume").cloned() else {
            let input = self.surface_number(plugin, name, default)?;
            if input.constant().is_none() {
                let what = format!("texture of `{name}` of {}", plugin.title());
                self.approximate(plugin, &what, "its mean is taken");
            }
            return Ok(Parameter::Constant { value: self.mean(&input), to_world: DAffine3::IDENTITY });
        };
        volume.visited.set(true);
        volume.without_effect(&["id"]);
        match volume.name.as_str() {
            "constvolume" => {
                let Parameter::Constant { value, .. } = self.volume_parameter(&volume, "value", 1.0)? else {
                    return Err(volume.error("the value of a constvolume is a number or a colour"));
                };
                Ok(Parameter::Constant { value, to_world: volume.transform("to_world")? })
            }
            "gridvolume" => Ok(Parameter::Grid(self.read_grid(&volume)?)),
            other => {
                volume.properties.iter().for_each(|property| property.used.set(true));
                volume.children.iter().for_each(|child| child.used.set(true));
                let what = format!("volume `{other}`");
                self.drop(&volume, &what, format!("{default} is taken everywhere"));
                Ok(Parameter::Constant { value: Spectrum::grey(default), to_world: DAffine3::IDENTITY })
            }
        }
    }

    /// A parameter for which there can be no grid here: the mean of one is taken, and reported.
    pub(super) fn volume_mean(&mut self, plugin: &Rc<Plugin>, name: &str, default: f64) -> Result<Spectrum, SceneError> {
        Ok(match self.volume_parameter(plugin, name, default)? {
            Parameter::Constant { value, .. } => value,
            Parameter::Grid(grid) => {
                let _ = self.grid_entry(&grid, OutsideName::Border)?;
                let what = format!("grid of `{name}` of {}", plugin.title());
                self.approximate(plugin, &what, "the mean of its voxels is taken");
                grid.mean()
            }
        })
    }

    fn read_grid(&mut self, plugin: &Rc<Plugin>) -> Result<Grid, SceneError> {
        // How it is looked up, and what a colour of it is called, changes nothing in linear Rec.709.
        plugin.without_effect(&["raw", "accel", "max_value"]);
        let written = plugin.text("filename")?.ok_or_else(|| plugin.error("a gridvolume needs the string `filename`"))?;
        let path = self.reader.find(written).ok_or_else(|| plugin.error(format!("there is no file {written}")))?;
        let most = MOST_VOLUME_BYTES.min(memory::available() / 2);
        let content = self.files.read(&path, most).map_err(|error| plugin.error(format!("{}: {error}", show(&path))))?;
        let placed = volume::read(&content, None, memory::available() / 2);
        let placed = placed.map_err(|error| plugin.error(format!("{}: {error}", show(&path))))?;
        Ok(Grid { plugin: plugin.clone(), path, placed })
    }

    /// The grid as an entry with this outside.
    pub(super) fn grid_entry(&mut self, grid: &Grid, outside: OutsideName) -> Result<VolumeEntry, SceneError> {
        let Grid { plugin, path, .. } = grid;
        let place = plugin.at();
        let filter = match plugin.text("filter_type")?.unwrap_or("trilinear") {
            "trilinear" => None,
            "nearest" => Some(VolumeFilterName::Nearest),
            other => return Err(plugin.error(format!("`filter_type` is trilinear or nearest, not {other}"))),
        };
        match plugin.text("wrap_mode")?.unwrap_or("clamp") {
            "clamp" => {}
            // Within the box a mirror shows what the border has.
            "mirror" if outside == OutsideName::Background => {}
            other @ ("repeat" | "mirror") => {
                let what = format!("wrap_mode `{other}` of a volume");
                self.approximate(plugin, &what, "`clamp` is taken");
            }
            other => return Err(plugin.error(format!("`wrap_mode` is clamp, repeat or mirror, not {other}"))),
        }
        let own = plugin.transform("to_world")?;
        if outside == OutsideName::Background && !is_upright(&own) {
            let instead =
                "nothing is outside of its own box; there its border goes on to the corners of an upright box around that";
            self.approximate(plugin, "density of a medium that is turned", instead);
        }
        let bounds = match plugin.flag("use_grid_bbox", false)? {
            true => None,
            false => Some(place.at(Exactly([plugin.possible(Exactly::of([0.0; 3]))?, plugin.possible(Exactly::of([1.0; 3]))?]))),
        };
        Ok(VolumeEntry {
            file: Some(place.at(FileOr::OnDisk(path.clone()))),
            bounds,
            filter,
            outside: Some(outside),
            transform: self.transform(&own, plugin)?,
            ..VolumeEntry::default()
        })
    }

    /// The density, and a colour by which it is multiplied: voxels that all have one colour are looked up as one channel.
    fn of_one_colour(&mut self, grid: &Grid) -> Result<(Arc<VoxelGrid>, Spectrum), SceneError> {
        let Grid { plugin, placed, .. } = grid;
        let grid = &placed.grid;
        if grid.channels() == 1 {
            return Ok((grid.clone(), Spectrum::WHITE));
        }
        let voxels = grid.values().chunks_exact(grid.channels());
        let largest = |voxel: &[f32]| voxel.iter().copied().fold(0.0, f32::max);
        let densest = voxels.clone().max_by(|a, b| largest(a).total_cmp(&largest(b))).unwrap_or(&[1.0; 3]);
        let tint: Vec<f32> = match largest(densest) {
            0.0 => vec![1.0; 3],
            most => densest.iter().map(|value| value / most).collect(),
        };
        let is_tinted = |voxel: &[f32]| {
            let most = largest(voxel);
            voxel.iter().zip(&tint).all(|(value, share)| (value - most * share).abs() <= 1e-5 * most)
        };
        if !voxels.clone().all(is_tinted) {
            return Ok((grid.clone(), Spectrum::WHITE));
        }
        let values = voxels.map(largest).collect();
        let [red, green, blue] = [0, 1, 2].map(|channel| f64::from(tint[channel]));
        Ok((Arc::new(plugin.possible(VoxelGrid::new(grid.resolution(), 1, values))?), Spectrum::new(red, green, blue)))
    }

    /// The density of a medium, which is nowhere but in its box, and the colour that multiplies it.
    pub(super) fn density_entry(&mut self, grid: &Grid) -> Result<(VolumeEntry, Spectrum), SceneError> {
        let (of_one, tint) = self.of_one_colour(grid)?;
        let mut entry = self.grid_entry(grid, OutsideName::Background)?;
        if !Arc::ptr_eq(&of_one, &grid.placed.grid) {
            let to_box = grid.placed.to_index.inverse();
            let corner = |point: DVec3| grid.plugin.possible(Exactly::of(to_box.transform_point3(point).to_array()));
            if entry.bounds.is_none() {
                let size = DVec3::from_array(of_one.resolution().map(f64::from));
                entry.bounds = Some(grid.place().at(Exactly([corner(DVec3::ZERO)?, corner(size)?])));
            }
            entry.file = Some(grid.place().at(FileOr::InMemory(of_one)));
        }
        Ok((entry, tint))
    }
}
