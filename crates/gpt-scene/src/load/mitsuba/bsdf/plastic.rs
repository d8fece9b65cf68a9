//! A diffuse base under a dielectric coat.

use std::rc::Rc;

use super::conductor::distribution;
use super::dielectric::relative_ior;
use super::keyed::Keyed;
use crate::load::error::SceneError;
use crate::load::file::material::roughness::{DistributionEntry, MaskingEntry};
use crate::load::file::material::{MaterialEntry, plastic as entry};
use crate::load::file::value::Checked;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::plugin::Plugin;
use crate::spectrum::Spectrum;

pub fn plastic(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    let ior = relative_ior(plugin, "polypropylene")?;
    let diffuse = converter.reflectance(plugin, "diffuse_reflectance", 0.5)?;
    let specular = converter.reflectance(plugin, "specular_reflectance", 1.0)?;
    let place = plugin.at();
    let mut keys = entry::Keys {
        reflectance: plugin.possible(diffuse.colour(&place))?,
        ior: Some(plugin.possible(Checked::of(ior))?),
        ..Default::default()
    };
    if specular.constant() != Some(Spectrum::WHITE) {
        keys.specular_reflectance = Some(plugin.possible(specular.colour(&place))?);
    }
    keys.nonlinear = plugin.flag("nonlinear", false)?;
    if plugin.name == "roughplastic" {
        let alpha = converter.plain_number(plugin, "alpha", 0.1)?.clamp(0.0, 1.0);
        keys.alpha = Some(place.at(plugin.possible(Checked::of(alpha))?));
        keys.distribution = distribution(converter, plugin)?.then(|| place.at(DistributionEntry::Beckmann));
        keys.masking = Some(place.at(MaskingEntry::Separable));
    }
    Ok((MaterialEntry::from(keys), false))
}
