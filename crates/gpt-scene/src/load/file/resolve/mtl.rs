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
//! | `map_Bump`, `bump` | heights: 1 stands for `-bm` scene units; or normals, where the picture shows some |

use std::path::Path;

use super::mtl_principled::is_principled;
use crate::load::error::{SceneError, show};
use crate::load::file::resolver::Resolver;
use crate::load::formats;
use crate::load::image_file::PictureSource;
use crate::load::mends::Mends;
use crate::load::model::{MtlKey, MtlMaterial, Substitute};
use crate::load::obj::TextureMap;
use crate::scene::{
    BlendWeight, Channel, ColorInput, ColorSpace, Emission, ImageData, ImageTexture, Material, MaterialId, MaterialKind,
    Principled, Relief, Texture, TextureFilter, TextureId, TextureKind, TextureWrap, UvTransform,
};
use crate::spectrum::Spectrum;

/// Stands for what is missing. No material looks so by chance.
const MAGENTA: Spectrum = Spectrum::new(1.0, 0.0, 1.0);
/// A highlight that stays whatever Kd is: the reflectance of plastic seen head-on.
const LEAST_SPECULAR: f64 = 0.04;

/// The factors of Kd and Ks with which they take no more than all light in any channel. Ks gives way first, as a whole: both keep their hue.
fn shares(diffuse: Spectrum, specular: Spectrum) -> [f64; 2] {
    // f32 texels of 1 come out as 1 + 6e-8 at most.
    if (diffuse + specular).max_component() <= 1.0 + 1e-6 {
        return [1.0; 2];
    }
    // The largest factor up to 1 that leaves a colour room beside another.
    let room = |colour: Spectrum, other: Spectrum| {
        let channels = colour.to_rgb().into_iter().zip(other.to_rgb()).filter(|(channel, _)| *channel > 0.0);
        channels.map(|(channel, other)| (1.0 - other) / channel).fold(1.0, f64::min).max(0.0)
    };
    let least = (LEAST_SPECULAR / specular.max_component()).min(1.0);
    let of_specular = room(specular, diffuse).max(least);
    [room(diffuse, specular * of_specular), of_specular]
}

