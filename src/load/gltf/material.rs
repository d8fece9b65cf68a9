//! Materials and their textures.

use glam::{DAffine2, DVec3};

use super::importer::Importer;
use super::json::{Material, TextureInfo, extension};
use super::lookup::{Lookup, Lookups};
use super::made::{Coordinates, MadeMaterial, Paint};
use crate::load::import::{Entry, Keys, Value};

/// Index of refraction where nothing is said.
const IOR: f64 = 1.5;

impl Importer<'_> {
    /// The material of a primitive; None for the one that the specification gives where none is named.
    pub fn material(&mut self, index: Option<usize>) -> Result<MadeMaterial, String> {
        if let Some(made) = self.materials.get(&index) {
            return Ok(made.clone());
        }
        let made = match index {
            None => self.make_material(&Material::default(), "(default)", String::new()),
            Some(index) => {
                let material =
                    self.root.materials.get(index).cloned().ok_or_else(|| format!("there is no materials[{index}]"))?;
                let name = material.name.clone().unwrap_or_else(|| format!("material {index}"));
                self.make_material(&material, &name, format!("materials[{index}]"))
            }
        };
        let made = made.map_err(|message| match index {
            Some(index) => format!("materials[{index}]: {message}"),
            None => message,
        })?;
        self.materials.insert(index, made.clone());
        Ok(made)
    }

    /// The material once more, its base colour multiplied by a texture of vertex colours.
    pub fn painted_material(&mut self, index: Option<usize>, paint: &Paint) -> Result<MadeMaterial, String> {
        let material = index.and_then(|index| self.root.materials.get(index)).cloned().unwrap_or_default();
        let name = material.name.clone().unwrap_or_else(|| "painted".to_owned());
        let place = index.map_or_else(String::new, |index| format!("materials[{index}]"));
        self.make_painted_material(&material, &name, place, Some(paint))
    }

    fn make_material(&mut self, material: &Material, name: &str, place: String) -> Result<MadeMaterial, String> {
        self.make_painted_material(material, name, place, None)
    }

    fn make_painted_material(
        &mut self,
        material: &Material,
        name: &str,
        place: String,
        paint: Option<&Paint>,
    ) -> Result<MadeMaterial, String> {
        let lookups = Lookups::of(material)?;
        let mut surface = Surface { importer: self, material, place, lookups, coordinates: None, paint };
        let keys = surface.keys()?;
        let coordinates = surface.coordinates;
        let place = surface.place;
        let name = self.scene.free_material_name(name);
        let mut named = Keys::new().with("name", name.as_str());
        named.0.extend(keys.0);
        self.scene.materials.push(Entry { place: self.place(&place), keys: named });
        Ok(MadeMaterial { name, coordinates })
    }
}

/// A material in the making.
struct Surface<'s, 'i> {
    importer: &'s mut Importer<'i>,
    material: &'s Material,
    place: String,
    lookups: Lookups,
    coordinates: Option<Coordinates>,
    /// What multiplies the base colour.
    paint: Option<&'s Paint>,
}

impl Surface<'_, '_> {
    fn number(&mut self, of: &str, key: &str, default: f64) -> f64 {
        let value = self.material.extensions.get(of).and_then(|object| object.get(key)).and_then(serde_json::Value::as_f64);
        value.unwrap_or(default)
    }

    fn approximate(&mut self, what: &str, instead: &str) {
        self.importer.scene.report.approximate(what, self.importer.place(&self.place).to_string(), instead);
    }

    fn drop(&mut self, what: &str, instead: &str) {
        self.importer.scene.report.drop(what, self.importer.place(&self.place).to_string(), instead);
    }

    fn keys(&mut self) -> Result<Keys, String> {
        let pbr = self.material.pbr_metallic_roughness.clone();
        let factor = pbr.base_color_factor.unwrap_or([1.0; 4]);
        let colour = DVec3::new(factor[0], factor[1], factor[2]).clamp(DVec3::ZERO, DVec3::ONE);
        let base = match &pbr.base_color_texture {
            Some(info) => {
                let name = self.base_texture(info)?;
                reference(&name, colour)
            }
            None => self.paint.map_or_else(|| constant(colour), |paint| reference(&paint.texture, colour)),
        };
        self.report_extensions();
        let mut keys = if self.material.extensions.contains_key("KHR_materials_unlit") {
            self.approximate("KHR_materials_unlit", "the surface gives light of its colour, which falls on others too");
            Keys::of_type("emissive").with("radiance", base.clone()).with("two_sided", true)
        } else {
            self.lit(base.clone())?
        };
        self.normal_map(&mut keys)?;
        self.emission(&mut keys)?;
        self.see_through(keys, factor[3])
    }

