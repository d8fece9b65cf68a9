//! A grid in a medium's space.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::grid::{VolumeFilter, VoxelGrid};
use crate::scene::check::{Check, is_amount};
use crate::spectrum::Spectrum;

/// The value outside of a grid's box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outside {
    /// The value of the nearest point of the box.
    Border,
    /// One value, before it is scaled.
    Constant(Spectrum),
}

/// A grid of values that is placed in a medium's space.
#[derive(Debug, Clone)]
pub struct Volume {
    /// The values, which several volumes may share.
    pub grid: Arc<VoxelGrid>,
    /// From the medium's space to index space.
    pub to_index: DAffine3,
    /// The way a value is found between voxels.
    pub filter: VolumeFilter,
    /// The value outside of the grid's box.
    pub outside: Outside,
    /// Factor of all values, that outside too.
    pub scale: f64,
}

impl Volume {
    /// The grid in a box of the medium's space that is along its axes, looked up trilinearly, with nothing outside.
    pub fn in_box(grid: Arc<VoxelGrid>, low: DVec3, high: DVec3) -> Self {
        let size = DVec3::from_array(grid.resolution().map(f64::from));
        let factor = size / (high - low);
        let to_index = DAffine3::from_scale(factor) * DAffine3::from_translation(-low);
        Self { grid, to_index, filter: VolumeFilter::Trilinear, outside: Outside::Constant(Spectrum::BLACK), scale: 1.0 }
    }

    /// The value at a point of the medium's space; grey where the grid has one channel.
    pub fn value_at(&self, point: DVec3) -> Spectrum {
        self.value_at_index(self.to_index.transform_point3(point))
    }

    /// The value at a point of index space.
    pub fn value_at_index(&self, at: DVec3) -> Spectrum {
        let size = DVec3::from_array(self.grid.resolution().map(f64::from));
        let is_inside = at.cmpge(DVec3::ZERO).all() && at.cmple(size).all();
        let value = match self.outside {
            Outside::Constant(value) if !is_inside => value,
            Outside::Constant(_) | Outside::Border => match self.filter {
                VolumeFilter::Nearest => self.grid.nearest(at),
                VolumeFilter::Trilinear => self.grid.trilinear(at),
            },
        };
        value * self.scale
    }

    /// The value next to a point of index space that is within a coarse cell of this side, or outside of the box. Where rounding puts the point into
    /// the cell beside, the value is that of the nearest point of its own, whose bounds hold.
    pub fn in_cell(&self, cell: Option<[u32; 3]>, side: u32, at: DVec3) -> Spectrum {
        match (cell, self.outside) {
            (None, Outside::Constant(value)) => value * self.scale,
            (None, Outside::Border) => self.value_at_index(at),
            (Some(cell), _) => {
                let low = DVec3::from_array(cell.map(|cell| f64::from(cell) * f64::from(side)));
                let high = (low + f64::from(side)).min(DVec3::from_array(self.grid.resolution().map(f64::from)));
                let value = match self.filter {
                    VolumeFilter::Nearest => self.grid.nearest(at.clamp(low, high - 1.0 + 0.5)),
                    VolumeFilter::Trilinear => self.grid.trilinear(at.clamp(low, high)),
                };
                value * self.scale
            }
        }
    }

    /// Moves the volume with the space around it.
    pub fn translate(&mut self, by: DVec3) {
        self.to_index *= DAffine3::from_translation(-by);
    }

    /// The smallest and the largest value of any channel anywhere.
    pub fn range(&self) -> [f64; 2] {
        let [low, high] = self.grid.range().map(f64::from);
        let [low, high] = match self.outside {
            Outside::Border => [low, high],
            Outside::Constant(value) => [low.min(value.min_component()), high.max(value.max_component())],
        };
        [low * self.scale, high * self.scale]
    }

    /// The corner of the grid's box in the medium's space from which its axes grow, and its three edges.
    pub fn corner_and_edges(&self) -> (DVec3, [DVec3; 3]) {
        let to_medium = self.to_index.inverse();
        let [x, y, z] = self.grid.resolution().map(f64::from);
        let matrix = to_medium.matrix3;
        (to_medium.translation, [matrix.x_axis * x, matrix.y_axis * y, matrix.z_axis * z])
    }

    /// Checks what the type does not.
    ///
    /// # Errors
    /// A place that flattens the grid, and a negative or infinite value outside or factor.
    pub fn check(&self) -> Check {
        let inverse = self.to_index.inverse();
        if !(self.to_index.is_finite() && inverse.is_finite()) {
            return Err("its transform flattens the grid, or is not finite".to_owned());
        }
        if !(self.scale.is_finite() && self.scale >= 0.0) {
            return Err(format!("its scale is {}, and not a number from 0", self.scale));
        }
        match self.outside {
            Outside::Constant(value) if !is_amount(value) => Err("its value outside is negative or no number".to_owned()),
            Outside::Border | Outside::Constant(_) => Ok(()),
        }
    }
}

/// Volumes that share a grid are not compared voxel by voxel.
impl PartialEq for Volume {
    fn eq(&self, other: &Self) -> bool {
        let of = |volume: &Self| (volume.to_index, volume.filter, volume.outside, volume.scale);
        of(self) == of(other) && (Arc::ptr_eq(&self.grid, &other.grid) || self.grid == other.grid)
    }
}
