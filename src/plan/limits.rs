//! What the plan has to know of a device.

use super::choices::FilmStorage;
use super::error::PlanError;
use super::path_state::PATH_STATE_BYTES;

/// Bytes that the queue of shadow rays takes at most: five million of them keep any device busy.
const MOST_SHADOW_RAY_BYTES: u64 = 256 << 20;

/// Limits in bytes unless the name says otherwise.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceLimits {
    pub max_storage_binding: u64,
    pub max_uniform_binding: u32,
    pub max_buffer: u64,
    /// Of an array that one binding holds.
    pub max_array: u64,
    /// Paths in flight: enough to fill the device, few enough for its caches and for the largest binding.
    pub path_capacity: u32,
    /// Storage buffers that one stage can bind.
    pub max_storage_buffers: u32,
    /// In pixels.
    pub max_texture_side: u32,
    pub max_workgroups: u32,
    pub read_write_rgba32float: bool,
    /// The device is the CPU in disguise: its memory is the machine's, and its caches reward small working sets.
    pub software: bool,
    /// Of a software device: how many threads share a dispatch; 1 of others.
    pub threads: u32,
    /// Invocations of a subgroup can exchange values, however many they are.
    pub subgroups: bool,
    /// Invocations of a subgroup, where all subgroups have as many and can exchange values.
    pub subgroup_size: Option<u32>,
    /// What acceleration structures can hold, where kernels can ask them.
    pub ray_queries: Option<RayQueryLimits>,
}

/// Limits of acceleration structures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RayQueryLimits {
    /// Vertices of triangles, or boxes, of one part.
    pub max_primitives: u32,
}

impl Default for DeviceLimits {
    /// What WebGPU guarantees.
    fn default() -> Self {
        Self {
            max_storage_binding: 128 << 20,
            max_uniform_binding: 64 << 10,
            max_buffer: 256 << 20,
            max_array: 128 << 20,
            path_capacity: 1 << 20,
            max_storage_buffers: 8,
            max_texture_side: 8192,
            max_workgroups: 65_535,
            read_write_rgba32float: false,
            software: false,
            threads: 1,
            subgroups: false,
            subgroup_size: None,
            ray_queries: None,
        }
    }
}

impl DeviceLimits {
    pub fn of(adapter: &wgpu::Adapter) -> Self {
        let limits = adapter.limits();
        let features = adapter.get_texture_format_features(wgpu::TextureFormat::Rgba32Float);
        let info = adapter.get_info();
        let software = info.device_type == wgpu::DeviceType::Cpu;
        let subgroups = adapter.features().contains(wgpu::Features::SUBGROUP);
        let one_size = subgroups && info.subgroup_min_size == info.subgroup_max_size;
        let specific = adapter.features().contains(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);
        let max_array = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let max_workgroups = limits.max_compute_workgroups_per_dimension;
        let wanted_paths: u64 = if software { 1 << 18 } else { 1 << 20 };
        let most_paths = (max_array / PATH_STATE_BYTES).min(u64::from(max_workgroups) * 64);
        Self {
            max_storage_binding: limits.max_storage_buffer_binding_size,
            max_uniform_binding: limits.max_uniform_buffer_binding_size.min(64 << 10) as u32,
            max_buffer: limits.max_buffer_size,
            max_array,
            path_capacity: wanted_paths.min(most_paths) as u32,
            max_storage_buffers: limits.max_storage_buffers_per_shader_stage,
            max_texture_side: limits.max_texture_dimension_2d,
            max_workgroups,
            read_write_rgba32float: specific && features.flags.contains(wgpu::TextureFormatFeatureFlags::STORAGE_READ_WRITE),
            software,
            threads: if software { std::thread::available_parallelism().map_or(1, |count| count.get() as u32) } else { 1 },
            subgroups,
            subgroup_size: one_size.then_some(info.subgroup_min_size),
            ray_queries: Some(RayQueryLimits { max_primitives: limits.max_blas_primitive_count })
                .filter(|_| adapter.features().contains(wgpu::Features::EXPERIMENTAL_RAY_QUERY)),
        }
    }

    /// # Errors
    /// [`PlanError::DoesNotFit`] where the device, so called, has no ray queries.
    pub fn check_ray_queries(&self, device: &str) -> Result<RayQueryLimits, PlanError> {
        let missing = || {
            PlanError::DoesNotFit(format!(
                "{device} has no ray queries, or its driver does not offer them; without `--traversal ray-query` it renders all the same"
            ))
        };
        self.ray_queries.ok_or_else(missing)
    }

    /// Paths in flight, each with so many bytes of shadow rays: as many as one binding holds of either.
    pub fn paths_with_shadow_rays(&self, bytes: u64) -> u32 {
        let binding = self.max_storage_binding.min(self.max_buffer);
        let by_shadow_rays = binding.min(MOST_SHADOW_RAY_BYTES) / bytes.max(1);
        u64::from(self.path_capacity).min(binding / PATH_STATE_BYTES).min(by_shadow_rays) as u32
    }

    /// Rows per band so that a band's film stays below 16 MiB a texture and within the device's limits.
    pub fn band_rows(&self, size: [u32; 2], film: FilmStorage) -> u32 {
        let [width, height] = size;
        let texture_rows = if film == FilmStorage::Texture { self.max_texture_side } else { u32::MAX };
        ((1 << 20) / width).clamp(1, texture_rows).min(height)
    }
}
