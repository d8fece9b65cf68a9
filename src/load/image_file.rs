//! Image files as linear texels.

use std::path::Path;

use glam::Vec3;
use image::{DynamicImage, ImageFormat, ImageReader, Limits};

use super::builtin;
use crate::math::srgb_to_linear;
use crate::scene::{ColorSpace, ImageData};

/// Most texels on a side.
const LARGEST_SIDE: u32 = 16_384;
/// Most bytes the decoder may hold: 16 bytes for every texel of the largest image.
const MOST_BYTES: u64 = 16 * (LARGEST_SIDE as u64) * (LARGEST_SIDE as u64);

/// Reads an image and turns it into linear colours. Without a colour space, formats of integers are taken to be sRGB and those of
/// floating-point numbers linear. The error says what is wrong with the file, without its name.
pub fn read_image(path: &Path, color_space: Option<ColorSpace>) -> Result<ImageData, String> {
    let is_exr = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr"));
    let image = if is_exr { read_exr(path, color_space)? } else { read_other(path, color_space)? };
    match image.texels.iter().any(|texel| !texel.is_finite() || texel.min_element() < 0.0) {
        true => Err("the image has texels that are negative or not finite".to_owned()),
        false => Ok(image),
    }
}

fn check_size(width: u32, height: u32) -> Result<(), String> {
    if width == 0 || height == 0 {
        return Err(format!("the image is empty: {width} x {height} pixels"));
    }
    if width.max(height) > LARGEST_SIDE {
        return Err(format!("the image is too large: {width} x {height} pixels, at most {LARGEST_SIDE} on a side"));
    }
    Ok(())
}

fn read_other(path: &Path, color_space: Option<ColorSpace>) -> Result<ImageData, String> {
    let open = || {
        let reader = builtin::open(path).and_then(|file| {
            let mut reader = ImageReader::new(file);
            // The ending says what a file without a signature is, as TGA files are.
            if let Ok(format) = ImageFormat::from_path(path) {
                reader.set_format(format);
            }
            reader.with_guessed_format()
        });
        reader.map_err(|error| format!("cannot be read: {error}"))
    };
    let reader = open()?;
    if reader.format().is_none() {
        return Err("is not an image in a format known here (PNG, JPEG, EXR, HDR, TIFF, BMP, TGA, WebP, GIF, PNM)".to_owned());
    }
    let (width, height) = reader.into_dimensions().map_err(|error| format!("is not a valid image: {error}"))?;
    check_size(width, height)?;
    let mut reader = open()?;
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MOST_BYTES);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| format!("is not a valid image: {error}"))?;
    Ok(to_linear(image, color_space))
}

fn to_linear(image: DynamicImage, color_space: Option<ColorSpace>) -> ImageData {
    let is_float = matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
    let default = if is_float { ColorSpace::Linear } else { ColorSpace::Srgb };
    let space = color_space.unwrap_or(default);
    let (width, height) = (image.width(), image.height());
    let eight_bits = matches!(image.color().bytes_per_pixel() / image.color().channel_count(), 1);
    let mut has_alpha = false;
    let texels = if eight_bits {
        let table: [f32; 256] = std::array::from_fn(|byte| decode(byte as f32 / 255.0, space));
        let pixels = image.into_rgba8();
        has_alpha |= pixels.pixels().any(|pixel| pixel.0[3] != u8::MAX);
        pixels.pixels().map(|pixel| Vec3::from_array([0, 1, 2].map(|channel| table[usize::from(pixel.0[channel])]))).collect()
    } else {
        let pixels = image.into_rgba32f();
        has_alpha |= pixels.pixels().any(|pixel| pixel.0[3] != 1.0);
        pixels.pixels().map(|pixel| Vec3::from_array([0, 1, 2].map(|channel| decode(pixel.0[channel], space)))).collect()
    };
    ImageData { width, height, texels, has_alpha }
}

fn decode(value: f32, space: ColorSpace) -> f32 {
    match space {
        ColorSpace::Srgb => srgb_to_linear(value),
        ColorSpace::Linear => value,
    }
}

/// A picture whose rows are collected as they are decoded.
struct Collected {
    image: ImageData,
    space: ColorSpace,
}

fn read_exr(path: &Path, color_space: Option<ColorSpace>) -> Result<ImageData, String> {
    let space = color_space.unwrap_or(ColorSpace::Linear);
    let metadata = exr::meta::MetaData::read_from_file(path, false).map_err(|error| format!("is not a valid EXR: {error}"))?;
    for header in &metadata.headers {
        let size = header.layer_size;
        check_size(u32::try_from(size.x()).unwrap_or(u32::MAX), u32::try_from(size.y()).unwrap_or(u32::MAX))?;
    }
    let read = exr::prelude::read_first_rgba_layer_from_file(
        path,
        move |size, _| Collected {
            image: ImageData {
                width: size.x() as u32,
                height: size.y() as u32,
                texels: vec![Vec3::ZERO; size.area()],
                has_alpha: false,
            },
            space,
        },
        |collected: &mut Collected, position, (red, green, blue, alpha): (f32, f32, f32, f32)| {
            let image = &mut collected.image;
            let index = position.y() * image.width as usize + position.x();
            image.texels[index] = Vec3::from_array([red, green, blue].map(|value| decode(value, collected.space)));
            image.has_alpha |= alpha != 1.0;
        },
    );
    let picture = read.map_err(|error| format!("is not an EXR with channels R, G and B: {error}"))?;
    Ok(picture.layer_data.channel_data.pixels.image)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_srgb_curve_meets_its_published_values() {
        assert_eq!(srgb_to_linear(0.0), 0.0);
        assert_eq!(srgb_to_linear(1.0), 1.0);
        // 0.04045 / 12.92 where the pieces meet, and the middle grey 128/255.
        approx::assert_relative_eq!(srgb_to_linear(0.04045), 0.003_130_805, max_relative = 1e-6);
        approx::assert_relative_eq!(srgb_to_linear(128.0 / 255.0), 0.215_860_5, max_relative = 1e-6);
    }
}
