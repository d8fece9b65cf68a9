//! Compute pipelines, their bindings read off the shaders by naga.

use naga::{AddressSpace, StorageAccess, TypeInner};
use rayon::prelude::*;

use super::buffers::Buffers;
use super::compiled::{CompiledStage, UsedBinding};
use super::device::Device;
use crate::plan::Plan;
use crate::plan::bindings::Binding;
use crate::plan::stages::Stage;
use crate::renderer::RenderError;
use crate::shader::{self, ComposeError};

/// One stage: a pipeline and what it is bound to.
pub struct Kernel {
    pub stage: &'static Stage,
    pipeline: wgpu::ComputePipeline,
    bind_group: wgpu::BindGroup,
    /// The kernel reads the vertex's parameters, so its bind group takes their offset.
    takes_vertex: bool,
}

impl Kernel {
    /// Makes this kernel the pass's, for the submission's vertex number `vertex_index` (from 0).
    pub fn set(&self, pass: &mut wgpu::ComputePass<'_>, vertex_index: u32) {
        pass.set_pipeline(&self.pipeline);
        let offset = [super::buffers::vertex_offset(vertex_index)];
        pass.set_bind_group(0, &self.bind_group, if self.takes_vertex { &offset } else { &[] });
    }
}

/// The bindings that `entry` uses, from the validated module, in order.
pub fn used_bindings(module: &naga::Module, info: &naga::valid::ModuleInfo, entry: &str) -> Vec<UsedBinding> {
    let Some(index) = module.entry_points.iter().position(|point| point.name == entry) else { return Vec::new() };
    let uses = info.get_entry_point(index);
    let mut bindings: Vec<UsedBinding> = module
        .global_variables
        .iter()
        .filter(|(handle, _)| !uses[*handle].is_empty())
        .filter_map(|(_, variable)| {
            let number = variable.binding.as_ref()?.binding;
            let buffer = |ty| wgpu::BindingType::Buffer {
                ty,
                has_dynamic_offset: number == Binding::Vertex as u32,
                min_binding_size: None,
            };
            let kind = match (variable.space, &module.types[variable.ty].inner) {
                (AddressSpace::Uniform, _) => buffer(wgpu::BufferBindingType::Uniform),
                (AddressSpace::Storage { access }, _) => {
                    buffer(wgpu::BufferBindingType::Storage { read_only: !access.contains(StorageAccess::STORE) })
                }
                (_, TypeInner::Image { .. }) => wgpu::BindingType::StorageTexture {
                    access: wgpu::StorageTextureAccess::ReadWrite,
                    format: wgpu::TextureFormat::Rgba32Float,
                    view_dimension: wgpu::TextureViewDimension::D2,
                },
                (_, TypeInner::AccelerationStructure { vertex_return }) => {
                    wgpu::BindingType::AccelerationStructure { vertex_return: *vertex_return }
                }
                _ => return None,
            };
            Some(UsedBinding { number, kind })
        })
        .collect();
    bindings.sort_by_key(|used| used.number);
    bindings
}

/// Compiles the plan's stages, side by side.
///
/// # Errors
/// [`RenderError::Internal`] for a mistake in the shaders, with file and line.
pub fn compile(device: &Device, plan: &Plan) -> Result<Vec<CompiledStage>, RenderError> {
    let stages: Vec<&'static Stage> = plan.pipeline().collect();
    let compiled: Vec<CompiledStage> =
        stages.into_par_iter().map(|stage| compile_stage(device, plan, stage)).collect::<Result<_, _>>()?;
    device.kernels.keep(&compiled);
    Ok(compiled)
}

fn compile_stage(device: &Device, plan: &Plan, stage: &'static Stage) -> Result<CompiledStage, RenderError> {
    let Stage { file, entry, .. } = *stage;
    let internal = |error: ComposeError| RenderError::Internal(error.to_string());
    let composed = shader::compose(file, &plan.switches).map_err(internal)?;
    if let Some(compiled) = device.kernels.find(stage, &composed.text, plan.checked_shaders) {
        return Ok(compiled);
    }
    let (module, info) = composed.validate().map_err(internal)?;
    let used = used_bindings(&module, &info, entry);
    let entries: Vec<wgpu::BindGroupLayoutEntry> = used
        .iter()
        .map(|used| wgpu::BindGroupLayoutEntry {
            binding: used.number,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: used.kind,
            count: None,
        })
        .collect();
    let layout =
        device.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(entry), entries: &entries });
    let pipeline_layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(entry),
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let descriptor =
        wgpu::ShaderModuleDescriptor { label: Some(file), source: wgpu::ShaderSource::Wgsl(composed.text.as_str().into()) };
    let module = if plan.checked_shaders {
        device.device.create_shader_module(descriptor)
    } else {
        // SAFETY: every index the kernels use comes from arrays that `PackedScene::validate` checked or is bounded by the sizes that
        // the plan also compiled in, and every loop ends: traversal visits each node once, sampling loops count up to constants.
        // A test renders with the checks on and compares.
        unsafe { device.device.create_shader_module_trusted(descriptor, wgpu::ShaderRuntimeChecks::unchecked()) }
    };
    let pipeline = device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(&pipeline_layout),
        module: &module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions { zero_initialize_workgroup_memory: false, ..Default::default() },
        cache: None,
    });
    device.check()?;
    Ok(CompiledStage { stage, source: composed.text.into(), is_checked: plan.checked_shaders, used, layout, pipeline })
}

/// Binds compiled stages to their buffers.
///
/// # Errors
/// [`RenderError::Internal`] where a stage uses a binding that the plan does not have.
pub fn bind(device: &Device, stages: Vec<CompiledStage>, buffers: &Buffers) -> Result<Vec<Kernel>, RenderError> {
    stages.into_iter().map(|stage| bind_stage(device, stage, buffers)).collect()
}

fn bind_stage(device: &Device, compiled: CompiledStage, buffers: &Buffers) -> Result<Kernel, RenderError> {
    let CompiledStage { stage, used, layout, pipeline, .. } = compiled;
    let Stage { file, entry, .. } = *stage;
    let mut bound = Vec::new();
    for used in &used {
        let resource = buffers.resource(used.number);
        let resource = resource.ok_or_else(|| RenderError::Internal(format!("{file}: nothing to bind at {}", used.number)))?;
        bound.push(wgpu::BindGroupEntry { binding: used.number, resource });
    }
    let bind_group =
        device.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(entry), layout: &layout, entries: &bound });
    device.check()?;
    let takes_vertex = used.iter().any(|used| used.number == Binding::Vertex as u32);
    Ok(Kernel { stage, pipeline, bind_group, takes_vertex })
}
