//! MTL materials as materials of the scene.
//!
//! | MTL | here |
//! | --- | --- |
//! | `illum` 4, 6, 7, or `d` < 1 with `Ni` ≠ 1 | glass of index `Ni`, transmittance `Tf` |
//! | `illum` 3, 5, or black `Kd` with white `Ks` and `Ns` ≥ 1000 | mirror of reflectance `Ks` |
//! | `d` = 0 | pass |
//! | 0 < `d` < 1, `map_d` | blend of the rest and pass |
//! | `illum` ≥ 2 and `Ks` above 0 | phong: `Kd` times `map_Kd`, `Ks`, exponent `Ns` |
//! | else | diffuse `Kd` times `map_Kd` |
//! | `Ke` | emission, from the front |

use std::path::Path;

use glam::DVec3;

use super::mtl_principled::is_principled;
use crate::load::error::{SceneError, show};
use crate::load::file::resolver::Resolver;
use crate::load::formats;
use crate::load::model::MtlMaterial;
use crate::load::obj::TextureMap;
use crate::scene::{
    BlendWeight, Channel, ColorInput, ColorSpace, Emission, ImageTexture, Material, MaterialId, MaterialKind, Principled, Relief,
    Texture, TextureFilter, TextureId, TextureKind, TextureWrap, UvTransform,
};

/// Stands for what is missing. No material looks so by chance.
const MAGENTA: DVec3 = DVec3::new(1.0, 0.0, 1.0);
/// A highlight that stays whatever Kd is: the reflectance of plastic seen head-on.
const LEAST_SPECULAR: f64 = 0.04;

/// The factors of Kd and Ks with which they take no more than all light in any channel. Ks gives way first, as a whole: both keep their hue.
fn shares(diffuse: DVec3, specular: DVec3) -> [f64; 2] {
    // f32 texels of 1 come out as 1 + 6e-8 at most.
    if (diffuse + specular).max_element() <= 1.0 + 1e-6 {
        return [1.0; 2];
    }
    // The largest factor up to 1 that leaves a colour room beside another.
    let room = |colour: DVec3, other: DVec3| {
        let channels = (0..3).filter(|&channel| colour[channel] > 0.0);
        channels.map(|channel| (1.0 - other[channel]) / colour[channel]).fold(1.0, f64::min).max(0.0)
    };
    let least = (LEAST_SPECULAR / specular.max_element()).min(1.0);
    let of_specular = room(specular, diffuse).max(least);
    [room(diffuse, specular * of_specular), of_specular]
}

