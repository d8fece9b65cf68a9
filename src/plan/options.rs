//! Choices that a user or a tool makes instead of the plan.

use std::time::Duration;

use super::choices::StageMode;
use super::fault::Fault;
use crate::film::KernelLayer;
use crate::packed::hierarchy::Traversal;

/// How rays find what they meet on a graphics device (`--traversal`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TraversalChoice {
    /// Few primitives are tested one by one, others stand in a bounding volume hierarchy.
    #[default]
    Auto,
    /// A bounding volume hierarchy, however few the primitives.
    Bvh,
    /// The device's own acceleration structure, by ray queries. Scenes that move are refused, and so are devices without the feature.
    RayQuery,
}

/// What is asked of a plan. The default leaves every choice to it.
#[derive(Debug, Clone, Default)]
pub struct PlanOptions {
    /// With ray queries the device must have been opened for them ([`crate::gpu::Device::open_for`]).
    pub traversal: TraversalChoice,
    pub stages: Option<StageMode>,
    /// Let a batch leave pixels out ([`crate::renderer::Batch::selection`]).
    pub pixel_list: bool,
    /// Write down what happens along a path, for [`crate::gpu::GpuRenderer::trace`]; one kernel then traces whole paths.
    pub trace: bool,
    /// What is made in place of the picture, from a scene that is [made ready for it](crate::reference::layer::layer_scene).
    pub layer: Option<KernelLayer>,
    /// Keep naga's bounds checks and loop bounds in the kernels.
    pub checked_shaders: bool,
    /// Switches of parts that are compiled though the scene does not need them, to measure what leaving them out is worth.
    pub compile_in: Vec<&'static str>,
    /// What one submission may take before the device counts as lost; None: a minute.
    pub device_timeout: Option<Duration>,
    /// Compute wrongly, so that tests can see whether it is noticed.
    pub fault: Option<Fault>,
}

impl PlanOptions {
    /// What a scene has to be packed for.
    pub fn packed_traversal(&self) -> Traversal {
        match self.traversal {
            TraversalChoice::RayQuery => Traversal::RayQuery,
            TraversalChoice::Auto | TraversalChoice::Bvh => Traversal::Bvh,
        }
    }

    /// Whether plans may need ray queries of the device, which has to be opened for them.
    pub fn asks_for_ray_queries(&self) -> bool {
        self.traversal == TraversalChoice::RayQuery
    }
}
