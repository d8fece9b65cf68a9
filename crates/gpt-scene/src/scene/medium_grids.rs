//! Values in space by which a medium differs from place to place.

use std::sync::Arc;

use glam::DVec3;
use sha2::Sha256;

use super::check::Check;
use super::volume::{Majorants, Volume, VoxelGrid};
use crate::spectrum::Spectrum;

/// Coarse cells along the longest axis of a density's grid. More of them bound the density closer, and more are crossed.
const MOST_CELLS: u32 = 32;

/// Places, on average, at which light that a medium gives off is looked up along the diagonal of its grid at the least.
const LOOKUPS: f64 = 8.0;

/// Values in the space of the scene by which a medium differs from place to place.
#[derive(Debug, Clone)]
pub struct MediumGrids {
    density: Volume,
    majorants: Majorants,
    albedo: Option<Volume>,
    emission: Option<Volume>,
}

/// The grids that make a medium.
#[derive(Debug, Clone, PartialEq)]
pub struct GridsOfMedium {
    /// Factor of everything that the medium takes and gives per unit length.
    pub density: Volume,
    /// Share that is scattered of the light that is lost, by which the medium's scattering is multiplied.
    pub albedo: Option<Volume>,
    /// Factor of the emission.
    pub emission: Option<Volume>,
}

impl MediumGrids {
    /// Finds the bounds of the density, which takes as long as reading its grid once.
    pub fn new(GridsOfMedium { density, albedo, emission }: GridsOfMedium) -> Self {
        let longest = density.grid.resolution().into_iter().max().unwrap_or(1);
        let majorants = Majorants::of(&density.grid, density.filter, longest.div_ceil(MOST_CELLS).max(1));
        Self { density, majorants, albedo, emission }
    }

    /// Factor of everything that the medium takes and gives per unit length.
    pub fn density(&self) -> &Volume {
        &self.density
    }

    /// Bounds of the density's grid.
    pub fn majorants(&self) -> &Majorants {
        &self.majorants
    }

    /// Share that is scattered of the light that is lost.
    pub fn albedo(&self) -> Option<&Volume> {
        self.albedo.as_ref()
    }

    /// Factor of the emission.
    pub fn emission(&self) -> Option<&Volume> {
        self.emission.as_ref()
    }

    /// All of them.
    pub fn volumes(&self) -> impl Iterator<Item = &Volume> {
        [Some(&self.density), self.albedo.as_ref(), self.emission.as_ref()].into_iter().flatten()
    }

    /// The density next to a point of the medium's space that is within a coarse cell, or outside of the grid.
    pub fn density_in(&self, cell: Option<[u32; 3]>, point: DVec3) -> Spectrum {
        self.density.in_cell(cell, self.majorants.side(), self.density.to_index.transform_point3(point))
    }

    /// Attenuation per unit length and density at which light that is given off is looked up often enough, though none is lost.
    pub fn emission_rate(&self) -> f64 {
        let (_, edges) = self.density.corner_and_edges();
        let diagonal = edges.into_iter().sum::<DVec3>().length();
        let [_, most] = self.density.range();
        if most > 0.0 && diagonal > 0.0 { LOOKUPS / (most * diagonal) } else { 0.0 }
    }

    /// The grids moved with the whole scene.
    pub fn translated(&self, by: DVec3) -> Self {
        let mut moved = self.clone();
        let volumes = [Some(&mut moved.density), moved.albedo.as_mut(), moved.emission.as_mut()];
        for volume in volumes.into_iter().flatten() {
            volume.translate(by);
        }
        moved
    }

    /// A sentence about what cannot be.
    pub fn check(&self) -> Check {
        let Self { density, albedo, emission, .. } = self;
        for (what, volume) in [("density", Some(density)), ("albedo", albedo.as_ref()), ("emission", emission.as_ref())] {
            volume.map_or(Ok(()), Volume::check).map_err(|reason| format!("the grid of its {what}: {reason}"))?;
        }
        match albedo {
            Some(albedo) if albedo.range()[1] > 1.0 => Err(format!("its albedo goes up to {}, above 1", albedo.range()[1])),
            _ => Ok(()),
        }
    }

    /// Adds the values of all grids to a fingerprint.
    pub(super) fn hash_into(&self, hash: &mut Sha256) {
        self.volumes().for_each(|volume| volume.grid.hash_into(hash));
    }

    /// The grids with no values, and placed no more exactly than devices know: what prints in no time, and alike after it was written and read.
    pub(super) fn without_values(&self) -> Self {
        let empty = |volume: &Volume| {
            let grid = VoxelGrid::new([1; 3], 1, vec![0.0]).expect("a voxel is a grid");
            let to_index = volume.to_index.as_affine3a().as_daffine3();
            Volume { grid: Arc::new(grid), to_index, ..volume.clone() }
        };
        let [albedo, emission] = [&self.albedo, &self.emission].map(|volume| volume.as_ref().map(empty));
        Self::new(GridsOfMedium { density: empty(&self.density), albedo, emission })
    }
}

/// Bounds follow from the rest.
impl PartialEq for MediumGrids {
    fn eq(&self, other: &Self) -> bool {
        self.density == other.density && self.albedo == other.albedo && self.emission == other.emission
    }
}