impl Resolver<'_> {
    /// Adds the material to the scene.
    pub(in crate::load::file) fn mtl_material(&mut self, written: &MtlMaterial) -> Result<MaterialId, SceneError> {
        if written.is_missing {
            let kind = MaterialKind::Diffuse { reflectance: ColorInput::Constant(MAGENTA) };
            let name = format!("{} (missing)", written.name);
            return Ok(self.add(Material { name, kind, normal_map: None, emission: None, two_sided: true, interior: None }));
        }
        let mut opacity = opacity(written);
        if opacity == 0.0 && written.maps.contains_key("map_d") {
            // Beside a map the number is often 0, which would leave nothing of it.
            opacity = 1.0;
        }
        let kind = self.mtl_kind(written, opacity)?;
        let emission = self.mtl_emission(written)?;
        let transmits = |principled: &Principled| principled.transmission != ColorInput::grey(0.0);
        let see_through = matches!(&kind, MaterialKind::Glass { .. } | MaterialKind::Pass)
            || matches!(&kind, MaterialKind::Principled(principled) if transmits(principled));
        let normal_map = self.mtl_relief(written)?;
        let mask = self.mtl_mask(written, opacity)?;
        let whole = mask.is_none() && (opacity >= 1.0 || see_through);
        // A blend's normals are its own, not those of a part.
        let own_map = normal_map.filter(|_| whole);
        let material =
            Material { name: written.name.clone(), kind, normal_map: own_map, emission, two_sided: true, interior: None };
        let id = self.add(material);
        if whole {
            return Ok(id);
        }
        let name = &written.name;
        let pass = self.add(Material {
            name: format!("{name} (what is behind)"),
            kind: MaterialKind::Pass,
            normal_map: None,
            emission: None,
            two_sided: true,
            interior: None,
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
            interior: None,
        }))
    }

    fn add(&mut self, material: Material) -> MaterialId {
        self.scene.materials.push(material);
        self.scene.materials.len() - 1
    }

    fn mtl_kind(&mut self, written: &MtlMaterial, opacity: f64) -> Result<MaterialKind, SceneError> {
        let specular = written.colour("Ks").unwrap_or(Spectrum::BLACK);
        let illumination = written.illumination.unwrap_or(2);
        let ior = written.number("Ni").unwrap_or(1.0);
        if is_principled(written) && opacity > 0.0 {
            return self.mtl_principled(written, opacity);
        }
        if matches!(illumination, 4 | 6 | 7) || (opacity > 0.0 && opacity < 1.0 && (ior - 1.0).abs() > 1e-3) {
            return Ok(self.mtl_glass(written, ior));
        }
        if opacity == 0.0 {
            return Ok(MaterialKind::Pass);
        }
        let polished = written.colour("Kd") == Some(Spectrum::BLACK)
            && specular.min_component() > 0.9
            && written.number("Ns").is_some_and(|exponent| exponent >= 1000.0);
        if matches!(illumination, 3 | 5) || polished {
            let tint = if specular.max_component() > 0.0 { specular } else { Spectrum::WHITE };
            return Ok(MaterialKind::Mirror { reflectance: ColorInput::Constant(self.at_most_one(written, "Ks", tint)) });
        }
        if specular.max_component() > 0.0 && illumination >= 2 {
            return self.mtl_phong(written, specular);
        }
        Ok(MaterialKind::Diffuse { reflectance: self.mtl_diffuse(written)? })
    }

    /// Kd, Ks and Ns as they are; where both colours together would make energy, they are shrunk.
    fn mtl_phong(&mut self, written: &MtlMaterial, specular: Spectrum) -> Result<MaterialKind, SceneError> {
        let specular = self.at_most_one(written, "Ks", specular);
        let diffuse = self.mtl_diffuse(written)?;
        let brightest_texel = |texture: TextureId| self.scene.textures[texture].kind.range().1;
        let brightest = match diffuse {
            ColorInput::Constant(colour) => colour,
            ColorInput::ScaledTexture(texture, factor) => factor * brightest_texel(texture),
            // MTL has nothing but whole textures besides.
            other => Spectrum::grey(other.texture().map_or(0.0, brightest_texel)),
        };
        let [of_diffuse, of_specular] = shares(brightest, specular);
        if of_specular < 1.0 {
            let name = &written.name;
            let as_well = if of_diffuse < 1.0 { format!(" and Kd by {of_diffuse:.3}") } else { String::new() };
            self.warn(
                written,
                &format!("Kd + Ks of the material `{name}` is above 1, which makes energy: Ks is multiplied by {of_specular:.3}{as_well}"),
            );
        }
        let specular = specular * of_specular;
        let diffuse = if of_diffuse == 1.0 { diffuse } else { diffuse.scaled(Spectrum::grey(of_diffuse)) };
        let exponent = written.number("Ns").unwrap_or(0.0);
        Ok(MaterialKind::Phong { diffuse, specular: ColorInput::Constant(specular), exponent: ColorInput::grey(exponent) })
    }

    fn mtl_glass(&mut self, written: &MtlMaterial, ior: f64) -> MaterialKind {
        let transmittance = written.colour("Tf").map_or(Spectrum::WHITE, |filter| self.at_most_one(written, "Tf", filter));
        MaterialKind::Glass {
            ior,
            reflectance: ColorInput::grey(1.0),
            transmittance: ColorInput::Constant(transmittance),
            thin: false,
            film: None,
            dispersion: None,
        }
    }

    pub(super) fn mtl_diffuse(&mut self, written: &MtlMaterial) -> Result<ColorInput, SceneError> {
        let tint = written.colour("Kd").map(|tint| self.at_most_one(written, "Kd", tint));
        let texture = self.mtl_texture(written, "map_Kd", tint, None)?;
        Ok(texture.unwrap_or_else(|| tint.map_or(ColorInput::grey(0.8), ColorInput::Constant)))
    }

    fn mtl_emission(&mut self, written: &MtlMaterial) -> Result<Option<Emission>, SceneError> {
        let factor = written.colour("Ke");
        if factor.is_some_and(|factor| factor.max_component() == 0.0) {
            return Ok(None);
        }
        let radiance = self.mtl_texture(written, "map_Ke", factor, None)?.or(factor.map(ColorInput::Constant));
        Ok(radiance.map(|radiance| Emission { radiance, two_sided: false }))
    }

    /// The value of a picture's key, parsed.
    pub(super) fn mtl_map(&mut self, written: &MtlMaterial, key: MtlKey) -> Result<Option<TextureMap>, SceneError> {
        let Some((line, text)) = written.maps.get(key) else { return Ok(None) };
        let folder = written.file.parent().unwrap_or(Path::new(""));
        let mut mends = Mends::default();
        let is_there = |name: &str| self.files().find_exactly(folder, name).is_some();
        let map = TextureMap::parse(text, *line, &is_there, &mut mends);
        if key != "map_Bump" && map.range[0] != 0.0 {
            mends.add("`-mm` has no effect unless it multiplies alone", *line, text);
        }
        for mend in mends.into_substitutes() {
            self.substitute(&written.file, mend)?;
        }
        Ok(Some(map))
    }

    /// The picture that a key names, times a tint; none where the key is not there. Magenta stands for one that cannot be read.
    pub(super) fn mtl_texture(
        &mut self,
        written: &MtlMaterial,
        key: MtlKey,
        tint: Option<Spectrum>,
        space: Option<ColorSpace>,
    ) -> Result<Option<ColorInput>, SceneError> {
        let Some(map) = self.mtl_map(written, key)? else { return Ok(None) };
        let Some(texture) = self.mtl_picture(written, key, &map, space)? else {
            return Ok(Some(ColorInput::Constant(MAGENTA * tint.map_or(1.0, Spectrum::max_component).max(0.5))));
        };
        let tint = tint.unwrap_or(Spectrum::WHITE) * map.gain();
        Ok(Some(if tint == Spectrum::WHITE { ColorInput::Texture(texture) } else { ColorInput::ScaledTexture(texture, tint) }))
    }

    /// The picture of a map as a texture. None where it cannot be read, which is reported.
    pub(super) fn mtl_picture(
        &mut self,
        written: &MtlMaterial,
        key: MtlKey,
        map: &TextureMap,
        space: Option<ColorSpace>,
    ) -> Result<Option<TextureId>, SceneError> {
        let of_material = |message: String| format!("the material `{}`: {key}: {message}", written.name);
        let line = written.maps.get(key).map(|(line, _)| *line);
        let folder = written.file.parent().unwrap_or(Path::new(""));
        let space = space.or(map.space);
        let instead = if matches!(key, "norm" | "map_Bump") { "the surface stays as it is" } else { "magenta stands for it" };
        if map.file.is_empty() {
            let what = of_material(format!("it names no picture; {instead}"));
            self.substitute(&written.file, Substitute { line, what })?;
            return Ok(None);
        }
        let found = self.files().find(folder, &map.file);
        let path = found.as_ref().map_or_else(|| folder.join(&map.file), |found| found.path.clone());
        if found.is_some_and(|found| found.is_substitute) {
            self.warn(written, &of_material(format!("there is no {}; {} is taken", map.file, show(&path))));
        }
        let image = match self.picture(&PictureSource::File(path.clone()), space) {
            Ok((image, _)) => image,
            Err(reason) => {
                let advice = formats::unread_picture(&path).map_or_else(String::new, |advice| format!(" ({advice})"));
                let what = of_material(format!("{}: {reason}{advice}; {instead}", show(&path)));
                self.substitute(&written.file, Substitute { line, what })?;
                return Ok(None);
            }
        };
        let kind = TextureKind::Image(ImageTexture {
            image,
            wrap: [if map.clamp { TextureWrap::Clamp } else { TextureWrap::Repeat }; 2],
            filter: TextureFilter::Bilinear,
            scale: map.scale,
        });
        let transform = UvTransform { offset: map.offset, ..UvTransform::default() };
        self.scene.textures.push(Texture { transform, ..Texture::new(show(&path), kind) });
        self.linear_textures.push(space == Some(ColorSpace::Linear));
        Ok(Some(self.scene.textures.len() - 1))
    }

    /// The texture by which normals are perturbed: that of `norm`, a map of normals, or of `map_Bump`. The latter holds heights, of which 1 stands for
    /// the bump multiplier (`-bm`) in scene units, as in Blender's node of bumps and in three.js; but Blender and others write maps of normals
    /// there, whose strength the multiplier then is.
    fn mtl_relief(&mut self, written: &MtlMaterial) -> Result<Option<TextureId>, SceneError> {
        let is_both = written.maps.contains_key("norm") && written.maps.contains_key("map_Bump");
        if is_both {
            let what = format!("the material `{}` has `norm` and `map_Bump`, and `norm` counts", written.name);
            self.substitute(&written.file, Substitute { line: None, what })?;
        }
        let key = if written.maps.contains_key("norm") { "norm" } else { "map_Bump" };
        let Some(map) = self.mtl_map(written, key)? else { return Ok(None) };
        let Some(texture) = self.mtl_picture(written, key, &map, Some(ColorSpace::Linear))? else { return Ok(None) };
        let shows_normals =
            matches!(&self.scene.textures[texture].kind, TextureKind::Image(image) if shows_normals(&image.image));
        let relief = if key == "norm" || shows_normals {
            Relief::Normals(map.bump)
        } else {
            // A base that all heights have is no slope.
            Relief::Heights(map.bump * map.range[1])
        };
        let line = written.maps.get(key).map(|(line, _)| *line);
        if key == "map_Bump" && map.channel.is_some() && !shows_normals && !self.is_grey(texture) {
            let what =
                format!("the material `{}`: {key}: heights are the picture's luminance, whatever `-imfchan` says", written.name);
            self.substitute(&written.file, Substitute { line, what })?;
        }
        if key != "norm" && shows_normals {
            let message = format!("the material `{}`: {key}: {} is a map of normals, and taken as one", written.name, map.file);
            self.warn(written, &message);
        }
        self.scene.textures[texture].relief = relief;
        Ok(Some(texture))
    }

    fn is_grey(&self, texture: TextureId) -> bool {
        let TextureKind::Image(image) = &self.scene.textures[texture].kind else { return false };
        image.image.texels.colors().all(|texel| texel.x == texel.y && texel.y == texel.z)
    }

    /// `map_d`: the alpha channel where the picture has one, else red, times `d`. None where there is no map, or it cannot be read.
    fn mtl_mask(&mut self, written: &MtlMaterial, opacity: f64) -> Result<Option<BlendWeight>, SceneError> {
        let Some(map) = self.mtl_map(written, "map_d")? else { return Ok(None) };
        let Some(texture) = self.mtl_picture(written, "map_d", &map, Some(ColorSpace::Linear))? else { return Ok(None) };
        let kind = &self.scene.textures[texture].kind;
        let has_alpha = matches!(kind, TextureKind::Image(image) if image.image.has_alpha);
        let channel = map.channel.unwrap_or(if has_alpha { Channel::A } else { Channel::R });
        Ok(Some(BlendWeight::Channel { texture, channel, factor: opacity }))
    }

    /// A reflectance above 1 would make energy.
    fn at_most_one(&mut self, written: &MtlMaterial, key: &str, colour: Spectrum) -> Spectrum {
        if colour.max_component() > 1.0 {
            self.warn(written, &format!("{key} of the material `{}` is above 1 and taken as 1", written.name));
        }
        colour.min(Spectrum::WHITE)
    }

    pub(super) fn warn(&mut self, written: &MtlMaterial, what: &str) {
        self.scene.warnings.push(format!("{}: {what}", show(&written.file)));
    }
}

