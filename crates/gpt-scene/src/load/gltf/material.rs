//! Materials and their textures.

pub mod scattering;
mod see_through;

use glam::DAffine2;

use super::importer::Importer;
use super::json::{Material, SpecularGlossiness, TextureInfo, extension};
use super::lookup::{Lookup, Lookups};
use super::made::{Coordinates, Form, MadeMaterial};
use super::texture_role::{TextureRole, UvsOf};
use crate::load::file::colour::{ChannelName, Rgb, Scalar};
use crate::load::file::material::blend_weight::BlendWeightEntry;
use crate::load::file::material::{MaterialEntry, diffuse, emissive, principled};
use crate::load::file::reference::TextureName;
use crate::load::file::value::{Checked, Fraction, IndexOfRefraction, LARGEST, Located, Number, Rule};
use crate::load::import::Input;
use crate::load::place::Place;
use crate::scene::{Channel, Dispersion};
use crate::spectrum::Spectrum;

/// Index of refraction where nothing is said, and the largest that scene files have.
const IOR: f64 = 1.5;
const LARGEST_IOR: f64 = 10.0;
/// Largest thickness of a film in nanometres that is read.
const LARGEST_THICKNESS: f64 = 1e6;
const GLOSSY: &str = "KHR_materials_pbrSpecularGlossiness";
const SPECULAR: &str = "KHR_materials_specular";
const VOLUME: &str = "KHR_materials_volume";
const DIFFUSE_TRANSMISSION: &str = "KHR_materials_diffuse_transmission";

impl Importer<'_> {
    /// The material of a primitive; None for the one that the specification gives where none is named.
    pub fn material(&mut self, index: Option<usize>) -> Result<MadeMaterial, String> {
        if let Some(made) = self.materials.get(&index) {
            return Ok(made.clone());
        }
        let made = match index {
            None => self.make_material(&Material::default(), "(default)", String::new(), &Form::default()),
            Some(index) => {
                let material =
                    self.root.materials.get(index).cloned().ok_or_else(|| format!("there is no materials[{index}]"))?;
                let name = material.name.clone().unwrap_or_else(|| format!("material {index}"));
                self.make_material(&material, &name, format!("materials[{index}]"), &Form::default())
            }
        };
        let made = made.map_err(|message| match index {
            Some(index) => format!("materials[{index}]: {message}"),
            None => message,
        })?;
        self.materials.insert(index, made.clone());
        Ok(made)
    }

    /// The material once more, in another form.
    pub fn material_as(&mut self, index: Option<usize>, form: &Form) -> Result<MadeMaterial, String> {
        let material = index.and_then(|index| self.root.materials.get(index)).cloned().unwrap_or_default();
        let name = material.name.clone().unwrap_or_else(|| "(default)".to_owned());
        let place = index.map_or_else(String::new, |index| format!("materials[{index}]"));
        let made = self.make_material(&material, &name, place, form)?;
        // A material that takes the place of this one takes that of its other forms too.
        if let Some(original) = self.materials.get(&index) {
            self.scene.material_variants.insert(made.name.clone(), original.name.clone());
        }
        Ok(made)
    }

    fn make_material(&mut self, material: &Material, name: &str, place: String, form: &Form) -> Result<MadeMaterial, String> {
        let lookups = Lookups::of(material)?;
        let glossy = extension(&material.extensions, GLOSSY)?;
        let mut surface = Surface { importer: self, material, key: place, lookups, coordinates: None, form, glossy };
        let mut entry = surface.entry()?;
        let (coordinates, place) = (surface.coordinates, surface.place());
        let name = self.scene.free_material_name(name);
        *entry.common_mut().name = place.at(name.clone());
        self.scene.file.material.push(entry);
        Ok(MadeMaterial { name, coordinates })
    }
}

/// A material in the making.
struct Surface<'s, 'i> {
    importer: &'s mut Importer<'i>,
    material: &'s Material,
    /// The material's name in the file.
    key: String,
    lookups: Lookups,
    coordinates: Option<Coordinates>,
    form: &'s Form,
    /// The factors of KHR_materials_pbrSpecularGlossiness, in place of metal and roughness.
    glossy: Option<SpecularGlossiness>,
}

