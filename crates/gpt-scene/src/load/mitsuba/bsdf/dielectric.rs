//! Glass and its like.

use std::rc::Rc;

use super::conductor::{Widths, distribution, widths};
use super::keyed::Keyed;
use crate::load::error::SceneError;
use crate::load::file::colour::Colour;
use crate::load::file::material::rough_glass::MicrofacetEntry;
use crate::load::file::material::roughness::MaskingEntry;
use crate::load::file::material::{MaterialEntry, glass, rough_glass};
use crate::load::file::value::{Checked, Fraction};
use crate::load::import::Input;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::metals;
use crate::load::mitsuba::plugin::{Plugin, PropertyValue, SpectralCurve};
use crate::spectrum::Spectrum;

/// Glass; a thin one is two surfaces so near to each other that nothing is refracted.
pub fn dielectric(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    let ior = relative_ior(plugin, "bk7")?;
    let reflectance = converter.reflectance(plugin, "specular_reflectance", 1.0)?;
    let transmittance = converter.reflectance(plugin, "specular_transmittance", 1.0)?;
    let place = plugin.at();
    let tint = |input: Input| -> Result<Option<Colour<Fraction>>, SceneError> {
        let tint = Some(input).filter(|input| input.constant() != Some(Spectrum::WHITE));
        tint.map(|input| plugin.possible(input.colour(&place))).transpose()
    };
    let (ior, reflectance, transmittance) =
        (Some(place.at(plugin.possible(Checked::of(ior))?)), tint(reflectance)?, tint(transmittance)?);
    if plugin.name != "roughdielectric" {
        let thin = plugin.name == "thindielectric";
        let keys = glass::Keys { ior, reflectance, transmittance, thin, ..Default::default() };
        return Ok((MaterialEntry::from(keys), true));
    }
    let Widths { alpha, alpha_u, alpha_v } = widths(converter, plugin)?;
    let keys = rough_glass::Keys {
        ior,
        reflectance,
        transmittance,
        alpha,
        alpha_u,
        alpha_v,
        distribution: distribution(converter, plugin)?.then(|| place.at(MicrofacetEntry::Beckmann)),
        masking: Some(place.at(MaskingEntry::Separable)),
        ..Default::default()
    };
    Ok((MaterialEntry::from(keys), true))
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
            Some(PropertyValue::Number(number) | PropertyValue::Spectrum(SpectralCurve::Uniform(number))) => Ok(*number),
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
