//! The contract of every renderer, GPU or CPU.

mod decision;
mod observer;
pub mod sink;
pub mod state;
mod stopping;

use std::ops::Range;
use std::time::Instant;

use crate::film::Band;
use crate::scene::{InvalidScene, Scene};
use crate::spectrum::Spectrum;
use sink::Sink;
use state::BatchState;

pub use decision::Decision;
pub use observer::{Observer, Silent};
pub use stopping::{CAUTION, Ending, Stopping};

/// Which device renders.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum DeviceChoice {
    /// Discrete, integrated, then software Vulkan; with no adapter at all, the CPU integrator.
    #[default]
    Auto,
    /// Chooses as `Auto` does, without a fallback to the CPU integrator.
    Gpu,
    /// The reference integrator.
    Cpu,
    /// The adapter whose name contains this, ignoring case.
    Named(String),
}

/// The part of a render that is wanted: all pixels of `rows`, the samples with these absolute indices.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RenderRequest {
    pub rows: Range<u32>,
    pub samples: Range<u32>,
}

/// In what a frame of a scene differs from the one before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// In where the camera stands and looks, and in nothing else. Both move during the exposure, or both rest.
    Camera,
    /// In more, such as where shapes are.
    Shapes,
}

/// A request that is one of several for the same picture.
#[derive(Debug, Clone, Copy)]
pub struct Batch<'a> {
    pub request: &'a RenderRequest,
    /// Key of all random numbers; None: the scene's.
    pub seed: Option<u32>,
    /// Which pixels take part, of the whole film, row by row; None: all of them. The others' means are 0. A renderer on a GPU must have
    /// been made for it ([`crate::plan::PlanOptions::pixel_list`]).
    pub selection: Option<&'a [bool]>,
    /// Which columns take part; None: all of them. A renderer on a GPU must have been made for it as for a selection.
    pub columns: Option<(u32, u32)>,
    /// No iteration over the film begins that is expected to end later, but for the first. Paths that run on long after it are given up.
    pub deadline: Option<Instant>,
    /// How far an earlier render of the same batch was, from where this one goes on.
    pub resume: Option<&'a BatchState>,
}

impl<'a> Batch<'a> {
    /// All that is requested, as the scene says.
    pub fn of(request: &'a RenderRequest) -> Self {
        Self { request, seed: None, selection: None, columns: None, deadline: None, resume: None }
    }

    /// Samples of all pixels together, in a film of this width.
    pub fn total_samples(&self, width: u32) -> u64 {
        let RenderRequest { rows, samples } = self.request;
        let taking_part = if self.selects() {
            let pixels = rows.start as usize * width as usize..rows.end as usize * width as usize;
            pixels.filter(|pixel| self.takes_part(*pixel, width)).count() as u64
        } else {
            u64::from(width) * rows.len() as u64
        };
        taking_part * samples.len() as u64
    }

    /// True if there may be pixels that take no part.
    pub fn selects(&self) -> bool {
        self.selection.is_some() || self.columns.is_some()
    }

    /// True if a pixel of the film, counted from its first row's first, takes part, in a film of this width.
    pub fn takes_part(&self, pixel: usize, width: u32) -> bool {
        let column = (pixel % width as usize) as u32;
        self.columns.is_none_or(|(first, end)| (first..end).contains(&column))
            && self.selection.is_none_or(|selection| selection[pixel])
    }
}

