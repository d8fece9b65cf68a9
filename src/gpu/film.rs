//! Reads the film back, sums on the device and means on the host, and puts sums back into it.

use std::ops::Range;

use rayon::prelude::*;

use super::device::Device;
use super::film_memory::{Film, FilmHalf, PIXEL_BYTES, row_stride, rows_at_once};
use crate::film::{Band, count_in, rounded};
use crate::renderer::state::FilmState;
use crate::renderer::{Batch, RenderError};

/// Sums of a run of pixels, and what their rounding lost: the two halves of the film.
pub type Halves = (Vec<[f32; 4]>, Vec<[f32; 4]>);

/// Rows of the film, counted within the band.
///
/// # Errors
/// [`RenderError`] that the device reports.
pub fn read_rows(device: &Device, film: &Film, width: u32, rows: Range<u32>) -> Result<Halves, RenderError> {
    let [sums, compensations] = &film.halves;
    Ok((
        read_half(device, sums, &film.readback, width, rows.clone())?,
        read_half(device, compensations, &film.readback, width, rows)?,
    ))
}

/// All sums of a band.
///
/// # Errors
/// [`RenderError`] that the device reports.
pub fn read_band(device: &Device, film: &Film, [width, rows]: [u32; 2]) -> Result<FilmState, RenderError> {
    let pixels = width as usize * rows as usize;
    let (mut sums, mut compensations) = (Vec::with_capacity(pixels), Vec::with_capacity(pixels));
    for rows in runs_of_rows(width, rows) {
        let (sum, compensation) = read_rows(device, film, width, rows)?;
        sums.extend(sum);
        compensations.extend(compensation);
    }
    Ok(FilmState::Single { sums, compensations })
}

/// Puts the first sums of `state` into the film, so many rows of them.
///
/// # Errors
/// [`RenderError`] that the device reports.
pub fn write_band(device: &Device, film: &Film, [width, rows]: [u32; 2], state: &FilmState) -> Result<(), RenderError> {
    for rows in runs_of_rows(width, rows) {
        let pixels = rows.start as usize * width as usize..rows.end as usize * width as usize;
        let (sums, compensations): Halves = pixels.map(|pixel| state.single(pixel)).unzip();
        write_half(device, &film.halves[0], width, rows.clone(), &sums);
        write_half(device, &film.halves[1], width, rows, &compensations);
        // The upload under way stays small.
        device.submit_and_wait(device.device.create_command_encoder(&Default::default()).finish())?;
    }
    Ok(())
}

fn write_half(device: &Device, half: &FilmHalf, width: u32, rows: Range<u32>, pixels: &[[f32; 4]]) {
    let bytes = bytemuck::cast_slice(pixels);
    match half {
        FilmHalf::Texture(texture) => device.queue.write_texture(
            wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x: 0, y: rows.start, z: 0 }, ..texture.as_image_copy() },
            bytes,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * PIXEL_BYTES), rows_per_image: None },
            wgpu::Extent3d { width, height: rows.len() as u32, depth_or_array_layers: 1 },
        ),
        FilmHalf::Buffer(buffer) => {
            device.queue.write_buffer(buffer, u64::from(width * PIXEL_BYTES) * u64::from(rows.start), bytes)
        }
    }
}

/// A band's rows in runs that are small enough to be copied at once.
fn runs_of_rows(width: u32, rows: u32) -> impl Iterator<Item = Range<u32>> {
    let at_once = rows_at_once(width);
    (0..rows).step_by(at_once as usize).map(move |row| row..(row + at_once).min(rows))
}

