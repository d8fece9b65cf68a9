//! Pictures as files: PNG where their texels are integers, else OpenEXR. Every texel comes back bit for bit.

use std::io::Cursor;

use exr::prelude::{Encoding, Image, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage, f16};
use image::{ImageBuffer, ImageFormat, Rgba};

use crate::scene::{ColorSpace, ImageData, Texels};

/// The file of a picture of this size with these channels. A function could not name how long its texels are borrowed.
macro_rules! exr {
    ($size:expr, $channels:expr) => {{
        let size = ($size[0] as usize, $size[1] as usize);
        let layer = Layer::new(size, LayerAttributes::default(), Encoding::SMALL_FAST_LOSSLESS, $channels);
        let image = Image::from_layer(layer);
        written(|bytes| Some(image.write().to_buffered(bytes).is_ok()))
    }};
}

/// Ending and colour space of a picture's file.
pub fn picture_format(image: &ImageData) -> (&'static str, ColorSpace) {
    match &image.texels {
        Texels::Bytes { space, .. } | Texels::Shorts { space, .. } => ("png", *space),
        Texels::Half(_) | Texels::Float(_) | Texels::FloatAlpha(_) => ("exr", ColorSpace::Linear),
    }
}

/// Content of a picture's file.
pub fn picture(image: &ImageData) -> Vec<u8> {
    let size @ [width, height] = [image.width, image.height];
    match &image.texels {
        Texels::Bytes { codes, .. } => {
            let pixels = ImageBuffer::<Rgba<u8>, _>::from_raw(width, height, codes.as_flattened());
            written(|bytes| pixels.map(|pixels| pixels.write_to(bytes, ImageFormat::Png).is_ok()))
        }
        Texels::Shorts { codes, .. } => {
            let pixels = ImageBuffer::<Rgba<u16>, _>::from_raw(width, height, codes.as_flattened());
            written(|bytes| pixels.map(|pixels| pixels.write_to(bytes, ImageFormat::Png).is_ok()))
        }
        Texels::Half(texels) => {
            let texel = |at: Vec2<usize>| texels[place(at, size)].map(f16::from_bits).into();
            exr!(size, SpecificChannels::rgba(texel))
        }
        Texels::Float(texels) => {
            let texel = |at: Vec2<usize>| texels[place(at, size)].into();
            exr!(size, SpecificChannels::rgb::<f32, f32, f32>(texel))
        }
        Texels::FloatAlpha(texels) => {
            let texel = |at: Vec2<usize>| texels[place(at, size)].into();
            exr!(size, SpecificChannels::rgba::<f32, f32, f32, f32>(texel))
        }
    }
}

fn place(at: Vec2<usize>, [width, _]: [u32; 2]) -> usize {
    at.y() * width as usize + at.x()
}

/// The bytes of a picture written into memory, which cannot fail: pictures of a scene have sizes that the
/// formats allow.
fn written(write: impl FnOnce(&mut Cursor<Vec<u8>>) -> Option<bool>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let is_written = write(&mut bytes);
    debug_assert!(is_written == Some(true), "a picture cannot be written");
    bytes.into_inner()
}
