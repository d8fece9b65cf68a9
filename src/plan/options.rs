//! Choices that a user or a tool makes instead of the plan.

use std::time::Duration;

use super::choices::{FilmStorage, StageMode};
use super::fault::Fault;
use super::verified_drivers::VerifiedDrivers;
use crate::film::KernelLayer;

/// How rays find what they meet on a graphics device (`--traversal`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TraversalChoice {
    /// Few primitives are tested one by one. Others stand in a bounding volume hierarchy, or are found by ray queries where hardware has them, they
    /// were verified ([`PlanOptions::verified`]) and they can see the scene.
    #[default]
    Auto,
    /// A bounding volume hierarchy, however few the primitives.
    Bvh,
    /// The device's own acceleration structure, by ray queries. Scenes that move are refused, and so are devices without the feature.
    RayQuery,
}

/// Requests to a plan. The default leaves every choice to it.
#[derive(Debug, Clone, Default)]
pub struct PlanOptions {
    /// With ray queries the device must have been opened for them ([`crate::gpu::Device::open_for`]).
    pub traversal: TraversalChoice,
    /// Drivers with which ray queries are used by default.
    pub verified: VerifiedDrivers,
    pub stages: Option<StageMode>,
    /// Storage of the film's sums; textures are refused where the device cannot read and write them.
    pub film: Option<FilmStorage>,
    /// Let a batch leave pixels out ([`crate::renderer::Batch::selection`]).
    pub pixel_list: bool,
    /// Most pixels of the film that are kept at a time, where fewer than there is memory for will do: a region takes those of its whole rows.
    pub most_film_pixels: Option<u64>,
    /// Write down what happens along a path, for [`crate::gpu::GpuRenderer::trace`]; one kernel then traces whole paths.
    pub trace: bool,
    /// Layer that is rendered in place of the picture, from a scene that is [made ready for
    /// it](crate::reference::layer::layer_scene).
    pub layer: Option<KernelLayer>,
    /// Keep naga's bounds checks and loop bounds in the kernels.
    pub checked_shaders: bool,
    /// Switches of parts that are compiled though the scene does not need them, to measure what leaving them out is worth.
    pub compile_in: Vec<&'static str>,
    /// Longest time of one submission before the device counts as lost; None: a minute.
    pub device_timeout: Option<Duration>,
    /// The time after which the render ends, if it does: there is less to learn for a short one ([`crate::learn`]).
    pub time_limit: Option<Duration>,
    /// Compute wrongly, so that tests can see whether it is noticed.
    pub fault: Option<Fault>,
}

impl PlanOptions {
    /// True where the packing of scenes depends on the device that is found.
    pub fn waits_for_device(&self) -> bool {
        self.traversal == TraversalChoice::Auto && !self.verified.is_empty()
    }

    /// True where plans require ray queries of the device.
    pub fn asks_for_ray_queries(&self) -> bool {
        self.traversal == TraversalChoice::RayQuery
    }
}
