//! Of which scenes a pilot is made, and how much of them it looks at.

use crate::scene::{Scene, SceneSummary};

/// Pixels of a film below which a pilot would take longer than it saves.
const FEWEST_PIXELS: u64 = 1 << 16;
/// Triangles above which the reference's hierarchy, which the pilot needs, takes seconds to build.
const MOST_TRIANGLES: usize = 1 << 20;
/// One of so many pixels is tried, within these numbers.
const ONE_OF_PIXELS: u64 = 1 << 10;
const TRIED_PIXELS: [u64; 2] = [1 << 8, 1 << 10];

fn pixel_count(scene: &Scene) -> u64 {
    scene.film.size.map(u64::from).iter().product()
}

/// The film has too few pixels for a pilot.
pub fn has_few_pixels(scene: &Scene) -> bool {
    pixel_count(scene) < FEWEST_PIXELS
}

/// The scene has too many triangles for a pilot.
pub fn has_many_triangles(scene: &Scene) -> bool {
    let SceneSummary { triangles, group_triangles, .. } = SceneSummary::of(scene);
    triangles + group_triangles > MOST_TRIANGLES
}

/// How many pixels are tried.
pub fn tried_pixels(scene: &Scene) -> u32 {
    let [fewest, most] = TRIED_PIXELS;
    (pixel_count(scene) / ONE_OF_PIXELS).clamp(fewest, most) as u32
}
