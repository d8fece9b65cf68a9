//! Where a lamp whose emission is a picture is bright: how bright any part of it is, and what points of a rectangle are drawn by.

mod level;

use std::sync::Arc;

use glam::{DMat2, DVec2};

use super::hierarchical_warp::HierarchicalWarp;
use crate::math::luminance;
use crate::scene::{
    ChannelInput, ColorInput, ImageTexture, Material, MaterialId, Scene, TextureFilter, TextureKind, TextureWrap,
};
use level::Level;

/// Most cells along either side of a rectangle. Of larger pictures, cells hold several texels.
const MOST_CELLS: f64 = 512.0;
/// The mean of the squared luminance over the squared mean from which on points are drawn by luminance. Rectangles that are lit more evenly are
/// drawn by solid angle, which counts for more where they are near.
const LEAST_CONTRAST: f64 = 1.5;
/// Pieces of texels that parts of lamps are looked up in, of all parts of a scene together.
const MOST_PIECES: f64 = 8_388_608.0;
/// The same along either side of a part, where there are few parts and where there are many.
const PIECES: [f64; 2] = [64.0, 2.0];
/// Texels up to which interpolation is looked at in quarters of texels, and in halves.
const FINE_TEXELS: [usize; 2] = [1 << 16, 1 << 20];

/// The pictures that a scene's lamps show, by material.
#[derive(Debug, Clone, Default)]
pub struct EmissionMaps {
    maps: Vec<Option<EmissionMap>>,
}

/// The luminance of one picture as it lies on a lamp.
#[derive(Debug, Clone)]
struct EmissionMap {
    /// From finest to coarsest.
    levels: Vec<Level>,
    wrap: TextureWrap,
    /// From texture coordinates to those in which the picture is the unit square, u to the right and v upward.
    scale: DVec2,
    rotation: DMat2,
    offset: DVec2,
    /// How many pieces of texels are looked at along each side of a part.
    pieces: f64,
    /// What points of rectangles are drawn by; None: evenly.
    warp: Option<Arc<HierarchicalWarp>>,
}

impl EmissionMaps {
    /// Of all materials that emit by an image alone. What blends emit changes with their weights, and patterns have no texels.
    pub fn new(scene: &Scene) -> Self {
        let emits: Vec<bool> = scene.materials.iter().map(|material| picture(scene, material).is_some()).collect();
        if !emits.contains(&true) {
            return Self::default();
        }
        let lamps = scene.shapes.iter().filter(|shape| shape.materials().any(|id| emits[id]));
        let parts: usize = lamps.map(|shape| shape.geometry.faces().max(1)).sum();
        let pieces = (MOST_PIECES / parts.max(1) as f64).sqrt().clamp(PIECES[1], PIECES[0]);
        let of =
            |material: &Material| picture(scene, material).map(|(input, image)| EmissionMap::new(scene, input, image, pieces));
        Self { maps: scene.materials.iter().map(of).collect() }
    }

    /// The mean luminance that a material sends out from a triangle or a parallelogram with these texture coordinates at its corners. None: that
    /// of the whole material is all that is known.
    pub fn luminance(&self, material: MaterialId, corners: &[DVec2]) -> Option<f64> {
        self.maps.get(material)?.as_ref()?.mean_over(corners)
    }

    /// The density over the unit square of texture coordinates by which points of rectangles of this material are drawn. None: evenly.
    pub fn warp(&self, material: MaterialId) -> Option<&Arc<HierarchicalWarp>> {
        self.maps.get(material)?.as_ref()?.warp.as_ref()
    }
}

/// The corners of a rectangle's texture coordinates.
pub const UNIT_SQUARE: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];

