//! Grids of values in space as the device reads them.

use std::sync::Arc;

use super::error::PackError;
use super::texture::PackedTextures;
use crate::scene::{Majorants, Outside, Volume, VolumeFilter, VoxelGrid};
use crate::shader::shared::shared_constants;

shared_constants!(constants {
    /// Words of a volume in the tables.
    const VOLUME_WORDS: u32 = (size_of::<PackedVolume>() / 16) as u32;
    /// Flags of a volume: values are not interpolated; outside of the box they are those at its border; voxels have three values.
    const VOLUME_NEAREST: u32 = 1;
    const VOLUME_BORDER: u32 = 2;
    const VOLUME_COLORED: u32 = 4;
});

/// Most voxels along an axis: kernels compute with them in signed numbers, and in single precision.
const MOST_VOXELS: u32 = 1 << 20;

/// 112 bytes, seven vec4 of the tables.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedVolume {
    /// Rows of the map from the scene's space to index space.
    pub to_index: [[f32; 4]; 3],
    pub resolution: [u32; 3],
    pub flags: u32,
    /// Index of the first value among the texels.
    pub first_value: u32,
    /// That of the first pair of bounds, of a density.
    pub first_bound: u32,
    /// Voxels along the side of a coarse cell, of a density.
    pub side: u32,
    /// Factor of all values.
    pub scale: f32,
    /// The value outside of the box, with the factor.
    pub outside: [f32; 3],
    pub unused: u32,
    /// Bounds of all values, without the factor, of a density.
    pub bounds: [f32; 2],
    /// `Filling::tracking_rate` of the medium that has this density.
    pub rate: f32,
    pub unused_too: u32,
}

impl PackedVolume {
    /// Packs a volume whose values are not placed yet.
    pub fn new(volume: &Volume) -> Self {
        let Volume { grid, to_index, filter, outside, scale } = volume;
        let row = |axis: usize| to_index.matrix3.row(axis).extend(to_index.translation[axis]).as_vec4().to_array();
        let flag = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
        let constant = match outside {
            Outside::Border => [0.0; 3],
            Outside::Constant(value) => (*value * *scale).to_f32(),
        };
        Self {
            to_index: [row(0), row(1), row(2)],
            resolution: grid.resolution(),
            flags: flag(*filter == VolumeFilter::Nearest, VOLUME_NEAREST)
                | flag(*outside == Outside::Border, VOLUME_BORDER)
                | flag(grid.channels() == 3, VOLUME_COLORED),
            scale: *scale as f32,
            outside: constant,
            ..Self::default()
        }
    }

    /// Packs a density with the bounds of its coarse cells.
    pub fn of_density(volume: &Volume, majorants: &Majorants, rate: f64) -> Self {
        Self { side: majorants.side(), bounds: majorants.overall(), rate: rate as f32, ..Self::new(volume) }
    }

    fn cells(&self) -> u64 {
        self.resolution.iter().map(|&voxels| u64::from(voxels.div_ceil(self.side.max(1)))).product()
    }

    /// A sentence about a number by which a kernel would read outside of the texels.
    pub fn check(&self, texel_words: usize) -> Result<(), String> {
        let [x, y, z] = self.resolution;
        if self.resolution.iter().any(|voxels| !(1..=MOST_VOXELS).contains(voxels)) {
            return Err(format!("has {x} × {y} × {z} voxels, and at most {MOST_VOXELS} along an axis are possible"));
        }
        if self.flags & !(VOLUME_NEAREST | VOLUME_BORDER | VOLUME_COLORED) != 0 {
            return Err(format!("has the flags {:#x}", self.flags));
        }
        let channels = if self.flags & VOLUME_COLORED != 0 { 3 } else { 1 };
        let end = u64::from(self.first_value) + channels * self.resolution.map(u64::from).iter().product::<u64>();
        let end_of_bounds = if self.side == 0 { 0 } else { u64::from(self.first_bound) + 2 * self.cells() };
        if end.max(end_of_bounds) > texel_words as u64 {
            return Err(format!("has values from {} and bounds from {} on of {texel_words}", self.first_value, self.first_bound));
        }
        Ok(())
    }
}

/// Volumes and what they are packed of, in the same order.
#[derive(Debug, Clone, Default)]
pub struct PackedVolumes {
    pub volumes: Vec<PackedVolume>,
    grids: Vec<Arc<VoxelGrid>>,
    /// Bounds of the coarse cells of a density.
    bounds: Vec<Vec<[f32; 2]>>,
}

impl PackedVolumes {
    /// Adds a volume, with the bounds of its cells where it is a density.
    pub fn push(&mut self, packed: PackedVolume, volume: &Volume, majorants: Option<&Majorants>) {
        self.volumes.push(packed);
        self.grids.push(volume.grid.clone());
        self.bounds.push(majorants.map_or_else(Vec::new, |majorants| majorants.bounds().to_vec()));
    }

    /// All grids; some may stand there twice.
    pub fn grids(&self) -> &[Arc<VoxelGrid>] {
        &self.grids
    }

    /// Notes where the grids' values stand among the texels, and adds the bounds of coarse cells behind them.
    ///
    /// # Errors
    /// [`PackError::TooManyTexels`] where 32 bits cannot number them.
    pub fn place(&mut self, textures: &mut PackedTextures) -> Result<(), PackError> {
        for ((volume, grid), bounds) in self.volumes.iter_mut().zip(&self.grids).zip(&self.bounds) {
            volume.first_value = textures.first_word_of_grid(grid);
            let first = textures.texel_words();
            let Ok(number) = u32::try_from(first) else { return Err(PackError::TooManyTexels { words: first }) };
            volume.first_bound = number;
            textures.words.extend(bounds.as_flattened().iter().map(|bound| bound.to_bits()));
        }
        Ok(())
    }
}
