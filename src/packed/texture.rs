//! Textures as the device reads them.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use super::constants::NONE;
use super::error::PackError;
use crate::scene::image::Code;
use crate::scene::{
    Channel, ColorInput, ImageData, ImageTexture, Relief, Scene, Texels, Texture, TextureFilter, TextureId, TextureKind,
    TextureWrap, VoxelGrid,
};
use crate::shader::shared::{Constants, shared_constants, shared_kinds};
use crate::spectrum::Spectrum;

shared_kinds! {
    /// The kind of a texture.
    pub enum PackedTextureKind {
        Image = 0 as TEXTURE_IMAGE,
        Checker = 1 as TEXTURE_CHECKER,
        Perlin = 2 as TEXTURE_PERLIN,
        Worley = 3 as TEXTURE_WORLEY,
    }
}

shared_kinds! {
    /// How an image's texels are kept.
    pub enum TexelFormat {
        Bytes = 0 as TEXELS_OF_BYTES,
        Shorts = 1 as TEXELS_OF_SHORTS,
        Half = 2 as TEXELS_OF_HALF_FLOATS,
        Float = 3 as TEXELS_OF_FLOATS,
    }
}

shared_constants!(flags {
    /// Words of a texture in the tables.
    pub const TEXTURE_WORDS: u32 = (size_of::<PackedTexture>() / 16) as u32;
    /// Flag beside the kind of an image: texels are not interpolated.
    const TEXTURE_NEAREST: u32 = 1 << 10;
    /// Likewise: each block of 2 × 2 texels is a triangle.
    const TEXTURE_TRIANGLES: u32 = 1 << 17;
    /// Flag of any kind: a normal map that is this texture holds heights.
    pub(super) const TEXTURE_HEIGHTS: u32 = 1 << 18;
    /// Flag of any kind: reflection at its mapped normals is multiplied by the shadowing term.
    pub(super) const TEXTURE_SHADOWS: u32 = 1 << 19;
    /// Flag of any kind, beside the one before: mapped normals that point away from the viewer are mirrored.
    pub(super) const TEXTURE_MIRRORS: u32 = 1 << 20;
    /// Flag of any kind: it is looked up by the second texture coordinates.
    pub(super) const TEXTURE_BY_SECOND_UVS: u32 = 1 << 21;
    /// Likewise, beside that: directions of a normal map follow the first ones.
    pub(super) const TEXTURE_BENDS_BY_FIRST_UVS: u32 = 1 << 24;
    /// Bits of the way of wrapping along u, and of that along v.
    pub(super) const WRAP_SHIFT: u32 = 8;
    pub(super) const WRAP_V_SHIFT: u32 = 22;
    /// Bit from which on an image's format stands, and the flag of floating-point texels that have alpha.
    pub(super) const FORMAT_SHIFT: u32 = 11;
    pub(super) const FLOAT_ALPHA: u32 = 1 << 13;
    /// Bit from which on the number of the channel in use stands, from 1; 0: all of the colour is used.
    pub(super) const CHANNEL_SHIFT: u32 = 14;
});

/// Flags of an image, beside its kind.
pub(super) const IMAGE_FLAGS: u32 = TEXTURE_NEAREST
    | TEXTURE_TRIANGLES
    | 3 << WRAP_SHIFT
    | 3 << WRAP_V_SHIFT
    | 3 << FORMAT_SHIFT
    | FLOAT_ALPHA
    | 7 << CHANNEL_SHIFT;

/// Kinds, flags and sizes, for WGSL.
pub fn constants() -> Constants {
    [PackedTextureKind::constants(), TexelFormat::constants(), flags()].concat()
}

