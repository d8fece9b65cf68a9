//! Textures as the device reads them.

use std::collections::HashMap;

use glam::DVec3;

use super::error::PackError;
use crate::scene::{ImageTexture, Scene, Texture, TextureFilter, TextureId, TextureKind, TextureWrap};
use crate::shader::shared::{Constants, shared_constants, shared_kinds};

shared_kinds! {
    /// What a texture is.
    pub enum PackedTextureKind {
        Image = 0 as TEXTURE_IMAGE,
        Checker = 1 as TEXTURE_CHECKER,
        Perlin = 2 as TEXTURE_PERLIN,
        Worley = 3 as TEXTURE_WORLEY,
    }
}

shared_constants!(flags {
    /// Words of a texture in the tables.
    pub const TEXTURE_WORDS: u32 = (size_of::<PackedTexture>() / 16) as u32;
    /// Flag beside the kind of an image: texels are not interpolated.
    const TEXTURE_NEAREST: u32 = 1 << 10;
    /// Where the way of wrapping stands.
    pub(super) const WRAP_SHIFT: u32 = 8;
});

/// Of an image, beside its kind.
pub(super) const IMAGE_FLAGS: u32 = TEXTURE_NEAREST | 3 << WRAP_SHIFT;

/// Kinds, flags and sizes, for WGSL.
pub fn constants() -> Constants {
    [PackedTextureKind::constants(), flags()].concat()
}

/// 64 bytes, four vec4 of the tables.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedTexture {
    /// Kind in bits 0 to 7; of an image, bits 8 and 9: 0 repeat, 1 clamp, 2 mirror, and bit 10: nearest.
    pub kind_and_flags: u32,
    /// Of an image: index of its first float in the texels. Of noise: its seed.
    pub first_texel_or_seed: u32,
    /// Of an image: its width. Of Perlin noise: the number of octaves.
    pub width_or_octaves: u32,
    pub height: u32,
    pub scale: [f32; 2],
    pub offset: [f32; 2],
    pub a: [f32; 4],
    pub b: [f32; 4],
}

/// The textures that something looks up.
#[derive(Debug, Clone, Default)]
pub struct PackedTextures {
    pub textures: Vec<PackedTexture>,
    /// Linear Rec.709 texels of all images, three floats each.
    pub texels: Vec<f32>,
}

impl PackedTextures {
    /// Packs the textures that are mentioned by their numbers in the scene, each once; the mentions become places here.
    ///
    /// # Errors
    /// [`PackError::TooManyTexels`] where 32 bits cannot number them.
    pub fn new<'a>(scene: &Scene, mentions: impl Iterator<Item = &'a mut u32>) -> Result<Self, PackError> {
        let mut packed = Self::default();
        let mut places: HashMap<TextureId, u32> = HashMap::new();
        for mention in mentions {
            let id = *mention as TextureId;
            *mention = match places.get(&id) {
                Some(&place) => place,
                None => {
                    let place = packed.add(&scene.textures[id])?;
                    places.insert(id, place);
                    place
                }
            };
        }
        Ok(packed)
    }

    /// Its place.
    fn add(&mut self, texture: &Texture) -> Result<u32, PackError> {
        let packed = match &texture.kind {
            TextureKind::Image(image) => self.add_image(image)?,
            TextureKind::Checker { a, b, scale } => {
                PackedTexture { scale: scale.map(|x| x as f32), ..procedural(PackedTextureKind::Checker, *a, *b) }
            }
            TextureKind::Perlin { scale, octaves, a, b, seed } => PackedTexture {
                scale: [*scale as f32; 2],
                width_or_octaves: *octaves,
                first_texel_or_seed: *seed,
                ..procedural(PackedTextureKind::Perlin, *a, *b)
            },
            TextureKind::Worley { scale, a, b, seed } => PackedTexture {
                scale: [*scale as f32; 2],
                first_texel_or_seed: *seed,
                ..procedural(PackedTextureKind::Worley, *a, *b)
            },
        };
        self.textures.push(packed);
        Ok(self.textures.len() as u32 - 1)
    }

    fn add_image(&mut self, image: &ImageTexture) -> Result<PackedTexture, PackError> {
        let wrap = match image.wrap {
            TextureWrap::Repeat => 0,
            TextureWrap::Clamp => 1,
            TextureWrap::Mirror => 2,
        };
        let nearest = if image.filter == TextureFilter::Nearest { TEXTURE_NEAREST } else { 0 };
        let first_texel = self.texels.len();
        if first_texel + 3 * image.image.texels.len() > u32::MAX as usize {
            return Err(PackError::TooManyTexels { found: first_texel / 3 + image.image.texels.len() });
        }
        self.texels.extend(image.image.texels.iter().flat_map(|texel| texel.to_array()));
        Ok(PackedTexture {
            kind_and_flags: PackedTextureKind::Image as u32 | wrap << WRAP_SHIFT | nearest,
            first_texel_or_seed: first_texel as u32,
            width_or_octaves: image.image.width,
            height: image.image.height,
            scale: image.scale.map(|x| x as f32),
            offset: image.offset.map(|x| x as f32),
            a: [0.0; 4],
            b: [0.0; 4],
        })
    }
}

fn procedural(kind: PackedTextureKind, a: DVec3, b: DVec3) -> PackedTexture {
    let color = |color: DVec3| color.as_vec3().extend(0.0).to_array();
    PackedTexture {
        kind_and_flags: kind as u32,
        first_texel_or_seed: 0,
        width_or_octaves: 0,
        height: 0,
        scale: [1.0; 2],
        offset: [0.0; 2],
        a: color(a),
        b: color(b),
    }
}

impl PackedTexture {
    pub fn kind(&self) -> u32 {
        self.kind_and_flags & 255
    }
}
