//! Scenes that are worth learning about.

use crate::scene::{Scene, SceneSummary};

/// Pixels of a film below which learning takes longer than it saves.
const FEWEST_PIXELS: u64 = 1 << 16;
/// Triangles above which the reference's hierarchy, which learning needs, takes seconds to build.
const MOST_TRIANGLES: usize = 1 << 20;

/// Pixels of the scene's film.
pub fn pixel_count(scene: &Scene) -> u64 {
    scene.film.size.map(u64::from).iter().product()
}

/// Says that the film has too few pixels to learn for.
pub fn has_few_pixels(scene: &Scene) -> bool {
    pixel_count(scene) < FEWEST_PIXELS
}

/// Says that the scene has too many triangles to learn from.
pub fn has_many_triangles(scene: &Scene) -> bool {
    let SceneSummary { triangles, group_triangles, .. } = SceneSummary::of(scene);
    triangles + group_triangles > MOST_TRIANGLES
}