/// 80 bytes, five vec4 of the tables.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedTexture {
    /// Kind in bits 0 to 7; of an image, bits 8 and 9: 0 repeat, 1 clamp, 2 mirror along u, bits 22 and 23 along v, bit 10: nearest, bits 11 and 12: its [`TexelFormat`],
    /// bit 13: floating-point texels have alpha, from bit 14 on the channel, and bit 17: triangles.
    pub kind_and_flags: u32,
    /// Index of an image's first word in the texels, or seed of noise.
    pub first_texel_or_seed: u32,
    /// Width of an image, or number of octaves of Perlin noise.
    pub width_or_octaves: u32,
    pub height: u32,
    pub scale: [f32; 2],
    pub offset: [f32; 2],
    /// Colour a, and what a normal map that is this texture is multiplied by.
    pub a: [f32; 4],
    pub b: [f32; 4],
    /// Cosine and sine of the rotation, which comes before the offset and after the scale.
    pub cosine_sine: [f32; 2],
    /// Index in the texels of the first value of an integer image's codes.
    pub first_value: u32,
    /// One more than the place of the texture by which it is multiplied; 0: by none.
    pub times: u32,
}

/// Values that are not copied on their way to the device.
#[derive(Debug, Clone)]
enum Bulk {
    Image(Arc<ImageData>),
    Grid(Arc<VoxelGrid>),
}

impl Bulk {
    fn as_bytes(&self) -> &[u8] {
        match self {
            Self::Image(image) => image.texels.as_bytes(),
            Self::Grid(grid) => bytemuck::cast_slice(grid.values()),
        }
    }
}

/// The textures that something looks up.
#[derive(Debug, Clone, Default)]
pub struct PackedTextures {
    pub textures: Vec<PackedTexture>,
    /// Images and grids, whose values stand one after the other at the beginning of the texels.
    bulk: Vec<Bulk>,
    /// Words of all of them together.
    bulk_words: usize,
    /// First word of each grid, by its address.
    first_words_of_grids: HashMap<usize, u32>,
    /// Words behind the records: values of the integers in images, then the environment map and its
    /// distribution.
    pub words: Vec<u32>,
}

/// A colour as a constant factor and a texture index or NONE.
pub fn color_and_texture(input: &ColorInput) -> ([f32; 3], u32) {
    match input {
        ColorInput::Constant(color) => (color.to_f32(), NONE),
        ColorInput::Texture(texture) => ([1.0; 3], *texture as u32),
        ColorInput::ScaledTexture(texture, factor) => (factor.to_f32(), *texture as u32),
        // That it is squared stands beside the scalar it is for: colours never are.
        ColorInput::SquaredTexture(texture) => ([1.0; 3], *texture as u32),
        ColorInput::Channel(input) => (input.factor.to_f32(), mention(input.texture, Some(input.channel))),
    }
}

/// A texture, or one channel of it, as records mention it until textures are packed.
pub fn mention(texture: TextureId, channel: Option<Channel>) -> u32 {
    texture as u32 | channel.map_or(0, number_of) << MENTIONED_CHANNEL_SHIFT
}

/// The scene's number of a texture has the bits below. Scenes with more textures do not fit into any memory.
const MENTIONED_CHANNEL_SHIFT: u32 = 28;

fn number_of(channel: Channel) -> u32 {
    channel as u32 + 1
}

