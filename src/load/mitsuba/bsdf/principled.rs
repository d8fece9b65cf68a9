//! The principled BSDF of Burley (2012, 2015).

use std::rc::Rc;

use super::keyed::Keyed;
use crate::load::error::SceneError;
use crate::load::import::Keys;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::input::Input;
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
    let mut keys = Keys::of_type("principled").with("base_color", colour.value());
    for (ours, theirs, default) in [("metallic", "metallic", 0.0), ("roughness", "roughness", 0.5)] {
        let input = converter.scalar(plugin, theirs, default)?;
        keys.set(ours, clamped(&input).value());
    }
    keys.set("ior", ior.clamp(1.0, 10.0));
    let see_through = !is(&transmission, 0.0);
    if see_through {
        keys.set("transmission", clamped(&transmission).value());
        if plugin.name == "principledthin" {
            keys.set("thin", true);
        }
    }
    let coat = converter.scalar(plugin, "clearcoat", 0.0)?;
    if !is(&coat, 0.0) {
        keys.set("clearcoat", clamped(&coat).value());
        let gloss = converter.plain_number(plugin, "clearcoat_gloss", 0.0)?.clamp(0.0, 1.0);
        // The coat's width goes from 0.1 to 0.001 there; a roughness is its root.
        keys.set("clearcoat_roughness", (0.1 + (0.001 - 0.1) * gloss).sqrt());
    }
    let anisotropic = converter.plain_number(plugin, "anisotropic", 0.0)?;
    if anisotropic > 0.0 {
        keys.set("anisotropy", anisotropic.clamp(0.0, 1.0));
    }
    // A thin one scatters on both sides.
    Ok((keys, see_through || plugin.name == "principledthin"))
}

fn is(input: &Input, value: f64) -> bool {
    input.constant().is_some_and(|constant| constant.x == value)
}

fn clamped(input: &Input) -> Input {
    match input {
        Input::Constant(value) => Input::grey(value.x.clamp(0.0, 1.0)),
        texture => texture.clone(),
    }
}

/// The first by a share that may come from a texture.
pub fn blended(first: crate::load::import::Value, second: crate::load::import::Value, share: &Input) -> Keys {
    Keys::of_type("blend").with("materials", vec![first, second]).with("weight", weight(share))
}

/// A blend's weight.
pub fn weight(share: &Input) -> Keys {
    match share {
        Input::Constant(share) => Keys::of_type("constant").with("value", share.x.clamp(0.0, 1.0)),
        // The first channel: masks are grey.
        Input::Texture(name, factor) => {
            let keys = Keys::of_type("texture").with("texture", name.as_str()).with("channel", "r");
            keys.with_some("factor", (factor.x != 1.0).then_some(factor.x.clamp(0.0, 1.0)))
        }
    }
}
