//! The principled BSDF of Burley (2012, 2015).

use std::rc::Rc;

use super::Keyed;
use crate::load::error::SceneError;
use crate::load::import::Keys;
use crate::load::mitsuba::Converter;
use crate::load::mitsuba::plugin::Plugin;
use crate::load::mitsuba::texture::Input;

const PARAMETERS: [&str; 12] = [
    "anisotropic",
    "spec_tint",
    "sheen",
    "sheen_tint",
    "clearcoat",
    "clearcoat_gloss",
    "flatness",
    "diff_trans",
    "diffuse_reflectance_sampling_rate",
    "specular_sampling_rate",
    "clearcoat_sampling_rate",
    "main_specular_sampling_rate",
];

/// Metal and dielectric by `metallic`, glass by `spec_trans`.
pub fn principled(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Keyed, SceneError> {
    plugin.without_effect(&PARAMETERS);
    let what = plugin.title();
    converter.approximate(plugin, &what, "a metal, a diffuse surface under a mirror, and glass, blended");
    let colour = converter.reflectance(plugin, "base_color", 0.5)?;
    let roughness = converter.scalar(plugin, "roughness", 0.5)?;
    let metallic = converter.scalar(plugin, "metallic", 0.0)?;
    let transmission = converter.scalar(plugin, "spec_trans", 0.0)?;
    let ior = match plugin.number("eta")? {
        Some(eta) => eta,
        // Reflectance at normal incidence is 0.08 times `specular`.
        None => {
            let root = (0.08 * plugin.number_or("specular", 0.5)?).clamp(0.0, 0.8).sqrt();
            (1.0 + root) / (1.0 - root)
        }
    };
    let ior = ior.clamp(1.0, 10.0);
    let rough = |keys: Keys| keys.with("roughness", clamped(&roughness).value());
    let metal = rough(Keys::of_type("conductor").with("reflectance", colour.value()));
    if is(&metallic, 1.0) {
        return Ok((metal, false));
    }
    let base = converter.extra(plugin, "principled, base", Keys::of_type("diffuse").with("reflectance", colour.value()));
    let coat = converter.extra(plugin, "principled, coat", rough(Keys::of_type("conductor").with("reflectance", 1.0)));
    let weight = Keys::of_type("fresnel").with("ior", ior).with("exact", true);
    let mut keys = Keys::of_type("blend").with("materials", vec![base, coat]).with("weight", weight);
    let mut two_sided = false;
    if !is(&transmission, 0.0) {
        let glass = rough(Keys::of_type("rough_glass").with("ior", ior.max(1.01)).with("transmittance", colour.value()));
        if is(&transmission, 1.0) {
            keys = glass;
        } else {
            let (glass, opaque) =
                (converter.extra(plugin, "principled, glass", glass), converter.extra(plugin, "principled, opaque", keys));
            keys = blended(glass, opaque, &transmission);
        }
        two_sided = true;
    }
    if !is(&metallic, 0.0) {
        let (metal, rest) =
            (converter.extra(plugin, "principled, metal", metal), converter.extra(plugin, "principled, rest", keys));
        keys = blended(metal, rest, &metallic);
    }
    Ok((keys, two_sided))
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
