//! Scenes that are worth learning about.

use crate::scene::{Geometry, Guiding, Scene, SceneSummary};

/// Triangles above which the reference's hierarchy, which learning needs, takes seconds to build.
const MOST_TRIANGLES: usize = 1 << 20;

/// Pixels of the scene's film.
pub fn pixel_count(scene: &Scene) -> u64 {
    scene.film.size.map(u64::from).iter().product()
}

/// Triangles of the scene, a group's once however often it stands there.
pub fn triangle_count(scene: &Scene) -> usize {
    let SceneSummary { triangles, group_triangles, .. } = SceneSummary::of(scene);
    triangles + group_triangles
}

/// Says that the scene has too many triangles to learn from.
pub fn has_many_triangles(scene: &Scene) -> bool {
    triangle_count(scene) > MOST_TRIANGLES
}

/// Says that light depends on where paths go on: paths of one edge scatter nowhere.
pub fn paths_scatter(scene: &Scene) -> bool {
    scene.render.max_depth != 1
}

/// Says that a guide is to be learned if it pays, and that it may.
pub fn guide_may_pay(scene: &Scene) -> bool {
    scene.render.guiding == Guiding::Auto && paths_scatter(scene) && !has_many_triangles(scene)
}

/// Says that a surface with straight edges may give light, whose points can be drawn by solid angle.
pub fn has_flat_lights(scene: &Scene) -> bool {
    let emits = scene.materials_that(|material| material.emission.is_some());
    let is_flat = |geometry: &Geometry| matches!(geometry, Geometry::Mesh(_) | Geometry::Box(_) | Geometry::Rectangle(_));
    scene.shapes.iter().any(|shape| is_flat(&shape.geometry) && shape.materials().any(|id| emits.get(id) == Some(&true)))
}
