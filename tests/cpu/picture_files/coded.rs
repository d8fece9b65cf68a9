//! PNG, JPEG and what else has integers.

use std::io::Cursor;

use gpt::load;
use gpt::math::srgb_to_linear;
use gpt::output::read_picture;
use gpt::scene::ColorSpace;
use image::{ImageEncoder, ImageFormat, Rgb, RgbImage, Rgba, RgbaImage};
use moxcms::ColorProfile;

use super::{expect, expect_named, read};

/// A PNG of 3 × 2 pixels with chunks before its pixels.
fn png(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    RgbImage::from_fn(3, 2, |column, row| Rgb(code(column as usize, row as usize)))
        .write_to(&mut bytes, ImageFormat::Png)
        .expect("a picture");
    let mut bytes = bytes.into_inner();
    // Behind the signature and the first chunk, of 13 bytes.
    let mut new: Vec<u8> = bytes.drain(..8 + 12 + 13).collect();
    for (name, content) in chunks {
        new.extend((content.len() as u32).to_be_bytes());
        let checked = [&name[..], content].concat();
        new.extend(&checked);
        new.extend(crc(&checked).to_be_bytes());
    }
    new.extend(bytes);
    new
}

/// CRC-32 of PNG (ISO 3309), bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
    !bytes.iter().fold(u32::MAX, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step))
}

fn code(column: usize, row: usize) -> [u8; 3] {
    [40 * column as u8 + 60, 90 * row as u8 + 30, 200 - 20 * column as u8]
}

fn srgb(column: usize, row: usize) -> [f32; 3] {
    code(column, row).map(|code| srgb_to_linear(f32::from(code) / 255.0))
}

fn numbers(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_be_bytes()).collect()
}

const REC_709: [u32; 8] = [31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000];

#[test]
fn chunks_of_png_say_what_codes_mean() {
    let plain: [&[(&[u8; 4], &[u8])]; 3] =
        [&[], &[(b"sRGB", &[0])], &[(b"gAMA", &numbers(&[45455])), (b"cHRM", &numbers(&REC_709))]];
    for chunks in plain {
        let picture = read("a.png", &png(chunks));
        expect(&picture, [3, 2], 1e-6, srgb);
        assert!(picture.notes.is_empty(), "{:?}", picture.notes);
    }
    let linear = read("a.png", &png(&[(b"gAMA", &numbers(&[100_000]))]));
    expect(&linear, [3, 2], 1e-6, |column, row| code(column, row).map(|code| f32::from(code) / 255.0));
    // A gamma of 1.8, as of old Macintosh files; and cICP, which goes before all others: linear Rec. 709.
    let other = read("a.png", &png(&[(b"gAMA", &numbers(&[55556]))]));
    expect(&other, [3, 2], 4e-3, |column, row| code(column, row).map(|code| (f32::from(code) / 255.0).powf(1.8)));
    let coded = read("a.png", &png(&[(b"cICP", &[1, 8, 0, 1]), (b"gAMA", &numbers(&[45455]))]));
    expect(&coded, [3, 2], 1e-6, |column, row| code(column, row).map(|code| f32::from(code) / 255.0));
}

#[test]
fn whoever_says_what_codes_mean_is_not_contradicted_by_the_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.png");
    std::fs::write(&path, png(&[(b"gAMA", &numbers(&[100_000]))])).expect("the picture");
    let first = |space| load::read_image(&path, Some(space)).expect("a picture").texels.color(0).to_array();
    assert_eq!(first(ColorSpace::Srgb), srgb(0, 0));
    assert_eq!(first(ColorSpace::Linear), code(0, 0).map(|code| f32::from(code) / 255.0));
}

#[test]
fn profiles_are_followed_and_those_of_srgb_change_nothing() {
    let with = |profile: &ColorProfile| {
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = image::codecs::png::PngEncoder::new(&mut bytes);
        encoder.set_icc_profile(profile.encode().expect("a profile")).expect("it takes one");
        let pixels: Vec<u8> = (0..6).flat_map(|place| code(place % 3, place / 3)).collect();
        encoder.write_image(&pixels, 3, 2, image::ExtendedColorType::Rgb8).expect("a picture");
        bytes.into_inner()
    };
    expect(&read("a.png", &with(&ColorProfile::new_srgb())), [3, 2], 1e-6, srgb);
    // Display P3 has sRGB's curve and wider primaries: greens beyond Rec. 709's end at its edge.
    let p3 = read("a.png", &with(&ColorProfile::new_display_p3()));
    let matrix = [[1.22494, -0.22494, 0.0], [-0.04206, 1.04206, 0.0], [-0.01964, -0.07864, 1.09827]];
    expect(&p3, [3, 2], 6e-3, |column, row| {
        let colour = srgb(column, row);
        matrix.map(|row: [f32; 3]| row.iter().zip(colour).map(|(a, b)| a * b).sum::<f32>().clamp(0.0, 1.0))
    });
    assert!(p3.image.pixels[0] != srgb(0, 0) && p3.notes.is_empty());
    expect_named("a.png", &png(&[(b"cICP", &[9, 16, 0, 1])]), "cICP");
    expect_named("a.png", &png(&[(b"pHYs", &[0, 0, 0, 2, 0, 0, 0, 1, 0])]), "pHYs");
}

/// EXIF with nothing but an orientation.
fn exif(orientation: u8) -> Vec<u8> {
    let mut bytes = b"II\x2a\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0".to_vec();
    bytes.extend([orientation, 0, 0, 0, 0, 0, 0, 0]);
    bytes
}

#[test]
fn pictures_stand_upright_by_their_exif() {
    for orientation in 1..=8_u8 {
        let picture = read("a.png", &png(&[(b"eXIf", &exif(orientation))]));
        let size = if orientation < 5 { [3, 2] } else { [2, 3] };
        // The place of the picture's column and row in the file (TIFF 6.0, Orientation).
        expect(&picture, size, 1e-6, |column, row| {
            let (column, row) = match orientation {
                1 => (column, row),
                2 => (2 - column, row),
                3 => (2 - column, 1 - row),
                4 => (column, 1 - row),
                5 => (row, column),
                6 => (row, 1 - column),
                7 => (2 - row, 1 - column),
                _ => (2 - row, column),
            };
            srgb(column, row)
        });
    }
}

#[test]
fn transparent_colours_and_sixteen_bits_are_kept() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.png");
    // One colour of an RGB picture is transparent.
    let [red, green, blue] = code(1, 0);
    std::fs::write(&path, png(&[(b"tRNS", &[0, red, 0, green, 0, blue])])).expect("the picture");
    let image = load::read_image(&path, None).expect("a picture");
    let alphas: Vec<f32> = (0..6).map(|place| image.texels.get(place)[3]).collect();
    assert_eq!(alphas, [1.0, 0.0, 1.0, 1.0, 1.0, 1.0]);
    let deep = image::ImageBuffer::<Rgb<u16>, _>::from_fn(2, 1, |column, _| Rgb([1 + column as u16, 258, 65_535]));
    deep.save(&path).expect("a picture");
    let picture = read_picture(&path).expect("a picture");
    for (column, pixel) in picture.image.pixels.iter().enumerate() {
        let expected = [1 + column as u16, 258, 65_535].map(|code| srgb_to_linear(f32::from(code) / 65_535.0));
        assert!(pixel.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-7), "{pixel:?} {expected:?}");
    }
    RgbaImage::from_pixel(1, 1, Rgba([255, 128, 0, 128])).save(&path).expect("a picture");
    assert!((load::read_image(&path, None).expect("a picture").texels.get(0)[3] - 128.0 / 255.0).abs() < 1e-6);
}
