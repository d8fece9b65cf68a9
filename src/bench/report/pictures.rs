//! Pictures inside the report, and maps of where they are wrong.

use std::io::Cursor;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::super::subject::BenchError;
use crate::output::{Developer, Display, Image, Meter};

/// Relative error of 0.1 %, 1 %, 10 %, 100 %, in linear sRGB values of 0 to 255.
pub const HEAT_STOPS: [(&str, [f32; 3]); 4] =
    [("0.1 %", [8.0, 8.0, 24.0]), ("1 %", [92.0, 24.0, 130.0]), ("10 %", [235.0, 90.0, 60.0]), ("100 %", [252.0, 250.0, 190.0])];

/// A picture as the address of an image, PNG inside, shown as the previews of renders are.
///
/// # Errors
/// Errors of the encoder.
pub fn picture_address(picture: &Image) -> Result<String, BenchError> {
    let developer = Developer::new(&Display::default(), &Meter::default());
    address(picture.width, picture.height, picture.pixels.iter().map(|pixel| developer.bytes(*pixel)))
}

/// A map of |picture − reference| over the reference's brightness, on a logarithmic scale.
///
/// # Errors
/// Errors of the encoder.
pub fn heat_address(picture: &Image, reference: &Image) -> Result<String, BenchError> {
    let pixels = picture.pixels.iter().zip(&reference.pixels).map(|(pixel, expected)| heat(relative_error(pixel, expected)));
    address(picture.width, picture.height, pixels)
}

/// The largest channel's difference over the largest channel, dark pixels counted as of brightness 0.01.
fn relative_error(pixel: &[f32; 3], expected: &[f32; 3]) -> f32 {
    let difference = pixel.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    difference / (expected.iter().copied().fold(0.0, f32::max) + 0.01)
}

fn heat(error: f32) -> [u8; 3] {
    let place = (error.max(1e-9).log10() + 3.0).clamp(0.0, 3.0);
    let index = (place as usize).min(2);
    let share = place - index as f32;
    let [low, high] = [HEAT_STOPS[index].1, HEAT_STOPS[index + 1].1];
    std::array::from_fn(|channel| (low[channel] + (high[channel] - low[channel]) * share) as u8)
}

fn address(width: u32, height: u32, pixels: impl Iterator<Item = [u8; 3]>) -> Result<String, BenchError> {
    let failure = |what: String| BenchError::Internal(format!("a picture of the report cannot be encoded: {what}"));
    let image = image::RgbImage::from_raw(width, height, pixels.flatten().collect());
    let image = image.ok_or_else(|| failure("its pixels do not fill it".to_owned()))?;
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).map_err(|error| failure(error.to_string()))?;
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(bytes.into_inner())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_grows_with_the_error() {
        let brightness = |error: f32| heat(error).iter().map(|value| u32::from(*value)).sum::<u32>();
        let errors = [1e-5, 1e-3, 5e-3, 1e-2, 0.1, 0.5, 1.0];
        assert!(errors.windows(2).all(|pair| brightness(pair[0]) <= brightness(pair[1])));
        assert_eq!(heat(0.1), [235, 90, 60]);
        assert_eq!((heat(0.0), heat(100.0)), (heat(1e-4), heat(1.0)));
        assert!((relative_error(&[1.0, 0.0, 0.5], &[1.0, 0.0, 0.4]) - 0.1 / 1.01).abs() < 1e-6);
    }

    #[test]
    fn pictures_come_back_from_their_address() {
        let picture = Image { width: 2, height: 1, pixels: vec![[0.0, 1.0, 0.5], [2.0, 0.1, 0.0]] };
        let address = picture_address(&picture).unwrap();
        let png = STANDARD.decode(address.strip_prefix("data:image/png;base64,").unwrap()).unwrap();
        let decoded = image::load_from_memory(&png).unwrap().into_rgb8();
        let developer = Developer::new(&Display::default(), &Meter::default());
        assert_eq!(decoded.get_pixel(1, 0).0, developer.bytes([2.0, 0.1, 0.0]));
        assert!(picture_address(&Image { width: 3, ..picture }).is_err());
    }
}
