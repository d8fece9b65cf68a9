//! Colours of files of integers: ICC profiles, and the chunks of PNG.

use std::borrow::Cow;

use image::DynamicImage;
use moxcms::{
    Chromaticity, CicpColorPrimaries, CicpProfile, ColorPrimaries, ColorProfile, DataColorSpace, Layout, MatrixCoefficients,
    ProfileText, ToneReprCurve, TransferCharacteristics, TransformOptions,
};

use crate::picture_file::primaries::Primaries;
use crate::scene::ColorSpace;

/// Codes of 16 bits by which two profiles may differ and count as one: half a code of 8 bits.
const SAME: u16 = 128;
/// The gamma that PNG files write for the curve of sRGB.
const SRGB_GAMMA: [f32; 2] = [0.44, 0.47];

/// How the integers of a file become sRGB's, or linear numbers.
pub enum Meaning {
    Codes(ColorSpace),
    /// They are those of another profile.
    Profile(Box<ColorProfile>),
}

/// By an ICC profile. The error is a note.
pub fn of_icc(bytes: &[u8]) -> Result<Meaning, String> {
    let profile = ColorProfile::new_from_slice(bytes);
    let profile = profile.map_err(|_| "its ICC profile is damaged, and not used: its colours are taken for sRGB".to_owned())?;
    of_profile(profile)
}

/// By the chunks of a PNG file, of which cICP goes before iCCP, that before sRGB, and that before gAMA and cHRM (PNG 3, 4.3). None: it has none.
/// The error is a note.
pub fn of_png(info: &png::Info<'_>) -> Result<Option<Meaning>, String> {
    if let Some(points) = info.coding_independent_code_points {
        let name = format!("{} {}", points.color_primaries, points.transfer_function);
        let known = CicpColorPrimaries::try_from(points.color_primaries).ok();
        let curve = TransferCharacteristics::try_from(points.transfer_function).ok();
        let is_plain = points.matrix_coefficients == 0 && points.is_video_full_range_image;
        let (Some(color_primaries), Some(transfer_characteristics), true) = (known, curve, is_plain) else {
            return Err(format!("its cICP ({name}) is none that is known here: its colours are taken for sRGB"));
        };
        // Curves of HDR television have their own white, which no number here stands for.
        if matches!(points.transfer_function, 16 | 18) {
            return Err(format!(
                "its cICP ({name}) is that of HDR television, which is not used: its colours are taken for sRGB"
            ));
        }
        if (points.color_primaries, points.transfer_function) == (1, 8) {
            return Ok(Some(Meaning::Codes(ColorSpace::Linear)));
        }
        let matrix_coefficients = MatrixCoefficients::Identity;
        let profile = CicpProfile { color_primaries, transfer_characteristics, matrix_coefficients, full_range: true };
        return of_profile(ColorProfile::new_from_cicp(profile)).map(Some);
    }
    if let Some(icc) = &info.icc_profile {
        return of_icc(icc).map(Some);
    }
    if info.srgb.is_some() {
        return Ok(Some(Meaning::Codes(ColorSpace::Srgb)));
    }
    let (gamma, points) = (info.gama_chunk, info.chrm_chunk);
    if gamma.is_none() && points.is_none() {
        return Ok(None);
    }
    let gamma = gamma.map_or(SRGB_GAMMA[0], |gamma| gamma.into_value());
    let point = |(x, y): (png::ScaledFloat, png::ScaledFloat)| [x.into_value(), y.into_value()];
    let rec_709 = [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.3127, 0.329]];
    let points =
        points.map_or(rec_709, |points| [point(points.red), point(points.green), point(points.blue), point(points.white)]);
    let is_rec_709 = points.iter().zip(rec_709).all(|(a, b)| (a[0] - b[0]).abs() < 2e-3 && (a[1] - b[1]).abs() < 2e-3);
    let is_srgb = (SRGB_GAMMA[0]..=SRGB_GAMMA[1]).contains(&gamma);
    if is_rec_709 && is_srgb {
        return Ok(Some(Meaning::Codes(ColorSpace::Srgb)));
    }
    if is_rec_709 && (gamma - 1.0).abs() < 1e-3 {
        return Ok(Some(Meaning::Codes(ColorSpace::Linear)));
    }
    if !(0.1..=10.0).contains(&gamma) {
        return Err(format!("its gAMA is {gamma}, which is not used: its colours are taken for sRGB"));
    }
    let srgb = ColorProfile::new_srgb();
    let curve = if is_srgb { srgb.red_trc.clone() } else { Some(ToneReprCurve::Parametric(vec![1.0 / gamma])) };
    let mut profile = with_curve(srgb, curve);
    let at = |[x, y]: [f32; 2]| Chromaticity::new(x, y);
    let [red, green, blue, white] = points.map(at);
    let spanned =
        Primaries::new(points[0].map(f64::from), points[1].map(f64::from), points[2].map(f64::from), points[3].map(f64::from));
    if spanned.to_xyz().is_none() {
        return Err("its cHRM spans no colours, and is not used: its colours are taken for sRGB".to_owned());
    }
    profile.update_rgb_colorimetry(white.to_xyyb(), ColorPrimaries { red, green, blue });
    of_profile(profile).map(Some)
}