/// What a material emits, and the image that it looks that up in.
fn picture<'a>(scene: &'a Scene, material: &Material) -> Option<(ColorInput, &'a ImageTexture)> {
    let input = material.emission?.radiance;
    if material.is_blend() || input.is_squared() {
        return None;
    }
    let texture = scene.textures.get(input.texture()?)?;
    let TextureKind::Image(image) = &texture.kind else { return None };
    // Colours of triangles' corners lie in the picture in blocks of their own; of a product the picture is not all.
    (image.filter != TextureFilter::Triangle && !texture.by_second_uvs && texture.times.is_none()).then_some((input, image))
}

impl EmissionMap {
    fn new(scene: &Scene, input: ColorInput, image: &ImageTexture, pieces: f64) -> Self {
        let (width, height) = (image.image.width as usize, image.image.height as usize);
        let texels = &image.image.texels;
        let values: Vec<f64> = match input {
            ColorInput::Channel(ChannelInput { channel, factor, .. }) => {
                texels.channel(channel).map(|value| luminance(factor) * f64::from(value)).collect()
            }
            ColorInput::ScaledTexture(_, factor) => texels.colors().map(|texel| luminance(texel.as_dvec3() * factor)).collect(),
            _ => texels.colors().map(|texel| luminance(texel.as_dvec3())).collect(),
        };
        let finest = Level { width, height, values };
        let finest = match image.filter {
            TextureFilter::Nearest => finest,
            _ if width * height <= FINE_TEXELS[0] => finest.interpolated(4, image.wrap),
            _ if width * height <= FINE_TEXELS[1] => finest.interpolated(2, image.wrap),
            _ => finest.spread(image.wrap),
        };
        let transform = input.texture().map_or_else(Default::default, |texture| scene.textures[texture].transform);
        let mut map = Self {
            levels: finest.coarser_ones(),
            wrap: image.wrap,
            scale: DVec2::from(image.scale),
            rotation: transform.rotation(),
            offset: DVec2::from(transform.offset),
            pieces,
            warp: None,
        };
        map.warp = map.warp_of_square().map(Arc::new);
        map
    }

    /// None where the square is lit nearly evenly, or not at all.
    fn warp_of_square(&self) -> Option<HierarchicalWarp> {
        let finest = &self.levels[0];
        let texels = DVec2::new(finest.width as f64, finest.height as f64);
        let cells =
            |edge: DVec2| (texels * (self.rotation * (self.scale * edge)).abs()).max_element().round().clamp(1.0, MOST_CELLS);
        let [columns, rows] = [cells(DVec2::X), cells(DVec2::Y)];
        let size = DVec2::new(columns, rows);
        let of_cell = |(row, column): (u32, u32)| {
            let low = DVec2::new(column.into(), row.into());
            self.mean_over(&UNIT_SQUARE.map(|corner| (low + corner) / size))
        };
        let all = (0..rows as u32).flat_map(|row| (0..columns as u32).map(move |column| (row, column)));
        let weights: Vec<f64> = all.map(of_cell).collect::<Option<_>>()?;
        let count = columns * rows;
        let mean = weights.iter().sum::<f64>() / count;
        let squares = weights.iter().map(|weight| weight * weight).sum::<f64>() / count;
        if mean.is_nan() || mean <= 0.0 || squares < LEAST_CONTRAST * mean * mean {
            return None;
        }
        // A cell has no weight only where nothing of it shines: no share is drawn evenly, which would be noise that even sequences do not have.
        HierarchicalWarp::new(columns as u32, rows as u32, &weights)
    }

    /// None of what lies over more repetitions of the picture than are looked at.
    fn mean_over(&self, corners: &[DVec2]) -> Option<f64> {
        let placed: Vec<DVec2> = corners
            .iter()
            .map(|corner| {
                let at = self.rotation * (*corner * self.scale) + self.offset;
                // Rows run down.
                DVec2::new(at.x, 1.0 - at.y)
            })
            .collect();
        self.levels.iter().find_map(|level| level.mean_over(&placed, self.wrap, self.pieces))
    }
}

#[cfg(test)]
mod tests;