/// Rows of one half of the film, counted within the band: at most [`rows_at_once`], which the buffer has room for.
fn read_half(
    device: &Device,
    half: &FilmHalf,
    readback: &wgpu::Buffer,
    width: u32,
    rows: Range<u32>,
) -> Result<Vec<[f32; 4]>, RenderError> {
    let row_bytes = width * PIXEL_BYTES;
    let mut encoder = device.device.create_command_encoder(&Default::default());
    let stride = match half {
        FilmHalf::Texture(texture) => {
            let stride = row_stride(width);
            let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None };
            let origin = wgpu::Origin3d { x: 0, y: rows.start, z: 0 };
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() },
                wgpu::TexelCopyBufferInfo { buffer: readback, layout },
                wgpu::Extent3d { width, height: rows.len() as u32, depth_or_array_layers: 1 },
            );
            stride
        }
        FilmHalf::Buffer(buffer) => {
            let size = u64::from(row_bytes) * rows.len() as u64;
            encoder.copy_buffer_to_buffer(buffer, u64::from(row_bytes) * u64::from(rows.start), readback, 0, size);
            row_bytes
        }
    };
    device.submit_and_wait(encoder.finish())?;
    let mut pixels = vec![[0.0; 4]; width as usize * rows.len()];
    device.read_mapped(readback, u64::from(stride) * rows.len() as u64, |bytes| {
        let targets = pixels.par_chunks_exact_mut(width as usize);
        targets.zip(bytes.par_chunks_exact(stride as usize)).for_each(|(target, row)| {
            bytemuck::cast_slice_mut(target).copy_from_slice(&row[..row_bytes as usize]);
        });
    })?;
    Ok(pixels)
}

/// The part of a band that was rendered.
#[derive(Debug, Clone, Copy)]
pub struct Reached {
    pub first_row: u32,
    pub rows: u32,
    /// Pixels of the band, of those that take part, that have samples: the first so many. Of the others the film may hold an earlier batch's.
    pub pixels: u32,
    /// Samples that each pixel has at least, unless its driver lost some.
    pub least: u32,
    /// Bands say how many samples each pixel has.
    pub with_counts: bool,
}

/// Hands over the means of a band, of sums that `read` brings, in bands small enough to be copied at once. Pixels that took no part have
/// nothing: what the film holds of them is an earlier batch's.
///
/// # Errors
/// [`RenderError`] that `read` and `on_band` report; [`RenderError::NoDevice`] where a pixel has fewer samples than it must have, which is a driver's
/// fault: such a picture is not handed over.
pub fn deliver_band(
    width: u32,
    reached: &Reached,
    batch: &Batch<'_>,
    read: &dyn Fn(Range<u32>) -> Result<Halves, RenderError>,
    on_band: &mut dyn FnMut(Band) -> std::io::Result<()>,
) -> Result<(), RenderError> {
    let mut pixels_before = 0;
    for rows in runs_of_rows(width, reached.rows) {
        let first_row = reached.first_row + rows.start;
        let (sums, compensations) = read(rows)?;
        let band = means(&sums, &compensations, [width, first_row], reached, &mut pixels_before, batch);
        if band.samples < reached.least {
            let (last_row, found, least) = (first_row + band.rows - 1, band.samples, reached.least);
            return Err(RenderError::NoDevice(format!(
                "the driver lost samples: a pixel of the rows from {first_row} to {last_row} has {found} of {least}; \
                 take a newer driver, or --device cpu"
            )));
        }
        // Rows of a layer of surfaces may well have met nothing.
        if band.counts.is_none() || batch.selection.is_none() || band.counts.iter().flatten().any(|count| *count > 0) {
            on_band(band)?;
        }
    }
    Ok(())
}

