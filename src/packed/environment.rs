//! Light from outside the scene, as the device reads it.

use std::f64::consts::PI;

use glam::DVec3;

use super::validate::PackError;
use crate::math::luminance;
use crate::sampling::MapDistribution;
use crate::scene::{Environment, EnvironmentRadiance, ImageData, Light, Scene};

/// A map's place among the texels: radiance row by row, then the quadtree that directions are drawn by, three words for each inner node,
/// then the densities of the cells that it lies over.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PackedMap {
    pub first_texel: u32,
    pub width: u32,
    pub height: u32,
    pub first_node: u32,
    pub first_density: u32,
    pub grid_width: u32,
    pub grid_height: u32,
    pub levels: u32,
}

/// What kind of environment there is; its colours are in the view.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum PackedEnvironment {
    #[default]
    Black,
    Constant {
        mean_luminance: f64,
    },
    Map {
        map: PackedMap,
        mean_luminance: f64,
    },
    Sky {
        mean_luminance: f64,
    },
}

impl PackedEnvironment {
    /// Appends a map to the texels.
    ///
    /// # Errors
    /// [`PackError::TooManyTexels`] where 32 bits cannot number them.
    pub fn new(scene: &Scene, texels: &mut Vec<f32>) -> Result<Self, PackError> {
        let mut constant = DVec3::ZERO;
        for environment in environments(scene) {
            match &environment.radiance {
                EnvironmentRadiance::Constant(radiance) => constant += *radiance,
                EnvironmentRadiance::Map(image) => return map(image, texels),
                &EnvironmentRadiance::Sky { zenith, horizon, ground } => {
                    let mean_luminance = sky_halves(zenith, horizon, ground).iter().sum::<f64>() / (4.0 * PI);
                    return Ok(if mean_luminance > 0.0 { Self::Sky { mean_luminance } } else { Self::Black });
                }
            }
        }
        let mean_luminance = luminance(constant);
        Ok(if mean_luminance > 0.0 { Self::Constant { mean_luminance } } else { Self::Black })
    }

    /// Averaged over all directions.
    pub fn mean_luminance(&self) -> f64 {
        match *self {
            Self::Black => 0.0,
            Self::Constant { mean_luminance } | Self::Map { mean_luminance, .. } | Self::Sky { mean_luminance } => mean_luminance,
        }
    }

    pub fn map(&self) -> Option<PackedMap> {
        match self {
            Self::Map { map, .. } => Some(*map),
            _ => None,
        }
    }
}

/// The scene's environments.
pub fn environments(scene: &Scene) -> impl Iterator<Item = &Environment> {
    scene.lights.iter().filter_map(|light| match light {
        Light::Environment(environment) => Some(environment),
        _ => None,
    })
}

/// Integral of luminance over the upper and the lower half of a sky.
pub fn sky_halves(zenith: DVec3, horizon: DVec3, ground: DVec3) -> [f64; 2] {
    [PI * (luminance(zenith) + luminance(horizon)), 2.0 * PI * luminance(ground)]
}

fn map(image: &ImageData, texels: &mut Vec<f32>) -> Result<PackedEnvironment, PackError> {
    let Some(MapDistribution { warp, mean_luminance }) = MapDistribution::new(image) else {
        return Ok(PackedEnvironment::Black);
    };
    let end = texels.len() + 3 * image.texels.len() + 3 * warp.splits.len() + warp.densities.len();
    if end > u32::MAX as usize {
        return Err(PackError::TooManyTexels { found: end / 3 });
    }
    let first_texel = texels.len() as u32;
    texels.extend(image.texels.iter().flat_map(|texel| texel.to_array()));
    let first_node = texels.len() as u32;
    texels.extend(warp.splits.iter().flatten().map(|&split| f32::from_bits(split)));
    let first_density = texels.len() as u32;
    texels.extend(warp.densities.iter().map(|&density| density as f32));
    let map = PackedMap {
        first_texel,
        width: image.width,
        height: image.height,
        first_node,
        first_density,
        grid_width: warp.width,
        grid_height: warp.height,
        levels: warp.levels(),
    };
    Ok(PackedEnvironment::Map { map, mean_luminance })
}
