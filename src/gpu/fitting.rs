//! Scenes as they are packed for a device, and what is given up where they do not fit it.

use std::borrow::Cow;

use crate::binary_tree::parts::KeptTrees;
use crate::learn::{self, Effort, Pace, Settled};
use crate::packed::hierarchy::Traversal;
use crate::packed::{PackError, PackedScene};
use crate::plan::{DeviceLimits, PlanOptions};
use crate::renderer::RenderError;
use crate::scene::Scene;

/// A scene packed with all that was learned about it.
pub struct Fitting<'a> {
    /// The scene with complete settings, and what was learned about it.
    pub settled: Settled<'a>,
    pub packed: PackedScene,
    /// The options of the plan, without what was given up.
    pub options: Cow<'a, PlanOptions>,
    traversal: Traversal,
}

impl<'a> Fitting<'a> {
    /// Learns about the scene, and packs it for a device with these limits, if they are known yet. `kept`:
    /// the trees of an earlier frame.
    ///
    /// # Errors
    /// [`RenderError`] for a scene that is not valid, and for what does not fit the packed form.
    pub fn new(
        scene: &'a Scene,
        limits: Option<&DeviceLimits>,
        options: &'a PlanOptions,
        kept: &mut KeptTrees,
    ) -> Result<Self, RenderError> {
        let traversal = options.packed_traversal(scene, limits);
        let mut settled = learn::settle(scene, effort(limits, options))?;
        // The scene is not to be in memory in both forms.
        settled.integrator = None;
        let packed = pack(&settled, traversal, kept)?;
        Ok(Self { settled, packed, options: Cow::Borrowed(options), traversal })
    }

    /// Packs the scene again without something that nobody asked for, where it did not fit the device:
    /// without cells of lights, which take a buffer more, or else without ray queries. Nothing is learned
    /// again. Returns whether there was something to give up.
    ///
    /// # Errors
    /// [`RenderError`] for what does not fit the packed form.
    pub fn gives_something_up(&mut self, kept: &mut KeptTrees) -> Result<bool, RenderError> {
        if !self.settled.gives_up_cells(self.packed.local_lights) {
            let Some(by_nodes) = self.options.by_nodes_instead_of(self.traversal) else { return Ok(false) };
            self.options = Cow::Owned(by_nodes);
            self.traversal = Traversal::Bvh;
        }
        self.packed = pack(&self.settled, self.traversal, kept)?;
        Ok(true)
    }
}

/// The length of a render with these options on a device with these limits; a device that is not known is taken for a slow one.
pub fn effort(limits: Option<&DeviceLimits>, options: &PlanOptions) -> Effort {
    let is_card = limits.is_some_and(|limits| !limits.software);
    Effort { pace: if is_card { Pace::Card } else { Pace::Processor }, time_limit: options.time_limit }
}

/// Packs a scene with what was learned about it.
fn pack(settled: &Settled<'_>, traversal: Traversal, kept: &mut KeptTrees) -> Result<PackedScene, RenderError> {
    let does_not_fit = |error: PackError| RenderError::DoesNotFit(error.to_string());
    let mut packed = PackedScene::for_frame(&settled.scene, traversal, kept).map_err(does_not_fit)?;
    if let Some(light_cells) = &settled.light_cells {
        packed.set_light_cells(light_cells).map_err(does_not_fit)?;
    }
    packed.guide = settled.guide.as_ref().map_or_else(Vec::new, |guide| guide.words().to_vec());
    packed.light_choice.clone_from(&settled.because.light_choice);
    packed.light_samples.clone_from(&settled.because.light_samples);
    packed.directions.clone_from(&settled.because.directions);
    Ok(packed)
}
