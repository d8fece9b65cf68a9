//! Textures and their pictures.

use std::path::Path;

use super::buffers::{file_of, read_uri};
use super::importer::Importer;
use super::json::Image;
use super::lookup::Placement;
use crate::load::import::{Entry, FileReference, Keys};

const CLAMP: u64 = 33_071;
const MIRROR: u64 = 33_648;
const NEAREST: u64 = 9728;

impl Importer<'_> {
    /// The name of a texture whose texels are colours in sRGB, or numbers as they are. `placement`: how it lies on the mesh's coordinates, which are
    /// the second ones where `by_second`. `times`: the texture by which it is multiplied.
    pub fn texture(
        &mut self,
        index: usize,
        linear: bool,
        placement: Option<Placement>,
        by_second: bool,
        times: Option<&str>,
    ) -> Result<String, String> {
        let key = (index, linear, placement.map(Placement::bits), by_second, times.map(str::to_owned));
        if let Some(name) = self.textures.get(&key) {
            return Ok(name.clone());
        }
        let of_texture = |message: String| format!("textures[{index}]: {message}");
        let texture = self.root.textures.get(index).cloned().ok_or_else(|| format!("there is no textures[{index}]"))?;
        let webp =
            texture.extensions.get("EXT_texture_webp").and_then(|webp| webp.get("source")).and_then(|source| source.as_u64());
        let source = texture.source.or(webp.and_then(|source| usize::try_from(source).ok()));
        let Some(source) = source else {
            let message = if texture.extensions.contains_key("KHR_texture_basisu") {
                format!("its picture is in Basis or KTX2, which is not read: `{}` makes PNG of it", super::BASIS_COMMAND)
            } else {
                "it has no picture that is read here".to_owned()
            };
            return Err(of_texture(message));
        };
        let image = self.root.images.get(source).cloned().ok_or_else(|| of_texture(format!("there is no images[{source}]")))?;
        let file = self.picture(source, &image).map_err(|message| format!("images[{source}]: {message}"))?;
        let wanted = image.name.clone().filter(|name| !name.is_empty()).unwrap_or_else(|| format!("image {source}"));
        let name = self.scene.free_texture_name(&wanted);
        let mut keys = Keys::new().with("name", name.as_str()).with("type", "image").with("file", file);
        keys.set("color_space", if linear { "linear" } else { "srgb" });
        if let Some(sampler) = texture.sampler {
            let sampler =
                self.root.samplers.get(sampler).ok_or_else(|| of_texture(format!("there is no samplers[{sampler}]")))?;
            if sampler.wrap_s.unwrap_or(0) != sampler.wrap_t.unwrap_or(0) {
                let place = self.place(&format!("textures[{index}]")).to_string();
                self.scene.report.approximate("wrapping that differs between s and t", place, "that of s is taken");
            }
            match sampler.wrap_s {
                Some(CLAMP) => keys.set("wrap", "clamp"),
                Some(MIRROR) => keys.set("wrap", "mirror"),
                _ => {}
            }
            if sampler.mag_filter == Some(NEAREST) {
                keys.set("filter", "nearest");
            }
        }
        if let Some(Placement { scale, rotation_degrees, offset }) = placement {
            keys.set("scale", scale);
            keys.set("rotation", rotation_degrees);
            keys.set("offset", offset);
        }
        if by_second {
            keys.set("second_uvs", true);
        }
        if let Some(times) = times {
            keys.set("times", times);
        }
        self.scene.textures.push(Entry { place: self.place(&format!("textures[{index}]")), keys });
        self.textures.insert(key, name.clone());
        Ok(name)
    }

    fn picture(&mut self, index: usize, image: &Image) -> Result<FileReference, String> {
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
                    return Err(format!(
                        "{} is in Basis or KTX2, which is not read: `{}` makes PNG of it",
                        path.display(),
                        super::BASIS_COMMAND
                    ));
                }
                FileReference::Disk(path)
            }
            (Some(uri), _) => {
                let (_, bytes) = read_uri(self.files, &self.folder, uri)?;
                self.hold_picture(index, image, bytes)?
            }
            (None, Some(view)) => {
                let bytes = self.buffers.view(view)?.to_vec();
                self.hold_picture(index, image, bytes)?
            }
            (None, None) => return Err("it names no file and no bufferView".to_owned()),
        };
        self.pictures.insert(index, file.clone());
        Ok(file)
    }

    /// The bytes themselves say their format.
    fn hold_picture(&mut self, index: usize, image: &Image, bytes: Vec<u8>) -> Result<FileReference, String> {
        let ending = match &bytes[..] {
            [0x89, b'P', b'N', b'G', ..] => "png",
            [0xff, 0xd8, ..] => "jpg",
            [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => "webp",
            [0xab, b'K', b'T', b'X', ..] => {
                return Err(format!("it is in KTX2, which is not read: `{}` makes PNG of it", super::BASIS_COMMAND));
            }
            _ => return Err("it is neither PNG nor JPEG nor WebP".to_owned()),
        };
        let name = image.name.clone().unwrap_or_else(|| format!("image-{index}"));
        let stem = Path::new(&name).file_stem().map_or_else(|| name.clone(), |stem| stem.to_string_lossy().into_owned());
        Ok(self.scene.hold_bytes(&stem, ending, bytes))
    }
}