/// A share of something: a factor, times a channel of a texture.
#[derive(Debug, Clone, PartialEq)]
struct Share {
    map: Option<(String, Channel)>,
    factor: f64,
}

impl Share {
    fn constant(factor: f64) -> Self {
        Self { map: None, factor }
    }

    fn is(&self, number: f64) -> bool {
        self.map.is_none() && self.factor == number
    }

    fn scalar<R: Rule>(&self, place: &Place) -> Result<Scalar<R>, String> {
        match &self.map {
            Some((name, channel)) => Scalar::of_texture(place.at(TextureName(name.clone())), Some(*channel), self.factor),
            None => Scalar::constant(self.factor),
        }
    }
}

/// The reflectance of a material's base.
struct BaseLayer {
    metallic: Share,
    roughness: Share,
    ior: f64,
    specular: Share,
    specular_color: Input,
}

impl Surface<'_, '_> {
    fn number(&self, of: &str, key: &str, default: f64) -> f64 {
        let value = self.material.extensions.get(of).and_then(|object| object.get(key)).and_then(serde_json::Value::as_f64);
        value.unwrap_or(default)
    }

    fn place(&self) -> Place {
        self.importer.place(&self.key)
    }

    fn approximate(&mut self, what: &str, instead: &str) {
        self.importer.scene.report.approximate(what, self.place().to_string(), instead);
    }

    fn drop(&mut self, what: &str, instead: &str) {
        self.importer.scene.report.drop(what, self.place().to_string(), instead);
    }

    /// A number within limits, reported where it is beyond them.
    fn within(&mut self, value: f64, [least, most]: [f64; 2], key: &str) -> f64 {
        let possible = if value.is_nan() { least } else { value.clamp(least, most) };
        if possible != value {
            self.approximate(&format!("{key} beyond {least} to {most}"), "the nearest possible value is taken");
        }
        possible
    }

    /// Three numbers that are clamped to their range in this way.
    fn colour_within(&mut self, colour: Spectrum, limits: [f64; 2], key: &str) -> Spectrum {
        let possible = colour.clamp(Spectrum::grey(limits[0]), Spectrum::grey(limits[1]));
        if possible != colour {
            self.approximate(&format!("{key} beyond {} to {}", limits[0], limits[1]), "the nearest possible value is taken");
        }
        possible
    }

    /// The factor of the base colour and its texture.
    fn base_colour(&self) -> ([f64; 4], Option<TextureInfo>) {
        let pbr = &self.material.pbr_metallic_roughness;
        let (factor, texture) = match &self.glossy {
            Some(glossy) => (glossy.diffuse_factor, &glossy.diffuse_texture),
            None => (pbr.base_color_factor, &pbr.base_color_texture),
        };
        (factor.unwrap_or([1.0; 4]), texture.clone())
    }

    fn entry(&mut self) -> Result<MaterialEntry, String> {
        let (factor, texture) = self.base_colour();
        let key = if self.glossy.is_some() { "diffuseFactor" } else { "baseColorFactor" };
        let colour = self.colour_within(Spectrum::new(factor[0], factor[1], factor[2]), [0.0, 1.0], key);
        let alpha = self.within(factor[3], [0.0, 1.0], key);
        let base = match &texture {
            Some(info) => Input::Texture(self.base_texture(info)?, colour),
            None => match &self.form.paint {
                Some(paint) => Input::Texture(paint.texture.clone(), colour),
                None => Input::Constant(colour),
            },
        };
        self.report_extensions();
        let place = self.place();
        let mut entry = if self.material.extensions.contains_key("KHR_materials_unlit") {
            self.approximate("KHR_materials_unlit", "the surface gives light of its colour, which falls on others too");
            let (radiance, two_sided) = (base.colour(&place)?, Some(place.at(true)));
            MaterialEntry::from(emissive::Keys { radiance, two_sided, ..Default::default() })
        } else {
            self.lit(&base)?
        };
        self.normal_map(&mut entry)?;
        self.emission(&mut entry)?;
        let entry = self.see_through(entry, alpha)?;
        Ok(self.culled(entry))
    }