/// `d`, or 1 − `Tr`; 1 where neither is written.
fn opacity(written: &MtlMaterial) -> f64 {
    let transparency = written.number("Tr");
    written.number("d").or(transparency.map(|transparency| 1.0 - transparency)).unwrap_or(1.0)
}

/// True where most texels are directions of about unit length on the upper side: then it is a map of normals. Heights are grey.
fn shows_normals(image: &ImageData) -> bool {
    let step = (image.texels.len() / 4096).max(1);
    let is_direction = |index: usize| {
        let texel = image.texels.color(index).as_dvec3();
        let length = (2.0 * texel - 1.0).length();
        (0.8..1.2).contains(&length) && texel.z > 0.5 && texel.z > texel.x.min(texel.y) + 0.05
    };
    let looked_at = (0..image.texels.len()).step_by(step);
    let count = looked_at.len();
    looked_at.filter(|&index| is_direction(index)).count() * 10 >= count * 9
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
            let (diffuse, specular) = (Spectrum::from_rgb(diffuse), Spectrum::from_rgb(specular));
            let [of_diffuse, of_specular] = shares(diffuse, specular);
            assert!(
                (of_diffuse - expected[0]).abs() < 1e-9 && (of_specular - expected[1]).abs() < 1e-9,
                "{of_diffuse}, {of_specular}"
            );
            assert!((diffuse * of_diffuse + specular * of_specular).max_component() <= 1.0 + 1e-9);
        }
    }
}
