//! Materials, with the extensions that they need.

use serde_json::{Map, Value, json};

use super::Writer;
use super::draft::{Alpha, Draft, Share};
use super::made::Made;
use super::packing::Factors;
use super::volume::has_volume;
use crate::scene::{BlendWeight, Channel, CoatNormalMap, ColorInput, MaterialId, Principled, Relief, Shape, TextureId};
use crate::scene_writer::emission::emission_of;
use crate::scene_writer::inputs::{Colour, Scalar};
use crate::scene_writer::weights;
use crate::spectrum::Spectrum;

/// The largest colour of reflection of a dielectric.
const ANY: f64 = f64::MAX;

impl Writer<'_> {
    /// Writes a material once; None where nothing is to be seen.
    pub fn material(&mut self, id: MaterialId) -> Option<Made> {
        if let Some(made) = self.made_materials.get(&id) {
            return made.clone();
        }
        let draft = self.draft(id, 0);
        let made = draft.map(|draft| self.write(id, draft));
        self.made_materials.insert(id, made.clone());
        made
    }

    fn write(&mut self, id: MaterialId, mut draft: Draft) -> Made {
        let place = &self.place_of(id);
        let emission = emission_of(self.scene, id, place, &mut self.losses);
        if let Some(emission) = emission {
            // A surface that is there by a share gives off its light by that share too.
            draft.emission = match &draft.alpha {
                Alpha::Opaque => Some(emission.radiance),
                Alpha::Blend(Share::Constant(share)) if *share > 0.0 => {
                    Some(emission.radiance.scaled(Spectrum::grey(1.0 / share)))
                }
                _ => {
                    self.approximate("light of a surface that is not everywhere", place, "it is given off where the surface is");
                    Some(emission.radiance)
                }
            };
            // Light leaves both sides there, or the one that there is.
            if !emission.two_sided && draft.double_sided && self.encloses(id) {
                // Nobody sees the other side.
                draft.double_sided = false;
            } else if !emission.two_sided && draft.double_sided {
                self.approximate("light of one side", place, "the other side is not there");
                draft.double_sided = false;
            } else if emission.two_sided && !draft.double_sided {
                self.approximate(
                    "light of both sides of a surface that is there from the front alone",
                    place,
                    "the front alone shines",
                );
            }
        }
        let Draft { surface, alpha, emission, normal_map, double_sided, interior } = draft;
        let mut material = json!({ "name": self.materials.get(id) });
        self.uses_sets = [surface.anisotropy.is_some(), false];
        // Surfaces with a volume have both sides by themselves.
        let shines_within = emission.is_some() && double_sided;
        if double_sided && (shines_within || !has_volume(&surface, interior)) {
            material["doubleSided"] = json!(true);
        }
        let (paint, colour) = self.without_paint(Colour::of(surface.base_color));
        let (mode, cutoff, share) = match &alpha {
            Alpha::Opaque => (None, None, None),
            Alpha::Blend(share) => (Some("BLEND"), None, Some(share)),
            Alpha::Mask(share, cutoff) => (Some("MASK"), Some(*cutoff), Some(share)),
        };
        if let Some(mode) = mode {
            material["alphaMode"] = json!(mode);
        }
        if let Some(cutoff) = cutoff {
            material["alphaCutoff"] = json!(cutoff);
        }
        let painted = painted_share(share, paint);
        let (base, texture) = self.base(colour, painted.as_ref().or(share), place);
        let mut pbr = json!({ "baseColorFactor": base });
        if let Some(texture) = texture {
            pbr["baseColorTexture"] = texture;
        }
        let [metallic, roughness] = [surface.metallic, surface.roughness].map(Scalar::of);
        let Factors { factors: [metallic, roughness], texture } =
            self.numbers([(Channel::B, metallic), (Channel::G, roughness)], place);
        pbr["metallicFactor"] = json!(metallic);
        pbr["roughnessFactor"] = json!(roughness);
        if let Some(texture) = texture {
            pbr["metallicRoughnessTexture"] = texture;
        }
        material["pbrMetallicRoughness"] = pbr;
        if let Some(texture) = normal_map.and_then(|texture| self.normal_map(texture, place)) {
            material["normalTexture"] = texture;
        }
        let mut extensions = self.extensions_of(&surface, place);
        extensions.extend(self.volume(&surface, interior, place));
        if let Some(radiance) = emission {
            self.emission(&mut material, &mut extensions, radiance, place);
        }
        if !extensions.is_empty() {
            material["extensions"] = Value::Object(extensions);
        }
        self.lists.materials.push(material);
        let is_directed = surface.anisotropy.is_some() || surface.is_coated() && surface.coat_normal_map.is_some();
        let needs_tangents = is_directed && normal_map.is_none();
        let (index, uses_sets) = (self.lists.materials.len() - 1, self.uses_sets);
        Made { index, paint, paints_alpha: painted.is_some(), uses_sets, needs_tangents }
    }

    /// All shapes of the material are closed: nothing is seen of their backs.
    fn encloses(&self, id: MaterialId) -> bool {
        let of_it = self.scene.shapes.iter().filter(|shape| shape.materials().any(|material| material == id));
        of_it.into_iter().all(Shape::is_closed)
    }

    /// The light that a surface gives off: a colour from 0 to 1, and by how much it is stronger.
    fn emission(&mut self, material: &mut Value, extensions: &mut Map<String, Value>, radiance: ColorInput, place: &str) {
        let (factor, texture) = self.colour(Colour::of(radiance), ANY, place);
        let strength = factor.max_component().max(1.0);
        material["emissiveFactor"] = json!((factor / strength).to_rgb());
        if let Some(texture) = texture {
            material["emissiveTexture"] = texture;
        }
        if strength > 1.0 {
            let name = self.uses("KHR_materials_emissive_strength");
            extensions.insert(name.to_owned(), json!({ "emissiveStrength": strength }));
        }
    }

    fn normal_map(&mut self, id: TextureId, place: &str) -> Option<Value> {
        let texture = &self.scene.textures[id];
        if texture.shadows_perturbed_normals {
            self.drop("normal_shadowing", place, "light that reaches bent normals does not fade");
        }
        match texture.relief {
            Relief::Normals(scale) => self.directions(id, scale, place),
            Relief::Heights(_) => {
                self.drop("bump map", place, "normals are not bent");
                None
            }
        }
    }

    fn extensions_of(&mut self, surface: &Principled, place: &str) -> Map<String, Value> {
        let mut extensions = Map::new();
        let mut add = |name: &str, keys: Value| drop(extensions.insert(name.to_owned(), keys));
        if surface.ior != 1.5 {
            add(self.uses("KHR_materials_ior"), json!({ "ior": surface.ior }));
        }
        let [specular, transmission, clearcoat] = [surface.specular, surface.transmission, surface.clearcoat].map(Scalar::of);
        let specular_color = Colour::of(surface.specular_color);
        if !specular.is(1.0) || !specular_color.is(Spectrum::WHITE) {
            let Factors { factors: [factor], texture } = self.numbers([(Channel::A, specular)], place);
            let (colour, colour_texture) = self.colour(specular_color, ANY, place);
            let mut keys = json!({ "specularFactor": factor });
            set(&mut keys, "specularTexture", texture);
            if colour != Spectrum::WHITE || colour_texture.is_some() {
                keys["specularColorFactor"] = json!(colour.to_rgb());
            }
            set(&mut keys, "specularColorTexture", colour_texture);
            add(self.uses("KHR_materials_specular"), keys);
        }
        if !transmission.is(0.0) {
            let Factors { factors: [factor], texture } = self.numbers([(Channel::R, transmission)], place);
            let mut keys = json!({ "transmissionFactor": factor });
            set(&mut keys, "transmissionTexture", texture);
            add(self.uses("KHR_materials_transmission"), keys);
        }
        let passed = Scalar::of(surface.diffuse_transmission);
        if !passed.is(0.0) {
            let Factors { factors: [factor], texture } = self.numbers([(Channel::A, passed)], place);
            let (colour, colour_texture) = self.colour(Colour::of(surface.diffuse_transmission_color), 1.0, place);
            let mut keys = json!({ "diffuseTransmissionFactor": factor, "diffuseTransmissionColorFactor": colour.to_rgb() });
            set(&mut keys, "diffuseTransmissionTexture", texture);
            set(&mut keys, "diffuseTransmissionColorTexture", colour_texture);
            add(self.uses("KHR_materials_diffuse_transmission"), keys);
        }
        if !clearcoat.is(0.0) {
            let keys = self.clearcoat(surface, clearcoat, place);
            add(self.uses("KHR_materials_clearcoat"), keys);
        }
        let sheen = Colour::of(surface.sheen_color);
        if !sheen.is(Spectrum::BLACK) {
            let (colour, texture) = self.colour(sheen, 1.0, place);
            let roughness = Scalar::of(surface.sheen_roughness);
            let Factors { factors: [roughness], texture: of_roughness } = self.numbers([(Channel::A, roughness)], place);
            let mut keys = json!({ "sheenColorFactor": colour.to_rgb(), "sheenRoughnessFactor": roughness });
            set(&mut keys, "sheenColorTexture", texture);
            set(&mut keys, "sheenRoughnessTexture", of_roughness);
            add(self.uses("KHR_materials_sheen"), keys);
        }
        if let Some(anisotropy) = surface.anisotropy {
            let (strength, texture) = self.anisotropy(Scalar::of(anisotropy), surface.anisotropy_direction, place);
            let rotation = surface.anisotropy_rotation_degrees.to_radians();
            let mut keys = json!({ "anisotropyStrength": strength, "anisotropyRotation": rotation });
            set(&mut keys, "anisotropyTexture", texture);
            add(self.uses("KHR_materials_anisotropy"), keys);
        }
        if surface.thin_film.is_some() {
            let keys = self.film(surface, place);
            add(self.uses("KHR_materials_iridescence"), keys);
        }
        extensions
    }

    fn clearcoat(&mut self, surface: &Principled, clearcoat: Scalar, place: &str) -> Value {
        let Factors { factors: [factor], texture } = self.numbers([(Channel::R, clearcoat)], place);
        let roughness = Scalar::of(surface.clearcoat_roughness);
        let Factors { factors: [roughness], texture: of_roughness } = self.numbers([(Channel::G, roughness)], place);
        let mut keys = json!({ "clearcoatFactor": factor, "clearcoatRoughnessFactor": roughness });
        set(&mut keys, "clearcoatTexture", texture);
        set(&mut keys, "clearcoatRoughnessTexture", of_roughness);
        let normals = surface.coat_normal_map.and_then(|CoatNormalMap { texture, scale }| self.directions(texture, scale, place));
        set(&mut keys, "clearcoatNormalTexture", normals);
        keys
    }

    /// A film: as thick as the minimum where its texture is 0, and as the maximum where that is 1.
    fn film(&mut self, surface: &Principled, place: &str) -> Value {
        let Some(film) = surface.thin_film else { return json!({}) };
        let Factors { factors: [share], texture } = self.numbers([(Channel::R, Scalar::of(surface.thin_film_share))], place);
        let mut keys = json!({ "iridescenceFactor": share, "iridescenceIor": film.ior });
        set(&mut keys, "iridescenceTexture", texture);
        match Scalar::of(film.thickness) {
            Scalar::Constant(thickness) => {
                keys["iridescenceThicknessMaximum"] = json!(thickness + film.offset);
            }
            Scalar::Map(mut map) => {
                // Nanometres are in the minimum and the maximum.
                let thickest = std::mem::replace(&mut map.factor, 1.0);
                if map.is_squared {
                    self.approximate("square of a texture of thickness", place, "the texture is taken");
                    map.is_squared = false;
                }
                let Factors { factors: [_], texture } = self.numbers([(Channel::G, Scalar::Map(map))], place);
                keys["iridescenceThicknessMinimum"] = json!(film.offset);
                keys["iridescenceThicknessMaximum"] = json!(film.offset + thickest);
                set(&mut keys, "iridescenceThicknessTexture", texture);
            }
        }
        keys
    }
}

/// The opacity that is left beside the vertices' alpha, if the share is that of the paint.
fn painted_share(share: Option<&Share>, paint: Option<TextureId>) -> Option<Share> {
    let Some(Share::Texels { weight, is_rest: false }) = share else { return None };
    let (texture, _) = weights::of_texels(weight)?;
    match weight {
        BlendWeight::Channel { channel: Channel::A, factor, .. } if Some(texture) == paint => Some(Share::Constant(*factor)),
        _ => None,
    }
}

fn set(keys: &mut Value, name: &str, value: Option<Value>) {
    if let Some(value) = value {
        keys[name] = value;
    }
}
