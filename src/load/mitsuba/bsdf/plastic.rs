//! A diffuse base under a dielectric coat.

use std::rc::Rc;

use super::Keyed;
use super::dielectric::relative_ior;
use crate::load::error::SceneError;
use crate::load::import::Keys;
use crate::load::mitsuba::Converter;
use crate::load::mitsuba::plugin::Plugin;

pub fn plastic(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    plugin.without_effect(&["nonlinear", "alpha", "distribution", "sample_visible"]);
    let ior = relative_ior(plugin, "polypropylene")?;
    let diffuse = converter.reflectance(plugin, "diffuse_reflectance", 0.5)?;
    let specular = converter.reflectance(plugin, "specular_reflectance", 1.0)?;
    let what = plugin.title();
    converter.approximate(plugin, &what, "a diffuse surface and a mirror, blended by Fresnel's equations");
    let base = converter.extra(plugin, "plastic, base", Keys::of_type("diffuse").with("reflectance", diffuse.value()));
    let coat = converter.extra(plugin, "plastic, coat", Keys::of_type("mirror").with("reflectance", specular.value()));
    let weight = Keys::of_type("fresnel").with("ior", ior).with("exact", true);
    Ok((Keys::of_type("blend").with("materials", vec![base, coat]).with("weight", weight), false))
}
