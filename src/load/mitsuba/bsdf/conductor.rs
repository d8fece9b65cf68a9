//! Metals.

use std::rc::Rc;

use glam::DVec3;

use super::keyed::Keyed;
use crate::load::error::SceneError;
use crate::load::import::Keys;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::input::Input;
use crate::load::mitsuba::metals;
use crate::load::mitsuba::plugin::{Plugin, PropertyValue};

pub fn conductor(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    let tint = converter.reflectance(plugin, "specular_reflectance", 1.0)?;
    let material = plugin.text("material")?.map(str::to_owned);
    // `k` alone changes nothing where a material is named.
    let given = plugin.has("eta") || material.as_deref().is_none_or(is_none) && plugin.has("k");
    let fresnel = match material.as_deref() {
        _ if plugin.name == "mirror" => None,
        _ if given => Some(complex(converter, plugin)?),
        None => None,
        Some(name) if is_none(name) => None,
        Some(name) => Some(metals::conductor(name).unwrap_or_else(|| {
            let what = format!("conductor of the material `{name}`");
            converter.approximate(plugin, &what, "chromium is taken");
            metals::conductor("cr").unwrap_or_default()
        })),
    };
    let rough = plugin.name == "roughconductor";
    let Some(fresnel) = fresnel else {
        // Reflects all light: what is left is the tint.
        if !rough {
            return Ok((Keys::of_type("mirror").with("reflectance", tint.value()), false));
        }
        let mut keys = Keys::of_type("conductor").with("reflectance", 1.0);
        if tint.constant() != Some(DVec3::ONE) {
            keys.set("specular_reflectance", tint.value());
        }
        return Ok((with_roughness(converter, plugin, keys)?, false));
    };
    let mut keys = Keys::of_type("conductor");
    keys.0.extend(fresnel.0);
    if tint.constant() != Some(DVec3::ONE) {
        keys.set("specular_reflectance", tint.value());
    }
    if rough {
        keys = with_roughness(converter, plugin, keys)?;
    }
    Ok((keys, false))
}

fn is_none(material: &str) -> bool {
    material.eq_ignore_ascii_case("none")
}

/// `eta` and `k`, relative to what is outside.
fn complex(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keys, SceneError> {
    let mut constant = |name: &str, default: f64| -> Result<DVec3, SceneError> {
        let input = converter.surface_number(plugin, name, default)?;
        if input.constant().is_none() {
            let what = format!("texture of `{name}` of a conductor");
            converter.approximate(plugin, &what, "its mean is taken");
        }
        Ok(converter.mean(&input))
    };
    let (eta, k) = (constant("eta", 0.0)?, constant("k", 1.0)?);
    let outside = outside(plugin, "ext_eta")?;
    // An index of 0 is a perfect mirror, which a small one is as well.
    let eta = (eta / outside).max(DVec3::splat(1e-4));
    Ok(Keys::new().with("eta", Input::Constant(eta).value()).with("k", Input::Constant((k / outside).max(DVec3::ZERO)).value()))
}

/// The index of refraction of what is outside, a number or a name; of vacuum where nothing is said.
fn outside(plugin: &Plugin, name: &str) -> Result<f64, SceneError> {
    match plugin.value(name) {
        Some(PropertyValue::Text(text)) => {
            metals::dielectric(text).ok_or_else(|| plugin.error(format!("nothing is known of the material `{text}`")))
        }
        Some(PropertyValue::Number(number)) if *number > 0.0 => Ok(*number),
        _ => Ok(1.0),
    }
}

/// The distribution of microfacets: Mitsuba's masks and shadows them separately.
pub fn with_roughness(converter: &mut Converter, plugin: &Rc<Plugin>, keys: Keys) -> Result<Keys, SceneError> {
    let clamped = |input: Input| match input {
        Input::Constant(alpha) => Input::grey(alpha.x.clamp(0.0, 1.0)),
        texture => texture,
    };
    let keys = if plugin.has("alpha_u") || plugin.has("alpha_v") {
        let (u, v) = (converter.scalar(plugin, "alpha_u", 0.1)?, converter.scalar(plugin, "alpha_v", 0.1)?);
        if u == v {
            keys.with("alpha", clamped(u).value())
        } else {
            keys.with("alpha_u", clamped(u).value()).with("alpha_v", clamped(v).value())
        }
    } else {
        let alpha = converter.scalar(plugin, "alpha", 0.1)?;
        keys.with("alpha", clamped(alpha).value())
    };
    with_distribution(converter, plugin, keys)
}

/// `distribution` and `masking`.
pub fn with_distribution(converter: &mut Converter, plugin: &Rc<Plugin>, keys: Keys) -> Result<Keys, SceneError> {
    plugin.without_effect(&["sample_visible", "sample_all"]);
    let keys = match plugin.text("distribution")?.unwrap_or("beckmann").to_ascii_lowercase().as_str() {
        "ggx" => keys,
        "beckmann" => keys.with("distribution", "beckmann"),
        other => {
            let what = format!("distribution `{other}` of microfacets");
            converter.approximate(plugin, &what, "Beckmann's of the same width is taken");
            keys.with("distribution", "beckmann")
        }
    };
    Ok(keys.with("masking", "separable"))
}