impl Resolver<'_> {
    /// Adds the material to the scene.
    pub(in crate::load::file) fn mtl_material(&mut self, written: &MtlMaterial) -> Result<MaterialId, SceneError> {
        if written.is_missing {
            let kind = MaterialKind::Diffuse { reflectance: ColorInput::Constant(MAGENTA) };
            let name = format!("{} (missing)", written.material.name);
            return Ok(self.add(Material { name, kind, normal_map: None, emission: None, two_sided: true }));
        }
        let mut opacity = self.opacity(written)?;
        if opacity == 0.0 && written.material.dissolve_texture.is_some() {
            // Beside a map the number is often 0, which would leave nothing of it.
            opacity = 1.0;
        }
        let kind = self.mtl_kind(written, opacity)?;
        let emission = self.mtl_emission(written)?;
        let transmits = |principled: &Principled| principled.transmission != ColorInput::grey(0.0);
        let see_through = matches!(&kind, MaterialKind::Glass { .. } | MaterialKind::Pass)
            || matches!(&kind, MaterialKind::Principled(principled) if transmits(principled));
        let normal_map = self.mtl_normal_map(written)?;
        let mask = self.mtl_mask(written, opacity)?;
        let whole = mask.is_none() && (opacity >= 1.0 || see_through);
        // A blend's normals are its own, not those of a part.
        let own_map = normal_map.filter(|_| whole);
        let material = Material { name: written.material.name.clone(), kind, normal_map: own_map, emission, two_sided: true };
        let id = self.add(material);
        if whole {
            return Ok(id);
        }
        let name = &written.material.name;
        let pass = self.add(Material {
            name: format!("{name} (what is behind)"),
            kind: MaterialKind::Pass,
            normal_map: None,
            emission: None,
            two_sided: true,
        });
        let (behind, weight) = match mask {
            Some(weight) => (format!("{name} (map_d)"), weight),
            None => (format!("{name} (d = {opacity})"), BlendWeight::Constant { value: opacity }),
        };
        Ok(self.add(Material {
            name: behind,
            kind: MaterialKind::Blend { materials: [id, pass], weight },
            normal_map,
            emission: None,
            two_sided: true,
        }))
    }

    fn add(&mut self, material: Material) -> MaterialId {
        self.scene.materials.push(material);
        self.scene.materials.len() - 1
    }

    fn mtl_kind(&mut self, written: &MtlMaterial, opacity: f64) -> Result<MaterialKind, SceneError> {
        let material = &written.material;
        let specular = colour(material.specular).unwrap_or(DVec3::ZERO);
        let illumination = material.illumination_model.unwrap_or(2);
        let ior = f64::from(material.optical_density.unwrap_or(1.0));
        if is_principled(written) && opacity > 0.0 {
            return self.mtl_principled(written, opacity);
        }
        if matches!(illumination, 4 | 6 | 7) || (opacity > 0.0 && opacity < 1.0 && (ior - 1.0).abs() > 1e-3) {
            return self.mtl_glass(written, ior);
        }
        if opacity == 0.0 {
            return Ok(MaterialKind::Pass);
        }
        let polished = colour(material.diffuse) == Some(DVec3::ZERO)
            && specular.min_element() > 0.9
            && material.shininess.is_some_and(|exponent| exponent >= 1000.0);
        if matches!(illumination, 3 | 5) || polished {
            let tint = if specular.max_element() > 0.0 { specular } else { DVec3::ONE };
            return Ok(MaterialKind::Mirror { reflectance: ColorInput::Constant(self.at_most_one(written, "Ks", tint)) });
        }
        if specular.max_element() > 0.0 && illumination >= 2 {
            return self.mtl_phong(written, specular);
        }
        Ok(MaterialKind::Diffuse { reflectance: self.mtl_diffuse(written)? })
    }

    /// Kd, Ks and Ns as they are; where both colours together would make energy, they are shrunk.
    fn mtl_phong(&mut self, written: &MtlMaterial, specular: DVec3) -> Result<MaterialKind, SceneError> {
        let specular = self.at_most_one(written, "Ks", specular);
        let diffuse = self.mtl_diffuse(written)?;
        let brightest_texel = |texture: TextureId| self.scene.textures[texture].kind.range().1;
        let brightest = match diffuse {
            ColorInput::Constant(colour) => colour,
            ColorInput::ScaledTexture(texture, factor) => factor * brightest_texel(texture),
            // MTL has nothing but whole textures besides.
            other => DVec3::splat(other.texture().map_or(0.0, brightest_texel)),
        };
        let [of_diffuse, of_specular] = shares(brightest, specular);
        if of_specular < 1.0 {
            let name = &written.material.name;
            let as_well = if of_diffuse < 1.0 { format!(" and Kd by {of_diffuse:.3}") } else { String::new() };
            self.warn(
                written,
                &format!("Kd + Ks of the material `{name}` is above 1, which makes energy: Ks is multiplied by {of_specular:.3}{as_well}"),
            );
        }
        let specular = specular * of_specular;
        let diffuse = if of_diffuse == 1.0 { diffuse } else { diffuse.scaled(DVec3::splat(of_diffuse)) };
        let exponent = f64::from(written.material.shininess.unwrap_or(0.0)).max(0.0);
        Ok(MaterialKind::Phong { diffuse, specular: ColorInput::Constant(specular), exponent: ColorInput::grey(exponent) })
    }

    fn mtl_glass(&mut self, written: &MtlMaterial, ior: f64) -> Result<MaterialKind, SceneError> {
        let name = &written.material.name;
        if !(0.1..=10.0).contains(&ior) {
            let message = format!("the material `{name}` has the index of refraction Ni = {ior}, possible are 0.1 to 10");
            return Err(SceneError::in_file(show(&written.file), message));
        }
        let filter = written.material.unknown_param.get("Tf").and_then(|text| {
            let values: Vec<f64> = text.split_whitespace().map_while(|word| word.parse().ok()).collect();
            <[f64; 3]>::try_from(values).ok().map(DVec3::from_array)
        });
        let transmittance = filter.map_or(DVec3::ONE, |filter| self.at_most_one(written, "Tf", filter));
        Ok(MaterialKind::Glass {
            ior,
            reflectance: ColorInput::grey(1.0),
            transmittance: ColorInput::Constant(transmittance),
            thin: false,
        })
    }

    pub(super) fn mtl_diffuse(&mut self, written: &MtlMaterial) -> Result<ColorInput, SceneError> {
        let tint = colour(written.material.diffuse);
        let tint = tint.map(|tint| self.at_most_one(written, "Kd", tint));
        match written.material.diffuse_texture.clone() {
            Some(map) => self.mtl_texture(written, "map_Kd", &map, tint, None),
            None => Ok(tint.map_or(ColorInput::grey(0.8), ColorInput::Constant)),
        }
    }

    fn mtl_emission(&mut self, written: &MtlMaterial) -> Result<Option<Emission>, SceneError> {
        let factor = colour(written.material.emissive);
        let radiance = match (written.material.unknown_param.get("map_Ke").cloned(), factor) {
            (_, Some(factor)) if factor.max_element() == 0.0 => return Ok(None),
            (Some(map), factor) => self.mtl_texture(written, "map_Ke", &map, factor, None)?,
            (None, Some(factor)) => ColorInput::Constant(factor),
            (None, None) => return Ok(None),
        };
        Ok(Some(Emission { radiance, two_sided: false }))
    }

    /// Magenta stands for a picture that cannot be read.
    pub(super) fn mtl_texture(
        &mut self,
        written: &MtlMaterial,
        key: &str,
        map: &str,
        tint: Option<DVec3>,
        space: Option<ColorSpace>,
    ) -> Result<ColorInput, SceneError> {
        let of_material = |message: String| format!("the material `{}`: {key}: {message}", written.material.name);
        let folder = written.file.parent().unwrap_or(Path::new(""));
        let map = TextureMap::parse(map).map_err(|message| SceneError::in_file(show(&written.file), of_material(message)))?;
        let space = space.or(map.space);
        let found = self.files().find(folder, &map.file);
        let path = found.as_ref().map_or_else(|| folder.join(&map.file), |found| found.path.clone());
        if found.is_some_and(|found| found.is_substitute) {
            self.warn(written, &of_material(format!("there is no {}; {} is taken", map.file, show(&path))));
        }
        let image = match self.picture(&path, space) {
            Ok((image, _)) => image,
            Err(reason) => {
                let advice = formats::unread_picture(&path).map_or_else(String::new, |advice| format!(" ({advice})"));
                let what = of_material(format!("{}: {reason}{advice}; magenta stands for it", show(&path)));
                self.substitute(&written.file, what)?;
                return Ok(ColorInput::Constant(MAGENTA * tint.map_or(1.0, DVec3::max_element).max(0.5)));
            }
        };
        if !map.unsupported.is_empty() {
            let options = map.unsupported.join(", ");
            self.warn(written, &format!("texture options without effect: {options}"));
        }
        let texture = self.scene.textures.len();
        self.scene.textures.push(Texture {
            name: show(&path),
            kind: TextureKind::Image(ImageTexture {
                image,
                wrap: if map.clamp { TextureWrap::Clamp } else { TextureWrap::Repeat },
                filter: TextureFilter::Bilinear,
                scale: map.scale,
            }),
            transform: UvTransform { offset: map.offset, ..UvTransform::default() },
            relief: Relief::default(),
            shadows_bent_normals: false,
            mirrors_bent_normals: false,
            by_second_uvs: false,
            times: None,
        });
        self.linear_textures.push(space == Some(ColorSpace::Linear));
        Ok(match tint {
            Some(tint) if tint != DVec3::ONE => ColorInput::ScaledTexture(texture, tint),
            _ => ColorInput::Texture(texture),
        })
    }

    /// `d`, or 1 − `Tr`; 1 where neither is written.
    fn opacity(&self, written: &MtlMaterial) -> Result<f64, SceneError> {
        let transparency = written.material.unknown_param.get("Tr").and_then(|text| text.parse::<f64>().ok());
        let opacity = written.material.dissolve.map(f64::from).or(transparency.map(|transparency| 1.0 - transparency));
        let opacity = opacity.unwrap_or(1.0);
        if (0.0..=1.0).contains(&opacity) {
            return Ok(opacity);
        }
        let name = &written.material.name;
        Err(SceneError::in_file(show(&written.file), format!("the material `{name}` has d or Tr outside 0 to 1")))
    }

    /// `map_d`: the alpha channel where the picture has one, else red, times `d`. None where there is no map, or it cannot be read.
    fn mtl_mask(&mut self, written: &MtlMaterial, opacity: f64) -> Result<Option<BlendWeight>, SceneError> {
        let Some(map) = written.material.dissolve_texture.clone() else { return Ok(None) };
        let wanted = TextureMap::parse(&map).ok().and_then(|map| map.channel);
        let Some(texture) = self.mtl_texture(written, "map_d", &map, None, Some(ColorSpace::Linear))?.texture() else {
            return Ok(None);
        };
        let kind = &self.scene.textures[texture].kind;
        let has_alpha = matches!(kind, TextureKind::Image(image) if image.image.has_alpha);
        let channel = wanted.unwrap_or(if has_alpha { Channel::A } else { Channel::R });
        Ok(Some(BlendWeight::Channel { texture, channel, factor: opacity }))
    }

    /// A reflectance above 1 would make energy.
    fn at_most_one(&mut self, written: &MtlMaterial, key: &str, colour: DVec3) -> DVec3 {
        if colour.max_element() > 1.0 {
            self.warn(written, &format!("{key} of the material `{}` is above 1 and taken as 1", written.material.name));
        }
        colour.min(DVec3::ONE)
    }

    pub(super) fn warn(&mut self, written: &MtlMaterial, what: &str) {
        self.scene.warnings.push(format!("{}: {what}", show(&written.file)));
    }
}

