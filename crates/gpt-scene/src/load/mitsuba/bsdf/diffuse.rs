//! Diffuse surfaces.

use std::rc::Rc;

use super::keyed::Keyed;
use crate::load::error::SceneError;
use crate::load::file::material::{MaterialEntry, diffuse as entry};
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::plugin::Plugin;

pub fn diffuse(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    let name = if plugin.has("diffuse_reflectance") { "diffuse_reflectance" } else { "reflectance" };
    let reflectance = converter.reflectance(plugin, name, 0.5)?;
    let reflectance = plugin.possible(reflectance.colour(&plugin.at()))?;
    Ok((MaterialEntry::from(entry::Keys { reflectance, ..Default::default() }), false))
}

/// Oren and Nayar's model.
pub fn rough(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    plugin.without_effect(&["alpha", "use_fast_approx"]);
    converter.approximate(plugin, "bsdf `roughdiffuse`", "a smooth diffuse surface of the same reflectance");
    diffuse(converter, plugin)
}

/// Reflects and transmits by the cosine.
pub fn transmitting(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    plugin.without_effect(&["transmittance"]);
    converter.drop(plugin, "transmittance of bsdf `difftrans`", "it reflects alone");
    diffuse(converter, plugin)
}
