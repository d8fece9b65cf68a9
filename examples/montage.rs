//! Joins pictures of one size into one, row by row:
//!
//! ```sh
//! cargo run --release --example montage OUTPUT COLUMNS PICTURE…
//! ```

use std::process::ExitCode;

use image::{ImageResult, RgbImage, imageops};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [output, columns, pictures @ ..] = arguments.as_slice() else { return usage() };
    let Some(columns) = columns.parse().ok().filter(|&columns: &u32| columns > 0) else { return usage() };
    if pictures.is_empty() {
        return usage();
    }
    match montage(columns, pictures).and_then(|joined| joined.save(output)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("montage: {error}");
            ExitCode::FAILURE
        }
    }
}

fn usage() -> ExitCode {
    eprintln!("usage: montage OUTPUT COLUMNS PICTURE…");
    ExitCode::from(2)
}

/// The pictures, each in a cell of the first one's size.
fn montage(columns: u32, pictures: &[String]) -> ImageResult<RgbImage> {
    let pictures = pictures.iter().map(|path| Ok(image::open(path)?.into_rgb8())).collect::<ImageResult<Vec<_>>>()?;
    let (width, height) = pictures.first().map_or((0, 0), RgbImage::dimensions);
    let rows = (pictures.len() as u32).div_ceil(columns);
    let mut joined = RgbImage::new(columns * width, rows * height);
    for (picture, number) in pictures.iter().zip(0..) {
        let (column, row) = (number % columns, number / columns);
        imageops::replace(&mut joined, picture, i64::from(column * width), i64::from(row * height));
    }
    Ok(joined)
}