/// As single precision wrote it: 0.8 stays 0.8.
fn colour(written: Option<[f32; 3]>) -> Option<DVec3> {
    written.map(|channels| DVec3::from_array(channels.map(shortest)))
}

/// The double nearest to the shortest decimal number that reads as this float.
fn shortest(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::from(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kd_and_ks_keep_their_hues_and_make_no_energy() {
        let rows = [
            // Blender's red plastic: chrome before.
            ([0.8, 0.1, 0.1], [1.0; 3], [1.0, 0.2]),
            ([0.8, 0.8, 0.8], [0.5; 3], [1.0, 0.4]),
            ([0.3, 0.3, 0.3], [0.5; 3], [1.0, 1.0]),
            // White paint keeps a highlight.
            ([1.0; 3], [1.0; 3], [0.96, 0.04]),
            ([0.0, 0.0, 1.0], [0.02; 3], [0.98, 1.0]),
        ];
        for (diffuse, specular, expected) in rows {
            let (diffuse, specular) = (DVec3::from(diffuse), DVec3::from(specular));
            let [of_diffuse, of_specular] = shares(diffuse, specular);
            assert!(
                (of_diffuse - expected[0]).abs() < 1e-9 && (of_specular - expected[1]).abs() < 1e-9,
                "{of_diffuse}, {of_specular}"
            );
            assert!((diffuse * of_diffuse + specular * of_specular).max_element() <= 1.0 + 1e-9);
        }
    }
}
