//! The film in the device's memory, and the buffer that it is read through.

use wgpu::{BufferUsages, TextureFormat};

use super::device::Device;
use crate::plan::{FilmStorage, Plan, memory};

/// Pixels that are read at once, in whole rows: what is copied on the way stays small.
const PIXELS_AT_ONCE: u32 = 1 << 20;
/// Bytes of a pixel in one half of the film.
pub const PIXEL_BYTES: u32 = 16;

/// One of the two halves of the film.
pub enum FilmHalf {
    Texture(wgpu::Texture),
    Buffer(wgpu::Buffer),
}

/// The film of one band.
pub struct Film {
    /// Sums, and what their rounding lost.
    pub halves: [FilmHalf; 2],
    views: [Option<wgpu::TextureView>; 2],
    /// The buffer that the host reads rows of either half through. It is made beforehand, because drivers
    /// take a while to pin memory.
    pub readback: wgpu::Buffer,
}

impl Film {
    /// Makes room for a band of the plan's, of a film this wide.
    pub fn new(device: &Device, plan: &Plan, width: u32) -> Self {
        let halves = ["film sum", "film compensation"].map(|label| half(device, plan, width, label));
        let views = halves.each_ref().map(|half| match half {
            FilmHalf::Texture(texture) => Some(texture.create_view(&Default::default())),
            FilmHalf::Buffer(_) => None,
        });
        let rows = rows_at_once(width).min(plan.band_rows);
        let readback = device.readback_buffer(u64::from(row_stride(width)) * u64::from(rows));
        Self { halves, views, readback }
    }

    /// The resource of a bind group for one half.
    pub fn resource(&self, half: usize) -> Option<wgpu::BindingResource<'_>> {
        Some(match (&self.halves[half], &self.views[half]) {
            (FilmHalf::Buffer(buffer), _) => buffer.as_entire_binding(),
            (FilmHalf::Texture(_), view) => wgpu::BindingResource::TextureView(view.as_ref()?),
        })
    }
}

/// Rows that are copied at once, of a film this wide.
pub fn rows_at_once(width: u32) -> u32 {
    (PIXELS_AT_ONCE / width).max(1)
}

/// Bytes from one row to the next in what is read of a texture.
pub fn row_stride(width: u32) -> u32 {
    (width * PIXEL_BYTES).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

fn half(device: &Device, plan: &Plan, width: u32, label: &'static str) -> FilmHalf {
    match plan.film {
        FilmStorage::Texture => FilmHalf::Texture(device.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width, height: plan.band_rows, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: TextureFormat::Rgba32Float,
            usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })),
        FilmStorage::Buffer => FilmHalf::Buffer(device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: u64::from(width) * u64::from(plan.band_rows) * memory::FILM_BYTES / 2,
            usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })),
    }
}
