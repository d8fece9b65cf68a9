//! JPEG previews: sRGB, 8 bit.

use std::io::Write;

use image::ExtendedColorType;
use image::codecs::jpeg::JpegEncoder;

use super::developed::{developed_rows, software};
use super::provenance::BROKEN_OFF_KEY;
use super::rows::{Completeness, Rows};
use super::spec::PictureSpec;

/// Quality out of 100: the noise of a render that can still be seen survives.
const QUALITY: u8 = 92;
/// Marks a comment, whose length, itself included, has two bytes.
const COMMENT: [u8; 2] = [0xff, 0xfe];
const LONGEST_COMMENT: usize = u16::MAX as usize - 2;
/// The marker that every file begins with.
const START_BYTES: usize = 2;

/// Encodes all rows of the picture, of which three bytes a pixel are in memory. The error is a sentence.
pub(super) fn write(mut writer: impl Write, rows: Rows, spec: &PictureSpec) -> Result<(), String> {
    let mut pixels = Vec::with_capacity(3 * spec.width as usize * spec.height as usize);
    let completeness = developed_rows(rows, spec, |row| {
        pixels.extend_from_slice(row);
        Ok(())
    })?;
    let mut encoded = Vec::new();
    let mut encoder = JpegEncoder::new_with_quality(&mut encoded, QUALITY);
    encoder.encode(&pixels, spec.width, spec.height, ExtendedColorType::Rgb8).map_err(|error| error.to_string())?;

    let software = software(spec);
    let comment = &software.as_bytes()[..software.len().min(LONGEST_COMMENT)];
    let length = (comment.len() as u16 + 2).to_be_bytes();
    let (start, rest) = encoded.split_at(START_BYTES);
    // Behind the end of the picture readers look no more.
    let note = if completeness == Completeness::BrokenOff { BROKEN_OFF_KEY.as_bytes() } else { &[] };
    for part in [start, &COMMENT, &length, comment, rest, note] {
        writer.write_all(part).map_err(|error| error.to_string())?;
    }
    writer.flush().map_err(|error| error.to_string())
}

/// The comment that a file of ours begins with.
pub(super) fn comment(file: &[u8]) -> Option<&[u8]> {
    let marked = file.get(START_BYTES..)?.strip_prefix(&COMMENT)?;
    let length = usize::from(u16::from_be_bytes([*marked.first()?, *marked.get(1)?]));
    marked.get(2..length)
}
