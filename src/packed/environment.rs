//! Light from outside the scene, as the device reads it.

use glam::{DVec3, DVec4};

use super::error::PackError;
use super::texture::PackedTextures;
use crate::sampling::MapDistribution;
use crate::scene::{ImageData, MapRows, OutsideParameters};

/// A map's place among the texels: radiance row by row, then the quadtree that directions are drawn by, three words for each inner node,
/// then the densities of the cells that it lies over.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PackedMap {
    pub first_texel: u32,
    pub width: u32,
    pub height: u32,
    pub rows: MapRows,
    pub first_node: u32,
    pub first_density: u32,
    pub grid_width: u32,
    pub grid_height: u32,
    pub levels: u32,
}

/// The environment. Where it is black, its mean luminance is 0 and kernels hold nothing of it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PackedEnvironment {
    /// Averaged over all directions.
    pub mean_luminance: f64,
    /// Words of the view, which its shader reads; of a constant one, its radiance.
    pub words: [DVec4; 3],
    /// True where radiance is equal in all directions: BSDF sampling finds it without a shadow ray.
    pub is_constant: bool,
    /// The switch that compiles its shader; None: a constant one needs none.
    pub switch: Option<&'static str>,
    pub map: Option<PackedMap>,
}

impl PackedEnvironment {
    /// A light that is not constant is compiled by `switch`. A map is appended to the texels; a black one
    /// leaves nothing.
    ///
    /// # Errors
    /// [`PackError::TooManyTexels`] where 32 bits cannot number them.
    pub fn new(
        parameters: &OutsideParameters<'_>,
        switch: &'static str,
        textures: &mut PackedTextures,
    ) -> Result<Self, PackError> {
        Ok(match *parameters {
            OutsideParameters::Constant(radiance) => Self {
                mean_luminance: radiance.luminance(),
                words: [radiance.extend(0.0), DVec4::ZERO, DVec4::ZERO],
                is_constant: true,
                ..Self::default()
            },
            OutsideParameters::Varying { map: Some((image, rows)), words, .. } => {
                let (mean_luminance, map) = pack_map(image, rows, textures)?.unzip();
                Self {
                    mean_luminance: mean_luminance.unwrap_or(0.0),
                    words,
                    map,
                    is_constant: false,
                    switch: map.and(Some(switch)),
                }
            }
            OutsideParameters::Varying { mean_luminance, words, map: None } => {
                Self { mean_luminance, words, switch: Some(switch), ..Self::default() }
            }
        })
    }

    /// True of a map that is turned about another axis than +Y.
    pub fn is_turned(&self) -> bool {
        self.map.is_some() && self.words[0].truncate() != DVec3::ZERO
    }

    pub fn is_black(&self) -> bool {
        self.mean_luminance == 0.0
    }

    /// Constant ones add up; one that varies stands alone.
    pub fn of(parts: impl Iterator<Item = Self>) -> Self {
        let mut sum = Self { is_constant: true, ..Self::default() };
        for part in parts {
            if !part.is_constant {
                return part;
            }
            sum.mean_luminance += part.mean_luminance;
            sum.words[0] += part.words[0];
        }
        sum
    }
}

/// Mean luminance and place of a map that is appended to the texels; None of a black one.
fn pack_map(image: &ImageData, rows: MapRows, textures: &mut PackedTextures) -> Result<Option<(f64, PackedMap)>, PackError> {
    let Some(MapDistribution { warp, mean_luminance }) = MapDistribution::new(image, rows) else { return Ok(None) };
    let end = textures.texel_words() + 3 * image.texels.len() + 3 * warp.splits.len() + warp.densities.len();
    if end > u32::MAX as usize {
        return Err(PackError::TooManyTexels { words: end });
    }
    let first_texel = textures.texel_words() as u32;
    textures.words.extend(image.texels.colors().flat_map(|texel| texel.to_array().map(f32::to_bits)));
    let first_node = textures.texel_words() as u32;
    textures.words.extend(warp.splits.iter().flatten());
    let first_density = textures.texel_words() as u32;
    textures.words.extend(warp.densities.iter().map(|&density| (density as f32).to_bits()));
    let map = PackedMap {
        first_texel,
        width: image.width,
        height: image.height,
        rows,
        first_node,
        first_density,
        grid_width: warp.width,
        grid_height: warp.height,
        levels: warp.levels(),
    };
    Ok(Some((mean_luminance, map)))
}
