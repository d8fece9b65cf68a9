//! Which renderer takes a scene.

use crate::gpu::GpuRenderer;
use crate::plan::PlanOptions;
use crate::reference::ReferenceRenderer;
use crate::render::{DeviceChoice, RenderError, Renderer};
use crate::scene::Scene;

/// What is said where `auto` finds no graphics adapter.
const NO_ADAPTER_NOTICE: &str = "no Vulkan, Metal or Direct3D 12 adapter was found: rendering on the CPU, which is slower. \
    On Debian and Ubuntu, scripts/install-lavapipe installs Mesa's software Vulkan driver.";

/// A renderer ready to work, and what the user should know about the choice.
pub struct ChosenRenderer {
    pub renderer: Box<dyn Renderer>,
    pub notice: Option<&'static str>,
}

/// Makes the scene ready on the chosen device. With [`DeviceChoice::Auto`] and no adapter at all, that is the CPU reference,
/// for which `options` have no meaning.
///
/// # Errors
/// No such device, or a scene that does not fit it.
pub fn create(scene: &Scene, choice: &DeviceChoice, options: &PlanOptions) -> Result<ChosenRenderer, RenderError> {
    match choice {
        DeviceChoice::Cpu => Ok(ChosenRenderer { renderer: on_the_cpu(scene)?, notice: None }),
        DeviceChoice::Gpu | DeviceChoice::Named(_) => {
            Ok(ChosenRenderer { renderer: on_a_gpu(scene, choice, options)?, notice: None })
        }
        DeviceChoice::Auto => match on_a_gpu(scene, choice, options) {
            Err(RenderError::NoDevice(_)) => Ok(ChosenRenderer { renderer: on_the_cpu(scene)?, notice: Some(NO_ADAPTER_NOTICE) }),
            outcome => Ok(ChosenRenderer { renderer: outcome?, notice: None }),
        },
    }
}

fn on_the_cpu(scene: &Scene) -> Result<Box<dyn Renderer>, RenderError> {
    Ok(Box::new(ReferenceRenderer::new(scene)?))
}

fn on_a_gpu(scene: &Scene, choice: &DeviceChoice, options: &PlanOptions) -> Result<Box<dyn Renderer>, RenderError> {
    Ok(Box::new(GpuRenderer::new(scene, choice, options)?))
}
