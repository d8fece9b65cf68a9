//! A box of voxels.

use std::fmt;

use glam::{DVec3, I64Vec3};
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use crate::spectrum::Spectrum;

/// The largest value of a voxel: its square is finite in single precision, as that of any number in a scene file.
pub const LARGEST_VALUE: f32 = 1e18;

/// Most values of a grid, channels counted by themselves: 4 GiB of them.
pub const MOST_VALUES: u64 = 1 << 30;

/// The way a value is found between the middles of voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VolumeFilter {
    /// The value of the voxel that the point is in.
    Nearest,
    /// A blend of the eight values around the point, along x, then y, then z, each step by `a + (b - a) * share`.
    Trilinear,
}

/// Values in a box of voxels: finite, and at least 0. [The module](super) says where they stand.
#[derive(Clone, PartialEq)]
pub struct VoxelGrid {
    resolution: [u32; 3],
    channels: usize,
    values: Vec<f32>,
    range: [f32; 2],
}

impl VoxelGrid {
    /// A grid by its voxels along x, y and z, its channels (1, or 3 for red, green and blue), and its values: x grows fastest, then y, then z, and
    /// the channels of a voxel stand together.
    ///
    /// # Errors
    /// A sentence about a grid without voxels or with too many, about values that are too many or too few for it, and about the first value
    /// that is negative, above 1e18, infinite or no number.
    pub fn new(resolution: [u32; 3], channels: usize, values: Vec<f32>) -> Result<Self, String> {
        let [x, y, z] = resolution;
        let count = value_count(resolution.map(u64::from), channels)?;
        if values.len() as u64 != count {
            let of_channels = if channels == 1 { String::new() } else { format!(" × {channels} channels") };
            return Err(format!("it has {} values, and not {x} × {y} × {z}{of_channels} = {count}", values.len()));
        }
        let is_value = |value: f32| (0.0..=LARGEST_VALUE).contains(&value);
        if let Some(index) = values.par_iter().position_first(|&value| !is_value(value)) {
            let voxel = (index / channels) as u64;
            let place = [voxel % u64::from(x), voxel / u64::from(x) % u64::from(y), voxel / u64::from(x) / u64::from(y)];
            return Err(wrong_value(values[index], place.map(|place| place as i64)));
        }
        let fold = |[low, high]: [f32; 2], [other_low, other_high]: [f32; 2]| [low.min(other_low), high.max(other_high)];
        let range = values.par_iter().map(|&value| [value; 2]).reduce(|| [f32::INFINITY, 0.0], fold);
        Ok(Self { resolution, channels, values, range })
    }

    /// Voxels along x, y and z.
    pub fn resolution(&self) -> [u32; 3] {
        self.resolution
    }

    /// Values of a voxel: 1 or 3.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// All values, in the order of [`Self::new`].
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The smallest and the largest value of any channel.
    pub fn range(&self) -> [f32; 2] {
        self.range
    }

    /// The values of a voxel; of one beyond the border, those of the nearest. Grey where there is one channel.
    pub fn voxel(&self, at: I64Vec3) -> Spectrum {
        let index = self.first_value(at);
        match self.values[index..index + self.channels] {
            [red, green, blue] => Spectrum::from_f32([red, green, blue]),
            ref one => Spectrum::grey(one[0].into()),
        }
    }

    /// Place in the list of the first value of the voxel that is nearest to this one.
    pub(super) fn first_value(&self, at: I64Vec3) -> usize {
        let last = I64Vec3::from_array(self.resolution.map(i64::from)) - 1;
        let [x, y, z] = at.clamp(I64Vec3::ZERO, last).to_array().map(|index| index as usize);
        let [columns, rows, _] = self.resolution.map(|count| count as usize);
        ((z * rows + y) * columns + x) * self.channels
    }

    /// The value of the voxel that a point of index space is in, or that is nearest to it.
    pub fn nearest(&self, at: DVec3) -> Spectrum {
        // A point that is farther away than numbers of this size is clamped all the same.
        self.voxel(at.floor().as_i64vec3())
    }

    /// The trilinear blend at a point of index space, or at the point of the box that is nearest to it.
    pub fn trilinear(&self, at: DVec3) -> Spectrum {
        let size = DVec3::from_array(self.resolution.map(f64::from));
        let from_middle = at.clamp(DVec3::ZERO, size) - 0.5;
        let low = from_middle.floor();
        let share = from_middle - low;
        let low = low.as_i64vec3();
        let lerp = |a: Spectrum, b: Spectrum, share: f64| a + (b - a) * share;
        let along_x = |y: i64, z: i64| {
            let corner = |x: i64| self.voxel(low + I64Vec3::new(x, y, z));
            lerp(corner(0), corner(1), share.x)
        };
        let along_y = |z: i64| lerp(along_x(0, z), along_x(1, z), share.y);
        lerp(along_y(0), along_y(1), share.z)
    }

    /// Adds everything that the grid holds to a fingerprint.
    pub fn hash_into(&self, hash: &mut Sha256) {
        hash.update(self.resolution.map(u32::to_le_bytes).as_flattened());
        hash.update([self.channels as u8]);
        hash.update(bytemuck::cast_slice(&self.values));
    }
}

/// The values of a grid with this resolution.
///
/// # Errors
/// A sentence about a grid without voxels, about channels that no grid has, and about more values than [`MOST_VALUES`].
pub fn value_count(resolution: [u64; 3], channels: usize) -> Result<u64, String> {
    let [x, y, z] = resolution;
    if !matches!(channels, 1 | 3) {
        return Err(format!("it has {channels} channels, and not 1 (grey) or 3 (red, green and blue)"));
    }
    if resolution.contains(&0) {
        return Err(format!("it is empty: it has {x} × {y} × {z} voxels"));
    }
    let count = x.checked_mul(y).and_then(|area| area.checked_mul(z)).and_then(|voxels| voxels.checked_mul(channels as u64));
    match count {
        Some(count) if count <= MOST_VALUES => Ok(count),
        _ => {
            let gibibytes = x as f64 * y as f64 * z as f64 * channels as f64 * 4.0 / f64::from(1 << 30);
            Err(format!(
                "it has {x} × {y} × {z} voxels, which take {gibibytes:.0} GiB where {} GiB are the most; it has to be resampled to \
                 larger voxels, or cut to a smaller box, by the program that made it",
                MOST_VALUES >> 28
            ))
        }
    }
}

/// The complaint about a value that is negative, too large or no number.
fn wrong_value(value: f32, [x, y, z]: [i64; 3]) -> String {
    if value.is_nan() {
        return format!("the value of voxel [{x}, {y}, {z}] is no number (NaN)");
    }
    format!("the value of voxel [{x}, {y}, {z}] is {value}, and not a number from 0 to 1e18")
}

/// Shows what the grid is, and none of its values.
impl fmt::Debug for VoxelGrid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { resolution, channels, range, values: _ } = self;
        f.debug_struct("VoxelGrid")
            .field("resolution", resolution)
            .field("channels", channels)
            .field("range", range)
            .finish_non_exhaustive()
    }
}
