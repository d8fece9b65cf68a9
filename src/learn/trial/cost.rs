//! What things take, as pilots count them: whatever the machine, they choose alike.

/// What things take, in rays of paths with the surfaces that they meet.
pub struct Costs {
    /// What a guide adds to a ray of a path.
    pub guide: f64,
    /// A light sample with its shadow ray.
    pub light_sample: f64,
    /// The way down a tree of lights, and its probability for what paths find.
    pub tree_of_lights: f64,
    /// The same of a list in a cell.
    pub cells_of_lights: f64,
    /// Drawing its point by solid angle, with the density of what paths find.
    pub of_rectangle: f64,
    pub of_triangle: f64,
}

/// Measured on lavapipe (docs/strategies.md; guides: docs/performance.md): geometry that is code, and geometry in a hierarchy; of triangles there, and of trees where geometry is code,
/// by what they take in the other.
pub const SIMPLE: Costs =
    Costs { guide: 1.5, light_sample: 1.0, tree_of_lights: 1.4, cells_of_lights: 0.8, of_rectangle: 0.75, of_triangle: 2.2 };
pub const TRAVERSED: Costs =
    Costs { guide: 0.8, light_sample: 0.8, tree_of_lights: 1.4, cells_of_lights: 0.2, of_rectangle: 0.2, of_triangle: 0.6 };
