//! Reads the film back: sums on the device, means on the host.

use super::buffers::FilmHalf;
use super::renderer::{BandState, GpuRenderer};
use crate::film::Band;
use crate::renderer::{Batch, RenderError};

impl GpuRenderer {
    /// One half of the film of the band's first `rows` rows.
    pub(super) fn read_film(&self, half: &FilmHalf, rows: u32) -> Result<Vec<[f32; 4]>, RenderError> {
        let row_bytes = self.size[0] * 16;
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let (target, stride) = match half {
            FilmHalf::Texture(texture) => {
                let stride = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
                let target = self.readback_buffer(u64::from(stride) * u64::from(rows));
                let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None };
                encoder.copy_texture_to_buffer(
                    texture.as_image_copy(),
                    wgpu::TexelCopyBufferInfo { buffer: &target, layout },
                    wgpu::Extent3d { width: self.size[0], height: rows, depth_or_array_layers: 1 },
                );
                (target, stride)
            }
            FilmHalf::Buffer(buffer) => {
                let size = u64::from(row_bytes) * u64::from(rows);
                let target = self.readback_buffer(size);
                encoder.copy_buffer_to_buffer(buffer, 0, &target, 0, size);
                (target, row_bytes)
            }
        };
        self.device.submit_and_wait(encoder.finish())?;
        let bytes = self.device.read(&target)?;
        let rows = bytes.chunks(stride as usize).map(|row| &row[..row_bytes as usize]);
        Ok(rows.flat_map(|row| row.chunks_exact(16).map(bytemuck::pod_read_unaligned)).collect())
    }

    /// Means of a band from its sums. Pixels that took no part have nothing: what the film holds of them is an earlier batch's.
    pub(super) fn finish_band(&self, band: &BandState, batch: &Batch<'_>) -> Result<Band, RenderError> {
        let sums = self.read_film(&self.buffers.film[0], band.rows)?;
        let compensations = self.read_film(&self.buffers.film[1], band.rows)?;
        let mut samples = batch.request.samples.len() as u32;
        let mut mean = Vec::with_capacity(sums.len());
        let mut second_moment = Vec::with_capacity(sums.len());
        let first_of_band = (band.first_row * self.size[0]) as usize;
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
        Ok(Band { first_row: band.first_row, width: self.size[0], rows: band.rows, samples, mean, second_moment })
    }
}
