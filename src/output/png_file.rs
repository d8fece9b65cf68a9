//! PNG previews: sRGB, 8 bit, row by row.

use std::io::Write;

use png::text_metadata::TEXtChunk;
use png::{BitDepth, ColorType, Compression, Encoder, SrgbRenderingIntent};

use super::developed::{developed_rows, software};
use super::provenance::BROKEN_OFF_KEY;
use super::rows::{Completeness, Rows};
use super::spec::PictureSpec;

/// The text chunk with the picture's provenance.
pub(super) const KEYWORD: &str = "Software";

/// Encodes all rows of the picture. The error is a sentence.
pub(super) fn write(writer: impl Write, rows: Rows, spec: &PictureSpec) -> Result<(), String> {
    let mut encoder = Encoder::new(writer, spec.width, spec.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.add_itxt_chunk(KEYWORD.to_owned(), software(spec)).map_err(sentence)?;
    let mut image = encoder.write_header().map_err(sentence)?;
    let mut stream = image.stream_writer().map_err(sentence)?;
    let completeness = developed_rows(rows, spec, |row| stream.write_all(row).map_err(|error| error.to_string()))?;
    stream.finish().map_err(sentence)?;
    if completeness == Completeness::BrokenOff {
        let note = TEXtChunk::new(BROKEN_OFF_KEY, "1");
        image.write_text_chunk(&note).map_err(sentence)?;
    }
    image.finish().map_err(sentence)
}

fn sentence(error: png::EncodingError) -> String {
    error.to_string()
}
