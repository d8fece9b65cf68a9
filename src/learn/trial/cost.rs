//! Costs of the ways to draw from lights, as trial runs count them.
//!
//! All of them were measured on lavapipe, Mesa's Vulkan on the CPU; none was measured on hardware. They hold
//! for every device all the same: the choice is one of the scene, or parts of a picture from different
//! devices would not share it, and the two devices would not follow the same paths. On hardware, which traces
//! rays at other prices, the choice may therefore not be the fastest.

/// Costs in rays of paths, each with the surface that it meets.
pub struct Costs {
    /// The guide's part of a ray of a path.
    pub guide: f64,
    /// A light sample with its shadow ray.
    pub light_sample: f64,
    /// The way down a tree of lights, and its probability for what paths find.
    pub tree_of_lights: f64,
    /// The choice from a cell's list of lights, and its probability for what paths find.
    pub cells_of_lights: f64,
    /// A point of a rectangle by solid angle, with the density of what paths find.
    pub of_rectangle: f64,
    /// A point of a triangle by solid angle, with the density of what paths find.
    pub of_triangle: f64,
}

/// Costs where geometry is code (docs/strategies.md; guides: docs/notes/2026-11-28-when-guiding-pays.md). That of a tree is taken
/// from [`TRAVERSED`].
const SIMPLE: Costs =
    Costs { guide: 1.5, light_sample: 1.0, tree_of_lights: 1.4, cells_of_lights: 0.8, of_rectangle: 0.75, of_triangle: 2.2 };
/// Costs where geometry is in a hierarchy. That of a triangle is to that of a rectangle as in [`SIMPLE`].
const TRAVERSED: Costs =
    Costs { guide: 0.8, light_sample: 0.8, tree_of_lights: 1.4, cells_of_lights: 0.2, of_rectangle: 0.2, of_triangle: 0.6 };

/// Costs in a scene of so few primitives that its geometry is code, or in another one.
pub fn costs(is_simple: bool) -> &'static Costs {
    if is_simple { &SIMPLE } else { &TRAVERSED }
}
