//! PNG previews: sRGB, 8 bit, row by row.

use std::io::Write;

use png::text_metadata::TEXtChunk;
use png::{BitDepth, ColorType, Compression, Encoder, SrgbRenderingIntent};

use super::provenance::{BROKEN_OFF_KEY, COMPLETE_KEY, Entry, SAMPLES_KEY};
use super::rows::{Abandoned, Completeness, Rows};
use super::spec::PictureSpec;

/// The text chunk with the picture's provenance.
pub(super) const KEYWORD: &str = "Software";

/// Encodes all rows of the picture. The error is a sentence.
pub(super) fn write(writer: impl Write, mut rows: Rows, spec: &PictureSpec) -> Result<(), String> {
    let mut encoder = Encoder::new(writer, spec.width, spec.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.add_itxt_chunk(KEYWORD.to_owned(), software(spec)).map_err(sentence)?;
    let mut image = encoder.write_header().map_err(sentence)?;
    let mut stream = image.stream_writer().map_err(sentence)?;

    let factor = spec.exposure.exp2();
    let mut bytes = Vec::with_capacity(spec.width as usize * 3);
    for _ in 0..spec.height {
        let row = rows.next_row().map_err(abandoned)?.0;
        bytes.clear();
        bytes.extend(row.iter().flatten().map(|&radiance| srgb_byte(radiance * factor)));
        stream.write_all(&bytes).map_err(|error| error.to_string())?;
    }
    let completeness = rows.wait_for_finish().map_err(abandoned)?;
    stream.finish().map_err(sentence)?;
    if completeness == Completeness::BrokenOff {
        let note = TEXtChunk::new(BROKEN_OFF_KEY, "1");
        image.write_text_chunk(&note).map_err(sentence)?;
    }
    image.finish().map_err(sentence)
}

/// The picture's provenance as one line, since a preview has no typed header. Sample counts are left out: they are only known
/// once the header is written.
pub(super) fn software(spec: &PictureSpec) -> String {
    let entries = spec.header_entries(spec.samples_wanted(), Completeness::Finished);
    let wanted = entries.iter().filter(|(key, _)| !matches!(*key, SAMPLES_KEY | COMPLETE_KEY | BROKEN_OFF_KEY));
    let words: Vec<_> = wanted
        .map(|(key, entry)| match entry {
            Entry::Text(text) => format!("{}={text}", key.trim_start_matches("gpt:")),
            Entry::Number(number) => format!("{}={number}", key.trim_start_matches("gpt:")),
        })
        .collect();
    format!("gpt {}", words.join("; ")).trim_end().to_owned()
}

fn sentence(error: png::EncodingError) -> String {
    error.to_string()
}

fn abandoned(_: Abandoned) -> String {
    "the render broke off".to_owned()
}

/// One linear value as the nearest 8-bit sRGB code (IEC 61966-2-1); clamped to 0..1, NaN becomes 0.
pub fn srgb_byte(linear: f32) -> u8 {
    let clamped = if linear > 0.0 { linear.min(1.0) } else { 0.0 };
    let encoded = if clamped <= 0.003_130_8 { 12.92 * clamped } else { 1.055 * clamped.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_srgb_curve_meets_its_known_points() {
        assert_eq!(srgb_byte(0.0), 0);
        assert_eq!(srgb_byte(1.0), 255);
        // Middle grey: 18 % is code 118, half the radiance is code 188.
        assert_eq!(srgb_byte(0.18), 118);
        assert_eq!(srgb_byte(0.5), 188);
        // In the curve's linear part: 0.002 × 12.92 × 255 = 6.6.
        assert_eq!(srgb_byte(0.002), 7);
    }

    #[test]
    fn values_outside_the_range_are_clamped() {
        assert_eq!(srgb_byte(-1.0), 0);
        assert_eq!(srgb_byte(7.0), 255);
        assert_eq!(srgb_byte(f32::INFINITY), 255);
        assert_eq!(srgb_byte(f32::NAN), 0);
    }

    #[test]
    fn codes_rise_with_radiance() {
        let codes: Vec<u8> = (0..=4096).map(|step| srgb_byte(step as f32 / 4096.0)).collect();
        assert!(codes.is_sorted());
    }
}
