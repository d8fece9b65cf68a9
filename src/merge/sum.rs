//! The sum of parts.

use std::io;
use std::ops::Range;

use super::cover::{Missing, check_overlap, missing};
use super::error::PartsError;
use super::layers::LayerSums;
use super::part::{MergeError, PartHeader};
use crate::film::{Band, Layer};
use crate::output::{LayerChannel, Provenance};
use crate::render::error_estimate::ErrorEstimate;

/// Rows of a band.
const BAND_ROWS: usize = 64;

/// Parts that were joined.
pub struct Merged {
    /// Width and height of the whole picture.
    pub size: [u32; 2],
    pub provenance: Provenance,
    /// The missing samples and regions, where these were allowed.
    pub missing: Option<Missing>,
    /// How far the picture is from the truth; None where too little of it is in several parts.
    pub error: Option<ErrorEstimate>,
    /// Samples per pixel of the longest part, and of the whole picture.
    pub longest: u32,
    pub samples: Range<u32>,
    /// The layers of the parts beside the picture, and what the header says of them.
    pub layers: Vec<Layer>,
    pub notes: Vec<(String, String)>,
    pixels: Vec<Pixel>,
    layer_sums: LayerSums,
}

/// Sums over the samples of a pixel.
#[derive(Debug, Clone, Copy, Default)]
struct Pixel {
    radiance: [f64; 3],
    squares: f64,
    count: f64,
}

/// Joins parts. `wanted`: how many samples per pixel the picture shall have; where that is not said, as many as reach to the last part's
/// last. With `partial`, some may be missing.
///
/// # Errors
/// Parts that do not belong together, samples that come twice, and samples that are missing.
pub fn merge(mut parts: Vec<PartHeader>, wanted: Option<u32>, partial: bool) -> Result<Merged, MergeError> {
    // Sums are rounded, so they are formed in an order of their own.
    parts.sort_by(|a, b| {
        (a.samples.start, a.samples.end, a.region, &a.path).cmp(&(b.samples.start, b.samples.end, b.region, &b.path))
    });
    let Some((first, others)) = parts.split_first() else {
        return Err(MergeError::Missing("there are no parts".to_owned()));
    };
    others.iter().try_for_each(|other| first.belongs_with(other))?;
    check_overlap(&parts)?;
    let end = parts.iter().map(|part| part.samples.end).max().unwrap_or(0);
    let start = if partial && wanted.is_none() { first.samples.start } else { 0 };
    let samples = start..wanted.unwrap_or(end);
    if end > samples.end {
        let what = format!("it has samples beyond the {} that are wanted", samples.len());
        let beyond = parts.iter().find(|part| part.samples.end > samples.end).unwrap_or(first);
        return Err(MergeError::Part { path: beyond.path.clone(), what });
    }
    let missing = missing(&parts, first.film, &samples);
    if let Some(missing) = &missing
        && !partial
    {
        return Err(MergeError::Missing(missing.to_string()));
    }
    let [width, height] = first.film.map(|side| side as usize);
    let mut pixels = vec![Pixel::default(); width * height];
    let mut layer_sums = LayerSums::new(first, width * height);
    let mut error = PartsError::new((width * height) as u64, parts.len());
    for part in &parts {
        let of_part = part.pixels()?;
        let [x, y, columns, rows] = part.region.map(|side| side as usize);
        for row in 0..rows {
            let place = (y + row) * width + x;
            for column in 0..columns {
                let (pixel, found) = (&mut pixels[place + column], of_part.at(row * columns + column));
                for (sum, mean) in pixel.radiance.iter_mut().zip(found.mean) {
                    *sum += found.count * mean;
                }
                pixel.squares += found.count * found.second_moment;
                pixel.count += found.count;
            }
            let value = |column: usize| {
                let found = of_part.at(row * columns + column);
                (found.mean.map(|mean| mean as f32), found.count as f32)
            };
            error.add(place as u64, value, columns);
            layer_sums.add(&of_part, (row * columns, place), columns);
        }
    }
    let mut devices: Vec<&str> = parts.iter().map(PartHeader::device).collect();
    devices.sort_unstable();
    devices.dedup();
    Ok(Merged {
        size: first.film,
        provenance: first.provenance(samples.start, samples.len() as u32, devices.join("; ")),
        missing,
        error: error.estimate(),
        longest: parts.iter().map(|part| part.samples.len() as u32).max().unwrap_or(1),
        samples,
        layers: first.layers.clone(),
        notes: first.notes(),
        pixels,
        layer_sums,
    })
}

impl Merged {
    /// How many more parts, as long as the longest, bring the error below the target: the error falls as the number of samples grows.
    pub fn parts_to_reach(&self, target: f64) -> Option<u64> {
        let error = self.error?;
        let have = self.samples.len() as f64;
        let more = have * (error.upper / target - 1.0);
        Some((more.max(0.0) / f64::from(self.longest)).ceil() as u64)
    }

    /// The channels of its layers.
    ///
    /// # Errors
    /// Errors of temporary files.
    pub fn layer_channels(&self) -> io::Result<Vec<LayerChannel>> {
        self.layer_sums.channels(self.size, |pixel| self.pixels[pixel].count)
    }

    /// The picture from the top.
    pub fn bands(&self) -> impl Iterator<Item = Band> {
        let width = self.size[0] as usize;
        let with_counts = self.missing.is_some();
        self.pixels.chunks(BAND_ROWS * width).enumerate().map(move |(index, pixels)| {
            let per_sample = |pixel: &Pixel, sum: f64| if pixel.count > 0.0 { sum / pixel.count } else { 0.0 };
            let exact = |pixel: &Pixel| pixel.radiance.map(|sum| per_sample(pixel, sum));
            let mean: Vec<[f32; 3]> = pixels.iter().map(|pixel| exact(pixel).map(|mean| mean as f32)).collect();
            let rest = |pixel: &Pixel| exact(pixel).map(|mean| (mean - f64::from(mean as f32)) as f32);
            Band {
                first_row: (index * BAND_ROWS) as u32,
                width: width as u32,
                rows: (pixels.len() / width) as u32,
                samples: pixels.iter().map(|pixel| pixel.count as u32).min().unwrap_or(0),
                counts: with_counts.then(|| pixels.iter().map(|pixel| pixel.count as u32).collect()),
                mean,
                remainder: pixels.iter().map(rest).collect(),
                second_moment: pixels.iter().map(|pixel| per_sample(pixel, pixel.squares) as f32).collect(),
                ..Band::default()
            }
        })
    }
}