    /// What scatters light: the metallic-roughness material with its extensions.
    fn lit(&mut self, base: Value) -> Result<Keys, String> {
        const SPECULAR: &str = "KHR_materials_specular";
        const TRANSMISSION: &str = "KHR_materials_transmission";
        const CLEARCOAT: &str = "KHR_materials_clearcoat";
        const ANISOTROPY: &str = "KHR_materials_anisotropy";
        const SHEEN: &str = "KHR_materials_sheen";
        let pbr = self.material.pbr_metallic_roughness.clone();
        let map = match &pbr.metallic_roughness_texture {
            Some(info) => self.texture_name(info, "metallic and roughness")?,
            None => None,
        };
        // Of the texture, green is roughness and blue metallic.
        let share = |factor: Option<f64>| factor.unwrap_or(1.0).clamp(0.0, 1.0);
        let metallic = of_channel(map.as_deref(), "b", share(pbr.metallic_factor));
        let roughness = of_channel(map.as_deref(), "g", share(pbr.roughness_factor));
        let specular = self.factor(SPECULAR, "specularFactor", 1.0, "specularTexture", "a")?;
        let transmission = self.factor(TRANSMISSION, "transmissionFactor", 0.0, "transmissionTexture", "r")?;
        let clearcoat = self.factor(CLEARCOAT, "clearcoatFactor", 0.0, "clearcoatTexture", "r")?;
        let sheen = self.tint(SHEEN, "sheenColorFactor", [DVec3::ZERO, DVec3::ONE], "sheenColorTexture")?;
        let [none, one] = [0.0, 1.0].map(Value::Number);
        if [&metallic, &transmission, &specular, &clearcoat, &sheen].into_iter().all(|share| *share == none) {
            return Ok(Keys::of_type("diffuse").with("reflectance", base));
        }
        let ior = self.number("KHR_materials_ior", "ior", IOR);
        let mut keys =
            Keys::of_type("principled").with("base_color", base).with("metallic", metallic).with("roughness", roughness);
        keys.set("ior", if ior == 0.0 { 10.0 } else { ior.clamp(1.0, 10.0) });
        if specular != one {
            keys.set("specular", specular);
        }
        let tint = self.tint(SPECULAR, "specularColorFactor", [DVec3::ONE, DVec3::MAX], "specularColorTexture")?;
        if tint != one {
            keys.set("specular_color", tint);
        }
        if transmission != none {
            keys.set("transmission", transmission);
            // What has no volume is a wall without thickness.
            if self.number("KHR_materials_volume", "thicknessFactor", 0.0) == 0.0 {
                keys.set("thin", true);
            } else {
                self.attenuation(&mut keys);
            }
        }
        if sheen != none {
            let roughness = self.factor(SHEEN, "sheenRoughnessFactor", 0.0, "sheenRoughnessTexture", "a")?;
            keys.set("sheen_color", sheen);
            keys.set("sheen_roughness", roughness);
        }
        if clearcoat != none {
            let roughness = self.factor(CLEARCOAT, "clearcoatRoughnessFactor", 0.0, "clearcoatRoughnessTexture", "g")?;
            keys.set("clearcoat", clearcoat);
            keys.set("clearcoat_roughness", roughness);
            if let Some(info) = self.texture_of(CLEARCOAT, "clearcoatNormalTexture")?
                && let Some(name) = self.texture_name(&info, "clearcoatNormalTexture")?
            {
                keys.set("coat_normal_map", name);
                if let Some(scale) = info.scale.filter(|scale| *scale != 1.0) {
                    keys.set("coat_normal_scale", scale);
                }
            }
        }
        let anisotropy = self.factor(ANISOTROPY, "anisotropyStrength", 0.0, "anisotropyTexture", "b")?;
        if anisotropy != none {
            keys.set("anisotropy", anisotropy);
            if let Some(info) = self.texture_of(ANISOTROPY, "anisotropyTexture")?
                && let Some(name) = self.texture_name(&info, "anisotropyTexture")?
            {
                keys.set("anisotropy_direction", name);
            }
            keys.set("anisotropy_rotation", self.number(ANISOTROPY, "anisotropyRotation", 0.0).to_degrees());
            // Directions follow texture coordinates.
            self.coordinates.get_or_insert(Coordinates { set: 0, map: DAffine2::IDENTITY, second: None });
        }
        Ok(keys)
    }

    /// A factor of an extension, times a channel of its texture.
    fn factor(&mut self, of: &str, key: &str, default: f64, texture: &str, channel: &str) -> Result<Value, String> {
        let factor = self.number(of, key, default).clamp(0.0, 1.0);
        let map = match self.texture_of(of, texture)? {
            Some(info) if factor > 0.0 => self.texture_name(&info, texture)?,
            _ => None,
        };
        Ok(of_channel(map.as_deref(), channel, factor))
    }

