//! Reads the film back: sums on the device, means on the host.

use super::buffers::FilmHalf;
use super::device::Device;
use crate::film::Band;
use crate::renderer::{Batch, RenderError};

/// One half of the film, its first rows.
pub fn read_half(device: &Device, half: &FilmHalf, [width, rows]: [u32; 2]) -> Result<Vec<[f32; 4]>, RenderError> {
    let row_bytes = width * 16;
    let mut encoder = device.device.create_command_encoder(&Default::default());
    let (target, stride) = match half {
        FilmHalf::Texture(texture) => {
            let stride = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
            let target = device.readback_buffer(u64::from(stride) * u64::from(rows));
            let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None };
            encoder.copy_texture_to_buffer(
                texture.as_image_copy(),
                wgpu::TexelCopyBufferInfo { buffer: &target, layout },
                wgpu::Extent3d { width, height: rows, depth_or_array_layers: 1 },
            );
            (target, stride)
        }
        FilmHalf::Buffer(buffer) => {
            let size = u64::from(row_bytes) * u64::from(rows);
            let target = device.readback_buffer(size);
            encoder.copy_buffer_to_buffer(buffer, 0, &target, 0, size);
            (target, row_bytes)
        }
    };
    device.submit_and_wait(encoder.finish())?;
    let bytes = device.read(&target)?;
    let rows = bytes.chunks(stride as usize).map(|row| &row[..row_bytes as usize]);
    Ok(rows.flat_map(|row| row.chunks_exact(16).map(bytemuck::pod_read_unaligned)).collect())
}

/// Means of a band from its sums on the device. Pixels that took no part have nothing: what the film holds of them is an earlier batch's.
pub fn read_band(
    device: &Device,
    film: &[FilmHalf; 2],
    first_row: u32,
    [width, rows]: [u32; 2],
    batch: &Batch<'_>,
) -> Result<Band, RenderError> {
    let sums = read_half(device, &film[0], [width, rows])?;
    let compensations = read_half(device, &film[1], [width, rows])?;
    let mut samples = batch.request.samples.len() as u32;
    let mut mean = Vec::with_capacity(sums.len());
    let mut second_moment = Vec::with_capacity(sums.len());
    let first_of_band = (first_row * width) as usize;
    for (pixel, (sum, compensation)) in sums.iter().zip(&compensations).enumerate() {
        let count = f64::from(sum[3]);
        let takes_part = batch.selection.is_none_or(|selection| selection[first_of_band + pixel]);
        if takes_part {
            samples = samples.min(sum[3] as u32);
        }
        let per_sample = |x: f64| if takes_part && count > 0.0 { (x / count) as f32 } else { 0.0 };
        // The true sum is the stored one less what its compensation still owes.
        mean.push([0, 1, 2].map(|c| per_sample(f64::from(sum[c]) - f64::from(compensation[c]))));
        second_moment.push(per_sample(f64::from(compensation[3])));
    }
    Ok(Band { first_row, width, rows, samples, mean, second_moment })
}
