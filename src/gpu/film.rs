//! Reads the film back, sums on the device and means on the host, and puts sums back into it.

use std::ops::Range;

use super::buffers::FilmHalf;
use super::device::Device;
use crate::film::{Band, rounded};
use crate::renderer::state::FilmState;
use crate::renderer::{Batch, RenderError};

/// Pixels that are read at once, in whole rows: what is copied on the way stays small.
const PIXELS_AT_ONCE: u32 = 1 << 20;

/// Sums of a run of pixels, and what their rounding lost: the two halves of the film.
pub type Halves = (Vec<[f32; 4]>, Vec<[f32; 4]>);

/// Rows of the film, counted within the band.
///
/// # Errors
/// What the device reports.
pub fn read_rows(device: &Device, film: &[FilmHalf; 2], width: u32, rows: Range<u32>) -> Result<Halves, RenderError> {
    Ok((read_half(device, &film[0], width, rows.clone())?, read_half(device, &film[1], width, rows)?))
}

/// All sums of a band.
///
/// # Errors
/// What the device reports.
pub fn read_band(device: &Device, film: &[FilmHalf; 2], [width, rows]: [u32; 2]) -> Result<FilmState, RenderError> {
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
/// What the device reports.
pub fn write_band(device: &Device, film: &[FilmHalf; 2], [width, rows]: [u32; 2], state: &FilmState) -> Result<(), RenderError> {
    for rows in runs_of_rows(width, rows) {
        let pixels = rows.start as usize * width as usize..rows.end as usize * width as usize;
        let (sums, compensations): Halves = pixels.map(|pixel| state.single(pixel)).unzip();
        write_half(device, &film[0], width, rows.clone(), &sums);
        write_half(device, &film[1], width, rows, &compensations);
        // What is on its way stays small.
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
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 16), rows_per_image: None },
            wgpu::Extent3d { width, height: rows.len() as u32, depth_or_array_layers: 1 },
        ),
        FilmHalf::Buffer(buffer) => device.queue.write_buffer(buffer, u64::from(width) * 16 * u64::from(rows.start), bytes),
    }
}

/// A band's rows in runs that are small enough to be copied at once.
fn runs_of_rows(width: u32, rows: u32) -> impl Iterator<Item = Range<u32>> {
    let at_once = (PIXELS_AT_ONCE / width).max(1);
    (0..rows).step_by(at_once as usize).map(move |row| row..(row + at_once).min(rows))
}

/// Rows of one half of the film, counted within the band.
pub fn read_half(device: &Device, half: &FilmHalf, width: u32, rows: Range<u32>) -> Result<Vec<[f32; 4]>, RenderError> {
    let row_bytes = width * 16;
    let mut encoder = device.device.create_command_encoder(&Default::default());
    let (target, stride) = match half {
        FilmHalf::Texture(texture) => {
            let stride = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
            let target = device.readback_buffer(u64::from(stride) * rows.len() as u64);
            let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None };
            let origin = wgpu::Origin3d { x: 0, y: rows.start, z: 0 };
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() },
                wgpu::TexelCopyBufferInfo { buffer: &target, layout },
                wgpu::Extent3d { width, height: rows.len() as u32, depth_or_array_layers: 1 },
            );
            (target, stride)
        }
        FilmHalf::Buffer(buffer) => {
            let size = u64::from(row_bytes) * rows.len() as u64;
            let target = device.readback_buffer(size);
            encoder.copy_buffer_to_buffer(buffer, u64::from(row_bytes) * u64::from(rows.start), &target, 0, size);
            (target, row_bytes)
        }
    };
    device.submit_and_wait(encoder.finish())?;
    let bytes = device.read(&target)?;
    let rows = bytes.chunks(stride as usize).map(|row| &row[..row_bytes as usize]);
    Ok(rows.flat_map(|row| row.chunks_exact(16).map(bytemuck::pod_read_unaligned)).collect())
}

/// What of a band was rendered.
#[derive(Debug, Clone, Copy)]
pub struct Reached {
    pub first_row: u32,
    pub rows: u32,
    /// Pixels of the band, of those that take part, that have samples: the first so many. Of the others the film may hold an earlier batch's.
    pub pixels: u32,
    /// Whether bands say how many samples each pixel has.
    pub with_counts: bool,
}

/// Hands over the means of a band, of sums that `read` brings, in bands small enough to be copied at once. Pixels that took no part have
/// nothing: what the film holds of them is an earlier batch's.
///
/// # Errors
/// What `read` and `on_band` report.
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
        // Of a layer of surfaces, rows may well have met nothing.
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
    let first = (first_row * width) as usize;
    let mut samples = batch.request.samples.len() as u32;
    let (mut mean, mut remainder) = (Vec::with_capacity(sums.len()), Vec::with_capacity(sums.len()));
    let mut second_moment = Vec::with_capacity(sums.len());
    let mut counts = Vec::with_capacity(if reached.with_counts { sums.len() } else { 0 });
    for (pixel, (sum, compensation)) in sums.iter().zip(compensations).enumerate() {
        let takes_part = batch.takes_part(first + pixel, width);
        let has_samples = takes_part && *pixels_before < reached.pixels;
        let count = if has_samples { sum[3] as u32 } else { 0 };
        if takes_part {
            samples = samples.min(count);
            *pixels_before += 1;
        }
        if reached.with_counts {
            counts.push(count);
        }
        let per_sample = |x: f64| if count > 0 { x / f64::from(count) } else { 0.0 };
        // The true sum is the stored one less what its compensation still owes.
        let (nearest, rest) = rounded([0, 1, 2].map(|c| per_sample(f64::from(sum[c]) - f64::from(compensation[c]))));
        mean.push(nearest);
        remainder.push(rest);
        second_moment.push(per_sample(f64::from(compensation[3])) as f32);
    }
    let rows = (sums.len() / width as usize) as u32;
    Band { first_row, width, rows, samples, counts: reached.with_counts.then_some(counts), mean, remainder, second_moment }
}
