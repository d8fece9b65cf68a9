//! The device that renders: chosen, opened, and given a scene.

use crate::cpu::ReferenceRenderer;
use crate::gpu::{GpuRenderer, OpeningDevice, list_devices};
use crate::learn::{Effort, Pace};
use crate::plan::PlanOptions;
use crate::renderer::{DeviceChoice, RenderError, Renderer};
use crate::scene::Scene;

/// The notice where `auto` finds no graphics adapter.
const NO_ADAPTER_NOTICE: &str = "no Vulkan, Metal or Direct3D 12 adapter was found: rendering on the CPU, which is slower. \
    On Debian and Ubuntu, scripts/install-lavapipe installs Mesa's software Vulkan driver.";

/// A renderer ready to work, and what the user should know about the choice.
pub struct ChosenRenderer {
    pub renderer: Box<dyn Renderer>,
    pub notice: Option<String>,
}

/// A chosen device: an adapter opens while the scene is read.
pub struct ChosenDevice {
    choice: DeviceChoice,
    /// None for the CPU, which needs no adapter.
    opening: Option<OpeningDevice>,
}

impl ChosenDevice {
    /// Begins to open the adapter, if `choice` means one, for plans with these options.
    pub fn begin(choice: &DeviceChoice, options: &PlanOptions) -> Self {
        let opening = (*choice != DeviceChoice::Cpu).then(|| OpeningDevice::begin(choice, options));
        Self { choice: choice.clone(), opening }
    }

    /// Makes the scene ready on the chosen device. With [`DeviceChoice::Auto`] and no adapter that can be used, that is the CPU reference, for
    /// which `options` have no meaning; ray queries, which only an adapter has, are not given up that way. `options` are those that the choice
    /// began with.
    ///
    /// # Errors
    /// No such device, or a scene that does not fit it.
    pub fn renderer(self, scene: &Scene, options: &PlanOptions) -> Result<ChosenRenderer, RenderError> {
        let Some(opening) = self.opening else {
            return Ok(ChosenRenderer { renderer: on_the_cpu(scene, options)?, notice: None });
        };
        match GpuRenderer::from_opening_device(opening, scene, options) {
            Err(RenderError::NoDevice(why)) if self.choice == DeviceChoice::Auto && !options.asks_for_ray_queries() => {
                Ok(ChosenRenderer { renderer: on_the_cpu(scene, options)?, notice: Some(no_adapter_notice(&why)) })
            }
            outcome => Ok(ChosenRenderer { renderer: Box::new(outcome?), notice: None }),
        }
    }
}

/// Why `auto` means the CPU: no adapter, what keeps each from being used, or why the one to use does not open.
fn no_adapter_notice(why: &str) -> String {
    let adapters = list_devices();
    if adapters.iter().any(|adapter| adapter.unusable.is_none()) {
        return format!("rendering on the CPU, which is slower, because {why}");
    }
    let obstacles: Vec<String> = adapters
        .into_iter()
        .filter_map(|adapter| adapter.unusable.map(|obstacle| format!("{} {obstacle}", adapter.name)))
        .collect();
    if obstacles.is_empty() {
        return NO_ADAPTER_NOTICE.to_owned();
    }
    format!("rendering on the CPU, which is slower, because {}", obstacles.join("; "))
}

fn on_the_cpu(scene: &Scene, options: &PlanOptions) -> Result<Box<dyn Renderer>, RenderError> {
    let effort = Effort { pace: Pace::Processor, time_limit: options.time_limit };
    let renderer = ReferenceRenderer::of_length(scene, options.layer, effort)?;
    Ok(Box::new(match options.most_film_pixels {
        Some(pixels) => renderer.with_film_pixels(pixels),
        None => renderer,
    }))
}
