//! Mitsuba's `.vol`, version 3: the signature `VOL` and a 3, the encoding (1: single precision), the voxels along x, y and z, the channels, the
//! corners of a box, and the values, x changing fastest, a voxel's channels together.

use glam::DVec3;

use super::bytes::Bytes;
use super::choice::VolumeError;
use super::number::{Number, ValueType};
use super::placed_grid::PlacedGrid;
use crate::scene::volume::grid::value_count;
use crate::scene::{Volume, VoxelGrid};

const SIGNATURE: &[u8; 3] = b"VOL";
const VERSION: u8 = 3;
const SINGLE_PRECISION: i32 = 1;

pub fn is_signature(content: &[u8]) -> bool {
    content.starts_with(SIGNATURE)
}

pub fn read(content: &[u8], name: Option<&str>) -> Result<PlacedGrid, VolumeError> {
    if let Some(name) = name {
        return Err(format!(
            "it is a file of Mitsuba, which has one grid without a name and not `{name}`: `grid` has to be left out"
        )
        .into());
    }
    let mut bytes = Bytes::from(content, SIGNATURE.len() as u64)?;
    let version = bytes.u8()?;
    if version != VERSION {
        return Err(format!("it is a file of Mitsuba in version {version}; version {VERSION} is read").into());
    }
    let encoding = bytes.i32()?;
    if encoding != SINGLE_PRECISION {
        return Err(
            format!("its values have the encoding {encoding}; {SINGLE_PRECISION} is read, numbers of single precision").into()
        );
    }
    let resolution = bytes.coordinate()?;
    let channels = bytes.i32()?;
    if resolution.iter().any(|&side| side < 0) || channels < 0 {
        return Err(format!("it has {resolution:?} voxels of {channels} channels").into());
    }
    let (resolution, channels) = (resolution.map(|side| side as u32), channels as usize);
    let mut corners = [0.0; 6];
    for corner in &mut corners {
        *corner = f64::from(bytes.f32()?);
    }
    let count = value_count(resolution.map(u64::from), channels)? as usize;
    let number = ValueType { number: Number::Float, channels: 1 };
    let values = number.read_all(bytes.take(count * number.size())?).map(|[value, ..]| value).collect();
    let [low, high] = [0, 3].map(|first| DVec3::from_slice(&corners[first..first + 3]));
    if !(low.is_finite() && high.is_finite() && high.cmpgt(low).all()) {
        return Err(format!("its bounding box from {low} to {high} is empty").into());
    }
    let Volume { grid, to_index, .. } = Volume::in_box(VoxelGrid::new(resolution, channels, values)?.into(), low, high);
    Ok(PlacedGrid { grid, to_index, background: None, border: 0 })
}

/// The contents of such a file; the corners are rounded to single precision.
pub fn write(grid: &VoxelGrid, low: DVec3, high: DVec3) -> Vec<u8> {
    let mut file = SIGNATURE.to_vec();
    file.push(VERSION);
    file.extend(SINGLE_PRECISION.to_le_bytes());
    file.extend(grid.resolution().into_iter().chain([grid.channels() as u32]).flat_map(u32::to_le_bytes));
    file.extend([low, high].into_iter().flat_map(|corner| corner.as_vec3().to_array()).flat_map(f32::to_le_bytes));
    file.extend(grid.values().iter().flat_map(|value| value.to_le_bytes()));
    file
}