    /// The reflectance of the base: metal and dielectric, or specular and glossiness, whose colour of reflection is that along the normal.
    fn base_layer(&mut self) -> Result<BaseLayer, String> {
        if let Some(glossy) = self.glossy.clone() {
            let colour = Spectrum::from_rgb(glossy.specular_factor.unwrap_or([1.0; 3]));
            let colour = self.colour_within(colour, [0.0, 1.0], "specularFactor") / normal_reflectance(LARGEST_IOR);
            let glossiness = self.within(glossy.glossiness_factor.unwrap_or(1.0), [0.0, 1.0], "glossinessFactor");
            let (specular_color, roughness) = match glossy.specular_glossiness_texture {
                None => (Input::Constant(colour), Share::constant(1.0 - glossiness)),
                Some(info) => {
                    let role = TextureRole::OfGlossiness(glossiness.to_bits());
                    let roughness = self.lookup(&info, role, "glossiness", None)?;
                    let roughness = Share { map: Some((roughness, Channel::R)), factor: 1.0 };
                    (self.texture(&info, TextureRole::Colour, colour, "specular")?, roughness)
                }
            };
            let [metallic, specular] = [0.0, 1.0].map(Share::constant);
            return Ok(BaseLayer { metallic, roughness, ior: LARGEST_IOR, specular, specular_color });
        }
        let pbr = self.material.pbr_metallic_roughness.clone();
        let map = match &pbr.metallic_roughness_texture {
            Some(info) => Some(self.lookup(info, TextureRole::Numbers, "metallic and roughness", None)?),
            None => None,
        };
        let metallic = self.within(pbr.metallic_factor.unwrap_or(1.0), [0.0, 1.0], "metallicFactor");
        let roughness = self.within(pbr.roughness_factor.unwrap_or(1.0), [0.0, 1.0], "roughnessFactor");
        let (ior, reflected) = self.ior();
        let tint = self.tint(SPECULAR, "specularColorFactor", Spectrum::WHITE, [f64::MAX, reflected], "specularColorTexture")?;
        Ok(BaseLayer {
            // Green of the texture is roughness, and blue is metallic.
            metallic: Share { map: map.clone().map(|map| (map, Channel::B)), factor: metallic },
            roughness: Share { map: map.map(|map| (map, Channel::G)), factor: roughness },
            ior,
            specular: self.factor(SPECULAR, "specularFactor", 1.0, "specularTexture", Channel::A)?,
            specular_color: tint,
        })
    }

    /// The index of refraction, and by what its reflectance is to be multiplied. One of 0 stands for a surface that reflects as its specular colour
    /// says (KHR_materials_ior), as one without bounds would.
    fn ior(&mut self) -> (f64, f64) {
        let stated = self.number("KHR_materials_ior", "ior", IOR);
        match stated {
            0.0 => (LARGEST_IOR, 1.0 / normal_reflectance(LARGEST_IOR)),
            large if large > LARGEST_IOR => {
                self.approximate("ior beyond 10", "it reflects as stated, and bends light as 10 does");
                (LARGEST_IOR, normal_reflectance(large.min(1e9)) / normal_reflectance(LARGEST_IOR))
            }
            _ => (self.within(stated, [1.0, LARGEST_IOR], "ior"), 1.0),
        }
    }

