//! A subject of measurements: it renders a picture with a seed and a number of samples, and reports how long
//! it took.

use std::borrow::Cow;

use crate::compare::SizeMismatch;
use crate::cpu::ReferenceRenderer;
use crate::denoise::library::OidnError;
use crate::film::KernelLayer;
use crate::gpu::{Device, GpuRenderer};
use crate::load::SceneError;
use crate::output::{Image, OutputError, ReadError};
use crate::plan::PlanOptions;
use crate::reference::layer::layer_scene;
use crate::renderer::{Batch, DeviceChoice, Observer, RenderError, RenderRequest, Renderer};
use crate::scene::Scene;

/// Why a measurement could not be done.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    #[error(transparent)]
    Render(#[from] RenderError),
    #[error(transparent)]
    Picture(#[from] ReadError),
    #[error(transparent)]
    Sizes(#[from] SizeMismatch),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Denoiser(#[from] OidnError),
    /// Nothing can be measured against it; the message is a sentence for the user.
    #[error("{0}")]
    UnsuitableReference(String),
    #[error("{0}")]
    Internal(String),
    /// The observer asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// One picture and what it took.
#[derive(Debug, Clone)]
pub struct Run {
    pub picture: Image,
    /// Time of the render alone, without packing the scene and compiling.
    pub seconds: f64,
    /// Camera, bounce and shadow rays.
    pub rays: u64,
    /// Over all pixels.
    pub samples: u64,
    pub non_finite_samples: u64,
    /// Acceleration structures and packing, once.
    pub build_seconds: f64,
    /// Shaders and pipelines, once.
    pub compile_seconds: f64,
}

/// Something to be measured. The clock is part of it, so that a test can plant a slowdown.
pub trait Subject {
    /// Renders samples 0 to `spp` of every pixel with random numbers of this seed.
    ///
    /// # Errors
    /// Errors of the renderer, and [`BenchError::Interrupted`].
    fn render(&mut self, seed: u32, spp: u32) -> Result<Run, BenchError>;
}

/// Devices that are open, so that settings share them.
#[derive(Default)]
pub struct Devices {
    /// The options that devices are opened for.
    options: PlanOptions,
    open: Vec<(DeviceChoice, Option<Device>)>,
}

impl Devices {
    /// Devices that will be opened for plans with these options.
    pub fn for_plans(options: &PlanOptions) -> Self {
        Self { options: options.clone(), open: Vec::new() }
    }

    /// The device of a choice; None for the CPU.
    ///
    /// # Errors
    /// [`RenderError::NoDevice`].
    pub fn get(&mut self, choice: &DeviceChoice) -> Result<Option<Device>, RenderError> {
        if let Some((_, device)) = self.open.iter().find(|(open, _)| open == choice) {
            return Ok(device.clone());
        }
        let device = match choice {
            DeviceChoice::Cpu => None,
            DeviceChoice::Auto => match Device::open_for(choice, &self.options) {
                Err(RenderError::NoDevice(_)) if !self.options.asks_for_ray_queries() => None,
                opened => Some(opened?),
            },
            _ => Some(Device::open_for(choice, &self.options)?),
        };
        self.open.push((choice.clone(), device.clone()));
        Ok(device)
    }

    /// Makes a scene ready.
    ///
    /// # Errors
    /// No such device, or a scene that does not fit it.
    pub fn prepare(&mut self, scene: &Scene, choice: &DeviceChoice) -> Result<Box<dyn Renderer>, RenderError> {
        self.prepare_layer(scene, choice, None)
    }

    /// Prepares a layer in the place of the picture, as [`Devices::prepare`] prepares the picture.
    ///
    /// # Errors
    /// The errors of [`Devices::prepare`].
    pub fn prepare_layer(
        &mut self,
        scene: &Scene,
        choice: &DeviceChoice,
        layer: Option<KernelLayer>,
    ) -> Result<Box<dyn Renderer>, RenderError> {
        let scene = &*layer.map_or(Cow::Borrowed(scene), |layer| layer_scene(scene, layer));
        Ok(match self.get(choice)? {
            Some(device) => Box::new(GpuRenderer::on(&device, scene, &PlanOptions { layer, ..PlanOptions::default() })?),
            None => Box::new(ReferenceRenderer::of_layer(scene, layer)?),
        })
    }

    /// The adapters that were opened, by name.
    pub fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = self
            .open
            .iter()
            .map(|(_, device)| device.as_ref().map_or_else(|| "CPU reference".to_owned(), |d| d.name.clone()))
            .collect();
        names.sort();
        names.dedup();
        names
    }
}

/// A scene made ready on a device.
pub struct SceneSubject<'a> {
    pub renderer: Box<dyn Renderer>,
    /// Width and height of the picture.
    pub size: [u32; 2],
    pub observer: &'a dyn Observer,
}

impl Subject for SceneSubject<'_> {
    fn render(&mut self, seed: u32, spp: u32) -> Result<Run, BenchError> {
        let [width, height] = self.size;
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        self.renderer.set_samples_per_pixel(spp);
        let request = RenderRequest { rows: 0..height, samples: 0..spp };
        let batch = Batch { seed: Some(seed), ..Batch::of(&request) };
        let report = self.renderer.render_batch(&batch, self.observer, &mut |band| {
            pixels.extend(band.mean);
            Ok(())
        })?;
        if report.interrupted {
            return Err(BenchError::Interrupted);
        }
        Ok(Run {
            picture: Image { width, height, pixels },
            seconds: report.render_seconds,
            rays: report.rays,
            samples: report.samples,
            non_finite_samples: report.non_finite_samples,
            build_seconds: report.build_seconds,
            compile_seconds: report.compile_seconds,
        })
    }
}
