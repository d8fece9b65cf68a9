//! Radiance pictures (`.hdr`): linear, 8 bits a channel with a shared exponent, row by row (Ward 1991, "Real Pixels").

use std::io::Write;

use super::developed::{abandoned, software};
use super::provenance::BROKEN_OFF_KEY;
use super::rows::{Completeness, Rows};
use super::spec::PictureSpec;

/// Rows of these widths are written channel by channel; others pixel by pixel.
const SHORTEST_ROW: u32 = 8;
const LONGEST_ROW: u32 = 32_767;
/// Bytes that one count stands before.
const LONGEST_RUN: usize = 128;

/// Encodes all rows of the picture. The error is a sentence.
pub(super) fn write(mut writer: impl Write, mut rows: Rows, spec: &PictureSpec) -> Result<(), String> {
    let in_words = |error: std::io::Error| error.to_string();
    let (width, height) = (spec.width, spec.height);
    // A line of the header ends where the text does.
    let software = software(spec).replace(['\n', '\r'], " ");
    let header = format!("#?RADIANCE\nSOFTWARE={software}\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n");
    writer.write_all(header.as_bytes()).map_err(in_words)?;
    let by_channel = (SHORTEST_ROW..=LONGEST_ROW).contains(&width);
    for _ in 0..height {
        let pixels: Vec<[u8; 4]> = rows.next_row().map_err(abandoned)?.mean.iter().map(|&pixel| rgbe(pixel)).collect();
        if !by_channel {
            writer.write_all(pixels.as_flattened()).map_err(in_words)?;
            continue;
        }
        let [high, low] = (width as u16).to_be_bytes();
        writer.write_all(&[2, 2, high, low]).map_err(in_words)?;
        for channel in 0..4 {
            let values: Vec<u8> = pixels.iter().map(|pixel| pixel[channel]).collect();
            for run in values.chunks(LONGEST_RUN) {
                writer.write_all(&[run.len() as u8]).and_then(|()| writer.write_all(run)).map_err(in_words)?;
            }
        }
    }
    if rows.wait_for_finish().map_err(abandoned)? == Completeness::BrokenOff {
        writer.write_all(BROKEN_OFF_KEY.as_bytes()).map_err(in_words)?;
    }
    writer.flush().map_err(in_words)
}

/// How the picture was made, as the header of a file of ours says it.
pub(super) fn software_entry(file: &[u8]) -> Option<&[u8]> {
    file.split(|byte| *byte == b'\n').find_map(|line| line.strip_prefix(b"SOFTWARE="))
}

/// Three mantissas and the exponent of the largest channel.
fn rgbe(pixel: [f32; 3]) -> [u8; 4] {
    // The format knows no negative numbers; its largest one stands for what is beyond.
    let [r, g, b] = pixel.map(|value| if value > 0.0 { f64::from(value).min(1.6e38) } else { 0.0 });
    let largest = r.max(g).max(b);
    if largest < 1e-38 {
        return [0; 4];
    }
    // largest = mantissa · 2^exponent with a mantissa from ½ to 1.
    let mut exponent = largest.log2().floor() as i32 + 1;
    // Rounding of the logarithm, and of the mantissa to 256.
    if (largest * f64::from(8 - exponent).exp2()).round() > 255.0 {
        exponent += 1;
    }
    let scale = f64::from(8 - exponent).exp2();
    let byte = |value: f64| (value * scale).round().min(255.0) as u8;
    [byte(r), byte(g), byte(b), (exponent + 128).clamp(0, 255) as u8]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mantissas_and_exponents_come_back() {
        for pixel in [[1.0, 0.5, 0.25], [0.999, 0.0, 1e-3], [17.0, 12.0, 4.0], [1e-6, 2e-6, 3e-6], [65_504.0, 1.0, 0.0]] {
            let [r, g, b, exponent] = rgbe(pixel);
            let scale = f64::from(i32::from(exponent) - 136).exp2();
            let largest = pixel.iter().copied().fold(0.0, f32::max);
            for (byte, value) in [r, g, b].into_iter().zip(pixel) {
                let error = (f64::from(byte) * scale - f64::from(value)).abs();
                assert!(error <= f64::from(largest) / 255.0, "{pixel:?}: {byte} {exponent}");
            }
            assert!(r.max(g).max(b) >= 127, "{pixel:?}");
        }
        assert_eq!([rgbe([0.0; 3]), rgbe([f32::NAN, -1.0, 0.0])], [[0; 4]; 2]);
        assert_eq!(rgbe([f32::INFINITY; 3])[3], 255);
    }
}
