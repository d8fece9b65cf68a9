//! Area lights that emit by one image alone.

use glam::{DMat2, DVec2};

use super::level::Level;
use crate::scene::{ChannelInput, ColorInput, ImageTexture, Material, Scene, TextureFilter, TextureKind, TextureWrap};
use crate::spectrum::Spectrum;
use crate::texture::Coordinates;

/// Most cells along either side of a square. Of larger pictures, cells hold several texels.
const MOST_CELLS: f64 = 512.0;
/// Pieces of texels that parts of area lights are looked up in, of all parts of a scene together.
const MOST_PIECES: f64 = 8_388_608.0;
/// The number of pieces along either side of a part, where there are few parts and where there are many.
const PIECES: [f64; 2] = [64.0, 2.0];
/// Texels up to which interpolation is looked at in quarters of texels, and in halves.
const FINE_TEXELS: [usize; 2] = [1 << 16, 1 << 20];

/// The luminance of one picture as it lies on an area light.
#[derive(Debug, Clone)]
pub struct EmissionImage {
    /// From finest to coarsest.
    levels: Vec<Level>,
    wrap: [TextureWrap; 2],
    /// From texture coordinates to those in which the picture is the unit square, u to the right and v upward.
    scale: DVec2,
    rotation: DMat2,
    offset: DVec2,
    by_second_uvs: bool,
    /// How many pieces of texels are looked at along each side of a part.
    pieces: f64,
}

/// The emission of a material and the image that it is looked up in, where that is all.
fn shown<'a>(scene: &'a Scene, material: &Material) -> Option<(ColorInput, &'a ImageTexture)> {
    let input = material.emission?.radiance;
    if material.is_blend() || input.is_squared() {
        return None;
    }
    let texture = scene.textures.get(input.texture()?)?;
    let TextureKind::Image(image) = &texture.kind else { return None };
    // Colours of triangles' corners lie in the picture in blocks of their own; of a product the picture is not all.
    (image.filter != TextureFilter::Triangle && texture.times.is_none()).then_some((input, image))
}

impl EmissionImage {
    /// The map of a scene whose textured area lights have so many parts. None where the material emits by
    /// more than an image.
    pub fn of(scene: &Scene, material: &Material, parts: usize) -> Option<Self> {
        let (input, image) = shown(scene, material)?;
        let (width, height) = (image.image.width as usize, image.image.height as usize);
        let texels = &image.image.texels;
        let values: Vec<f64> = match input {
            ColorInput::Channel(ChannelInput { channel, factor, .. }) => {
                texels.channel(channel).map(|value| factor.luminance() * f64::from(value)).collect()
            }
            ColorInput::ScaledTexture(_, factor) => {
                texels.colors().map(|texel| (Spectrum::from_f32(texel.to_array()) * factor).luminance()).collect()
            }
            _ => texels.colors().map(|texel| Spectrum::from_f32(texel.to_array()).luminance()).collect(),
        };
        let finest = Level { width, height, values };
        let finest = match image.filter {
            TextureFilter::Nearest => finest,
            _ if width * height <= FINE_TEXELS[0] => finest.interpolated(4, image.wrap),
            _ if width * height <= FINE_TEXELS[1] => finest.interpolated(2, image.wrap),
            _ => finest.spread(image.wrap),
        };
        let texture = &scene.textures[input.texture()?];
        Some(Self {
            levels: finest.coarser_ones(),
            wrap: image.wrap,
            scale: DVec2::from(image.scale),
            rotation: texture.transform.rotation(),
            offset: DVec2::from(texture.transform.offset),
            by_second_uvs: texture.by_second_uvs,
            pieces: (MOST_PIECES / parts.max(1) as f64).sqrt().clamp(PIECES[1], PIECES[0]),
        })
    }

    /// So many that cells are about as large as texels.
    pub fn cells(&self) -> [u32; 2] {
        let finest = &self.levels[0];
        let texels = DVec2::new(finest.width as f64, finest.height as f64);
        [DVec2::X, DVec2::Y].map(|edge| {
            let count = (texels * (self.rotation * (self.scale * edge)).abs()).max_element();
            count.round().clamp(1.0, MOST_CELLS) as u32
        })
    }

    pub fn mean_over_triangle(&self, corners: &[Coordinates; 3]) -> Option<f64> {
        self.mean_over(&corners.map(|corner| if self.by_second_uvs { corner.second } else { corner.first }))
    }

    /// None of what lies over more repetitions of the picture than are looked at.
    pub fn mean_over(&self, corners: &[DVec2]) -> Option<f64> {
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