impl PackedTextures {
    /// Packs the textures that are [mentioned](mention), each once; the mentions become places here. The values of grids stand among the texels of images.
    ///
    /// # Errors
    /// [`PackError::TooManyTexels`] where 32 bits cannot number them.
    pub fn new<'a>(
        scene: &Scene,
        mentions: impl Iterator<Item = &'a mut u32>,
        grids: &[Arc<VoxelGrid>],
    ) -> Result<Self, PackError> {
        let mut packed = Packing::default();
        let mut places: HashMap<u32, u32> = HashMap::new();
        for mention in mentions {
            *mention = packed.place_of(scene, *mention, &mut places)?;
        }
        for grid in grids {
            packed.add_grid(grid)?;
        }
        packed.finish()
    }

    /// Index of a grid's first value among the texels; 0 of a grid that is not there.
    pub fn first_word_of_grid(&self, grid: &Arc<VoxelGrid>) -> u32 {
        self.first_words_of_grids.get(&(Arc::as_ptr(grid) as usize)).copied().unwrap_or(0)
    }

    /// Words of all texels, which kernels number from 0 on.
    pub fn texel_words(&self) -> usize {
        self.bulk_words + self.words.len()
    }

    /// The number of the first of [`Self::words`] among all texels.
    pub fn first_word(&self) -> usize {
        self.bulk_words
    }

    /// Bytes of all texels.
    pub fn texel_bytes(&self) -> u64 {
        4 * self.texel_words() as u64
    }

    /// A run of the texels' bytes, piece by piece.
    pub fn pieces(&self, bytes: Range<usize>) -> impl Iterator<Item = &[u8]> {
        let bulk = self.bulk.iter().map(Bulk::as_bytes);
        let mut end = 0;
        bulk.chain([bytemuck::cast_slice(&self.words)]).filter_map(move |piece| {
            let first = end;
            end += piece.len();
            let from = bytes.start.clamp(first, end) - first;
            let to = bytes.end.clamp(first, end) - first;
            (from < to).then(|| &piece[from..to])
        })
    }

    /// Some image's texels are kept in this way.
    pub fn has_format(&self, format: TexelFormat) -> bool {
        self.of_images().any(|texture| texture.format() == format as u32)
    }

    /// Some texture stands for one channel of an image.
    pub fn has_channels(&self) -> bool {
        self.of_images().any(|texture| texture.channel() != 0)
    }

    /// Some image holds triangles.
    pub fn has_triangles(&self) -> bool {
        self.of_images().any(|texture| texture.kind_and_flags & TEXTURE_TRIANGLES != 0)
    }

    /// Some texture holds heights for a bump map.
    pub fn has_heights(&self) -> bool {
        self.textures.iter().any(|texture| texture.kind_and_flags & TEXTURE_HEIGHTS != 0)
    }

    /// Some map shadows the normals that it bends.
    pub fn has_shadowed_normals(&self) -> bool {
        self.textures.iter().any(|texture| texture.kind_and_flags & TEXTURE_SHADOWS != 0)
    }

    /// Some map mirrors normals that it bends away from the viewer.
    pub fn has_mirrored_normals(&self) -> bool {
        self.textures.iter().any(|texture| texture.kind_and_flags & TEXTURE_MIRRORS != 0)
    }

    /// Some normal map is made stronger or weaker.
    pub fn has_scaled_normals(&self) -> bool {
        self.textures.iter().any(|texture| texture.kind_and_flags & TEXTURE_HEIGHTS == 0 && texture.a[3] != 1.0)
    }

    /// Some texture lies by second texture coordinates.
    pub fn uses_second_uvs(&self) -> bool {
        self.textures.iter().any(|texture| texture.kind_and_flags & TEXTURE_BY_SECOND_UVS != 0)
    }

    /// Some texture is multiplied by another.
    pub fn has_products(&self) -> bool {
        self.textures.iter().any(|texture| texture.times != 0)
    }

    /// Some texture is turned.
    pub fn is_rotated(&self) -> bool {
        self.textures.iter().any(|texture| texture.cosine_sine != [1.0, 0.0])
    }

    fn of_images(&self) -> impl Iterator<Item = &PackedTexture> {
        self.textures.iter().filter(|texture| texture.kind() == PackedTextureKind::Image as u32)
    }
}

/// Textures that are being packed.
#[derive(Default)]
struct Packing {
    packed: PackedTextures,
    /// First word of images that several textures share, by their address.
    first_words: HashMap<*const ImageData, u32>,
    /// Values of the integers, of each texture that is an image of integers.
    codes: Vec<(usize, Code)>,
}

impl Packing {
    /// The place of a texture that is [mentioned](mention), which is added, with the one by which it is multiplied, where it was not before.
    fn place_of(&mut self, scene: &Scene, mentioned: u32, places: &mut HashMap<u32, u32>) -> Result<u32, PackError> {
        if let Some(&place) = places.get(&mentioned) {
            return Ok(place);
        }
        let id = (mentioned & ((1 << MENTIONED_CHANNEL_SHIFT) - 1)) as TextureId;
        let channel = Channel::ALL.into_iter().find(|&channel| number_of(channel) == mentioned >> MENTIONED_CHANNEL_SHIFT);
        let texture = &scene.textures[id];
        let place = self.add(texture, channel)?;
        places.insert(mentioned, place);
        if let Some(other) = texture.times {
            let by = self.place_of(scene, mention(other, channel), places)?;
            self.packed.textures[place as usize].times = by + 1;
        }
        Ok(place)
    }

