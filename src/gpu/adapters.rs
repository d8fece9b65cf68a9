//! Which graphics adapters there are, and which one renders.

use serde::Serialize;
use wgpu::{Adapter, Backend, Backends, DeviceType, Features, Instance, InstanceDescriptor, InstanceFlags, TextureFormat};

use super::limits::{driver_identity, has_ray_queries};
use super::software_drivers;
use crate::renderer::{DeviceChoice, RenderError};

/// The interfaces worth asking: the ones whose compute shaders meet WebGPU. OpenGL is left out on purpose.
const BACKENDS: Backends = Backends::VULKAN.union(Backends::METAL).union(Backends::DX12);

/// Facts about an adapter that a person wants to know before trusting it with a scene. Sizes are in bytes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AdapterSummary {
    pub name: String,
    /// `Vulkan`, `Metal` or `Dx12`.
    pub backend: String,
    pub kind: AdapterKind,
    pub driver: String,
    /// Names device and driver in the list of those that were verified.
    #[serde(skip)]
    pub identity: String,
    /// `--device auto` takes this one.
    pub chosen_by_auto: bool,
    pub max_storage_binding: u64,
    pub max_uniform_binding: u64,
    pub max_buffer: u64,
    pub max_storage_buffers_per_stage: u32,
    /// Width and height a texture may have, in pixels.
    pub max_texture_side: u32,
    pub max_workgroups_per_dimension: u32,
    pub max_workgroup_memory: u32,
    /// Immediates (push constants); 0 where the adapter has none.
    pub max_immediates: u32,
    pub subgroup_sizes: [u32; 2],
    /// A shader may read and write one rgba32float storage texture.
    pub read_write_rgba32float: bool,
    pub timestamps: bool,
    /// Kernels of this build can ask an acceleration structure of the device's own (`--traversal ray-query`).
    pub ray_queries: bool,
    /// The reason why the renderer cannot use the adapter; `auto` passes it over.
    pub unusable: Option<String>,
    /// A way to render faster that its user has.
    pub advice: Option<&'static str>,
}

/// Kinds of adapter in the order in which `auto` prefers them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum AdapterKind {
    Discrete,
    Integrated,
    Virtual,
    Other,
    Software,
}

impl AdapterKind {
    /// The kind as people call it.
    pub fn label(self) -> &'static str {
        match self {
            Self::Discrete => "discrete GPU",
            Self::Integrated => "integrated GPU",
            Self::Virtual => "virtual GPU",
            Self::Other => "unknown kind",
            Self::Software => "software",
        }
    }
}

impl From<DeviceType> for AdapterKind {
    fn from(device_type: DeviceType) -> Self {
        match device_type {
            DeviceType::DiscreteGpu => Self::Discrete,
            DeviceType::IntegratedGpu => Self::Integrated,
            DeviceType::VirtualGpu => Self::Virtual,
            DeviceType::Other => Self::Other,
            DeviceType::Cpu => Self::Software,
        }
    }
}

/// Every adapter of this machine, best first. Empty where there is no driver.
pub fn list_devices() -> Vec<AdapterSummary> {
    let mut summaries: Vec<_> = adapters_best_first().iter().map(summarise).collect();
    if let Some(first) = summaries.iter_mut().find(|summary| summary.unusable.is_none()) {
        first.chosen_by_auto = true;
    }
    summaries
}

/// The adapter that `choice` means. For [`DeviceChoice::Named`] that is the best one whose name contains the text, ignoring case.
///
/// # Errors
/// [`RenderError::NoDevice`] where there is none, saying what there is; also for [`DeviceChoice::Cpu`], which needs no adapter.
pub fn select_adapter(choice: &DeviceChoice) -> Result<Adapter, RenderError> {
    let adapters = adapters_best_first();
    let named = |adapter: &Adapter| match obstacle(adapter) {
        Some(obstacle) => format!("{}, which {obstacle}", adapter.get_info().name),
        None => adapter.get_info().name,
    };
    let names: Vec<_> = adapters.iter().map(named).collect();
    let found = match choice {
        DeviceChoice::Cpu => None,
        DeviceChoice::Auto | DeviceChoice::Gpu => adapters.into_iter().find(|adapter| obstacle(adapter).is_none()),
        DeviceChoice::Named(part) => {
            let mut matching = adapters.into_iter().filter(|adapter| name_contains(&adapter.get_info().name, part));
            matching.find(|adapter| obstacle(adapter).is_none())
        }
    };
    found.ok_or_else(|| RenderError::NoDevice(no_device_message(choice, &names)))
}