    /// The scattering material: the base with its extensions.
    fn lit(&mut self, base: &Input) -> Result<MaterialEntry, String> {
        const TRANSMISSION: &str = "KHR_materials_transmission";
        const CLEARCOAT: &str = "KHR_materials_clearcoat";
        const ANISOTROPY: &str = "KHR_materials_anisotropy";
        const SHEEN: &str = "KHR_materials_sheen";
        const TRANSMITTED: [&str; 4] = [
            "diffuseTransmissionFactor",
            "diffuseTransmissionTexture",
            "diffuseTransmissionColorFactor",
            "diffuseTransmissionColorTexture",
        ];
        let BaseLayer { metallic, roughness, ior, specular, specular_color } = self.base_layer()?;
        let transmission = self.factor(TRANSMISSION, "transmissionFactor", 0.0, "transmissionTexture", Channel::R)?;
        let scattered_on = self.factor(DIFFUSE_TRANSMISSION, TRANSMITTED[0], 0.0, TRANSMITTED[1], Channel::A)?;
        let clearcoat = self.factor(CLEARCOAT, "clearcoatFactor", 0.0, "clearcoatTexture", Channel::R)?;
        let sheen = self.tint(SHEEN, "sheenColorFactor", Spectrum::BLACK, [1.0, 1.0], "sheenColorTexture")?;
        let place = self.place();
        let has_sheen = sheen != Input::grey(0.0);
        if !has_sheen && [&metallic, &transmission, &specular, &clearcoat, &scattered_on].into_iter().all(|share| share.is(0.0)) {
            let reflectance = base.colour(&place)?;
            return Ok(MaterialEntry::from(diffuse::Keys { reflectance, ..Default::default() }));
        }
        let mut keys = principled::Keys {
            base_color: Some(base.colour(&place)?),
            metallic: Some(metallic.scalar(&place)?),
            roughness: Some(roughness.scalar(&place)?),
            ior: Some(place.at(Checked::of(ior)?)),
            ..Default::default()
        };
        if !specular.is(1.0) {
            keys.specular = Some(specular.scalar(&place)?);
        }
        if specular_color != Input::grey(1.0) {
            keys.specular_color = Some(specular_color.colour(&place)?);
        }
        if !transmission.is(0.0) {
            keys.transmission = Some(transmission.scalar(&place)?);
            // A surface without volume is a sheet without thickness.
            if !self.has_volume() {
                keys.thin = Some(place.at(true));
            }
        }
        if !scattered_on.is(0.0) {
            let tint = self.tint(DIFFUSE_TRANSMISSION, TRANSMITTED[2], Spectrum::WHITE, [1.0, 1.0], TRANSMITTED[3])?;
            keys.diffuse_transmission = Some(Box::new(scattered_on.scalar(&place)?));
            keys.diffuse_transmission_color = Some(place.at(tint.colour(&place)?));
        }
        if self.has_volume() {
            self.dispersion(&mut keys, ior)?;
            self.attenuation(&mut keys)?;
            self.scattering(&mut keys)?;
        } else {
            self.report_scattering("the surface encloses no volume that light gets into");
        }
        if has_sheen {
            let roughness = self.factor(SHEEN, "sheenRoughnessFactor", 0.0, "sheenRoughnessTexture", Channel::A)?;
            keys.sheen_color = Some(Box::new(sheen.colour(&place)?));
            keys.sheen_roughness = Some(place.at(roughness.scalar(&place)?));
        }
        if !clearcoat.is(0.0) {
            let roughness = self.factor(CLEARCOAT, "clearcoatRoughnessFactor", 0.0, "clearcoatRoughnessTexture", Channel::G)?;
            keys.clearcoat = Some(clearcoat.scalar(&place)?);
            keys.clearcoat_roughness = Some(place.at(roughness.scalar(&place)?));
            if let Some(info) = self.texture_of(CLEARCOAT, "clearcoatNormalTexture")? {
                let name = self.lookup(&info, TextureRole::Normals, "clearcoatNormalTexture", None)?;
                keys.coat_normal_map = Some(place.at(TextureName(name)));
                keys.coat_normal_scale = normal_scale(&info, &place)?;
            }
        }
        let anisotropy = self.factor(ANISOTROPY, "anisotropyStrength", 0.0, "anisotropyTexture", Channel::B)?;
        if !anisotropy.is(0.0) {
            keys.anisotropy = Some(Box::new(anisotropy.scalar(&place)?));
            if let Some(info) = self.texture_of(ANISOTROPY, "anisotropyTexture")? {
                let name = self.lookup(&info, TextureRole::Numbers, "anisotropyTexture", None)?;
                keys.anisotropy_direction = Some(place.at(TextureName(name)));
            }
            let degrees = self.number(ANISOTROPY, "anisotropyRotation", 0.0).to_degrees();
            keys.anisotropy_rotation = Some(place.at(Number::of(degrees)?));
            // Directions follow texture coordinates.
            self.coordinates.get_or_insert(Coordinates { set: 0, map: DAffine2::IDENTITY, second: None });
        }
        self.iridescence(&mut keys)?;
        Ok(MaterialEntry::from(keys))
    }

