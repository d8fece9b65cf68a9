//! Glass and its like.

use std::rc::Rc;

use super::conductor::with_roughness;
use super::keyed::Keyed;
use crate::load::error::SceneError;
use crate::load::import::Keys;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::metals;
use crate::load::mitsuba::plugin::{Plugin, PropertyValue, Spectrum};

pub fn dielectric(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    let ior = relative_ior(plugin, "bk7")?;
    let reflectance = converter.reflectance(plugin, "specular_reflectance", 1.0)?;
    let transmittance = converter.reflectance(plugin, "specular_transmittance", 1.0)?;
    let rough = plugin.name == "roughdielectric";
    let mut keys = Keys::of_type(if rough { "rough_glass" } else { "glass" }).with("ior", ior);
    for (key, input) in [("reflectance", reflectance), ("transmittance", transmittance)] {
        if input.constant() != Some(glam::DVec3::ONE) {
            keys.set(key, input.value());
        }
    }
    if rough {
        keys = with_roughness(converter, plugin, keys)?;
    }
    Ok((keys, true))
}

/// Two surfaces so near to each other that nothing is bent.
pub fn thin(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    dielectric(converter, plugin).map(|(keys, two_sided)| (keys.with("thin", true), two_sided))
}

/// `int_ior` over `ext_ior`, numbers or names.
pub fn relative_ior(plugin: &Plugin, default: &str) -> Result<f64, SceneError> {
    let index = |name: &str, default: &str| -> Result<f64, SceneError> {
        let by_name = |text: &str| {
            metals::dielectric(text).ok_or_else(|| plugin.error(format!("nothing is known of the material `{text}`")))
        };
        match plugin.value(name) {
            None => by_name(default),
            Some(PropertyValue::Text(text)) => by_name(text),
            Some(PropertyValue::Number(number) | PropertyValue::Spectrum(Spectrum::Uniform(number))) => Ok(*number),
            Some(_) => Err(plugin.error(format!("`{name}` is a number or a material's name"))),
        }
    };
    let (inside, outside) = (index("int_ior", default)?, index("ext_ior", "air")?);
    let ior = inside / outside;
    if (0.1..=10.0).contains(&ior) {
        return Ok(ior);
    }
    Err(plugin.error(format!("the index of refraction {inside} within {outside} is not between 0.1 and 10")))
}