    /// A texture of an extension.
    fn texture_of(&self, of: &str, key: &str) -> Result<Option<TextureInfo>, String> {
        match self.material.extensions.get(of).and_then(serde_json::Value::as_object) {
            Some(object) => extension(object, key),
            None => Ok(None),
        }
    }

    /// A colour of an extension, times its texture; `limits` are what it is where it is not written, and the most that it can be.
    fn tint(&mut self, of: &str, key: &str, limits: [DVec3; 2], texture: &str) -> Result<Value, String> {
        let [default, most] = limits;
        let factor = self.colour(of, key).unwrap_or(default).clamp(DVec3::ZERO, most);
        match self.texture_of(of, texture)? {
            Some(info) if factor != DVec3::ZERO => self.texture(&info, false, factor, texture),
            _ => Ok(constant(factor)),
        }
    }

    /// Three numbers of an extension.
    fn colour(&self, of: &str, key: &str) -> Option<DVec3> {
        let list = self.material.extensions.get(of)?.get(key)?.as_array()?;
        let channels: Option<Vec<f64>> = list.iter().map(serde_json::Value::as_f64).collect();
        <[f64; 3]>::try_from(channels?).ok().map(DVec3::from)
    }

    /// What takes light within a volume. Without a distance, or white, nothing does.
    fn attenuation(&mut self, keys: &mut Keys) {
        const VOLUME: &str = "KHR_materials_volume";
        let distance = self.number(VOLUME, "attenuationDistance", f64::INFINITY);
        let colour = self.colour(VOLUME, "attenuationColor").unwrap_or(DVec3::ONE).clamp(DVec3::ZERO, DVec3::ONE);
        if distance.is_finite() && distance > 0.0 && colour != DVec3::ONE {
            keys.set("attenuation_color", constant(colour));
            keys.set("attenuation_distance", distance);
        }
    }

    /// The first by its share, the second by the rest.
    fn mixed(&mut self, first: Keys, second: Keys, share: Keys, what: &str) -> Keys {
        let (first, second) = (self.extra(what, first), self.extra("rest", second));
        Keys::of_type("blend").with("materials", vec![first, second]).with("weight", share)
    }

    /// The surface as far as its alpha says, else what is behind.
    fn see_through(&mut self, keys: Keys, factor: f64) -> Result<Keys, String> {
        let cutoff = match self.material.alpha_mode.as_deref() {
            None | Some("OPAQUE") => return Ok(keys),
            Some("MASK") => Some(self.material.alpha_cutoff.unwrap_or(0.5)),
            Some(_) => None,
        };
        let factor = factor.clamp(0.0, 1.0);
        let map = match self.material.pbr_metallic_roughness.base_color_texture.clone() {
            Some(info) => Some(self.base_texture(&info)?),
            None => self.paint.filter(|paint| paint.has_alpha).map(|paint| paint.texture.clone()),
        };
        let share = match (map, cutoff) {
            (None, Some(cutoff)) => return Ok(if factor < cutoff { Keys::of_type("pass") } else { keys }),
            (None, None) if factor == 1.0 => return Ok(keys),
            (None, None) if factor == 0.0 => return Ok(Keys::of_type("pass")),
            (None, None) => Keys::of_type("constant").with("value", factor),
            (Some(map), None) => channel_weight(&map, "a", factor),
            (Some(map), Some(cutoff)) => {
                Keys::of_type("threshold").with("tau", cutoff).with("of", channel_weight(&map, "a", factor))
            }
        };
        // The whole surface has the light and the normals of its opaque part.
        let (on_whole, of_part): (Vec<_>, Vec<_>) =
            keys.0.into_iter().partition(|(key, _)| ["normal_map", "normal_scale"].contains(key));
        let mut mixed = self.mixed(Keys(of_part), Keys::of_type("pass"), share, "surface");
        mixed.0.extend(on_whole);
        Ok(mixed)
    }

    fn normal_map(&mut self, keys: &mut Keys) -> Result<(), String> {
        let Some(info) = self.material.normal_texture.clone() else { return Ok(()) };
        if let Value::Table(texture) = self.texture(&info, true, DVec3::ONE, "normal")?
            && let Some(name) = texture.text("texture")
        {
            keys.set("normal_map", name);
            if let Some(scale) = info.scale.filter(|scale| *scale != 1.0) {
                keys.set("normal_scale", scale);
            }
        }
        Ok(())
    }

