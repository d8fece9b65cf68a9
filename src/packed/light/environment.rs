//! An environment of one colour, or a lat-long map.

use glam::{DVec3, DVec4};

use crate::math::luminance;
use crate::packed::environment::{PackedEnvironment, PackedMap};
use crate::packed::error::PackError;
use crate::sampling::MapDistribution;
use crate::scene::{Environment, EnvironmentRadiance, ImageData};

/// Words: (radiance of a constant one; rotation of a map in turns). A map is appended to the texels.
///
/// # Errors
/// [`PackError::TooManyTexels`] where 32 bits cannot number them.
pub fn pack(light: &Environment, texels: &mut Vec<f32>) -> Result<PackedEnvironment, PackError> {
    match &light.radiance {
        EnvironmentRadiance::Constant(radiance) => Ok(PackedEnvironment {
            mean_luminance: luminance(*radiance),
            words: [radiance.extend(0.0), DVec4::ZERO, DVec4::ZERO],
            is_constant: true,
            ..PackedEnvironment::default()
        }),
        EnvironmentRadiance::Map(image) => {
            let turns = (light.rotation_degrees / 360.0).rem_euclid(1.0);
            let words = [DVec3::ZERO.extend(turns), DVec4::ZERO, DVec4::ZERO];
            Ok(PackedEnvironment { words, ..map(image, texels)? })
        }
    }
}

fn map(image: &ImageData, texels: &mut Vec<f32>) -> Result<PackedEnvironment, PackError> {
    let Some(MapDistribution { warp, mean_luminance }) = MapDistribution::new(image) else {
        return Ok(PackedEnvironment::default());
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
    Ok(PackedEnvironment { mean_luminance, map: Some(map), switch: Some("ENVIRONMENT_MAP"), ..PackedEnvironment::default() })
}
