//! Materials and textures as the device reads them.

use glam::DVec3;

use super::NONE;
use super::validate::FlatError;
use crate::scene::{ColorInput, Material, MaterialKind, Scene, TextureFilter, TextureKind, TextureWrap};

/// Kinds in `shaders/shading/bsdf.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u32)]
pub enum FlatMaterialKind {
    Diffuse = 0,
    Mirror = 1,
    Glass = 2,
    Emissive = 3,
}

const EMITS: u32 = 1;
const EMITS_TWO_SIDED: u32 = 2;

/// 64 bytes, four vec4 of the tables.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct FlatMaterial {
    pub reflectance: [f32; 3],
    pub kind: u32,
    pub transmittance: [f32; 3],
    pub ior: f32,
    pub emission: [f32; 3],
    pub emission_flags: u32,
    pub reflectance_texture: u32,
    pub emission_texture: u32,
    pub transmittance_texture: u32,
    pub padding: u32,
}

/// A colour as a constant factor and a texture index or NONE.
pub fn color_and_texture(input: &ColorInput) -> ([f32; 3], u32) {
    match input {
        ColorInput::Constant(color) => (color.as_vec3().to_array(), NONE),
        ColorInput::Texture(texture) => ([1.0; 3], *texture as u32),
        ColorInput::ScaledTexture(texture, factor) => (factor.as_vec3().to_array(), *texture as u32),
    }
}

impl FlatMaterial {
    pub fn new(material: &Material) -> Self {
        let none = ColorInput::Constant(DVec3::ZERO);
        let (kind, reflectance, transmittance, ior) = match &material.kind {
            MaterialKind::Diffuse { reflectance } => (FlatMaterialKind::Diffuse, *reflectance, none, 1.0),
            MaterialKind::Mirror { reflectance } => (FlatMaterialKind::Mirror, *reflectance, none, 1.0),
            MaterialKind::Glass { ior, reflectance, transmittance } => {
                (FlatMaterialKind::Glass, *reflectance, *transmittance, *ior)
            }
            // The rest reflects nothing here: `emissive` by definition, `pass` because its surfaces are left out, and what the
            // device does not know yet because the scene reader refuses it.
            _ => (FlatMaterialKind::Emissive, none, none, 1.0),
        };
        let emission = material.emission.map_or(none, |emission| emission.radiance);
        let two_sided = material.emission.is_some_and(|emission| emission.two_sided);
        let emits = emission != none;
        let (reflectance, reflectance_texture) = color_and_texture(&reflectance);
        let (transmittance, transmittance_texture) = color_and_texture(&transmittance);
        let (emission, emission_texture) = color_and_texture(&emission);
        Self {
            reflectance,
            kind: kind as u32,
            transmittance,
            ior: ior as f32,
            emission,
            emission_flags: if emits { EMITS } else { 0 } | if two_sided { EMITS_TWO_SIDED } else { 0 },
            reflectance_texture,
            emission_texture,
            transmittance_texture,
            padding: 0,
        }
    }
}

/// 32 bytes, two vec4 of the tables.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct FlatTexture {
    /// Index of the first float in the texels.
    pub first_texel: u32,
    pub width: u32,
    pub height: u32,
    /// Bits 0..2: 0 repeat, 1 clamp, 2 mirror. Bit 2: nearest.
    pub wrap_and_filter: u32,
    pub scale: [f32; 2],
    pub offset: [f32; 2],
}

/// Descriptors and texels of all image textures.
pub fn pack_textures(scene: &Scene) -> Result<(Vec<FlatTexture>, Vec<f32>), FlatError> {
    let mut textures = Vec::new();
    let mut texels = Vec::new();
    for texture in &scene.textures {
        let TextureKind::Image(image) = &texture.kind else {
            return Err(FlatError::Unsupported { what: format!("texture `{}` is not an image", texture.name) });
        };
        let wrap = match image.wrap {
            TextureWrap::Repeat => 0,
            TextureWrap::Clamp => 1,
            TextureWrap::Mirror => 2,
        };
        let nearest = if image.filter == TextureFilter::Nearest { 4 } else { 0 };
        if texels.len() + 3 * image.image.texels.len() > u32::MAX as usize {
            return Err(FlatError::TooManyTexels { found: texels.len() / 3 + image.image.texels.len() });
        }
        textures.push(FlatTexture {
            first_texel: texels.len() as u32,
            width: image.image.width,
            height: image.image.height,
            wrap_and_filter: wrap | nearest,
            scale: image.scale.map(|x| x as f32),
            offset: image.offset.map(|x| x as f32),
        });
        texels.extend(image.image.texels.iter().flat_map(|texel| texel.to_array()));
    }
    Ok((textures, texels))
}