    /// Its place.
    fn add(&mut self, texture: &Texture, channel: Option<Channel>) -> Result<u32, PackError> {
        // A grey of the channel.
        let color = |color: Spectrum| channel.map_or(color, |channel| Spectrum::grey(channel.of_color(color)));
        let packed = match &texture.kind {
            TextureKind::Image(image) => self.add_image(image, channel)?,
            TextureKind::Checker { a, b, scale } => {
                PackedTexture { scale: scale.map(|x| x as f32), ..procedural(PackedTextureKind::Checker, color(*a), color(*b)) }
            }
            TextureKind::Perlin { scale, octaves, a, b, seed } => PackedTexture {
                scale: [*scale as f32; 2],
                width_or_octaves: *octaves,
                first_texel_or_seed: *seed,
                ..procedural(PackedTextureKind::Perlin, color(*a), color(*b))
            },
            TextureKind::Worley { scale, a, b, seed } => PackedTexture {
                scale: [*scale as f32; 2],
                first_texel_or_seed: *seed,
                ..procedural(PackedTextureKind::Worley, color(*a), color(*b))
            },
        };
        let axis = texture.transform.rotation().x_axis;
        let (heights, scale) = match texture.relief {
            Relief::Normals(scale) => (false, scale),
            Relief::Heights(scale) => (true, scale),
        };
        self.packed.textures.push(PackedTexture {
            kind_and_flags: packed.kind_and_flags
                | if heights { TEXTURE_HEIGHTS } else { 0 }
                | if texture.shadows_perturbed_normals { TEXTURE_SHADOWS } else { 0 }
                | if texture.mirrors_perturbed_normals { TEXTURE_MIRRORS } else { 0 }
                | if texture.by_second_uvs { TEXTURE_BY_SECOND_UVS } else { 0 }
                | if texture.bends_by_first_uvs { TEXTURE_BENDS_BY_FIRST_UVS } else { 0 },
            a: [packed.a[0], packed.a[1], packed.a[2], scale as f32],
            offset: texture.transform.offset.map(|x| x as f32),
            cosine_sine: axis.as_vec2().to_array(),
            ..packed
        });
        Ok(self.packed.textures.len() as u32 - 1)
    }

    fn add_image(&mut self, image: &ImageTexture, channel: Option<Channel>) -> Result<PackedTexture, PackError> {
        let [wrap_u, wrap_v] = image.wrap.map(|wrap| match wrap {
            TextureWrap::Repeat => 0,
            TextureWrap::Clamp => 1,
            TextureWrap::Mirror => 2,
        });
        let filter = match image.filter {
            TextureFilter::Bilinear => 0,
            TextureFilter::Nearest => TEXTURE_NEAREST,
            TextureFilter::Triangle => TEXTURE_TRIANGLES,
        };
        let data = &image.image;
        let (format, alpha) = match data.texels {
            Texels::Bytes { .. } => (TexelFormat::Bytes, 0),
            Texels::Shorts { .. } => (TexelFormat::Shorts, 0),
            Texels::Half(_) => (TexelFormat::Half, 0),
            Texels::Float(_) if channel == Some(Channel::A) => {
                return Ok(procedural(PackedTextureKind::Checker, Spectrum::WHITE, Spectrum::WHITE));
            }
            Texels::Float(_) => (TexelFormat::Float, 0),
            Texels::FloatAlpha(_) => (TexelFormat::Float, FLOAT_ALPHA),
        };
        if let Some(code) = data.texels.code(channel == Some(Channel::A)) {
            self.codes.push((self.packed.textures.len(), code));
        }
        Ok(PackedTexture {
            kind_and_flags: PackedTextureKind::Image as u32
                | wrap_u << WRAP_SHIFT
                | wrap_v << WRAP_V_SHIFT
                | filter
                | (format as u32) << FORMAT_SHIFT
                | alpha
                | channel.map_or(0, number_of) << CHANNEL_SHIFT,
            first_texel_or_seed: self.first_word(data)?,
            width_or_octaves: data.width,
            height: data.height,
            scale: image.scale.map(|x| x as f32),
            ..procedural(PackedTextureKind::Image, Spectrum::BLACK, Spectrum::BLACK)
        })
    }