    /// An index of refraction for each channel (KHR_materials_dispersion), where light goes into a volume.
    fn dispersion(&mut self, keys: &mut principled::Keys, ior: f64) -> Result<(), String> {
        const DISPERSION: &str = "KHR_materials_dispersion";
        let dispersion = self.number(DISPERSION, "dispersion", 0.0);
        if dispersion <= 0.0 || keys.transmission.is_none() {
            return Ok(());
        }
        let written = (20.0 / dispersion).min(LARGEST);
        let possible = |abbe: &f64| Dispersion::Abbe(*abbe).channels(ior).to_rgb().into_iter().all(IndexOfRefraction::accepts);
        // The indices of channels lie nearer to each other with each step.
        let mut steps = (0..128).map(|step| written * 2.0_f64.powi(step));
        let Some(abbe) = steps.find(possible) else {
            self.drop(
                DISPERSION,
                "all colours are bent alike, since the index of refraction is the least or largest that is possible",
            );
            return Ok(());
        };
        if abbe != written {
            let instead = format!("{} is taken, with which every channel has a possible index of refraction", 20.0 / abbe);
            self.approximate(&format!("{DISPERSION}/dispersion of {dispersion}"), &instead);
        }
        keys.abbe_number = Some(self.place().at(Checked::of(abbe)?));
        Ok(())
    }

    /// A thin film (KHR_materials_iridescence).
    fn iridescence(&mut self, keys: &mut principled::Keys) -> Result<(), String> {
        const IRIDESCENCE: &str = "KHR_materials_iridescence";
        const TEXTURE: &str = "iridescenceThicknessTexture";
        let share = self.factor(IRIDESCENCE, "iridescenceFactor", 0.0, "iridescenceTexture", Channel::R)?;
        if share.is(0.0) {
            return Ok(());
        }
        let mut nanometres = |key: &str, default: f64| {
            let written = self.number(IRIDESCENCE, key, default);
            self.within(written, [0.0, LARGEST_THICKNESS], key)
        };
        let [least, most] = [nanometres("iridescenceThicknessMinimum", 100.0), nanometres("iridescenceThicknessMaximum", 400.0)];
        let ior = self.number(IRIDESCENCE, "iridescenceIor", 1.3);
        let ior = self.within(ior, [1.0, LARGEST_IOR], "iridescenceIor");
        let place = self.place();
        let (thickness, offset) = match self.texture_of(IRIDESCENCE, TEXTURE)? {
            Some(info) if least < most => {
                let map = self.lookup(&info, TextureRole::Numbers, TEXTURE, None)?;
                (Share { map: Some((map, Channel::G)), factor: most - least }, least)
            }
            Some(_) if least > most => {
                self.approximate(
                    "iridescenceThicknessMinimum above the maximum",
                    "the film is as thick as the maximum everywhere",
                );
                (Share::constant(most), 0.0)
            }
            _ => (Share::constant(most), 0.0),
        };
        if keys.clearcoat.is_some() {
            self.approximate("KHR_materials_iridescence below a clear coat", "the film reflects as it does in air");
        }
        keys.thin_film = Some(place.at(share.scalar(&place)?));
        keys.thin_film_thickness = Some(place.at(thickness.scalar(&place)?));
        keys.thin_film_offset =
            Some(offset).filter(|offset| *offset != 0.0).map(Checked::of).transpose()?.map(|offset| place.at(offset));
        keys.thin_film_ior = Some(place.at(Checked::of(ior)?));
        Ok(())
    }

