//! Textures and their pictures.

use std::path::Path;

use super::buffers::{file_of, read_uri};
use super::importer::Importer;
use super::json::{Image, Texture};
use super::lookup::Placement;
use super::texture_role::{TextureRole, UvsOf};
use crate::load::error::show;
use crate::load::file::colour::Rgb;
use crate::load::file::reference::{FileOr, TextureName};
use crate::load::file::syntax::{ColorSpaceEntry, ImageEntry, TextureEntry, TextureFilterEntry, WrapEntry};
use crate::load::file::value::{Exactly, Number};
use crate::load::files::MOST_MODEL_BYTES;
use crate::load::image_file::{EmbeddedFile, inverted_alpha, one_texel};
use crate::spectrum::Spectrum;

const REPEAT: u64 = 10_497;
const CLAMP: u64 = 33_071;
const MIRROR: u64 = 33_648;
const NEAREST: u64 = 9728;
const LINEAR: u64 = 9729;
/// The filters of minification with the nearest texel, with the nearest of two mipmaps or between them.
const NEAREST_MIPMAPS: [u64; 2] = [9984, 9986];
const LINEAR_MIPMAPS: [u64; 2] = [9985, 9987];

/// Extensions whose pictures are not read, and their formats.
const UNREAD_FORMATS: [(&str, &str); 3] =
    [("KHR_texture_basisu", "Basis or KTX2"), ("EXT_texture_avif", "AVIF"), ("MSFT_texture_dds", "DDS")];

/// The stand-in for a picture that cannot be read: magenta, as for those of OBJ; for numbers 1, so that factors count alone; no bend.
fn stand_in(role: TextureRole) -> [f64; 3] {
    match role {
        TextureRole::Colour => [1.0, 0.0, 1.0],
        TextureRole::Numbers | TextureRole::OfGlossiness(_) => [1.0; 3],
        TextureRole::Normals => [0.5, 0.5, 1.0],
    }
}

/// In words, that pictures of a format are not read.
fn unread(format: &str) -> String {
    match format {
        "Basis or KTX2" => format!("is in {format}, which is not read: `{}` makes PNG of it", super::BASIS_COMMAND),
        _ => format!("is in {format}, which is not read: save it as PNG"),
    }
}

