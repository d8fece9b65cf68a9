//! The check of a device, as users of the crate see it.

use crate::error::Error;
use crate::plan::PlanOptions;
use crate::renderer::DeviceChoice;
use crate::scene::Scene;
use crate::verify::{self, Verdict};

/// Renders the scene on a graphics device and by the CPU reference, with the same random numbers, and compares them path by path. It takes as
/// long as the CPU needs: pictures of some 100 pixels on a side and 16 samples per pixel are enough to find mistakes.
///
/// ```no_run
/// let mut scene = gpt::Scene::load("cornell")?;
/// (scene.film.size, scene.render.spp) = ([128, 128], 16);
/// let verdict = gpt::verify(&scene, &gpt::DeviceChoice::default())?;
/// println!("{} of {} paths match on {}", verdict.matching_paths, verdict.paths, verdict.device);
/// # Ok::<(), gpt::Error>(())
/// ```
///
/// # Errors
/// A device that is missing or too small for the scene, or that fails.
pub fn verify(scene: &Scene, device: &DeviceChoice) -> Result<Verdict, Error> {
    Ok(verify::verify(scene, device, &PlanOptions::default())?)
}
