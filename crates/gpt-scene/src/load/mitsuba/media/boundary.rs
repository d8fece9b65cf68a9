//! The media that shapes name, on both of their sides.

use std::rc::Rc;

use crate::load::error::SceneError;
use crate::load::import::Sides;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::plugin::Plugin;

impl Converter<'_> {
    /// True of a shape of a version before 2 that bounds a medium by itself: it has no BSDF and no emitter.
    pub fn is_bare_boundary(&self, shape: &Plugin) -> bool {
        let is_boundary = shape.children.iter().any(|child| child.plugin.kind == "medium");
        let gives_light = shape.children.iter().any(|child| child.plugin.kind == "emitter");
        self.reader.is_of_old && is_boundary && !gives_light
    }

    /// The media that a shape names.
    pub fn boundary(&mut self, shape: &Rc<Plugin>, has_bsdf: bool) -> Result<Sides, SceneError> {
        let medium = |name: &str| shape.child(name).filter(|child| child.kind == "medium").cloned();
        let (interior, exterior) = (medium("interior"), medium("exterior"));
        let is_boundary = interior.is_some() || exterior.is_some();
        if !is_boundary || self.leaves_media_out(shape) {
            return Ok(Sides::default());
        }
        if !has_bsdf && !self.is_bare_boundary(shape) {
            let instead = "nothing shows it: without a BSDF the shape is a diffuse surface, as in version 3.9.1; with `null` it would be a boundary alone";
            self.drop(shape, "medium of a shape without a BSDF", instead);
            return Ok(Sides::default());
        }
        let mut named = |medium: Option<Rc<Plugin>>| medium.map(|medium| self.medium(&medium)).transpose();
        Ok(Sides { inside: named(interior)?, outside: named(exterior)?, is_boundary })
    }
}