fn no_device_message(choice: &DeviceChoice, names: &[String]) -> String {
    let available = if names.is_empty() {
        "no Vulkan, Metal or Direct3D 12 adapter was found; `cpu` renders without one".to_owned()
    } else {
        format!("the adapters are: {}; `cpu` renders without one", names.join("; "))
    };
    match choice {
        DeviceChoice::Named(part) => format!("no usable adapter's name contains `{part}` ({available})"),
        DeviceChoice::Cpu => format!("the CPU reference runs without an adapter ({available})"),
        DeviceChoice::Auto | DeviceChoice::Gpu => available,
    }
}

fn name_contains(name: &str, part: &str) -> bool {
    name.to_lowercase().contains(&part.to_lowercase())
}

fn adapters_best_first() -> Vec<Adapter> {
    // Line numbers in SPIR-V take naga a search through the whole text for every statement.
    let flags = InstanceFlags::from_build_config().difference(InstanceFlags::DEBUG);
    let descriptor =
        InstanceDescriptor { backends: BACKENDS, flags, ..InstanceDescriptor::new_without_display_handle() }.with_env();
    let instance = Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(BACKENDS));
    adapters.sort_by_key(|adapter| {
        let info = adapter.get_info();
        (AdapterKind::from(info.device_type), backend_rank(info.backend))
    });
    adapters
}

/// Rank of an interface: on Windows a GPU shows up once per interface, and the one that the project is
/// measured on goes first.
fn backend_rank(backend: Backend) -> u8 {
    match backend {
        Backend::Vulkan => 0,
        Backend::Metal => 1,
        _ => 2,
    }
}

/// Why the renderer cannot use this adapter.
fn obstacle(adapter: &Adapter) -> Option<String> {
    if !adapter.get_downlevel_capabilities().is_webgpu_compliant() {
        return Some("does not meet the WebGPU standard".to_owned());
    }
    software_drivers::obstacle(&adapter.get_info())
}

fn summarise(adapter: &Adapter) -> AdapterSummary {
    let info = adapter.get_info();
    let limits = adapter.limits();
    let features = adapter.features();
    AdapterSummary {
        kind: info.device_type.into(),
        backend: format!("{:?}", info.backend),
        identity: driver_identity(&info),
        advice: software_drivers::advice(&info),
        driver: [info.driver, info.driver_info].join(" ").trim().to_owned(),
        name: info.name,
        chosen_by_auto: false,
        max_storage_binding: limits.max_storage_buffer_binding_size,
        max_uniform_binding: limits.max_uniform_buffer_binding_size,
        max_buffer: limits.max_buffer_size,
        max_storage_buffers_per_stage: limits.max_storage_buffers_per_shader_stage,
        max_texture_side: limits.max_texture_dimension_2d,
        max_workgroups_per_dimension: limits.max_compute_workgroups_per_dimension,
        max_workgroup_memory: limits.max_compute_workgroup_storage_size,
        max_immediates: if features.contains(Features::IMMEDIATES) { limits.max_immediate_size } else { 0 },
        subgroup_sizes: [info.subgroup_min_size, info.subgroup_max_size],
        read_write_rgba32float: can_read_and_write(adapter, TextureFormat::Rgba32Float),
        timestamps: features.contains(Features::TIMESTAMP_QUERY),
        ray_queries: has_ray_queries(adapter),
        unusable: obstacle(adapter),
    }
}

/// Says that one storage texture of this format can be read and written by the same shader.
pub fn can_read_and_write(adapter: &Adapter, format: TextureFormat) -> bool {
    adapter.features().contains(Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES)
        && adapter.get_texture_format_features(format).flags.contains(wgpu::TextureFormatFeatureFlags::STORAGE_READ_WRITE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn auto_prefers_discrete_then_integrated_then_software() {
        let mut kinds =
            [DeviceType::Cpu, DeviceType::Other, DeviceType::IntegratedGpu, DeviceType::DiscreteGpu].map(AdapterKind::from);
        kinds.sort();
        assert_eq!(kinds, [AdapterKind::Discrete, AdapterKind::Integrated, AdapterKind::Other, AdapterKind::Software]);
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_names_there_are() {
        let choice = DeviceChoice::Named("no such adapter".into());
        let Err(RenderError::NoDevice(message)) = select_adapter(&choice) else {
            panic!("an adapter was found for a name that no adapter has");
        };
        assert!(message.contains("no such adapter"), "{message}");
        for summary in list_devices() {
            assert!(message.contains(&summary.name), "{message} does not name {}", summary.name);
        }
    }

    #[test]
    fn names_match_by_part_ignoring_case() {
        assert!(name_contains("llvmpipe (LLVM 15.0.6, 256 bits)", "LLVMpipe"));
        assert!(!name_contains("llvmpipe (LLVM 15.0.6, 256 bits)", "nvidia"));
    }
}
