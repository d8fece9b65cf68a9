//! The media that a conversion has met so far, and the shapes that bound them.

use std::collections::HashMap;

use super::plugin::Plugin;
use crate::load::import::Enclosures;

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
    /// How reports call the integrator, if that does not render media.
    pub blind: Option<String>,
    pub enclosures: Enclosures,
    /// The shapes that are met are a group's, which instances place.
    pub in_group: bool,
}

impl MetMedia {
    /// Notes whether media are rendered.
    pub fn note_integrator(&mut self, plugin: &Plugin) {
        if !AROUND.contains(&plugin.name.as_str()) {
            self.blind = (!VOLUMETRIC.contains(&plugin.name.as_str())).then(|| plugin.title());
        }
    }
}