    /// A factor of an extension, times a channel of its texture.
    fn factor(&mut self, of: &str, key: &str, default: f64, texture: &str, channel: Channel) -> Result<Share, String> {
        let factor = self.number(of, key, default);
        let factor = self.within(factor, [0.0, 1.0], key);
        let map = match self.texture_of(of, texture)? {
            Some(info) if factor > 0.0 => Some((self.lookup(&info, TextureRole::Numbers, texture, None)?, channel)),
            _ => None,
        };
        Ok(Share { map, factor })
    }

    /// A texture of an extension.
    fn texture_of(&self, of: &str, key: &str) -> Result<Option<TextureInfo>, String> {
        match self.material.extensions.get(of).and_then(serde_json::Value::as_object) {
            Some(object) => extension(object, key),
            None => Ok(None),
        }
    }

    /// A colour of an extension, at most so much, times a factor and its texture.
    fn tint(&mut self, of: &str, key: &str, default: Spectrum, [most, times]: [f64; 2], texture: &str) -> Result<Input, String> {
        let colour = self.colour(of, key).unwrap_or(default);
        let factor = self.colour_within(colour, [0.0, most], key) * times;
        match self.texture_of(of, texture)? {
            Some(info) if factor != Spectrum::BLACK => self.texture(&info, TextureRole::Colour, factor, texture),
            _ => Ok(Input::Constant(factor)),
        }
    }

    /// Three numbers of an extension.
    fn colour(&self, of: &str, key: &str) -> Option<Spectrum> {
        let list = self.material.extensions.get(of)?.get(key)?.as_array()?;
        let channels: Option<Vec<f64>> = list.iter().map(serde_json::Value::as_f64).collect();
        <[f64; 3]>::try_from(channels?).ok().map(Spectrum::from_rgb)
    }

    /// A medium fills the body that it encloses. Both sides of such a surface are there (KHR_materials_volume).
    fn has_volume(&self) -> bool {
        let lets_light_in = self.number("KHR_materials_transmission", "transmissionFactor", 0.0) > 0.0
            || self.number(DIFFUSE_TRANSMISSION, "diffuseTransmissionFactor", 0.0) > 0.0;
        lets_light_in && self.number(VOLUME, "thicknessFactor", 0.0) > 0.0
    }

    /// Attenuation within a volume. Without a distance, or white, there is none.
    fn attenuation(&mut self, keys: &mut principled::Keys) -> Result<(), String> {
        let distance = self.number(VOLUME, "attenuationDistance", f64::INFINITY);
        let colour = self.colour(VOLUME, "attenuationColor").unwrap_or(Spectrum::WHITE);
        let colour = self.colour_within(colour, [0.0, 1.0], "attenuationColor");
        if distance <= 0.0 {
            self.approximate("attenuationDistance not above 0", "the volume takes no light");
        }
        if distance.is_finite() && distance > 0.0 && colour != Spectrum::WHITE {
            let place = self.place();
            keys.attenuation_color = Some(place.at(Rgb::<Fraction>::of(colour)?));
            keys.attenuation_distance = Some(place.at(Checked::of(distance)?));
        }
        Ok(())
    }

    fn normal_map(&mut self, entry: &mut MaterialEntry) -> Result<(), String> {
        let Some(info) = self.material.normal_texture.clone() else { return Ok(()) };
        let (name, place) = (self.lookup(&info, TextureRole::Normals, "normal", None)?, self.place());
        let common = entry.common_mut();
        *common.normal_map = Some(place.at(TextureName(name)));
        *common.normal_scale = normal_scale(&info, &place)?;
        Ok(())
    }

