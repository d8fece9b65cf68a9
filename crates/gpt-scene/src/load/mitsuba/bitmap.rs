//! Pictures as textures.
//!
//! Mitsuba decodes sRGB wherever a picture is not `raw`, and takes the luminance where a number is wanted. Where no file on disk says that, a
//! picture is made that does.

use std::io::Cursor;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

use exr::math::Vec2;
use exr::prelude::{Image, SpecificChannels, WritableImage};
use glam::{DAffine2, DMat2, DVec2, DVec3};

use super::converter::Converter;
use super::input::Texels;
use super::plugin::Plugin;
use super::texture::uv_map;
use crate::load::error::SceneError;
use crate::load::file::reference::FileOr;
use crate::load::file::syntax::{ColorSpaceEntry, ImageEntry, TextureEntry, TextureFilterEntry, WrapEntry};
use crate::load::image_file::{EmbeddedFile, PictureSource, Pictures};
use crate::load::import::Input;
use crate::scene::{ColorSpace, ImageData};
use crate::spectrum::Spectrum;

/// Rec.709
const LUMINANCE: DVec3 = DVec3::new(0.212671, 0.715160, 0.072169);

impl Converter<'_> {
    pub fn bitmap(&mut self, plugin: &Rc<Plugin>, texels: Texels, before: DAffine2) -> Result<Input, SceneError> {
        if plugin.first_of("texture").is_some() || plugin.has("data") || plugin.has("bitmap") {
            return Err(plugin.error("a bitmap is read from a file here, and this one names none"));
        }
        let written = plugin.text("filename")?.ok_or_else(|| plugin.error("a bitmap needs the string `filename`"))?;
        let path = self.reader.find(written).ok_or_else(|| plugin.error(format!("there is no file {written}")))?;
        let raw = plugin.flag("raw", false)?;
        let gamma = plugin.number("gamma")?;
        if gamma.is_some_and(|gamma| gamma != 1.0 && gamma != -1.0 && (gamma - 2.2).abs() > 0.3) {
            self.approximate(plugin, "gamma of a bitmap", "sRGB's curve is taken");
        }
        let linear = raw || gamma == Some(1.0);
        let filter = plugin.text("filter_type")?.unwrap_or("bilinear");
        let wrap = match plugin.text("wrap_mode")?.unwrap_or("repeat") {
            "repeat" => WrapEntry::Repeat,
            "mirror" => WrapEntry::Mirror,
            "clamp" => WrapEntry::Clamp,
            other => {
                let what = format!("wrap_mode `{other}`");
                self.approximate(plugin, &what, "`clamp` is taken");
                WrapEntry::Clamp
            }
        };
        plugin.without_effect(&["format", "accel", "to_uv", "max_anisotropy", "cache", "to_srgb"]);
        let channel = plugin.text("channel")?;
        if channel.is_some() {
            self.drop(plugin, "channel of a bitmap", "all of its channels are taken");
        }
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let (file, color_space) = self.picture(&path, &stem, linear, texels);
        let place = plugin.at();
        let mut entry = ImageEntry::of_file(place.at(String::new()), place.at(file));
        entry.color_space = color_space;
        entry.wrap = (wrap != WrapEntry::Repeat).then_some(wrap);
        entry.filter = (filter == "nearest").then_some(TextureFilterEntry::Nearest);
        // v runs downward: 1 − v is looked up.
        let down = DAffine2 { matrix2: DMat2::from_diagonal(DVec2::new(1.0, -1.0)), translation: DVec2::Y };
        let mut entry = TextureEntry::Image(entry);
        self.place_texture(plugin, &mut entry, down * uv_map(plugin)? * before)?;
        Ok(self.add_texture(plugin, &stem, entry))
    }

    /// The picture itself, or one that is made of it, and its colour space.
    fn picture(
        &mut self,
        path: &Path,
        stem: &str,
        linear: bool,
        texels: Texels,
    ) -> (FileOr<EmbeddedFile>, Option<ColorSpaceEntry>) {
        let is_float =
            path.extension().is_some_and(|ending| ["exr", "hdr", "rgbe", "pfm"].iter().any(|e| ending.eq_ignore_ascii_case(e)));
        // Data must be marked as such.
        let is_data = matches!(texels, Texels::Heights | Texels::Normals);
        let space = (is_data || linear && !is_float).then_some(ColorSpaceEntry::Linear);
        let plain = (FileOr::OnDisk(path.to_owned()), space);
        let is_decoded = is_data && !linear && !is_float;
        if texels == Texels::Colours || texels == Texels::Normals && !is_decoded {
            return plain;
        }
        let made = (path.to_owned(), linear, texels == Texels::Normals);
        let file = match self.made_pictures.get(&made) {
            Some(file) => file.clone(),
            None => {
                let space = linear.then_some(ColorSpace::Linear);
                // A picture that cannot be read is reported when the texture is.
                let picture = Pictures::new(self.files.clone()).read_file(path, space).ok().map(|picture| picture.image);
                let wanted = picture.filter(|image| texels == Texels::Normals || is_decoded || !is_grey(image));
                let bytes = wanted.and_then(|image| as_exr(&image, texels));
                let embedded = |bytes: Vec<u8>| Arc::new(EmbeddedFile { name: format!("{stem}.exr"), bytes: bytes.into() });
                let file = bytes.map(embedded);
                self.made_pictures.insert(made, file.clone());
                file
            }
        };
        match file {
            Some(file) => (FileOr::InMemory(file), is_data.then_some(ColorSpaceEntry::Linear)),
            None => plain,
        }
    }

    /// The mean of what a parameter gives over its texture.
    pub fn mean(&self, input: &Input) -> Spectrum {
        let Input::Texture(name, factor) = input else { return input.constant().unwrap_or(Spectrum::WHITE) };
        let image = match self.scene.file.texture.iter().find(|entry| entry.name() == name) {
            Some(TextureEntry::Image(image)) => image,
            Some(TextureEntry::Checker(checker)) => return *factor * 0.5 * (checker.a.0 + checker.b.0),
            _ => return *factor,
        };
        let source = match &image.file.value {
            FileOr::InMemory(file) => PictureSource::Embedded(file.clone()),
            FileOr::OnDisk(path) => PictureSource::File(path.clone()),
            FileOr::Written(path) => PictureSource::File(path.into()),
        };
        let space = image.color_space.filter(|space| *space == ColorSpaceEntry::Linear).map(ColorSpace::from);
        let picture = Pictures::new(self.files.clone()).read(&source, space);
        let mean = picture.map_or(Spectrum::WHITE, |picture| {
            let texels = &picture.image.texels;
            texels.colors().map(|texel| Spectrum::from_f32(texel.to_array())).sum::<Spectrum>() / texels.len().max(1) as f64
        });
        *factor * mean
    }
}

/// Its luminance is any of its channels.
fn is_grey(image: &ImageData) -> bool {
    image.texels.colors().all(|colour| colour.x == colour.y && colour.y == colour.z)
}

/// A picture's linear numbers, or its luminance where numbers are wanted.
fn as_exr(image: &ImageData, texels: Texels) -> Option<Vec<u8>> {
    let (width, height) = (image.width as usize, image.height as usize);
    let texel = |place: Vec2<usize>| -> (f32, f32, f32) {
        let [red, green, blue, _] = image.texels.get(place.y() * width + place.x());
        if texels == Texels::Normals {
            return (red, green, blue);
        }
        let luminance = LUMINANCE.dot(DVec3::new(red.into(), green.into(), blue.into())) as f32;
        (luminance, luminance, luminance)
    };
    let mut bytes = Vec::new();
    let made = Image::from_channels((width, height), SpecificChannels::rgb(texel));
    made.write().to_buffered(Cursor::new(&mut bytes)).ok()?;
    Some(bytes)
}
