//! Compiled stages, before they are bound to anything.

use std::sync::{Arc, Mutex, PoisonError};

use crate::plan::stages::Stage;

/// A binding that an entry point uses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UsedBinding {
    pub number: u32,
    pub kind: wgpu::BindingType,
}

/// A stage that is compiled and not bound to anything yet, so that the scene can be uploaded meanwhile.
#[derive(Clone)]
pub struct CompiledStage {
    pub stage: &'static Stage,
    /// The text that the kernel was compiled from.
    pub source: Arc<str>,
    pub is_checked: bool,
    pub used: Vec<UsedBinding>,
    pub layout: wgpu::BindGroupLayout,
    pub pipeline: wgpu::ComputePipeline,
}

/// The stages that a device compiled last. A scene whose kernels have the same text, as the next frame of an animation mostly does, takes them.
#[derive(Default)]
pub struct CompiledKernels(Mutex<Vec<CompiledStage>>);

impl CompiledKernels {
    /// The stage, if it was compiled from this.
    pub fn find(&self, stage: &'static Stage, source: &str, is_checked: bool) -> Option<CompiledStage> {
        let stages = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_it = |compiled: &&CompiledStage| {
            let same_stage = compiled.stage.file == stage.file && compiled.stage.entry == stage.entry;
            same_stage && compiled.is_checked == is_checked && *compiled.source == *source
        };
        stages.iter().find(is_it).cloned()
    }

    /// Keeps these in place of what was kept.
    pub fn keep(&self, compiled: &[CompiledStage]) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = compiled.to_vec();
    }
}
