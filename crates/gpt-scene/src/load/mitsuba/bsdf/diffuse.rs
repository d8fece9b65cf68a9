//! Diffuse surfaces.

use std::rc::Rc;

use super::keyed::Keyed;
use crate::load::error::SceneError;
use crate::load::file::colour::Scalar;
use crate::load::file::material::{MaterialEntry, diffuse as entry, oren_nayar};
use crate::load::file::value::Checked;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::plugin::Plugin;

pub fn diffuse(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    let name = if plugin.has("diffuse_reflectance") { "diffuse_reflectance" } else { "reflectance" };
    let reflectance = converter.reflectance(plugin, name, 0.5)?;
    let reflectance = plugin.possible(reflectance.colour(&plugin.at()))?;
    Ok((MaterialEntry::from(entry::Keys { reflectance, ..Default::default() }), false))
}

/// Mitsuba 0.6 takes `alpha` for the root mean square of slopes, of which the facets' angles deviate by this share.
const ANGLE_OF_SLOPE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Oren and Nayar's model: the whole one, or with `useFastApprox` the qualitative one.
pub fn rough(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    let reflectance = converter.reflectance(plugin, "reflectance", 0.5)?;
    let reflectance = plugin.possible(reflectance.colour(&plugin.at()))?;
    let roughness = (converter.plain_number(plugin, "alpha", 0.2)? * ANGLE_OF_SLOPE).clamp(0.0, 1.0);
    let is_simple = plugin.flag("use_fast_approx", false)?;
    let model = Some(if is_simple { oren_nayar::RoughDiffuseEntry::Qualitative } else { oren_nayar::RoughDiffuseEntry::Full });
    let roughness = Some(Scalar::Constant(plugin.possible(Checked::of(roughness))?));
    Ok((MaterialEntry::from(oren_nayar::Keys { reflectance, roughness, model, ..Default::default() }), false))
}

/// Reflects and transmits by the cosine.
pub fn transmitting(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    plugin.without_effect(&["transmittance"]);
    converter.drop(plugin, "transmittance of bsdf `difftrans`", "it reflects alone");
    diffuse(converter, plugin)
}
