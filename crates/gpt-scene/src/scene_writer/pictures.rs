//! Pictures that are made of others.

use exr::prelude::{Encoding, Image, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage};

use crate::scene::{ImageData, Texels};
use crate::spectrum::Spectrum;

/// A picture of colours that are a function of another's texels.
pub fn shown(image: &ImageData, colour: &dyn Fn([f64; 4]) -> Spectrum) -> ImageData {
    let texels = (0..image.texels.len()).map(|index| colour(image.texels.get(index).map(f64::from)).to_f32()).collect();
    ImageData { width: image.width, height: image.height, texels: Texels::Float(texels), has_alpha: false }
}

/// An OpenEXR file of one channel, Y, that is a function of a picture's texels.
pub fn grey_picture(image: &ImageData, value: &dyn Fn([f64; 4]) -> f64) -> Vec<u8> {
    let width = image.width as usize;
    let numbers: Vec<f32> = (0..image.texels.len()).map(|index| value(image.texels.get(index).map(f64::from)) as f32).collect();
    let channels =
        SpecificChannels::build().with_channel("Y").with_pixel_fn(|at: Vec2<usize>| (numbers[at.y() * width + at.x()],));
    let layer = Layer::new((width, image.height as usize), LayerAttributes::default(), Encoding::SMALL_FAST_LOSSLESS, channels);
    let mut bytes = std::io::Cursor::new(Vec::new());
    let is_written = Image::from_layer(layer).write().to_buffered(&mut bytes).is_ok();
    debug_assert!(is_written, "pictures of a scene have sizes that the format allows");
    bytes.into_inner()
}
