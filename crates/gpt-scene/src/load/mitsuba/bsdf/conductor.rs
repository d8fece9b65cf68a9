//! Metals.

use std::rc::Rc;

use super::keyed::Keyed;
use crate::load::error::SceneError;
use crate::load::file::colour::{Rgb, Scalar};
use crate::load::file::material::roughness::{DistributionEntry, MaskingEntry};
use crate::load::file::material::{MaterialEntry, conductor as entry, mirror};
use crate::load::file::value::{Fraction, Located};
use crate::load::import::Input;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::metals::{self, Metal};
use crate::load::mitsuba::plugin::{Plugin, PropertyValue};
use crate::spectrum::Spectrum;

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
            metals::conductor("cr").unwrap_or(Metal::Preset(entry::MetalEntry::Aluminium))
        })),
    };
    let rough = plugin.name == "roughconductor";
    let place = plugin.at();
    if let (None, false) = (&fresnel, rough) {
        // Reflects all light: what is left is the tint.
        let reflectance = Some(plugin.possible(tint.colour(&place))?);
        return Ok((MaterialEntry::from(mirror::Keys { reflectance, ..Default::default() }), false));
    }
    let mut keys = entry::Keys::default();
    match fresnel {
        Some(Metal::Preset(preset)) => keys.preset = Some(place.at(preset)),
        Some(Metal::Constants { eta, k }) => {
            keys.eta = Some(place.at(plugin.possible(Rgb::of(eta))?));
            keys.k = Some(place.at(plugin.possible(Rgb::of(k))?));
        }
        None => keys.reflectance = Some(place.at(plugin.possible(Input::grey(1.0).colour(&place))?)),
    }
    if tint.constant() != Some(Spectrum::WHITE) {
        keys.specular_reflectance = Some(plugin.possible(tint.colour(&place))?);
    }
    if rough {
        let Widths { alpha, alpha_u, alpha_v } = widths(converter, plugin)?;
        (keys.alpha, keys.alpha_u, keys.alpha_v) = (alpha, alpha_u, alpha_v);
        keys.distribution = distribution(converter, plugin)?.then(|| place.at(DistributionEntry::Beckmann));
        keys.masking = Some(place.at(MaskingEntry::Separable));
    }
    Ok((MaterialEntry::from(keys), false))
}

fn is_none(material: &str) -> bool {
    material.eq_ignore_ascii_case("none")
}

/// `eta` and `k`, relative to what is outside.
fn complex(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Metal, SceneError> {
    let mut constant = |name: &str, default: f64| -> Result<Spectrum, SceneError> {
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
    let eta = (eta / outside).max(Spectrum::grey(1e-4));
    Ok(Metal::Constants { eta, k: (k / outside).max(Spectrum::BLACK) })
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

/// The widths of microfacets: the same in all directions, or along and across the texture coordinate u.
#[derive(Default)]
pub struct Widths {
    pub alpha: Option<Located<Scalar<Fraction>>>,
    pub alpha_u: Option<Located<Scalar<Fraction>>>,
    pub alpha_v: Option<Located<Scalar<Fraction>>>,
}

/// `alpha`, or `alpha_u` and `alpha_v`.
pub fn widths(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Widths, SceneError> {
    let clamped = |input: Input| {
        let input = match input {
            Input::Constant(alpha) => Input::grey(alpha.r().clamp(0.0, 1.0)),
            texture => texture,
        };
        plugin.possible(input.scalar(&plugin.at())).map(|alpha| Some(plugin.at().at(alpha)))
    };
    if !plugin.has("alpha_u") && !plugin.has("alpha_v") {
        let alpha = converter.scalar(plugin, "alpha", 0.1)?;
        return Ok(Widths { alpha: clamped(alpha)?, ..Widths::default() });
    }
    let (u, v) = (converter.scalar(plugin, "alpha_u", 0.1)?, converter.scalar(plugin, "alpha_v", 0.1)?);
    if u == v {
        return Ok(Widths { alpha: clamped(u)?, ..Widths::default() });
    }
    Ok(Widths { alpha: None, alpha_u: clamped(u)?, alpha_v: clamped(v)? })
}

/// True where the distribution of microfacets is Beckmann's; else it is GGX. Mitsuba's masks and shadows them
/// separately.
pub fn distribution(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<bool, SceneError> {
    plugin.without_effect(&["sample_visible", "sample_all"]);
    match plugin.text("distribution")?.unwrap_or("beckmann").to_ascii_lowercase().as_str() {
        "ggx" => return Ok(false),
        "beckmann" => {}
        other => {
            let what = format!("distribution `{other}` of microfacets");
            converter.approximate(plugin, &what, "Beckmann's of the same width is taken");
        }
    }
    Ok(true)
}
