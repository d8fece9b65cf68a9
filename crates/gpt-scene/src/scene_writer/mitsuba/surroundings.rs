//! The medium around a shape, by the boxes around all bodies.

use glam::DVec3;

/// A shape's place and what it holds.
pub struct Hull {
    pub bounds: [DVec3; 2],
    /// None: nothing.
    pub holds: Option<String>,
}

impl Hull {
    pub fn size(&self) -> f64 {
        self.bounds[0].distance(self.bounds[1])
    }
}

/// The bodies of a scene, by which it is found what is around a shape.
#[derive(Default)]
pub struct Surroundings {
    /// The smallest first.
    pub hulls: Vec<Hull>,
    /// The medium around all of them.
    pub around_camera: Option<String>,
    /// By material: something else is within its surfaces than around them. Empty where the scene has no media.
    pub is_hull: Vec<bool>,
    /// By material: the id of the medium within its bodies. Empty where the scene has no media.
    pub within: Vec<Option<String>>,
}

impl Surroundings {
    /// The id of the medium around a box.
    pub fn around(&self, bounds: Option<[DVec3; 2]>) -> Option<&str> {
        let hull = bounds.and_then(|[low, high]| {
            self.hulls.iter().find(|hull| {
                let slack = (hull.bounds[1] - hull.bounds[0]) * 1e-6;
                let is_within = low.cmpge(hull.bounds[0] - slack).all() && high.cmple(hull.bounds[1] + slack).all();
                is_within && low.distance(high) < hull.size()
            })
        });
        hull.map_or(self.around_camera.as_deref(), |hull| hull.holds.as_deref())
    }
}