/// `pixels_before` of those that take part stand above these rows.
fn means(
    sums: &[[f32; 4]],
    compensations: &[[f32; 4]],
    [width, first_row]: [u32; 2],
    reached: &Reached,
    pixels_before: &mut u32,
    batch: &Batch<'_>,
) -> Band {
    let columns = width as usize;
    let first_pixel_of = |row: usize| (first_row as usize + row) * columns;
    let rows = sums.len() / columns;
    // Pixels above each row that take part.
    let before: Vec<u32> = (0..rows)
        .map(|row| {
            let first = first_pixel_of(row);
            let taking_part = if batch.selects() {
                (first..first + columns).filter(|pixel| batch.takes_part(*pixel, width)).count() as u32
            } else {
                width
            };
            std::mem::replace(pixels_before, *pixels_before + taking_part)
        })
        .collect();
    let pixels = sums.len();
    let (mut mean, mut remainder) = (vec![[0.0; 3]; pixels], vec![[0.0; 3]; pixels]);
    let (mut second_moment, mut counts) = (vec![0.0; pixels], vec![0; pixels]);
    let targets = (mean.par_chunks_exact_mut(columns), remainder.par_chunks_exact_mut(columns));
    let more_targets = (second_moment.par_chunks_exact_mut(columns), counts.par_chunks_exact_mut(columns));
    let sources = (sums.par_chunks_exact(columns), compensations.par_chunks_exact(columns));
    let fewest = (targets, more_targets, sources, before.par_iter()).into_par_iter().enumerate().map(
        |(row, ((mean, remainder), (second_moment, counts), (sums, compensations), before))| {
            let (mut fewest, mut before) = (u32::MAX, *before);
            for column in 0..columns {
                let (sum, compensation) = (sums[column], compensations[column]);
                let takes_part = batch.takes_part(first_pixel_of(row) + column, width);
                let has_samples = takes_part && before < reached.pixels;
                let count = if has_samples { count_in(sum[3]) } else { 0 };
                if takes_part {
                    fewest = fewest.min(count);
                    before += 1;
                }
                counts[column] = count;
                let per_sample = |x: f64| if count > 0 { x / f64::from(count) } else { 0.0 };
                // The true sum is the stored one less what its compensation still owes.
                (mean[column], remainder[column]) =
                    rounded([0, 1, 2].map(|c| per_sample(f64::from(sum[c]) - f64::from(compensation[c]))));
                second_moment[column] = per_sample(f64::from(compensation[3])) as f32;
            }
            fewest
        },
    );
    let samples = fewest.min().unwrap_or(u32::MAX).min(batch.request.samples.len() as u32);
    Band {
        first_row,
        width,
        rows: rows as u32,
        samples,
        counts: reached.with_counts.then_some(counts),
        mean,
        remainder,
        second_moment,
        ..Band::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::count_word;
    use crate::renderer::RenderRequest;

    /// Samples that a band of two rows of three pixels delivers which has so many a pixel, where each must have 8.
    fn delivered(counts: [u32; 6], batch: &Batch<'_>) -> Result<Vec<u32>, RenderError> {
        let reached = Reached { first_row: 4, rows: 2, pixels: 6, least: 8, with_counts: false };
        let sums = counts.map(|count| [1.0, 1.0, 1.0, count_word(count)]);
        let read = |rows: Range<u32>| {
            let pixels = 3 * rows.start as usize..3 * rows.end as usize;
            Ok((sums[pixels.clone()].to_vec(), vec![[0.0; 4]; pixels.len()]))
        };
        let mut samples = Vec::new();
        deliver_band(3, &reached, batch, &read, &mut |band| {
            samples.push(band.samples);
            Ok(())
        })?;
        Ok(samples)
    }

    #[test]
    fn a_picture_whose_driver_lost_samples_is_not_handed_over() {
        let request = RenderRequest { rows: 4..6, samples: 0..8 };
        let batch = Batch::of(&request);
        assert_eq!(delivered([8; 6], &batch).unwrap(), [8]);
        assert_eq!(delivered([9, 8, 8, 8, 8, 8], &batch).unwrap(), [8], "an iteration under way");
        let refused = delivered([8, 8, 8, 8, 7, 8], &batch);
        let Err(RenderError::NoDevice(message)) = refused else { panic!("handed over: {refused:?}") };
        assert!(message.contains("has 7 of 8"), "{message}");
    }

    /// Pixels that take no part have what an earlier batch left.
    #[test]
    fn pixels_that_take_no_part_may_have_fewer_samples() {
        let request = RenderRequest { rows: 4..6, samples: 0..8 };
        let selection: Vec<bool> = (0..3 * 6).map(|pixel| pixel != 3 * 5 + 1).collect();
        let batch = Batch { selection: Some(&selection), ..Batch::of(&request) };
        assert_eq!(delivered([8, 8, 8, 8, 7, 8], &batch).unwrap(), [8]);
    }
}
