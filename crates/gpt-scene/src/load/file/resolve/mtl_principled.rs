//! MTL's keys of physically based materials (`Pr`, `Pm`, `Ps`, `Pc`, `Pcr`, `aniso`, `anisor`, their maps and `norm`), as Blender writes them.

use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::model::{MtlKey, MtlMaterial};
use crate::scene::{Channel, ChannelInput, ColorInput, ColorSpace, Masking, MaterialKind, Principled};
use crate::spectrum::Spectrum;

/// Keys of which one makes a material this kind.
const KEYS: [MtlKey; 4] = ["Pr", "Pm", "map_Pr", "map_Pm"];

/// Others, unless they are 0.
const KEYS_OF_SOME: [MtlKey; 6] = ["Ps", "Pc", "aniso", "map_Ps", "map_Pc", "map_aniso"];
/// MTL has no key for the roughness of sheen; this is what Blender, which writes `Ps`, begins with.
const SHEEN_ROUGHNESS: f64 = 0.5;

/// True where the material states a roughness or metalness, or has a coat, sheen or a direction.
pub fn is_principled(written: &MtlMaterial) -> bool {
    let is_written = |key: &MtlKey| written.maps.contains_key(key) || written.numbers.contains_key(key);
    let is_some = |key: &MtlKey| written.maps.contains_key(key) || written.number(key).is_some_and(|number| number != 0.0);
    KEYS.iter().any(is_written) || KEYS_OF_SOME.iter().any(is_some)
}

impl Resolver<'_> {
    /// glTF's metallic-roughness material of these numbers. `Kd` is its base colour and `Ni` its index of refraction; `Ks` and `Ns`, which say
    /// the same once more in the older way, have no effect.
    pub(super) fn mtl_principled(&mut self, written: &MtlMaterial, opacity: f64) -> Result<MaterialKind, SceneError> {
        let base_color = self.mtl_diffuse(written)?;
        let ior = written.number("Ni").filter(|ior| (1.0..=10.0).contains(ior)).unwrap_or(1.5);
        let anisotropy = self.mtl_scalar(written, ["aniso", "map_aniso"], 0.0)?;
        let sheen = self.mtl_scalar(written, ["Ps", "map_Ps"], 0.0)?;
        let rotation = written.number("anisor").unwrap_or(0.0);
        Ok(MaterialKind::Principled(Box::new(Principled {
            base_color,
            metallic: self.mtl_scalar(written, ["Pm", "map_Pm"], 0.0)?,
            roughness: self.mtl_scalar(written, ["Pr", "map_Pr"], 0.5)?,
            ior,
            dispersion: None,
            specular: ColorInput::grey(1.0),
            specular_color: ColorInput::grey(1.0),
            // Blender writes what lets light through by `d` and an illumination model of glass.
            transmission: ColorInput::grey(if opacity < 1.0 && is_glass(written) { 1.0 - opacity } else { 0.0 }),
            diffuse_transmission: ColorInput::grey(0.0),
            diffuse_transmission_color: ColorInput::grey(1.0),
            subsurface: None,
            thin: false,
            attenuation: None,
            sheen_roughness: ColorInput::grey(if sheen == ColorInput::grey(0.0) { 0.0 } else { SHEEN_ROUGHNESS }),
            sheen_color: sheen,
            energy_compensation: false,
            clearcoat: self.mtl_scalar(written, ["Pc", "map_Pc"], 0.0)?,
            clearcoat_roughness: self.mtl_scalar(written, ["Pcr", "map_Pcr"], 0.0)?,
            coat_normal_map: None,
            anisotropy: Some(anisotropy).filter(|strength| *strength != ColorInput::grey(0.0)),
            anisotropy_direction: None,
            thin_film: None,
            thin_film_share: ColorInput::grey(1.0),
            // A share of a whole turn.
            anisotropy_rotation_degrees: 360.0 * rotation,
            masking: Masking::Separable,
        })))
    }

    /// A number from 0 to 1, perhaps times the red channel of a map.
    fn mtl_scalar(
        &mut self,
        written: &MtlMaterial,
        [key, map_key]: [MtlKey; 2],
        otherwise: f64,
    ) -> Result<ColorInput, SceneError> {
        let factor = written.number(key);
        let Some(map) = self.mtl_map(written, map_key)? else { return Ok(ColorInput::grey(factor.unwrap_or(otherwise))) };
        // Beside a map the number is often 0, which would leave nothing of it.
        let factor = Spectrum::grey(factor.filter(|factor| *factor > 0.0).unwrap_or(1.0) * map.gain());
        let channel = map.channel.unwrap_or(Channel::R);
        Ok(match self.mtl_picture(written, map_key, &map, Some(ColorSpace::Linear))? {
            Some(texture) => ColorInput::Channel(ChannelInput { texture, channel, factor, is_squared: false }),
            None => ColorInput::grey(otherwise),
        })
    }
}

fn is_glass(written: &MtlMaterial) -> bool {
    matches!(written.illumination, Some(4 | 6 | 7 | 9))
}
