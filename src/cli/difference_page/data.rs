//! The data that the page's script reads: JSON with the pixels in base64.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use exr::prelude::f16;
use gpt::compare::Finding;
use gpt::output::Image;
use serde::Serialize;

use super::section::PicturePair;

#[derive(Serialize)]
struct Data<'a> {
    width: u32,
    height: u32,
    labels: [&'a str; 2],
    /// Red, green and blue of each pixel, row by row from the top, in half precision, little-endian.
    a: String,
    b: String,
    /// ꟻLIP of each pixel in 255ths.
    flip: String,
    /// First column and row, width, height, and standard errors of the difference, of the channel where they are most.
    tiles: Vec<(u32, u32, u32, u32, f64)>,
}

/// The data as JSON that may stand in a page.
pub fn json(shown: &PicturePair) -> String {
    let [first, second] = shown.images;
    let flip: Vec<u8> = shown.flip.values.iter().map(|value| (value * 255.0).round() as u8).collect();
    let data = Data {
        width: first.width,
        height: first.height,
        labels: shown.labels,
        a: halves(first),
        b: halves(second),
        flip: STANDARD.encode(flip),
        tiles: shown.tiles.tiles.chunks(3).filter_map(score).collect(),
    };
    // Numbers and texts of Rust are always JSON; a closing tag cannot be in it.
    serde_json::to_string(&data).unwrap_or_default().replace('<', "\\u003c")
}

/// The channel of a tile that is farthest out, as the second picture is to the first.
fn score(channels: &[Finding]) -> Option<(u32, u32, u32, u32, f64)> {
    let worst = channels.iter().min_by(|a, b| a.test.p_value.total_cmp(&b.test.p_value))?;
    let region = worst.region;
    // A statistic that is not a number stands far out; JSON has no infinity.
    let distance = if worst.test.statistic.is_nan() { 99.0 } else { (-worst.test.statistic).clamp(-99.0, 99.0) };
    Some((region.x, region.y, region.width, region.height, (distance * 100.0).round() / 100.0))
}

fn halves(image: &Image) -> String {
    let largest = f16::MAX.to_f32();
    let half = |value: f32| f16::from_f32(if value.is_nan() { value } else { value.clamp(-largest, largest) });
    let bytes: Vec<u8> = image.pixels.iter().flatten().flat_map(|value| half(*value).to_le_bytes()).collect();
    STANDARD.encode(bytes)
}