impl Importer<'_> {
    /// The name of a texture. `placement`: how it lies on the mesh's coordinates. `times`: the texture by which it is multiplied.
    pub fn texture(
        &mut self,
        index: usize,
        role: TextureRole,
        placement: Option<Placement>,
        by: UvsOf,
        times: Option<&str>,
    ) -> Result<String, String> {
        let key = (index, role, placement.map(Placement::bits), by, times.map(str::to_owned));
        if let Some(name) = self.textures.get(&key) {
            return Ok(name.clone());
        }
        let texture = self.root.textures.get(index).cloned().ok_or_else(|| format!("there is no textures[{index}]"))?;
        let place = format!("textures[{index}]");
        let found = self.source(&texture).and_then(|source| {
            let image = self.root.images.get(source).cloned().ok_or_else(|| format!("there is no images[{source}]"))?;
            let file = self.picture(source, &image).map_err(|message| format!("images[{source}]: {message}"))?;
            let file = match role {
                TextureRole::OfGlossiness(factor) => self.roughness(&file, f64::from_bits(factor), source)?,
                _ => file,
            };
            Ok((file, image.name.filter(|name| !name.is_empty()).unwrap_or_else(|| format!("image {source}"))))
        });
        let stand_in = stand_in(role);
        let at = self.place(&place);
        let (file, fallback, wanted) = match found {
            Ok((file, wanted)) => (file, Some(Rgb::of(Spectrum::from_rgb(stand_in))?), wanted),
            Err(reason) => {
                self.approximate("picture that cannot be read", &place, &format!("the colour {stand_in:?}: {reason}"));
                self.scene.substitutes.push(format!("{place}: {reason}; the colour {stand_in:?} stands for it"));
                (embedded("stand-in.png".to_owned(), one_texel(stand_in)?), None, format!("texture {index}"))
            }
        };
        let name = self.scene.free_texture_name(&wanted);
        let mut entry = ImageEntry::of_file(at.at(name.clone()), at.at(file));
        entry.fallback = fallback;
        entry.color_space = Some(if role == TextureRole::Colour { ColorSpaceEntry::Srgb } else { ColorSpaceEntry::Linear });
        if let Some(sampler) = texture.sampler {
            self.sampler(sampler, &mut entry, &place)?;
        }
        if let Some(Placement { scale, rotation_degrees, offset }) = placement {
            entry.scale = Some(Exactly::of(scale)?);
            entry.rotation = Some(Number::of(rotation_degrees)?);
            entry.offset = Some(Exactly::of(offset)?);
        }
        entry.second_uvs = (by != UvsOf::First).then_some(true);
        entry.bends_by_first_uvs = (by == UvsOf::Framed && role == TextureRole::Normals).then_some(true);
        entry.times = times.map(|times| at.at(TextureName(times.to_owned())));
        self.scene.file.texture.push(TextureEntry::Image(entry));
        self.textures.insert(key, name.clone());
        Ok(name)
    }

    /// The image of a texture.
    fn source(&self, texture: &Texture) -> Result<usize, String> {
        let of =
            |name: &str| texture.extensions.get(name)?.get("source")?.as_u64().and_then(|source| usize::try_from(source).ok());
        let found = texture.source.or_else(|| of("EXT_texture_webp"));
        found.ok_or_else(|| match UNREAD_FORMATS.iter().find(|(name, _)| texture.extensions.contains_key(*name)) {
            Some((_, what)) => unread(what),
            None => "it names no picture".to_owned(),
        })
    }

    /// How texels are interpolated, and what is beyond the picture. Where nothing is said of magnification, it is as for minification.
    fn sampler(&mut self, index: usize, entry: &mut ImageEntry, place: &str) -> Result<(), String> {
        let sampler = self.root.samplers.get(index).cloned().ok_or_else(|| format!("{place}: there is no samplers[{index}]"))?;
        let mut wrap = |wrap: Option<u64>, key: &str| match wrap {
            None | Some(REPEAT) => WrapEntry::Repeat,
            Some(CLAMP) => WrapEntry::Clamp,
            Some(MIRROR) => WrapEntry::Mirror,
            Some(other) => {
                self.approximate(format!("{key} {other}"), &format!("samplers[{index}]"), "the picture is repeated");
                WrapEntry::Repeat
            }
        };
        let [along_s, along_t] = [wrap(sampler.wrap_s, "wrapS"), wrap(sampler.wrap_t, "wrapT")];
        entry.wrap = (along_s != WrapEntry::Repeat).then_some(along_s);
        entry.wrap_v = (along_t != along_s).then_some(along_t);
        let known = [NEAREST, LINEAR].iter().chain(&NEAREST_MIPMAPS).chain(&LINEAR_MIPMAPS);
        for (key, filter) in [("magFilter", sampler.mag_filter), ("minFilter", sampler.min_filter)] {
            if let Some(filter) = filter
                && known.clone().all(|known| *known != filter)
            {
                self.approximate(format!("{key} {filter}"), &format!("samplers[{index}]"), "texels are interpolated");
            }
        }
        let is_nearest = |filter: u64| filter == NEAREST || NEAREST_MIPMAPS.contains(&filter);
        if sampler.mag_filter.or(sampler.min_filter).is_some_and(is_nearest) {
            entry.filter = Some(TextureFilterEntry::Nearest);
        }
        Ok(())
    }

    pub fn picture(&mut self, index: usize, image: &Image) -> Result<FileOr<EmbeddedFile>, String> {
        if let Some(file) = self.pictures.get(&index) {
            return Ok(file.clone());
        }
        let file = match (&image.uri, image.buffer_view) {
            (Some(uri), _) if !uri.starts_with("data:") => {
                let path = file_of(self.files, &self.folder, uri)?;
                if path
                    .extension()
                    .is_some_and(|ending| ending.eq_ignore_ascii_case("ktx2") || ending.eq_ignore_ascii_case("basis"))
                {
                    return Err(format!("{} {}", path.display(), unread("Basis or KTX2")));
                }
                FileOr::OnDisk(path)
            }
            (Some(uri), _) => {
                let (_, bytes) = read_uri(self.files, &self.folder, uri)?;
                embedded_picture(index, image, bytes)?
            }
            (None, Some(view)) => {
                let bytes = self.buffers.view(view)?.to_vec();
                embedded_picture(index, image, bytes)?
            }
            (None, None) => return Err("it names no file and no bufferView".to_owned()),
        };
        self.pictures.insert(index, file.clone());
        Ok(file)
    }

    /// The roughness that a picture's glossiness stands for, as a picture of its own.
    fn roughness(&self, file: &FileOr<EmbeddedFile>, factor: f64, index: usize) -> Result<FileOr<EmbeddedFile>, String> {
        let bytes = match file {
            FileOr::OnDisk(path) => {
                self.files.read(path, MOST_MODEL_BYTES).map_err(|error| format!("{}: cannot be read: {error}", show(path)))?
            }
            FileOr::InMemory(file) => file.bytes.to_vec().into(),
            FileOr::Written(path) => return Err(format!("{path} is not a file of this one")),
        };
        let inverted = inverted_alpha(&bytes, factor)?;
        Ok(embedded(format!("roughness-{index}.png"), inverted))
    }
}

fn embedded(name: String, bytes: Vec<u8>) -> FileOr<EmbeddedFile> {
    FileOr::InMemory(EmbeddedFile { name, bytes: bytes.into() }.into())
}

/// A picture whose format its own bytes say.
fn embedded_picture(index: usize, image: &Image, bytes: Vec<u8>) -> Result<FileOr<EmbeddedFile>, String> {
    let ending = match &bytes[..] {
        [0x89, b'P', b'N', b'G', ..] => "png",
        [0xff, 0xd8, ..] => "jpg",
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => "webp",
        [0xab, b'K', b'T', b'X', ..] => return Err(unread("Basis or KTX2")),
        [b'D', b'D', b'S', b' ', ..] => return Err(unread("DDS")),
        [_, _, _, _, b'f', b't', b'y', b'p', b'a', b'v', b'i', b'f' | b's', ..] => return Err(unread("AVIF")),
        [b'G', b'I', b'F', b'8', ..] => "gif",
        [b'B', b'M', ..] => "bmp",
        [b'I', b'I', 42, 0, ..] | [b'M', b'M', 0, 42, ..] => "tif",
        [b'#', b'?', ..] => "hdr",
        _ => return Err("it is neither PNG nor JPEG nor WebP".to_owned()),
    };
    let name = image.name.clone().unwrap_or_else(|| format!("image-{index}"));
    let stem = Path::new(&name).file_stem().map_or_else(|| name.clone(), |stem| stem.to_string_lossy().into_owned());
    Ok(embedded(format!("{stem}.{ending}"), bytes))
}
