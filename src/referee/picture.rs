//! Pictures: true ones, and those that scenes of the suite name.

use std::io::Cursor;

/// The true picture: linear radiance, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct TruthPicture {
    pub width: u32,
    pub height: u32,
    pub mean: Vec<[f32; 3]>,
    /// Standard errors of the mean; 0 where a formula tells it.
    pub standard_errors: Vec<[f32; 3]>,
}

/// A file beside a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneFile {
    pub name: &'static str,
    pub bytes: Vec<u8>,
}

/// A PNG of 8 bits a channel.
///
/// # Panics
/// The number of texels is not width times height.
pub fn png(name: &'static str, [width, height]: [u32; 2], texel: impl Fn(u32, u32) -> [u8; 4]) -> SceneFile {
    let picture = image::RgbaImage::from_fn(width, height, |x, y| image::Rgba(texel(x, y)));
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).expect("memory takes it");
    SceneFile { name, bytes: bytes.into_inner() }
}

/// A Radiance picture of linear colours whose channels are sums of few powers of two, so that its shared exponents lose nothing.
pub fn hdr(name: &'static str, [width, height]: [u32; 2], texel: impl Fn(u32, u32) -> [f32; 3]) -> SceneFile {
    let texels: Vec<_> = (0..width * height).map(|index| image::Rgb(texel(index % width, index / width))).collect();
    let mut bytes = Vec::new();
    let encoder = image::codecs::hdr::HdrEncoder::new(&mut bytes);
    encoder.encode(&texels, width as usize, height as usize).expect("memory takes it");
    SceneFile { name, bytes }
}

/// An OpenEXR picture of 32 bits a channel.
///
/// # Panics
/// Memory is at an end.
pub fn exr(name: &'static str, [width, height]: [u32; 2], texel: impl Fn(u32, u32) -> [f32; 3] + Sync) -> SceneFile {
    use exr::prelude::*;
    let channels = SpecificChannels::rgb(|place: Vec2<usize>| <(f32, f32, f32)>::from(texel(place.x() as u32, place.y() as u32)));
    let mut bytes = Cursor::new(Vec::new());
    let image = Image::from_channels((width as usize, height as usize), channels);
    image.write().non_parallel().to_buffered(&mut bytes).expect("memory takes it");
    SceneFile { name, bytes: bytes.into_inner() }
}

/// The linear value of an sRGB code of 8 bits (IEC 61966-2-1).
pub fn srgb_to_linear(code: u8) -> f64 {
    srgb_value_to_linear(f64::from(code) / 255.0)
}

/// The sRGB value, from 0 to 1, of a linear one.
pub fn linear_to_srgb(value: f64) -> f64 {
    if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}

/// The linear value of an sRGB value from 0 to 1; beyond, the curve goes on.
pub fn srgb_value_to_linear(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}