fn of_profile(profile: ColorProfile) -> Result<Meaning, String> {
    let layout = match profile.color_space {
        DataColorSpace::Rgb => Layout::Rgb,
        DataColorSpace::Gray => Layout::Gray,
        other => {
            let name = name(&profile);
            return Err(format!(
                "its ICC profile {name}is of {other:?} colours, which is not used: its colours are taken for sRGB"
            ));
        }
    };
    let channels = if layout == Layout::Rgb { 3 } else { 1 };
    // Every colour of a coarse grid, or greys as fine.
    let steps: u16 = if channels == 3 { 6 } else { 64 };
    let level = |step: u16| u16::MAX / (steps - 1) * step;
    let codes: Vec<u16> = if channels == 3 {
        (0..steps.pow(3)).flat_map(|index| [index / 36, index / 6 % 6, index % 6].map(level)).collect()
    } else {
        (0..steps).map(level).collect()
    };
    let mut found = vec![0; codes.len()];
    let transform = profile.create_transform_16bit(layout, &ColorProfile::new_srgb(), layout, TransformOptions::default());
    let is_converted = transform.and_then(|transform| transform.transform(&codes, &mut found)).is_ok();
    if !is_converted {
        let name = name(&profile);
        return Err(format!("its ICC profile {name}is none that is used here: its colours are taken for sRGB"));
    }
    let is_srgb = codes.iter().zip(&found).all(|(code, found)| code.abs_diff(*found) <= SAME);
    Ok(if is_srgb { Meaning::Codes(ColorSpace::Srgb) } else { Meaning::Profile(Box::new(profile)) })
}

/// The profile's name, quoted, and a space; or nothing.
fn name(profile: &ColorProfile) -> String {
    let text = match &profile.description {
        Some(ProfileText::PlainString(text)) => Cow::Borrowed(text.as_str()),
        Some(ProfileText::Localizable(texts)) => {
            texts.first().map_or(Cow::Borrowed(""), |text| Cow::Borrowed(text.value.as_str()))
        }
        Some(ProfileText::Description(text)) => Cow::Borrowed(text.ascii_string.as_str()),
        None => Cow::Borrowed(""),
    };
    if text.trim().is_empty() { String::new() } else { format!("`{}` ", text.trim()) }
}

/// The picture in sRGB, with as many bits. The error is a note, and the picture as it was.
pub fn to_srgb(profile: &ColorProfile, image: DynamicImage) -> Result<DynamicImage, Box<(DynamicImage, String)>> {
    let is_grey = matches!(
        image,
        DynamicImage::ImageLuma8(_) | DynamicImage::ImageLumaA8(_) | DynamicImage::ImageLuma16(_) | DynamicImage::ImageLumaA16(_)
    );
    let fits = match profile.color_space {
        DataColorSpace::Gray => is_grey,
        _ => !is_grey,
    };
    // Greys are the same in all primaries, but not along all curves: they are converted as colours.
    let layout = Layout::Rgba;
    let srgb = ColorProfile::new_srgb();
    let profile =
        if is_grey && fits { Cow::Owned(with_curve(srgb.clone(), profile.gray_trc.clone())) } else { Cow::Borrowed(profile) };
    let options = TransformOptions::default();
    let is_deep = image.color().bytes_per_pixel() / image.color().channel_count() > 1;
    let converted = if !fits {
        None
    } else if is_deep {
        let mut pixels = image.to_rgba16();
        let source = pixels.as_raw().clone();
        let transform = profile.create_transform_16bit(layout, &srgb, layout, options).ok();
        transform.and_then(|transform| transform.transform(&source, &mut pixels).ok()).map(|()| DynamicImage::ImageRgba16(pixels))
    } else {
        let mut pixels = image.to_rgba8();
        let source = pixels.as_raw().clone();
        let transform = profile.create_transform_8bit(layout, &srgb, layout, options).ok();
        transform.and_then(|transform| transform.transform(&source, &mut pixels).ok()).map(|()| DynamicImage::ImageRgba8(pixels))
    };
    converted.ok_or_else(|| {
        let note = format!("its ICC profile {}does not fit its colours, which are taken for sRGB", name(&profile));
        Box::new((image, note))
    })
}

/// A profile with this curve for all three colours.
fn with_curve(mut profile: ColorProfile, curve: Option<ToneReprCurve>) -> ColorProfile {
    (profile.red_trc, profile.green_trc, profile.blue_trc) = (curve.clone(), curve.clone(), curve);
    profile.cicp = None;
    profile
}
