//! Everything that is learned about a scene, once, before the scene is fitted to a device.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

use super::budget::{Budget, Effort, LEAST_BUDGET};
use super::reasons::Reasons;
use super::trial::{self, Chosen};
use super::{guide, guide::Learned, openness};
use crate::reference::Integrator;
use crate::renderer::RenderError;
use crate::sampling::light_strategy::MANY_LIGHTS;
use crate::sampling::{Guide, LightCells};
use crate::scene::{LightChoice, Scene};

/// A scene with complete settings, and what was learned about it.
pub struct Settled<'a> {
    /// The scene; its settings leave nothing open.
    pub scene: Cow<'a, Scene>,
    /// Reasons for the settings that were open.
    pub because: Reasons,
    /// Lists of the lights that reach each cell, where lights are chosen by cells.
    pub light_cells: Option<Arc<LightCells>>,
    /// The guide of paths; None where paths are not guided.
    pub guide: Option<Arc<Guide>>,
    /// Paths were traced to learn, so that another camera may learn something else.
    pub depends_on_view: bool,
    /// The scene made ready for tracing paths, with all that was learned, where learning needed it.
    pub integrator: Option<Integrator>,
    /// Seconds that learning took, with the scene made ready for it.
    pub seconds: f64,
    /// Cells of lights were chosen by learning, not by the scene.
    chose_cells: bool,
}

/// Chooses what the scene's settings leave open, and learns what its paths are to know, as far as the render is
/// long enough for it.
///
/// # Errors
/// [`RenderError`] for a scene that is not valid or that the reference cannot render.
pub fn settle(scene: &Scene, effort: Effort) -> Result<Settled<'_>, RenderError> {
    scene.validate()?;
    let start = Instant::now();
    let mut settled = match openness::baked(scene)? {
        None => settle_baked(scene, effort)?,
        Some(baked) => settle_baked(&baked, effort)?.into_owned(),
    };
    settled.seconds = start.elapsed().as_secs_f64();
    Ok(settled)
}

/// The scene with all that it leaves open of how lights are drawn from, so that its frames draw from them alike.
///
/// # Errors
/// [`RenderError`] for a scene that the reference cannot render.
pub fn with_lights_settled(scene: &Scene, effort: Effort) -> Result<Scene, RenderError> {
    Ok(trial::choose(scene, Budget::new(scene, effort))?.scene.into_owned())
}

/// True where the render may be long enough to learn for, so that it matters how fast its device is.
pub fn may_learn(scene: &Scene) -> bool {
    Budget::new(scene, Effort::default()).most_paths() >= LEAST_BUDGET
}

/// Settles a scene without weights that are still to be baked.
fn settle_baked(scene: &Scene, effort: Effort) -> Result<Settled<'_>, RenderError> {
    let budget = Budget::new(scene, effort);
    let was_open = scene.render.light_choice == LightChoice::Auto;
    let Chosen { scene, mut because, mut was_tried, mut integrator, left, work_of_path } = trial::choose(scene, budget)?;
    let light_cells = integrator.as_ref().and_then(|integrator| integrator.light_cells().cloned());
    let mut guide = None;
    match guide::why_none(&scene, left) {
        Some(why) => because.directions = why,
        None => {
            let mut ready = integrator.map_or_else(|| Integrator::new(&scene), Ok)?;
            Learned { guide, because: because.directions } = guide::train(&mut ready, left, work_of_path);
            was_tried = true;
            integrator = Some(ready);
        }
    }
    let depends_on_view = was_tried || light_cells.is_some();
    let chose_cells = was_open && light_cells.is_some();
    Ok(Settled { scene, because, light_cells, guide, depends_on_view, integrator, seconds: 0.0, chose_cells })
}

impl Settled<'_> {
    /// A copy of it with a scene of its own.
    fn into_owned(self) -> Settled<'static> {
        let Self { scene, because, light_cells, guide, depends_on_view, integrator, seconds, chose_cells } = self;
        let scene = Cow::Owned(scene.into_owned());
        Settled { scene, because, light_cells, guide, depends_on_view, integrator, seconds, chose_cells }
    }

    /// Gives up cells of lights, for a device on which they have no room, where nobody asked for them:
    /// `local_lights` inside the scene are then chosen by a tree, or by power where they are few. Returns
    /// whether there were cells to give up.
    pub fn gives_up_cells(&mut self, local_lights: usize) -> bool {
        if !std::mem::take(&mut self.chose_cells) {
            return false;
        }
        let choice = if local_lights < MANY_LIGHTS { LightChoice::Power } else { LightChoice::Tree };
        self.scene.to_mut().render.light_choice = choice;
        self.because.light_choice = Some("cells of lights do not fit the device".to_owned());
        self.light_cells = None;
        true
    }
}
