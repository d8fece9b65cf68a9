//! The intervals of a render of one scene.

use crate::confidence::{IntervalBasis, IntervalGoal, IntervalOptions};
use crate::reference::sample_bound::sample_bound;
use crate::scene::Scene;
use crate::spectrum::Spectrum;

/// The goal of a render of this scene: intervals stand on the bound of its samples, if it has one and nothing else was asked for.
pub fn interval_goal(scene: &Scene, options: &IntervalOptions) -> IntervalGoal {
    let bound = if options.by == Some(IntervalBasis::Seen) { None } else { sample_bound(scene).ok() };
    let by = if bound.is_some() { IntervalBasis::Bound } else { IntervalBasis::Seen };
    IntervalGoal { options: IntervalOptions { by: Some(by), ..*options }, sample_bound: bound.map(Spectrum::to_rgb) }
}
