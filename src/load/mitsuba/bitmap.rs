//! Pictures as textures.
//!
//! Mitsuba decodes sRGB wherever a picture is not `raw`, and takes the luminance where a number is wanted. Where no file on disk says that, a
//! picture is made that does.

use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use exr::math::Vec2;
use exr::prelude::{Image, SpecificChannels, WritableImage};
use glam::{DAffine2, DMat2, DVec2, DVec3};

use super::converter::Converter;
use super::input::{Input, Texels};
use super::plugin::Plugin;
use super::texture::uv_map;
use crate::load::error::SceneError;
use crate::load::image_file::Pictures;
use crate::load::import::{FileReference, HeldContent, Keys, Value};
use crate::scene::{ColorSpace, ImageData};

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
            "repeat" => "repeat",
            "mirror" => "mirror",
            "clamp" => "clamp",
            other => {
                let what = format!("wrap_mode `{other}`");
                self.approximate(plugin, &what, "`clamp` is taken");
                "clamp"
            }
        };
        plugin.without_effect(&["format", "accel", "to_uv", "max_anisotropy", "cache", "to_srgb"]);
        let channel = plugin.text("channel")?;
        if channel.is_some() {
            self.drop(plugin, "channel of a bitmap", "all of its channels are taken");
        }
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let mut keys = Keys::of_type("image");
        for (key, value) in self.picture_keys(&path, &stem, linear, texels).0 {
            keys.set(key, value);
        }
        if wrap != "repeat" {
            keys.set("wrap", wrap);
        }
        if filter == "nearest" {
            keys.set("filter", "nearest");
        }
        // v runs downward: 1 − v is looked up.
        let down = DAffine2 { matrix2: DMat2::from_diagonal(DVec2::new(1.0, -1.0)), translation: DVec2::Y };
        let keys = self.placed_texture(plugin, keys, down * uv_map(plugin)? * before);
        Ok(self.add_texture(plugin, &stem, keys))
    }

    /// `file` and `color_space`: the picture itself, or one that is made of it.
    fn picture_keys(&mut self, path: &Path, stem: &str, linear: bool, texels: Texels) -> Keys {
        let is_float =
            path.extension().is_some_and(|ending| ["exr", "hdr", "rgbe", "pfm"].iter().any(|e| ending.eq_ignore_ascii_case(e)));
        // Data must be marked as such.
        let is_data = matches!(texels, Texels::Heights | Texels::Normals);
        let space = if is_data || linear && !is_float { Some("linear") } else { None };
        let plain = Keys::new().with("file", FileReference::Disk(path.to_owned())).with_some("color_space", space);
        let is_decoded = is_data && !linear && !is_float;
        if texels == Texels::Colours || texels == Texels::Normals && !is_decoded {
            return plain;
        }
        let made = (path.to_owned(), linear, texels == Texels::Normals);
        let file = match self.made_pictures.get(&made) {
            Some(file) => file.clone(),
            None => {
                let space = linear.then_some(ColorSpace::Linear);
                // A picture that cannot be read is told when the texture is.
                let picture = Pictures::new(self.files.clone()).read_file(path, space).ok().map(|picture| picture.image);
                let wanted = picture.filter(|image| texels == Texels::Normals || is_decoded || !is_grey(image));
                let bytes = wanted.and_then(|image| as_exr(&image, texels));
                let file = bytes.map(|bytes| self.scene.hold_bytes(stem, "exr", bytes));
                self.made_pictures.insert(made, file.clone());
                file
            }
        };
        match file {
            Some(file) => Keys::new().with("file", file).with_some("color_space", is_data.then_some("linear")),
            None => plain,
        }
    }

    /// The mean of what a parameter gives over its texture.
    pub fn mean(&self, input: &Input) -> DVec3 {
        let Input::Texture(name, factor) = input else { return input.constant().unwrap_or(DVec3::ONE) };
        let Some(entry) = self.scene.textures.iter().find(|entry| entry.keys.text("name") == Some(name)) else { return *factor };
        let colour = |key: &str| match entry.keys.get(key) {
            Some(Value::Number(grey)) => DVec3::splat(*grey),
            Some(Value::List(parts)) => match parts[..] {
                [Value::Number(red), Value::Number(green), Value::Number(blue)] => DVec3::new(red, green, blue),
                _ => DVec3::ZERO,
            },
            _ => DVec3::ZERO,
        };
        let space = (entry.keys.text("color_space") == Some("linear")).then_some(ColorSpace::Linear);
        let mut files = self.files.clone();
        let path = match entry.keys.get("file") {
            None => return *factor * 0.5 * (colour("a") + colour("b")),
            Some(Value::File(FileReference::Disk(path))) => path.clone(),
            Some(Value::File(held @ FileReference::Held(index))) => {
                let path = self.scene.held_path(held);
                if let Some((_, HeldContent::Bytes(bytes))) = self.scene.held.get(*index) {
                    files.hold_bytes(path.clone(), bytes.clone());
                }
                path
            }
            Some(_) => PathBuf::new(),
        };
        let picture = Pictures::new(files).read_file(&path, space);
        let mean = picture.map_or(DVec3::ONE, |picture| {
            let texels = &picture.image.texels;
            texels.colors().map(|texel| texel.as_dvec3()).sum::<DVec3>() / texels.len().max(1) as f64
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