    fn emission(&mut self, entry: &mut MaterialEntry) -> Result<(), String> {
        let strength = self.number("KHR_materials_emissive_strength", "emissiveStrength", 1.0);
        let strength = self.within(strength, [0.0, f64::MAX], "emissiveStrength");
        // Above 1 it is as bright as it says.
        let factor =
            self.colour_within(Spectrum::from_rgb(self.material.emissive_factor), [0.0, f64::MAX], "emissiveFactor") * strength;
        if factor == Spectrum::BLACK {
            return Ok(());
        }
        let emission = match self.material.emissive_texture.clone() {
            Some(info) => self.texture(&info, TextureRole::Colour, factor, "emission")?,
            None => Input::Constant(factor),
        };
        if matches!(entry, MaterialEntry::Emissive(_)) {
            self.approximate("emission of an unlit material", "its colour alone counts");
            return Ok(());
        }
        let (place, common) = (self.place(), entry.common_mut());
        *common.emission = Some(place.at(emission.colour(&place)?));
        *common.emission_two_sided = self.material.double_sided.then(|| place.at(true));
        Ok(())
    }

    /// Names what of known extensions has no effect.
    fn report_extensions(&mut self) {
        if self.material.occlusion_texture.is_some() {
            self.drop("occlusionTexture", "light is traced, so what is hidden is dark by itself");
        }
    }

    /// Adds a material beside this one; its name.
    fn extra(&mut self, what: &str, mut entry: MaterialEntry) -> String {
        let name = format!("{}, {what}", self.material.name.as_deref().unwrap_or("(unnamed)"));
        let name = self.importer.scene.free_material_name(&name);
        *entry.common_mut().name = self.place().at(name.clone());
        self.importer.scene.file.material.push(entry);
        name
    }

    /// A texture times a factor.
    fn texture(&mut self, info: &TextureInfo, role: TextureRole, factor: Spectrum, what: &str) -> Result<Input, String> {
        Ok(Input::Texture(self.lookup(info, role, what, None)?, factor))
    }

    /// The base colour's texture, multiplied by the vertex colours; its name.
    fn base_texture(&mut self, info: &TextureInfo) -> Result<String, String> {
        self.lookup(info, TextureRole::Colour, "base colour", self.form.paint.as_ref().map(|paint| paint.texture.as_str()))
    }
}

impl Surface<'_, '_> {
    /// The texture of a lookup, multiplied by another; its name.
    fn lookup(&mut self, info: &TextureInfo, role: TextureRole, what: &str, times: Option<&str>) -> Result<String, String> {
        let lookup = Lookup::of(info)?;
        let coordinates = self.lookups.coordinates;
        if Some(lookup.set) == coordinates.second {
            self.coordinates.get_or_insert(coordinates);
            // On coordinates as they are written every placement can be said.
            let placement = lookup.about(&DAffine2::IDENTITY).flatten();
            return self.importer.texture(info.index, role, placement, UvsOf::Second, times);
        }
        if lookup.set != coordinates.set {
            let message = format!("set of texture coordinates of the {what}");
            self.approximate(&message, "a mesh has two sets, and this is a third one");
        }
        let placement = lookup.about(&coordinates.map).unwrap_or_else(|| {
            let message = format!("KHR_texture_transform of the {what}");
            self.approximate(&message, "what is turned and stretched beside the normal map lies as that does");
            None
        });
        self.coordinates.get_or_insert(coordinates);
        let by = if self.form.is_framed { UvsOf::Framed } else { UvsOf::First };
        self.importer.texture(info.index, role, placement, by, times)
    }
}

/// The reflectance along the normal of a surface of an index of refraction.
fn normal_reflectance(ior: f64) -> f64 {
    ((ior - 1.0) / (ior + 1.0)).powi(2)
}

/// By how much a normal map bends, where it is not as its texels say.
fn normal_scale(info: &TextureInfo, place: &Place) -> Result<Option<Located<Number>>, String> {
    let scale = info.scale.filter(|scale| *scale != 1.0);
    scale.map(|scale| Number::of(scale).map(|scale| place.at(scale))).transpose()
}

/// A blend's weight by the alpha of a texture.
fn alpha_weight(name: &str, factor: f64, place: &Place) -> Result<BlendWeightEntry, String> {
    BlendWeightEntry::channel(place.at(TextureName(name.to_owned())), ChannelName::A, factor)
}