/// The report of a render, for `--stats`.
#[derive(Debug, Clone, Default)]
pub struct RenderReport {
    /// The device as people call it, for example `llvmpipe (LLVM 15.0.6, 256 bits)` or `CPU reference`.
    pub device: String,
    /// The name of a graphics device's hierarchy, `bvh4` or `ray_query`; None where geometry is code.
    pub hierarchy: Option<&'static str>,
    /// The plan's decisions for a graphics device, with reasons; empty for the CPU.
    pub decisions: Vec<Decision>,
    /// The parts of the shaders that a graphics device's kernels hold.
    pub compiled_in: Vec<&'static str>,
    /// Camera, bounce and shadow rays traced.
    pub rays: u64,
    /// Samples finished, over all pixels.
    pub samples: u64,
    /// Samples that were not finite and that the film refused.
    pub non_finite_samples: u64,
    /// Samples that were brighter than the setting `clamp` allows.
    pub clamped_samples: u64,
    /// The luminance that was taken from them, in [`state::CLAMP_UNITS`] of the radiance that is allowed.
    pub clamped_units: u64,
    /// Most bytes allocated on the device at once (0 for the CPU).
    pub peak_device_bytes: u64,
    /// Seconds spent on paths before the first sample that say how lights and directions are chosen.
    pub learn_seconds: f64,
    /// Seconds spent building acceleration structures and packing the scene.
    pub build_seconds: f64,
    /// Seconds spent making shaders and pipelines.
    pub compile_seconds: f64,
    /// Seconds spent tracing paths.
    pub render_seconds: f64,
    /// The observer asked to stop before all samples were done.
    pub interrupted: bool,
    /// The deadline came before all samples were done.
    pub out_of_time: bool,
}

impl RenderReport {
    /// The share of the light at the film that clamping took, of a picture of this mean radiance whose samples were clamped at `limit`.
    pub fn clamped_light(&self, limit: f64, mean: [f64; 3]) -> f64 {
        let taken = self.clamped_units as f64 / state::CLAMP_UNITS * limit;
        let kept = Spectrum::from_rgb(mean).luminance() * self.samples as f64;
        if taken > 0.0 { taken / (taken + kept) } else { 0.0 }
    }
}

/// Why a render could not be done or finished.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    #[error("no usable device: {0}")]
    NoDevice(String),
    /// Needs and limits are part of the message.
    #[error("the scene does not fit the device: {0}")]
    DoesNotFit(String),
    /// A scene built by a program, not read from a file, that cannot be rendered as it is.
    #[error("the scene is not valid: {0}")]
    InvalidScene(#[from] InvalidScene),
    #[error("the device was lost: {0}")]
    DeviceLost(String),
    #[error("{0}")]
    Internal(String),
    /// The receiver of the bands failed (a full disk, say).
    #[error(transparent)]
    Output(#[from] std::io::Error),
}

/// A scene made ready on one device.
pub trait Renderer {
    /// The device as people call it; the same text as [`RenderReport::device`], known before the render because picture files
    /// carry it in their header.
    fn device(&self) -> &str;

    /// Makes another frame of the scene ready in place of this one, on the same device and with the kernels that still fit.
    ///
    /// # Errors
    /// The errors of the first frame. There is no renderer any more then.
    fn with_scene(self: Box<Self>, scene: &Scene, change: Change) -> Result<Box<dyn Renderer>, RenderError>;

    /// True if samples go over all of a film of this size together. If not, its bands are finished one after
    /// the other, for want of memory.
    fn holds_whole_film(&self) -> bool;

    /// Changes the samples per pixel for which samplers with strata lay them out from what the scene says. Nothing is built or compiled
    /// anew.
    fn set_samples_per_pixel(&mut self, spp: u32);

    /// Renders the request and hands over finished bands in order from the top, each once. When the observer stops it, bands hold
    /// what was done so far: `samples` and `counts` of a band say how many, rows without any sample are not delivered. Where the device is lost, bands hold what was read from it before, and the error follows.
    fn render(
        &mut self,
        request: &RenderRequest,
        observer: &dyn Observer,
        on_band: &mut dyn FnMut(Band) -> std::io::Result<()>,
    ) -> Result<RenderReport, RenderError> {
        self.render_batch(&Batch::of(request), observer, on_band)
    }

    /// Renders as [`Renderer::render`] does, with random numbers and numbers of samples that the scene does
    /// not decide.
    fn render_batch(
        &mut self,
        batch: &Batch<'_>,
        observer: &dyn Observer,
        mut on_band: &mut dyn FnMut(Band) -> std::io::Result<()>,
    ) -> Result<RenderReport, RenderError> {
        self.render_into(batch, observer, &mut on_band)
    }

    /// Renders as [`Renderer::render_batch`] does, into a sink that may take states of the batch: while it is
    /// rendered, when the observer stops it, and when the device is lost, but not where the deadline ends it.
    fn render_into(
        &mut self,
        batch: &Batch<'_>,
        observer: &dyn Observer,
        sink: &mut dyn Sink,
    ) -> Result<RenderReport, RenderError>;
}
