//! Formats of integers (PNG, JPEG and others, and TIFF with numbers of either kind): upright, and in sRGB or linear.

mod colours;
mod jpeg;

use image::codecs::webp::WebPDecoder;
use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::pixels::{Sink, linear};
use crate::input::AnyFile;
use crate::scene::ColorSpace;
use colours::Meaning;

/// Bytes of a decoder's own tables besides the pixels, of which even small pictures have some.
const TABLES: u64 = 1 << 26;
/// Most bytes of a pixel while it is decoded.
const OF_A_PIXEL: u64 = 16;

/// A picture whose header was read.
pub struct CodedFile {
    decoder: Box<dyn ImageDecoder>,
    size: [u32; 2],
    orientation: Orientation,
    /// How colours are coded; None: as the format has them, numbers of floating point linear and others in sRGB.
    color_space: Option<ColorSpace>,
    /// The file's colours where they are not sRGB.
    profile: Option<Box<moxcms::ColorProfile>>,
    /// True if the file says that its integers are linear.
    is_linear: bool,
    notes: Vec<String>,
}

impl CodedFile {
    /// Reads the header. `color_space` stands for all that it says of its colours.
    ///
    /// # Errors
    /// A file that is no picture of this format.
    pub fn open(mut file: AnyFile, format: ImageFormat, color_space: Option<ColorSpace>) -> Result<Self, String> {
        let failure = |error: std::io::Error| format!("cannot be read: {error}");
        let mut notes = Vec::new();
        let mut of_png = Ok(None);
        match format {
            ImageFormat::Png => {
                // A file that is no PNG is refused by the decoder itself.
                if let Ok(reader) = png::Decoder::new(&mut file).read_info() {
                    of_png = colours::of_png(reader.info());
                    if reader.info().animation_control.is_some_and(|control| control.num_frames > 1) {
                        notes.push("it is an animation, of which the first picture is taken".to_owned());
                    }
                    if let Some(aspect) = aspect(reader.info()) {
                        notes.push(format!("its pHYs makes pixels {aspect:.3} times as wide as high, which is not used: pixels are taken for squares"));
                    }
                }
            }
            ImageFormat::Jpeg => {
                let components = jpeg::components(&mut file).map_err(failure)?;
                if components == Some(4) {
                    notes.push("it is in CMYK: its colours are those of plain arithmetic, without a profile of inks".to_owned());
                }
            }
            ImageFormat::Tiff => {
                if let Ok(mut decoder) = tiff::decoder::Decoder::new(&mut file) {
                    let extra = decoder.find_tag_unsigned_vec::<u16>(tiff::tags::Tag::ExtraSamples).ok().flatten();
                    if extra.is_some_and(|extra| extra.contains(&tiff::tags::ExtraSamples::AssociatedAlpha.to_u16())) {
                        notes.push("its colours are multiplied by its alpha, and taken as they are".to_owned());
                    }
                    if decoder.more_images() {
                        notes.push("it has several pictures, of which the first is taken".to_owned());
                    }
                }
            }
            ImageFormat::WebP => {
                let is_animation = WebPDecoder::new(&mut file).is_ok_and(|decoder| decoder.has_animation());
                if is_animation {
                    notes.push("it is an animation, of which the first picture is taken".to_owned());
                }
            }
            _ => {}
        }
        file.rewind().map_err(failure)?;
        let decoder = ImageReader::with_format(file, format).into_decoder();
        let mut decoder: Box<dyn ImageDecoder> = Box::new(decoder.map_err(|error| format!("is not a valid image: {error}"))?);
        let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
        let (width, height) = decoder.dimensions();
        let size = match orientation {
            Orientation::Rotate90 | Orientation::Rotate270 | Orientation::Rotate90FlipH | Orientation::Rotate270FlipH => {
                [height, width]
            }
            _ => [width, height],
        };
        let mut profile = None;
        let mut own = None;
        // Whoever says what colours are does not want to hear what the file says.
        if color_space.is_none() {
            let meaning = if format == ImageFormat::Png {
                of_png
            } else {
                decoder.icc_profile().ok().flatten().map(|icc| colours::of_icc(&icc)).transpose()
            };
            match meaning {
                Ok(Some(Meaning::Codes(space))) => own = Some(space),
                Ok(Some(Meaning::Profile(other))) => profile = Some(other),
                Ok(None) => {}
                Err(note) => notes.push(note),
            }
        }
        // An ICC profile of sRGB says nothing of numbers of floating point.
        let own = own.filter(|space| *space == ColorSpace::Linear);
        Ok(Self { decoder, size, orientation, color_space: color_space.or(own), profile, is_linear: own.is_some(), notes })
    }

    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Answers [`super::PictureFile::is_plain`].
    pub fn is_plain(&self) -> bool {
        self.profile.is_none() && !self.is_linear && self.orientation == Orientation::NoTransforms
    }

    /// Bits of a channel.
    pub fn bits(&self) -> u16 {
        let color = self.decoder.color_type();
        color.bits_per_pixel() / u16::from(color.channel_count())
    }

    /// The pixels as they are coded, upright, and how that is.
    ///
    /// # Errors
    /// Errors of the decoder.
    pub fn decode_codes(self) -> Result<(DynamicImage, ColorSpace), String> {
        let Self { mut decoder, orientation, color_space, profile, .. } = self;
        let (width, height) = decoder.dimensions();
        let mut limits = Limits::no_limits();
        limits.max_image_width = Some(width);
        limits.max_image_height = Some(height);
        limits.max_alloc = Some((OF_A_PIXEL * u64::from(width) * u64::from(height)).max(TABLES));
        let failure = |error| format!("is not a valid image: {error}");
        decoder.set_limits(limits).map_err(failure)?;
        let mut image = DynamicImage::from_decoder(decoder).map_err(failure)?;
        let is_float = matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
        if let Some(profile) = profile.filter(|_| !is_float) {
            image = match colours::to_srgb(&profile, image) {
                Ok(converted) => converted,
                Err(refused) => refused.0,
            };
        }
        image.apply_orientation(orientation);
        let default = if is_float { ColorSpace::Linear } else { ColorSpace::Srgb };
        Ok((image, color_space.unwrap_or(default)))
    }

    /// Does the work of [`super::PictureFile::decode`].
    pub fn decode(self, sink: Sink<'_>) -> Result<(), String> {
        let (image, space) = self.decode_codes()?;
        let width = image.width() as usize;
        let finish = |[red, green, blue, alpha]: [f32; 4]| {
            let [red, green, blue] = [red, green, blue].map(|value| linear(value, space));
            [red, green, blue, alpha]
        };
        let image = image.into_rgba32f();
        let mut row = Vec::with_capacity(width);
        for (index, pixels) in image.as_raw().chunks_exact(4 * width.max(1)).enumerate() {
            row.clear();
            row.extend(pixels.as_chunks().0.iter().map(|pixel| finish(*pixel)));
            sink([0, index], &row);
        }
        Ok(())
    }
}

/// How many times as wide as high pixels are, where they are no squares.
fn aspect(info: &png::Info<'_>) -> Option<f64> {
    let png::PixelDimensions { xppu, yppu, .. } = info.pixel_dims?;
    let ratio = f64::from(yppu) / f64::from(xppu);
    (ratio.is_finite() && ratio > 0.0 && (ratio - 1.0).abs() > 1e-2).then_some(ratio)
}