    fn emission(&mut self, keys: &mut Keys) -> Result<(), String> {
        let strength = self.number("KHR_materials_emissive_strength", "emissiveStrength", 1.0).max(0.0);
        let factor = DVec3::from(self.material.emissive_factor).max(DVec3::ZERO) * strength;
        if factor == DVec3::ZERO {
            return Ok(());
        }
        let emission = match self.material.emissive_texture.clone() {
            Some(info) => self.texture(&info, false, factor, "emission")?,
            None => constant(factor),
        };
        if keys.text("type") == Some("emissive") {
            self.approximate("emission of an unlit material", "its colour alone counts");
            return Ok(());
        }
        keys.set("emission", emission);
        if self.material.double_sided {
            keys.set("emission_two_sided", true);
        }
        Ok(())
    }

    /// Names what of known extensions has no effect.
    fn report_extensions(&mut self) {
        const PARTS: [(&str, &str); 4] = [
            ("KHR_materials_iridescence", "there is no thin film"),
            ("KHR_materials_dispersion", "all colours are bent alike"),
            ("KHR_materials_diffuse_transmission", "light does not come through"),
            ("KHR_materials_pbrSpecularGlossiness", "the metallic-roughness parameters count"),
        ];
        let volume = self.material.extensions.get("KHR_materials_volume");
        if volume.is_some_and(|volume| volume.get("thicknessTexture").is_some()) {
            self.drop("KHR_materials_volume: thicknessTexture", "thickness is that of the shape");
        }
        for (name, instead) in PARTS {
            if self.material.extensions.contains_key(name) {
                self.drop(name, instead);
            }
        }
        if self.material.occlusion_texture.is_some() {
            self.drop("occlusionTexture", "light is traced, so what is hidden is dark by itself");
        }
    }

    fn extra(&mut self, what: &str, keys: Keys) -> Value {
        let name = format!("{}, {what}", self.material.name.as_deref().unwrap_or("(unnamed)"));
        let name = self.importer.scene.free_material_name(&name);
        let mut named = Keys::new().with("name", name.as_str());
        named.0.extend(keys.0);
        let place = self.importer.place(&self.place);
        self.importer.scene.materials.push(Entry { place, keys: named });
        Value::Text(name)
    }

    /// The name of a texture of numbers.
    fn texture_name(&mut self, info: &TextureInfo, what: &str) -> Result<Option<String>, String> {
        let Value::Table(keys) = self.texture(info, true, DVec3::ONE, what)? else { return Ok(None) };
        Ok(keys.text("texture").map(str::to_owned))
    }

    /// `{ texture = … }`, or a constant where there is no picture.
    fn texture(&mut self, info: &TextureInfo, linear: bool, factor: DVec3, what: &str) -> Result<Value, String> {
        let name = self.lookup(info, linear, what, None)?;
        Ok(reference(&name, factor))
    }

    /// The base colour's texture, multiplied by the vertex colours; its name.
    fn base_texture(&mut self, info: &TextureInfo) -> Result<String, String> {
        self.lookup(info, false, "base colour", self.paint.map(|paint| paint.texture.as_str()))
    }
}

impl Surface<'_, '_> {
    /// The texture of a lookup, multiplied by another; its name.
    fn lookup(&mut self, info: &TextureInfo, linear: bool, what: &str, times: Option<&str>) -> Result<String, String> {
        let lookup = Lookup::of(info)?;
        let coordinates = self.lookups.coordinates;
        if Some(lookup.set) == coordinates.second {
            self.coordinates.get_or_insert(coordinates);
            // On coordinates as they are written every placement can be said.
            let placement = lookup.about(&DAffine2::IDENTITY).flatten();
            return self.importer.texture(info.index, linear, placement, true, times);
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
        self.importer.texture(info.index, linear, placement, false, times)
    }
}

/// A texture of colours, times a factor.
fn reference(texture: &str, factor: DVec3) -> Value {
    let factor = (factor != DVec3::ONE).then(|| constant(factor));
    Value::Table(Keys::new().with("texture", texture).with_some("factor", factor))
}

/// A number for grey.
fn constant(colour: DVec3) -> Value {
    if colour.min_element() == colour.max_element() { Value::Number(colour.x) } else { colour.into() }
}

/// A channel of a texture, times a factor.
fn channel_of(name: &str, channel: &str, factor: f64) -> Keys {
    let keys = Keys::new().with("texture", name).with("channel", channel);
    keys.with_some("factor", (factor != 1.0).then_some(factor))
}

/// A blend's weight by a channel.
fn channel_weight(name: &str, channel: &str, factor: f64) -> Keys {
    let mut keys = Keys::of_type("texture");
    keys.0.extend(channel_of(name, channel, factor).0);
    keys
}

/// A factor, times a channel where there is a texture.
fn of_channel(texture: Option<&str>, channel: &str, factor: f64) -> Value {
    match texture {
        Some(name) => Value::Table(channel_of(name, channel, factor)),
        None => Value::Number(factor),
    }
}
