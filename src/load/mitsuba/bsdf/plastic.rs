//! A diffuse base under a dielectric coat.

use std::rc::Rc;

use glam::DVec3;

use super::conductor::with_distribution;
use super::dielectric::relative_ior;
use super::keyed::Keyed;
use crate::load::error::SceneError;
use crate::load::import::Keys;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::plugin::Plugin;

pub fn plastic(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    let ior = relative_ior(plugin, "polypropylene")?;
    let diffuse = converter.reflectance(plugin, "diffuse_reflectance", 0.5)?;
    let specular = converter.reflectance(plugin, "specular_reflectance", 1.0)?;
    let mut keys = Keys::of_type("plastic").with("reflectance", diffuse.value()).with("ior", ior);
    if specular.constant() != Some(DVec3::ONE) {
        keys.set("specular_reflectance", specular.value());
    }
    if plugin.flag("nonlinear", false)? {
        keys.set("nonlinear", true);
    }
    if plugin.name == "roughplastic" {
        let alpha = converter.plain_number(plugin, "alpha", 0.1)?.clamp(0.0, 1.0);
        keys = with_distribution(converter, plugin, keys.with("alpha", alpha))?;
    }
    Ok((keys, false))
}
