//! Values in space, as keys of media have them: a grid from a file, or written in the scene file.

use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::colour::Rgb;
use super::reference::FileOr;
use super::resolver::Resolver;
use super::shape::transform::TransformEntry;
use super::suggestion::did_you_mean_name;
use super::value::{Checked, Exactly, Located, NonNegative, Rule, Vector, vector};
use super::writer::{Writer, colour, list, number, table, text};
use crate::load::error::{SceneError, show};
use crate::load::memory;
use crate::load::place::Place;
use crate::load::volume::{self, MOST_VOLUME_BYTES, PlacedGrid, VolumeError};
use crate::scene::{GridSource, Outside, Volume, VolumeFilter, VoxelGrid};
use crate::spectrum::Spectrum;

/// A grid of values in the medium's space, from a file or written here.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(extend("allOf" = [{ "oneOf": [
    { "required": ["file"], "not": { "anyOf": [{ "required": ["resolution"] }, { "required": ["values"] }] } },
    { "required": ["resolution", "values"], "not": { "anyOf": [{ "required": ["file"] }, { "required": ["grid"] }] } },
] }]))]
pub struct VolumeEntry {
    /// Path of an OpenVDB (`.vdb`), a NanoVDB (`.nvdb`) or a Mitsuba (`.vol`) file, relative to the scene file.
    pub file: Option<Located<FileOr<VoxelGrid>>>,
    /// Name of the grid in an OpenVDB or NanoVDB file; when left out, the only one, or of several the one named "density".
    pub grid: Option<Located<String>>,
    /// Voxels along x, y and z of a grid that is written here.
    pub resolution: Option<Located<Exactly<NonZeroU32, 3>>>,
    /// Its values, one for each voxel, or three (red, green and blue): x grows fastest, then y, then z. Each stands in the middle of its voxel.
    pub values: Option<Located<Vec<Checked<NonNegative>>>>,
    /// Lower and upper corner of the box that the voxels fill, before `transform`; when left out, the one in the file, or [[0, 0, 0], [1, 1, 1]].
    /// The box of a sparse grid is that of its active voxels.
    pub bounds: Option<Located<Exactly<Vector, 2>>>,
    /// The way values are found between voxels; "trilinear" when left out.
    pub filter: Option<VolumeFilterName>,
    /// The value outside of the box; "background" when left out.
    pub outside: Option<OutsideName>,
    /// The value of `outside = "background"`; when left out, the one in the file, or 0.
    pub background: Option<Rgb<NonNegative>>,
    /// Factor of all values, 1 when left out.
    pub scale: Option<Located<Checked<NonNegative>>>,
    /// From the box, or the file's space, to the medium's: steps applied in this order, or a matrix.
    pub transform: Option<Located<TransformEntry>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VolumeFilterName {
    /// The value of the voxel that the point is in.
    Nearest,
    /// A blend of the eight values around the point.
    Trilinear,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum OutsideName {
    /// The background's value.
    Background,
    /// The value at the nearest point of the box.
    Border,
}

impl Resolver<'_> {
    /// The volume of an entry that stands at `place`, whose values are all such as `R` accepts.
    pub(in crate::load::file) fn volume<R: Rule>(&mut self, written: &VolumeEntry, place: &Place) -> Result<Volume, SceneError> {
        let placed = match (&written.file, &written.values) {
            (Some(file), None) => {
                if let Some(resolution) = &written.resolution {
                    return Err(self.error(&resolution.place, "`resolution` belongs to `values`; a file says its own"));
                }
                self.grid_of_file(file, written.grid.as_ref())?
            }
            (None, Some(values)) => {
                if let Some(name) = &written.grid {
                    return Err(self.error(&name.place, "`grid` is the name of a grid in a `file`, which is missing"));
                }
                self.written_grid(values, written.resolution.as_ref())?
            }
            (Some(_), Some(values)) => {
                return Err(self.error(&values.place, "a grid is either in a `file` or has `values`, and not both"));
            }
            (None, None) => {
                let error = self.error(place, "a grid needs the key `file`, or `resolution` and `values`");
                return Err(error
                    .with_help("{ file = \"smoke.vdb\", grid = \"density\" }, or { resolution = [2, 1, 1], values = [0, 1] }"));
            }
        };
        let mut to_index = match &written.bounds {
            Some(bounds) => self.index_of_bounds(&placed, bounds)?,
            None => placed.to_index,
        };
        if let Some(transform) = &written.transform {
            to_index *= self.transform(transform)?.to_affine().inverse();
        }
        let background = written.background.as_ref().map(|colour| colour.0).or(placed.background);
        let volume = Volume {
            grid: placed.grid,
            to_index,
            filter: match written.filter {
                Some(VolumeFilterName::Nearest) => VolumeFilter::Nearest,
                Some(VolumeFilterName::Trilinear) | None => VolumeFilter::Trilinear,
            },
            outside: match written.outside {
                Some(OutsideName::Border) => Outside::Border,
                Some(OutsideName::Background) | None => Outside::Constant(background.unwrap_or(Spectrum::BLACK)),
            },
            scale: written.scale.as_ref().map_or(1.0, |scale| scale.value.0),
        };
        volume
            .check()
            .map_err(|reason| self.error(written.transform.as_ref().map_or(place, |transform| &transform.place), reason))?;
        match volume.range().into_iter().find(|&value| !R::accepts(value)) {
            None => Ok(volume),
            Some(found) => {
                let times = if volume.scale == 1.0 { "" } else { " times its `scale`" };
                Err(self.error(place, format!("expected {}, found {found} in the grid{times}", R::WORDS)))
            }
        }
    }

    /// Reads a grid of a file, once for all that name it.
    fn grid_of_file(
        &mut self,
        file: &Located<FileOr<VoxelGrid>>,
        name: Option<&Located<String>>,
    ) -> Result<PlacedGrid, SceneError> {
        let path = match (&file.value, file.value.path(self.folder)) {
            (_, Some(path)) => path,
            (FileOr::InMemory(grid), _) => return Ok(in_unit_box(grid.clone())),
            (FileOr::Written(_) | FileOr::OnDisk(_), None) => return Err(self.error(&file.place, "it is no file")),
        };
        let key = (path.clone(), name.map(|name| name.value.clone()));
        if let Some(placed) = self.grids.get(&key) {
            return Ok(placed.clone());
        }
        let progress = self.files().progress();
        progress.expect(1);
        let most = MOST_VOLUME_BYTES.min(memory::available() / 2);
        let content =
            self.files().read(&path, most).map_err(|error| self.error(&file.place, format!("{}: {error}", show(&path))))?;
        let placed = volume::read(&content, key.1.as_deref(), memory::available() / 2);
        let placed = placed.map_err(|error| self.grid_error(&path, file, name, &error))?;
        self.files().progress().one_was_read();
        let source = GridSource { path, grid: key.1.clone(), to_index: placed.to_index };
        self.scene.sources.add_grid(&placed.grid, source);
        self.grids.insert(key, placed.clone());
        Ok(placed)
    }

    /// The error about a file that gives no grid, at the key that is wrong.
    fn grid_error(
        &self,
        path: &Path,
        file: &Located<FileOr<VoxelGrid>>,
        name: Option<&Located<String>>,
        error: &VolumeError,
    ) -> SceneError {
        let place = match error {
            VolumeError::NoSuchGrid { .. } => name.map_or(&file.place, |name| &name.place),
            VolumeError::Unreadable(_) | VolumeError::WhichGrid { .. } => &file.place,
        };
        let mistake = self.error(place, format!("{}: {error}", show(path)));
        let help = match error {
            VolumeError::NoSuchGrid { wanted, names } => {
                did_you_mean_name(wanted, &names.iter().map(String::as_str).collect::<Vec<_>>())
            }
            VolumeError::WhichGrid { names } => Some(format!("valid choices: {}", names.join(", "))),
            VolumeError::Unreadable(_) => None,
        };
        match help {
            Some(help) => mistake.with_help(help),
            None => mistake,
        }
    }

    fn written_grid(
        &self,
        values: &Located<Vec<Checked<NonNegative>>>,
        resolution: Option<&Located<Exactly<NonZeroU32, 3>>>,
    ) -> Result<PlacedGrid, SceneError> {
        let Some(resolution) = resolution else {
            return Err(self.error(&values.place, "`values` need the key `resolution`, the voxels along x, y and z"));
        };
        let sides = resolution.value.map(NonZeroU32::get);
        let voxels = sides.iter().map(|&side| u64::from(side)).try_fold(1_u64, u64::checked_mul);
        let is_coloured = voxels.and_then(|voxels| voxels.checked_mul(3)) == Some(values.value.len() as u64);
        let numbers = values.value.iter().map(|value| value.0 as f32).collect();
        let grid = VoxelGrid::new(sides, if is_coloured { 3 } else { 1 }, numbers);
        let grid = grid.map_err(|reason| {
            self.error(&values.place, format!("the grid: {reason}")).with_help("one number for each voxel, or three")
        })?;
        Ok(in_unit_box(Arc::new(grid)))
    }

    /// The map from a box in which the grid's own voxels are.
    fn index_of_bounds(&self, placed: &PlacedGrid, bounds: &Located<Exactly<Vector, 2>>) -> Result<DAffine3, SceneError> {
        let [low, high] = bounds.value.map(vector);
        if !high.cmpgt(low).all() {
            return Err(self.error(&bounds.place, "the upper corner of a box is above the lower one along each axis"));
        }
        let border = f64::from(placed.border);
        let own = DVec3::from_array(placed.grid.resolution().map(f64::from)) - 2.0 * border;
        let from_low = DAffine3::from_scale(own / (high - low)) * DAffine3::from_translation(-low);
        Ok(DAffine3::from_translation(DVec3::splat(border)) * from_low)
    }
}

fn in_unit_box(grid: Arc<VoxelGrid>) -> PlacedGrid {
    let Volume { grid, to_index, .. } = Volume::in_box(grid, DVec3::ZERO, DVec3::ONE);
    PlacedGrid { grid, to_index, background: None, border: 0 }
}

/// The volume as the value of a key: with the file that it was read from, or one of Mitsuba's format beside the scene file.
pub(crate) fn write_volume(volume: &Volume, writer: &mut Writer<'_>) -> String {
    let Volume { grid, to_index, filter, outside, scale } = volume;
    let source = writer.scene.sources.grid(grid).filter(|source| source.path.is_file()).cloned();
    let (file, name, own_index) = match source {
        Some(GridSource { path, grid, to_index }) => (writer.files.name_of(&path), grid, to_index),
        None => {
            let content = || volume::write_mitsuba(grid, DVec3::ZERO, DVec3::ONE);
            let file = writer.files.add_once("volume", Arc::as_ptr(grid) as usize, "vol", content);
            (file, None, in_unit_box(grid.clone()).to_index)
        }
    };
    let mut keys = vec![("file", file)];
    keys.extend(name.map(|name| ("grid", text(&name))));
    if *filter == VolumeFilter::Nearest {
        keys.push(("filter", text("nearest")));
    }
    match outside {
        Outside::Border => keys.push(("outside", text("border"))),
        Outside::Constant(value) => keys.push(("background", colour(*value))),
    }
    if *scale != 1.0 {
        keys.push(("scale", number(*scale)));
    }
    if *to_index != own_index {
        let map = to_index.inverse() * own_index;
        let rows = (0..3).flat_map(|row| map.matrix3.row(row).extend(map.translation[row]).to_array());
        let matrix = rows.chain([0.0, 0.0, 0.0, 1.0]).map(number);
        keys.push(("transform", table([("matrix", list(matrix))])));
    }
    table(keys)
}

#[cfg(test)]
mod tests;
