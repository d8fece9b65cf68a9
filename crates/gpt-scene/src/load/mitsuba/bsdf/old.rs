//! BSDFs of versions before 2.

use std::rc::Rc;

use super::dielectric::relative_ior;
use super::keyed::Keyed;
use crate::load::error::SceneError;
use crate::load::file::material::blend_weight::{BlendWeightEntry, FresnelWeight};
use crate::load::file::material::{MaterialEntry, blend, mirror, phong as phong_entry};
use crate::load::file::value::Checked;
use crate::load::import::Input;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::plugin::Plugin;

/// Modified Phong, which both programs have; Ward's model is said by it.
pub fn phong(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    let diffuse = converter.reflectance(plugin, "diffuse_reflectance", 0.5)?;
    let specular = converter.reflectance(plugin, "specular_reflectance", 0.2)?;
    let exponent = if plugin.name == "ward" {
        plugin.without_effect(&["variant"]);
        converter.approximate(plugin, "bsdf `ward`", "a Phong lobe about as wide");
        let alpha = plugin.number_or("alpha_u", plugin.number_or("alpha", 0.1)?)?;
        let _ = plugin.number("alpha_v")?;
        Input::grey((2.0 / alpha.clamp(1e-3, 1.0).powi(2) - 2.0).max(0.0))
    } else {
        converter.scalar(plugin, "exponent", 30.0)?
    };
    let place = plugin.at();
    let keys = phong_entry::Keys {
        diffuse: plugin.possible(diffuse.colour(&place))?,
        specular: place.at(plugin.possible(specular.colour(&place))?),
        exponent: plugin.possible(exponent.scalar(&place))?,
        ..Default::default()
    };
    Ok((MaterialEntry::from(keys), false))
}

/// A dielectric layer over another BSDF.
pub fn coating(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    plugin.without_effect(&["thickness", "sigma_a", "alpha", "distribution", "sample_visible", "sample_all"]);
    let ior = relative_ior(plugin, "bk7")?;
    let specular = converter.reflectance(plugin, "specular_reflectance", 1.0)?;
    let parts = converter.parts(plugin, depth)?;
    let Some(base) = parts.names.first().cloned() else { return Err(plugin.error("a coating needs a bsdf within")) };
    let what = plugin.title();
    converter.approximate(plugin, &what, "a mirror over what is below, blended by Fresnel's equations");
    let place = plugin.at();
    let reflectance = Some(plugin.possible(specular.colour(&place))?);
    let mirror = MaterialEntry::from(mirror::Keys { reflectance, ..Default::default() });
    let coat = converter.extra(plugin, "coat", mirror);
    let ior = Some(plugin.possible(Checked::of(ior))?);
    let weight = BlendWeightEntry::Fresnel(FresnelWeight { ior, exact: true });
    let blend = MaterialEntry::from(blend::Keys::of([base, coat], weight, &place));
    Ok((parts.relief.given_to(blend), false))
}
