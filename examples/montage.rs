//! Joins pictures of one size into one, row by row:
//!
//! ```sh
//! cargo run --release --example montage [--enlarge FACTOR] OUTPUT COLUMNS PICTURE…
//! ```
//!
//! `--enlarge` shows every pixel as a square of that many.

use std::process::ExitCode;

use image::imageops::FilterType;
use image::{ImageResult, RgbImage, imageops};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (factor, arguments) = match arguments.as_slice() {
        [flag, factor, rest @ ..] if flag == "--enlarge" => (positive(factor), rest),
        rest => (Some(1), rest),
    };
    let [output, columns, pictures @ ..] = arguments else { return usage() };
    let (Some(factor), Some(columns)) = (factor, positive(columns)) else { return usage() };
    if pictures.is_empty() {
        return usage();
    }
    match montage(columns, factor, pictures).and_then(|joined| joined.save(output)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("montage: {error}");
            ExitCode::FAILURE
        }
    }
}

fn usage() -> ExitCode {
    eprintln!("usage: montage [--enlarge FACTOR] OUTPUT COLUMNS PICTURE…");
    ExitCode::from(2)
}

fn positive(text: &str) -> Option<u32> {
    text.parse().ok().filter(|&number| number > 0)
}

/// The pictures, enlarged, each in a cell of the first one's size.
fn montage(columns: u32, factor: u32, pictures: &[String]) -> ImageResult<RgbImage> {
    let open = |path| {
        let picture = image::open(path)?.into_rgb8();
        let (width, height) = picture.dimensions();
        Ok(imageops::resize(&picture, width * factor, height * factor, FilterType::Nearest))
    };
    let pictures = pictures.iter().map(open).collect::<ImageResult<Vec<_>>>()?;
    let (width, height) = pictures.first().map_or((0, 0), RgbImage::dimensions);
    let rows = (pictures.len() as u32).div_ceil(columns);
    let mut joined = RgbImage::new(columns * width, rows * height);
    for (picture, number) in pictures.iter().zip(0..) {
        let (column, row) = (number % columns, number / columns);
        imageops::replace(&mut joined, picture, i64::from(column * width), i64::from(row * height));
    }
    Ok(joined)
}
