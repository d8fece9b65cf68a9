//! The media that a conversion has met so far, and the shapes that bound them.

use std::collections::HashMap;
use std::rc::Rc;

use glam::DVec3;

use super::plugin::Plugin;

/// Integrators that render media; the others go through them as if they were empty.
const VOLUMETRIC: [&str; 9] =
    ["volpath", "volpathmis", "prbvolpath", "volpath_simple", "bdpt", "mlt", "pssmlt", "erpt", "photonmapper"];
/// Integrators around others.
const AROUND: [&str; 5] = ["aov", "moment", "stokes", "multichannel", "adaptive"];

/// Media, and where they are.
#[derive(Default)]
pub struct MetMedia {
    /// Their names, by their plugins.
    pub names: HashMap<*const Plugin, String>,
    /// The one that the sensor is within.
    pub around_sensor: Option<Rc<Plugin>>,
    /// How reports call the integrator, if that does not render media.
    pub blind: Option<String>,
    pub boundaries: Vec<Boundary>,
    /// The shapes that are met are a group's, which instances place.
    pub in_group: bool,
    /// Materials that enclose a medium, by the names of the material without it and of the medium.
    pub filled: HashMap<(String, String), String>,
    /// Materials that light gets into and is refracted by, by their names.
    pub bodies: HashMap<String, bool>,
    /// The name of a medium that neither takes nor gives.
    pub clear: Option<String>,
}

impl MetMedia {
    /// Notes whether media are rendered.
    pub fn note_integrator(&mut self, plugin: &Plugin) {
        if !AROUND.contains(&plugin.name.as_str()) {
            self.blind = (!VOLUMETRIC.contains(&plugin.name.as_str())).then(|| plugin.title());
        }
    }
}

/// The media on the sides of a shape.
#[derive(Default)]
pub struct Sides {
    /// Behind its surface; none also where nothing would see it.
    pub interior: Option<Rc<Plugin>>,
    /// Before its surface.
    pub exterior: Option<Rc<Plugin>>,
    /// The shape says of a side what is there.
    pub is_boundary: bool,
}

/// A shape that light goes through.
pub struct Boundary {
    pub plugin: Rc<Plugin>,
    /// Its number in the scene.
    pub shape: usize,
    pub sides: Sides,
    /// The lower and upper corner of the box around it; None of what is infinite.
    pub bounds: Option<[DVec3; 2]>,
}

impl Boundary {
    pub fn is_within(&self, other: &Self) -> bool {
        let (Some([low, high]), Some([other_low, other_high])) = (self.bounds, other.bounds) else { return false };
        let slack = (other_high - other_low) * 1e-6;
        low.cmpge(other_low - slack).all() && high.cmple(other_high + slack).all() && self.size() < other.size()
    }

    /// A measure by which boxes are ordered, flat ones too.
    pub fn size(&self) -> f64 {
        self.bounds.map_or(f64::INFINITY, |[low, high]| (high - low).length())
    }
}
