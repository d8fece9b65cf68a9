//! Facts about an adapter that plans have to know.

use wgpu::{Adapter, AdapterInfo, DeviceType, Features, TextureFormat, TextureFormatFeatureFlags};

use super::software_drivers::gathers;
use crate::plan::{BUILD_HAS_RAY_QUERIES, DeviceLimits, PlanError, PlanOptions, RayQueryDefault, RayQueryLimits};

/// The limits of an adapter that is opened for plans with these options: it has ray queries only where they may be used.
///
/// # Errors
/// [`PlanError::DoesNotFit`] where it lacks those that are asked for.
pub fn limits_for_plans(adapter: &Adapter, options: &PlanOptions) -> Result<DeviceLimits, PlanError> {
    let limits = device_limits(adapter);
    let info = adapter.get_info();
    if options.asks_for_ray_queries() {
        limits.check_ray_queries(&info.name)?;
    }
    let is_verified = options.verified.contains(&driver_identity(&info));
    Ok(limits.with_ray_queries(options.traversal, is_verified))
}

/// Kernels of this build can use ray queries on the adapter.
pub fn has_ray_queries(adapter: &Adapter) -> bool {
    BUILD_HAS_RAY_QUERIES && adapter.features().contains(Features::EXPERIMENTAL_RAY_QUERY)
}

/// A device with the interface and the version of the driver, as one text.
pub fn driver_identity(info: &AdapterInfo) -> String {
    let driver = [&*info.driver, &*info.driver_info].join(" ");
    format!("{}, {:?}, {}", info.name, info.backend, driver.trim())
}

fn device_limits(adapter: &Adapter) -> DeviceLimits {
    let limits = adapter.limits();
    let features = adapter.get_texture_format_features(TextureFormat::Rgba32Float);
    let info = adapter.get_info();
    let software = info.device_type == DeviceType::Cpu;
    let subgroups = adapter.features().contains(Features::SUBGROUP);
    let one_size = subgroups && info.subgroup_min_size == info.subgroup_max_size;
    let specific = adapter.features().contains(Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);
    let max_array = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let max_workgroups = limits.max_compute_workgroups_per_dimension;
    DeviceLimits {
        max_storage_binding: limits.max_storage_buffer_binding_size,
        max_uniform_binding: limits.max_uniform_buffer_binding_size.min(64 << 10) as u32,
        max_buffer: limits.max_buffer_size,
        max_array,
        path_capacity: DeviceLimits::most_paths(software, max_array, max_workgroups),
        max_storage_buffers: limits.max_storage_buffers_per_shader_stage,
        max_texture_side: limits.max_texture_dimension_2d,
        max_workgroups,
        read_write_rgba32float: specific && features.flags.contains(TextureFormatFeatureFlags::STORAGE_READ_WRITE),
        software,
        threads: if software { std::thread::available_parallelism().map_or(1, |count| count.get() as u32) } else { 1 },
        subgroups,
        subgroup_size: one_size.then_some(info.subgroup_min_size),
        gathers: gathers(&info),
        ray_queries: Some(RayQueryLimits { max_primitives: limits.max_blas_primitive_count })
            .filter(|_| has_ray_queries(adapter)),
        ray_query_default: RayQueryDefault::No,
        ..DeviceLimits::default()
    }
}
