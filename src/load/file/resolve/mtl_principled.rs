//! MTL's keys of physically based materials (`Pr`, `Pm`, `Ps`, `Pc`, `Pcr`, `aniso`, `anisor`, their maps and `norm`), as Blender writes them.

use glam::DVec3;

use crate::load::error::{SceneError, show};
use crate::load::file::resolver::Resolver;
use crate::load::model::MtlMaterial;
use crate::scene::{ChannelInput, ColorInput, ColorSpace, Masking, MaterialKind, Principled, TextureId};

/// Keys of which one makes a material this kind.
const KEYS: [&str; 4] = ["Pr", "Pm", "map_Pr", "map_Pm"];

/// Others, unless they are 0.
const KEYS_OF_SOME: [&str; 6] = ["Ps", "Pc", "aniso", "map_Ps", "map_Pc", "map_aniso"];
/// MTL has no key for the roughness of sheen; this is what Blender, which writes `Ps`, begins with.
const SHEEN_ROUGHNESS: f64 = 0.5;

/// It says its roughness or how much of a metal it is, or has a coat, sheen or a direction.
pub fn is_principled(written: &MtlMaterial) -> bool {
    let params = &written.material.unknown_param;
    let is_zero = |text: &String| text.split_whitespace().all(|word| word.parse() == Ok(0.0));
    KEYS.iter().any(|key| params.contains_key(*key))
        || KEYS_OF_SOME.iter().any(|key| params.get(*key).is_some_and(|text| !is_zero(text)))
}

impl Resolver<'_> {
    /// glTF's metallic-roughness material of these numbers. `Kd` is its base colour and `Ni` its index of refraction; `Ks` and `Ns`, which say
    /// the same once more in the older way, have no effect.
    pub(super) fn mtl_principled(&mut self, written: &MtlMaterial, opacity: f64) -> Result<MaterialKind, SceneError> {
        let base_color = self.mtl_diffuse(written)?;
        let ior = f64::from(written.material.optical_density.unwrap_or(1.5));
        let ior = if (1.0..=10.0).contains(&ior) { ior } else { 1.5 };
        let anisotropy = self.mtl_scalar(written, "aniso", 0.0)?;
        let sheen = self.mtl_scalar(written, "Ps", 0.0)?;
        let rotation = number(written, "anisor")?.unwrap_or(0.0);
        Ok(MaterialKind::Principled(Box::new(Principled {
            base_color,
            metallic: self.mtl_scalar(written, "Pm", 0.0)?,
            roughness: self.mtl_scalar(written, "Pr", 0.5)?,
            ior,
            specular: ColorInput::grey(1.0),
            specular_color: ColorInput::grey(1.0),
            // Blender writes what lets light through by `d` and an illumination model of glass.
            transmission: ColorInput::grey(if opacity < 1.0 && is_glass(written) { 1.0 - opacity } else { 0.0 }),
            thin: false,
            attenuation: None,
            sheen_roughness: ColorInput::grey(if sheen == ColorInput::grey(0.0) { 0.0 } else { SHEEN_ROUGHNESS }),
            sheen_color: sheen,
            energy_compensation: false,
            clearcoat: self.mtl_scalar(written, "Pc", 0.0)?,
            clearcoat_roughness: self.mtl_scalar(written, "Pcr", 0.0)?,
            coat_normal_map: None,
            anisotropy: Some(anisotropy).filter(|strength| *strength != ColorInput::grey(0.0)),
            anisotropy_direction: None,
            // A share of a whole turn.
            anisotropy_rotation_degrees: 360.0 * rotation,
            masking: Masking::Separable,
        })))
    }

    /// The texture of `norm`, a map of normals; `map_Bump` holds heights and says nothing of their unit.
    pub(super) fn mtl_normal_map(&mut self, written: &MtlMaterial) -> Result<Option<TextureId>, SceneError> {
        let Some(map) = written.material.unknown_param.get("norm").cloned() else { return Ok(None) };
        Ok(self.mtl_texture(written, "norm", &map, None, Some(ColorSpace::Linear))?.texture())
    }

    /// A number from 0 to 1, perhaps times the red channel of a map.
    fn mtl_scalar(&mut self, written: &MtlMaterial, key: &str, otherwise: f64) -> Result<ColorInput, SceneError> {
        let factor = number(written, key)?;
        if let Some(wrong) = factor.filter(|factor| *factor > 1.0) {
            let name = &written.material.name;
            self.warn(written, &format!("{key} of the material `{name}` is {wrong}: 1 is taken"));
        }
        let factor = factor.map(|factor| factor.min(1.0));
        let map_key = format!("map_{key}");
        let Some(map) = written.material.unknown_param.get(&map_key).cloned() else {
            return Ok(ColorInput::grey(factor.unwrap_or(otherwise)));
        };
        // Beside a map the number is often 0, which would leave nothing of it.
        let factor = DVec3::splat(factor.filter(|factor| *factor > 0.0).unwrap_or(1.0));
        let texture = self.mtl_texture(written, &map_key, &map, None, Some(ColorSpace::Linear))?;
        let channel = crate::scene::Channel::R;
        Ok(match texture.texture() {
            Some(texture) => ColorInput::Channel(ChannelInput { texture, channel, factor, is_squared: false }),
            None => ColorInput::grey(otherwise),
        })
    }
}

fn is_glass(written: &MtlMaterial) -> bool {
    matches!(written.material.illumination_model, Some(4 | 6 | 7 | 9))
}

fn number(written: &MtlMaterial, key: &str) -> Result<Option<f64>, SceneError> {
    let Some(text) = written.material.unknown_param.get(key) else { return Ok(None) };
    let value: Option<f64> = text.split_whitespace().next().and_then(|word| word.parse().ok());
    match value.filter(|value| (0.0..=1e18).contains(value)) {
        Some(value) => Ok(Some(value)),
        None => {
            let message = format!("the material `{}`: {key}: expected a number from 0 up, found `{text}`", written.material.name);
            Err(SceneError::in_file(show(&written.file), message))
        }
    }
}
