//! Textures: pictures, checkerboards, and means in place of what there is not.

use std::path::Path;
use std::sync::Arc;

use super::Writer;
use super::directive::{Directive, Number, Tint};
use super::made::Relief;
use crate::load::file::writer::{is_on_disk, picture, picture_format};
use crate::scene::{
    ColorSpace, ImageData, ImageSource, ImageTexture, Relief as Bend, Texels, Texture, TextureFilter, TextureId, TextureKind,
    TextureWrap, UvTransform,
};
use crate::scene_writer::inputs::{ColourMap, Scalar};
use crate::scene_writer::pictures::{grey_picture, shown};
use crate::spectrum::Spectrum;

/// Endings of pictures that pbrt reads.
const ENDINGS: [&str; 6] = ["png", "exr", "jpg", "jpeg", "hdr", "tga"];

impl Writer<'_> {
    /// A number, or the texture of one.
    pub fn scalar(&mut self, value: Scalar, place: &str) -> Number {
        match value {
            Scalar::Constant(value) => Number::Constant(value),
            Scalar::Map(map) => self.number_map(map.texture, &format!("{map:?}"), place, &|texel| map.of_texel(texel)),
        }
    }

    /// A function of a texture's texels as a texture of numbers. `what` tells it from other functions.
    pub fn number_map(&mut self, id: TextureId, what: &str, place: &str, value: &dyn Fn([f64; 4]) -> f64) -> Number {
        let texture = &self.scene.textures[id];
        let key = format!("number {id} {what}");
        if let Some(name) = self.textures.get(&key) {
            return Number::Texture(name.clone());
        }
        let of_colour = |colour: Spectrum| value([colour.r(), colour.g(), colour.b(), 1.0]);
        let name = self.free_name(&texture.name);
        let directive = match &texture.kind {
            TextureKind::Image(image) => {
                let picture = grey_picture(&image.image, value);
                let file = self.files.add_file(&format!("numbers-{}.exr", self.files.len() + 1), picture);
                let head = Directive::new("Texture", &[&name, "float", "imagemap"]).string("filename", &file);
                self.lookup(head.string("encoding", "linear"), image, texture, place)
            }
            TextureKind::Checker { a, b, scale } => {
                let head = Directive::new("Texture", &[&name, "float", "checkerboard"]);
                let head = head.float("tex1", of_colour(*a)).float("tex2", of_colour(*b));
                self.mapped(head, *scale, texture, place)
            }
            TextureKind::Perlin { .. } | TextureKind::Worley { .. } => {
                self.report_noise(place);
                return Number::Constant(of_colour(texture.kind.mean()));
            }
        };
        self.push(directive);
        self.textures.insert(key, name.clone());
        Number::Texture(name)
    }

    /// A texture of colours from 0 to 1.
    pub fn tint_map(&mut self, map: ColourMap, place: &str) -> Tint {
        let texture = &self.scene.textures[map.texture];
        let key = format!("colour {map:?}");
        if let Some(name) = self.textures.get(&key) {
            return Tint::Texture(name.clone());
        }
        let of_colour =
            |colour: Spectrum| map.of_texel([colour.r(), colour.g(), colour.b(), 1.0]).clamp(Spectrum::BLACK, Spectrum::WHITE);
        let name = self.free_name(&texture.name);
        let directive = match &texture.kind {
            TextureKind::Image(image) => {
                let is_grey = map.factor.min_component() == map.factor.max_component();
                let head = Directive::new("Texture", &[&name, "spectrum", "imagemap"]);
                let head = if map.is_plain() && is_grey {
                    let (file, space) = self.picture_file(&image.image);
                    let encoding = if space == ColorSpace::Srgb { "sRGB" } else { "linear" };
                    let head = head.string("filename", &file).string("encoding", encoding);
                    if map.factor == Spectrum::WHITE { head } else { head.float("scale", map.factor.r()) }
                } else {
                    let content = picture(&shown(&image.image, &|texel| map.of_texel(texel)));
                    let file = self.files.add_file(&format!("colours-{}.exr", self.files.len() + 1), content);
                    head.string("filename", &file).string("encoding", "linear")
                };
                self.lookup(head, image, texture, place)
            }
            TextureKind::Checker { a, b, scale } => {
                let head = Directive::new("Texture", &[&name, "spectrum", "checkerboard"]);
                let head = head.rgb("tex1", of_colour(*a)).rgb("tex2", of_colour(*b));
                self.mapped(head, *scale, texture, place)
            }
            TextureKind::Perlin { .. } | TextureKind::Worley { .. } => {
                self.report_noise(place);
                return Tint::Constant(of_colour(texture.kind.mean()));
            }
        };
        self.push(directive);
        self.textures.insert(key, name.clone());
        Tint::Texture(name)
    }

    /// The picture of a texture's colours times a factor, for a surface that gives them off; None of what is no picture.
    pub fn emitted_picture(&mut self, map: ColourMap, place: &str) -> Option<String> {
        let texture = &self.scene.textures[map.texture];
        let TextureKind::Image(image) = &texture.kind else { return None };
        let key = format!("light {map:?}");
        if let Some(name) = self.textures.get(&key) {
            return Some(name.clone());
        }
        self.approximate("texture of emission", place, "its texels are not interpolated, and it ends with the picture");
        if texture.transform != UvTransform::default() || image.scale != [1.0; 2] {
            self.drop("placement of a texture of emission", place, "it lies as the surface's texture coordinates do");
        }
        let content = picture(&shown(&image.image, &|texel| map.of_texel(texel)));
        let file = self.files.add_file(&format!("light-{}.exr", self.files.len() + 1), content);
        self.textures.insert(key, file.clone());
        Some(file)
    }

    /// The material with what bends its normals.
    pub fn bent(&mut self, directive: Directive, relief: Relief, place: &str) -> Directive {
        let texture = &self.scene.textures[relief];
        if texture.shadows_perturbed_normals {
            self.drop("normal_shadowing", place, "light that reaches bent normals does not fade");
        }
        match texture.relief {
            Bend::Heights(scale) => {
                let heights = self.number_map(relief, &format!("heights {scale}"), place, &|texel| texel[0] * scale);
                match heights {
                    Number::Texture(_) => directive.number("displacement", &heights),
                    Number::Constant(_) => directive,
                }
            }
            Bend::Normals(scale) => {
                let TextureKind::Image(image) = &texture.kind else {
                    self.drop("normal map that is no picture", place, "normals are not bent");
                    return directive;
                };
                let lies_otherwise = texture.transform != UvTransform::default() || image.scale != [1.0; 2];
                if lies_otherwise || texture.by_second_uvs {
                    self.drop("placement of a normal map", place, "it lies as the surface's texture coordinates do");
                }
                if image.wrap != [TextureWrap::Repeat; 2] {
                    self.approximate("wrap of a normal map", place, "it is repeated");
                }
                let file = if scale == 1.0 {
                    self.picture_file(&image.image).0
                } else {
                    // Red and green are what bends.
                    let scaled = |value: f64| (0.5 + (value - 0.5) * scale).clamp(0.0, 1.0);
                    let content = picture(&shown(&image.image, &|[r, g, b, _]| Spectrum::new(scaled(r), scaled(g), b)));
                    self.files.add_file(&format!("normals-{}.exr", self.files.len() + 1), content)
                };
                directive.string("normalmap", &file)
            }
        }
    }

    fn report_noise(&mut self, place: &str) {
        self.approximate("texture of noise", place, "its mean is taken");
    }

    /// Adds how a picture is looked up.
    fn lookup(&mut self, head: Directive, image: &ImageTexture, texture: &Texture, place: &str) -> Directive {
        let [along_u, along_v] = image.wrap;
        if along_u != along_v || along_u == TextureWrap::Mirror {
            let instead = if along_u == TextureWrap::Clamp { "it ends with the picture" } else { "it is repeated" };
            self.approximate("wrap of a texture", place, instead);
        }
        let wrap = if along_u == TextureWrap::Clamp { "clamp" } else { "repeat" };
        let filter = match image.filter {
            TextureFilter::Bilinear => "bilinear",
            TextureFilter::Nearest => "point",
            TextureFilter::Triangle => {
                self.approximate("colours of vertices", place, "they are a picture, in which neighbours run into each other");
                "bilinear"
            }
        };
        self.mapped(head.string("wrap", wrap).string("filter", filter), image.scale, texture, place)
    }

    /// Adds where a texture lies.
    fn mapped(&mut self, head: Directive, scale: [f64; 2], texture: &Texture, place: &str) -> Directive {
        if texture.transform.rotation_degrees != 0.0 {
            self.drop("rotation of a texture", place, "it is not turned");
        }
        if texture.by_second_uvs {
            self.approximate("second texture coordinates", place, "the first ones are taken");
        }
        if texture.times.is_some() {
            self.drop("texture by which another is multiplied", place, "the other is as it is");
        }
        let offset = texture.transform.offset;
        let parameters =
            [("uscale", scale[0], 1.0), ("vscale", scale[1], 1.0), ("udelta", offset[0], 0.0), ("vdelta", offset[1], 0.0)];
        let stated = parameters.into_iter().filter(|(_, value, default)| value != default);
        stated.fold(head, |head, (name, value, _)| head.float(name, value))
    }

    /// The file of a picture, on disk or beside the scene, and how it is coded.
    fn picture_file(&mut self, image: &Arc<ImageData>) -> (String, ColorSpace) {
        let space = match &image.texels {
            Texels::Bytes { space, .. } | Texels::Shorts { space, .. } => *space,
            Texels::Half(_) | Texels::Float(_) | Texels::FloatAlpha(_) => ColorSpace::Linear,
        };
        let is_read =
            |path: &Path| path.extension().is_some_and(|ending| ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known)));
        let source = self.scene.sources.image(image).filter(|source| is_read(&source.path) && source.scale == 1.0);
        let address = Arc::as_ptr(image) as usize;
        match source {
            Some(source) if source.embedded.is_none() && is_on_disk(&source.path) => {
                (self.files.path_to(&source.path).to_string_lossy().replace('\\', "/"), space)
            }
            Some(ImageSource { path, embedded: Some(content), .. }) => {
                let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
                (self.files.add_file_once("picture", address, &ending, || content.to_vec()), space)
            }
            _ => (self.files.add_file_once("picture", address, picture_format(image).0, || picture(image)), space),
        }
    }
}
