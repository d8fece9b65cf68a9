//! The principled BSDF of Burley (2012, 2015).

use std::rc::Rc;

use super::keyed::Keyed;
use crate::load::error::SceneError;
use crate::load::file::material::{MaterialEntry, principled as entry};
use crate::load::file::value::Checked;
use crate::load::import::Input;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::plugin::Plugin;

const PARAMETERS: [&str; 9] = [
    "spec_tint",
    "sheen",
    "sheen_tint",
    "flatness",
    "diff_trans",
    "diffuse_reflectance_sampling_rate",
    "specular_sampling_rate",
    "clearcoat_sampling_rate",
    "main_specular_sampling_rate",
];

/// The principled material of glTF, which is near.
pub fn principled(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    plugin.without_effect(&PARAMETERS);
    let what = plugin.title();
    converter.approximate(plugin, &what, "the principled material of glTF, whose base is Lambert's");
    let colour = converter.reflectance(plugin, "base_color", 0.5)?;
    let transmission = converter.scalar(plugin, "spec_trans", 0.0)?;
    let ior = match plugin.number("eta")? {
        Some(eta) => eta,
        // Reflectance at normal incidence is 0.08 times `specular`.
        None => {
            let root = (0.08 * plugin.number_or("specular", 0.5)?).clamp(0.0, 0.8).sqrt();
            (1.0 + root) / (1.0 - root)
        }
    };
    let place = plugin.at();
    let share = |input: &Input| plugin.possible(clamped(input).scalar(&place));
    let (metallic, roughness) = (converter.scalar(plugin, "metallic", 0.0)?, converter.scalar(plugin, "roughness", 0.5)?);
    let mut keys = entry::Keys {
        base_color: Some(plugin.possible(colour.colour(&place))?),
        metallic: Some(share(&metallic)?),
        roughness: Some(share(&roughness)?),
        ior: Some(plugin.at().at(plugin.possible(Checked::of(ior.clamp(1.0, 10.0)))?)),
        ..Default::default()
    };
    let see_through = !is(&transmission, 0.0);
    if see_through {
        keys.transmission = Some(share(&transmission)?);
        keys.thin = (plugin.name == "principledthin").then(|| place.at(true));
    }
    let coat = converter.scalar(plugin, "clearcoat", 0.0)?;
    if !is(&coat, 0.0) {
        keys.clearcoat = Some(share(&coat)?);
        let gloss = converter.plain_number(plugin, "clearcoat_gloss", 0.0)?.clamp(0.0, 1.0);
        // The coat's width goes from 0.1 to 0.001 there; a roughness is its root.
        keys.clearcoat_roughness = Some(place.at(share(&Input::grey((0.1 + (0.001 - 0.1) * gloss).sqrt()))?));
    }
    let anisotropic = converter.plain_number(plugin, "anisotropic", 0.0)?;
    if anisotropic > 0.0 {
        keys.anisotropy = Some(Box::new(share(&Input::grey(anisotropic))?));
    }
    // A thin one scatters on both sides.
    Ok((MaterialEntry::from(keys), see_through || plugin.name == "principledthin"))
}

fn is(input: &Input, value: f64) -> bool {
    input.constant().is_some_and(|constant| constant.r() == value)
}

fn clamped(input: &Input) -> Input {
    match input {
        Input::Constant(value) => Input::grey(value.r().clamp(0.0, 1.0)),
        texture => texture.clone(),
    }
}
