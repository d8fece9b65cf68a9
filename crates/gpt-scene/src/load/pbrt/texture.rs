//! Textures by their names, as trees of what they are made of.

use std::rc::Rc;

use super::converter::Converter;
use super::directives::unknown;
use super::parameter::{Entity, Kind};
use super::spectrum::{SPECTRA, SpectrumKind};
use super::text::Spot;
use super::texture_node::{ImageLeaf, NodeKind, Placement, TextureNode};
use super::world::PlacedEntity;
use crate::load::error::SceneError;
use crate::load::file::syntax::{TextureFilterEntry, WrapEntry};
use crate::spectrum::Spectrum;

/// Most textures within each other.
const DEEPEST: usize = 64;
impl Converter<'_> {
    /// A parameter that is a number or a texture of numbers; None where it is not written.
    pub fn float_node(&mut self, entity: &Entity, name: &str) -> Result<Option<Rc<TextureNode>>, SceneError> {
        self.float_node_within(entity, name, 0)
    }

    /// A parameter that is a spectrum or a texture of spectra; None where it is not written.
    pub fn spectrum_node(
        &mut self,
        entity: &Entity,
        name: &str,
        kind: SpectrumKind,
    ) -> Result<Option<Rc<TextureNode>>, SceneError> {
        self.spectrum_node_within(entity, name, kind, 0)
    }

    fn float_node_within(&mut self, entity: &Entity, name: &str, depth: usize) -> Result<Option<Rc<TextureNode>>, SceneError> {
        if let Some(texture) = entity.texture(name)?.map(str::to_owned) {
            return self.float_texture(&texture, entity.spot_of(name), depth).map(Some);
        }
        Ok(entity.float(name)?.map(|number| TextureNode::constant(Spectrum::grey(number))))
    }

    fn spectrum_node_within(
        &mut self,
        entity: &Entity,
        name: &str,
        kind: SpectrumKind,
        depth: usize,
    ) -> Result<Option<Rc<TextureNode>>, SceneError> {
        let kinds = [&[Kind::Texture][..], &SPECTRA].concat();
        let Some(parameter) = entity.find(name, &kinds).cloned() else { return Ok(None) };
        if parameter.kind != Kind::Texture {
            return self.colour_of(&parameter, kind).map(|colour| Some(TextureNode::constant(colour)));
        }
        match parameter.texts() {
            [texture] => self.spectrum_texture(&texture.clone(), &parameter.spot, kind, depth).map(Some),
            _ => Err(parameter.spot.error(format!("`{name}` has one texture"))),
        }
    }

    fn float_texture(&mut self, name: &str, spot: &Spot, depth: usize) -> Result<Rc<TextureNode>, SceneError> {
        if let Some(known) = self.float_textures.get(name) {
            return Ok(known.clone());
        }
        let world = self.world.clone();
        let Some(placed) = world.float_textures.get(name) else {
            return Err(unknown("texture of float", name, spot, world.float_textures.keys()));
        };
        let kind = self.node(placed, None, depth, spot)?;
        let node = Rc::new(TextureNode::of(kind, name));
        self.float_textures.insert(name.to_owned(), node.clone());
        Ok(node)
    }

    fn spectrum_texture(
        &mut self,
        name: &str,
        spot: &Spot,
        kind: SpectrumKind,
        depth: usize,
    ) -> Result<Rc<TextureNode>, SceneError> {
        let key = format!("{kind:?} {name}");
        if let Some(known) = self.spectrum_textures.get(&key) {
            return Ok(known.clone());
        }
        let world = self.world.clone();
        let Some(placed) = world.spectrum_textures.get(name) else {
            return Err(unknown("texture of spectrum", name, spot, world.spectrum_textures.keys()));
        };
        let made = self.node(placed, Some(kind), depth, spot)?;
        let node = Rc::new(TextureNode::of(made, name));
        self.spectrum_textures.insert(key, node.clone());
        Ok(node)
    }

    /// A texture of this kind of spectra, or of numbers.
    fn node(
        &mut self,
        placed: &PlacedEntity,
        kind: Option<SpectrumKind>,
        depth: usize,
        spot: &Spot,
    ) -> Result<NodeKind, SceneError> {
        let entity = &placed.entity;
        if depth > DEEPEST {
            return Err(
                spot.error(format!("textures lie more than {DEEPEST} deep within each other, or a texture within itself"))
            );
        }
        let mut part = |name: &str, default: f64| -> Result<Rc<TextureNode>, SceneError> {
            let written = match kind {
                Some(kind) => self.spectrum_node_within(entity, name, kind, depth + 1)?,
                None => self.float_node_within(entity, name, depth + 1)?,
            };
            Ok(written.unwrap_or_else(|| TextureNode::constant(Spectrum::grey(default))))
        };
        let made = match entity.name.as_str() {
            "constant" => match part("value", 1.0)?.as_constant() {
                Some(value) => NodeKind::Constant(value),
                None => return Err(entity.spot_of("value").error("the value of a constant is no texture")),
            },
            "scale" => {
                let tex = part("tex", 1.0)?;
                let scale = self.float_node_within(entity, "scale", depth + 1)?;
                NodeKind::Product([tex, scale.unwrap_or_else(|| TextureNode::constant(Spectrum::WHITE))])
            }
            "mix" => {
                let (first, second) = (part("tex1", 0.0)?, part("tex2", 1.0)?);
                let amount = self.float_node_within(entity, "amount", depth + 1)?;
                let amount = amount.unwrap_or_else(|| TextureNode::constant(Spectrum::grey(0.5)));
                match (first.as_constant(), second.as_constant(), amount.as_constant()) {
                    (Some(first), Some(second), Some(amount)) => NodeKind::Constant(first.lerp(second, amount.r())),
                    _ => NodeKind::Mix([first, second, amount]),
                }
            }
            "checkerboard" => {
                let parts = [part("tex1", 1.0)?, part("tex2", 0.0)?];
                if entity.integer_or("dimension", 2)? == 2 {
                    NodeKind::Checker(parts, self.placement(entity)?)
                } else {
                    let instead = "the mean of its two colours is taken";
                    self.approximate(&entity.spot, "Texture `checkerboard` in space", instead);
                    NodeKind::Constant(0.5 * (self.mean_of(&parts[0]) + self.mean_of(&parts[1])))
                }
            }
            "bilerp" => {
                let mut corners = [Spectrum::BLACK; 4];
                for (corner, (name, default)) in corners.iter_mut().zip([("v00", 0.0), ("v01", 1.0), ("v10", 0.0), ("v11", 1.0)])
                {
                    let value = part(name, default)?.as_constant();
                    *corner = value.ok_or_else(|| entity.spot_of(name).error("the corners of bilerp are no textures"))?;
                }
                NodeKind::Bilinear(corners, self.placement(entity)?)
            }
            "imagemap" => NodeKind::Image(self.image_leaf(entity)?),
            "dots" => {
                let outside = part("outside", 0.0)?;
                let _ = part("inside", 1.0)?;
                entity.without_effect(&["mapping", "uscale", "vscale", "udelta", "vdelta", "v1", "v2"]);
                self.approximate(&entity.spot, "Texture `dots`", "what is between the dots is everywhere");
                NodeKind::Constant(self.mean_of(&outside))
            }
            other @ ("fbm" | "wrinkled" | "windy" | "marble" | "ptex" | "directionmix") => {
                entity.all_without_effect();
                let value = if kind.is_some() { 0.5 } else { 0.0 };
                self.drop(&entity.spot, format!("Texture `{other}`"), format!("{value} is taken everywhere"));
                NodeKind::Constant(Spectrum::grey(value))
            }
            other => return Err(entity.error(format!("there is no texture `{other}`"))),
        };
        self.report_unused(entity);
        Ok(made)
    }

    /// How texture coordinates become those of a texture.
    fn placement(&mut self, entity: &Entity) -> Result<Placement, SceneError> {
        let mapping = entity.text("mapping")?.unwrap_or("uv").to_owned();
        let number = |name: &str, default: f64| entity.float_or(name, default);
        let offset = [number("udelta", 0.0)?, number("vdelta", 0.0)?];
        match mapping.as_str() {
            "uv" => Ok(Placement { scale: [number("uscale", 1.0)?, number("vscale", 1.0)?], offset }),
            "spherical" | "cylindrical" | "planar" => {
                entity.without_effect(&["v1", "v2", "uscale", "vscale", "udelta", "vdelta"]);
                let instead = "the shape's texture coordinates are taken";
                self.approximate(entity.spot_of("mapping"), format!("mapping `{mapping}` of a texture"), instead);
                Ok(Placement::IDENTITY)
            }
            other => Err(entity
                .spot_of("mapping")
                .error(format!("a mapping is uv, spherical, cylindrical or planar, and not `{other}`"))),
        }
    }

    fn image_leaf(&mut self, entity: &Entity) -> Result<ImageLeaf, SceneError> {
        // They say how far things are smoothed; samples of a pixel do that here.
        entity.without_effect(&["maxanisotropy"]);
        let written = entity.text("filename")?.ok_or_else(|| entity.error("an imagemap needs \"string filename\""))?;
        let found = self.files.find(&self.folder, written);
        let path = found.ok_or_else(|| entity.spot_of("filename").error(format!("there is no file {written}")))?.path;
        let filter = match entity.text("filter")?.unwrap_or("bilinear") {
            "point" => Some(TextureFilterEntry::Nearest),
            "bilinear" | "trilinear" | "ewa" | "EWA" => None,
            other => return Err(entity.spot_of("filter").error(format!("there is no filter `{other}` of textures"))),
        };
        let wrap = match entity.text("wrap")?.unwrap_or("repeat") {
            "repeat" => WrapEntry::Repeat,
            "clamp" => WrapEntry::Clamp,
            other @ ("black" | "octahedralsphere") => {
                let what = format!("wrap `{other}` of a texture");
                self.approximate(entity.spot_of("wrap"), what, "the picture's border goes on");
                WrapEntry::Clamp
            }
            other => return Err(entity.spot_of("wrap").error(format!("there is no wrap `{other}` of textures"))),
        };
        let is_png = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
        let encoding = entity.text("encoding")?.map(str::to_ascii_lowercase);
        // Integers of PNG alone may have other codes than sRGB's.
        let is_linear = match encoding.as_deref() {
            None | Some("srgb") => false,
            Some("linear") => is_png,
            Some(other) => {
                self.approximate(entity.spot_of("encoding"), format!("encoding `{other}` of a texture"), "sRGB's is taken");
                false
            }
        };
        Ok(ImageLeaf {
            path,
            is_linear,
            wrap,
            filter,
            scale: entity.float_or("scale", 1.0)?,
            inverts: entity.flag_or("invert", false)?,
            placement: self.placement(entity)?,
        })
    }
}