    /// First word of an image, which is added where no texture had it before.
    fn first_word(&mut self, image: &Arc<ImageData>) -> Result<u32, PackError> {
        if let Some(&known) = self.first_words.get(&Arc::as_ptr(image)) {
            return Ok(known);
        }
        let number = self.add_bulk(image.texels.words() * image.texels.len(), Bulk::Image(image.clone()))?;
        self.first_words.insert(Arc::as_ptr(image), number);
        Ok(number)
    }

    /// Adds a grid's values where they are not there yet.
    fn add_grid(&mut self, grid: &Arc<VoxelGrid>) -> Result<(), PackError> {
        let address = Arc::as_ptr(grid) as usize;
        if !self.packed.first_words_of_grids.contains_key(&address) {
            let number = self.add_bulk(grid.values().len(), Bulk::Grid(grid.clone()))?;
            self.packed.first_words_of_grids.insert(address, number);
        }
        Ok(())
    }

    /// The first word of values that are added.
    fn add_bulk(&mut self, words: usize, bulk: Bulk) -> Result<u32, PackError> {
        let first = self.packed.bulk_words;
        self.packed.bulk_words += words;
        let numbered = u32::try_from(first).ok().filter(|_| u32::try_from(self.packed.bulk_words).is_ok());
        let Some(number) = numbered else { return Err(PackError::TooManyTexels { words: self.packed.bulk_words }) };
        self.packed.bulk.push(bulk);
        Ok(number)
    }

    /// Puts what integers stand for behind the images, each way once.
    fn finish(self) -> Result<PackedTextures, PackError> {
        let mut packed = self.packed;
        let mut first_values: HashMap<Code, usize> = HashMap::new();
        for (texture, code) in self.codes {
            let first = *first_values.entry(code).or_insert_with(|| {
                let first = packed.texel_words();
                packed.words.extend(code.values().iter().map(|value| value.to_bits()));
                first
            });
            let Ok(number) = u32::try_from(first) else { return Err(PackError::TooManyTexels { words: packed.texel_words() }) };
            packed.textures[texture].first_value = number;
        }
        Ok(packed)
    }
}

fn procedural(kind: PackedTextureKind, a: Spectrum, b: Spectrum) -> PackedTexture {
    let color = |color: Spectrum| color.extend(0.0).as_vec4().to_array();
    PackedTexture {
        kind_and_flags: kind as u32,
        first_texel_or_seed: 0,
        width_or_octaves: 0,
        height: 0,
        scale: [1.0; 2],
        offset: [0.0; 2],
        a: color(a),
        b: color(b),
        cosine_sine: [1.0, 0.0],
        first_value: 0,
        times: 0,
    }
}

impl PackedTexture {
    pub fn kind(&self) -> u32 {
        self.kind_and_flags & 255
    }

    /// Format of an image, as a number of [`TexelFormat`].
    pub fn format(&self) -> u32 {
        self.kind_and_flags >> FORMAT_SHIFT & 3
    }

    /// The number of the channel that counts, from 1; 0: the colour counts.
    pub fn channel(&self) -> u32 {
        self.kind_and_flags >> CHANNEL_SHIFT & 7
    }

    /// Words of a texel of an image.
    pub fn words_of_texel(&self) -> u32 {
        match self.format() {
            format if format == TexelFormat::Bytes as u32 => 1,
            format if format == TexelFormat::Float as u32 => 3 + u32::from(self.kind_and_flags & FLOAT_ALPHA != 0),
            _ => 2,
        }
    }

    /// Number of values that an image's integers have; 0 where it has none.
    pub fn values(&self) -> u32 {
        match self.format() {
            format if format == TexelFormat::Bytes as u32 => 1 << 8,
            format if format == TexelFormat::Shorts as u32 => 1 << 16,
            _ => 0,
        }
    }
}
