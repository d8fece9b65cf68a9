//! `[[texture]]`

use std::collections::HashSet;
use std::collections::hash_map::Entry;
use std::mem::take;
use std::sync::Arc;

use rayon::prelude::*;

use crate::load::error::SceneError;
use crate::load::file::reference::FileOr;
use crate::load::file::resolver::{CachedImage, Resolver};
use crate::load::file::syntax::{ColorSpaceEntry, CommonKeys, ImageEntry, TextureEntry, TextureFilterEntry, WrapEntry};
use crate::load::file::value::{Checked, Exactly, Located, Number, Positive};
use crate::load::formats;
use crate::load::image_file::{EmbeddedFile, PictureSource};
use crate::picture_file::Envelope;
use crate::scene::validate::MOST_OCTAVES;
use crate::scene::{
    ColorSpace, ImageData, ImageTexture, Texture, TextureFilter, TextureId, TextureKind, TextureWrap, UvTransform,
};
use crate::spectrum::Spectrum;

impl Resolver<'_> {
    pub(super) fn textures(&mut self, written: &[TextureEntry]) -> Result<(), SceneError> {
        self.texture_names = self.register("texture", written.iter().map(|entry| entry.common().name))?;
        self.decode_side_by_side(written);
        for (index, entry) in written.iter().enumerate() {
            let kind = self.texture_kind(entry);
            // Something has to stand in its place, or others would have none.
            let kind =
                self.note(kind).unwrap_or(TextureKind::Checker { a: Spectrum::BLACK, b: Spectrum::BLACK, scale: [1.0; 2] });
            self.linear_textures
                .push(matches!(entry, TextureEntry::Image(ImageEntry { color_space: Some(ColorSpaceEntry::Linear), .. })));
            let CommonKeys { name, rotation, offset, second_uvs, bends_by_first_uvs, .. } = entry.common();
            let transform = UvTransform {
                rotation_degrees: rotation.map_or(0.0, |rotation| rotation.0),
                offset: offset.map_or([0.0; 2], |offset| offset.map(|shift| shift.0)),
            };
            let by_second_uvs = second_uvs.unwrap_or(false);
            let times = self.times(index, written);
            let times = self.note(times).flatten();
            let bends_by_first_uvs = bends_by_first_uvs.unwrap_or(false);
            self.scene.textures.push(Texture {
                transform,
                by_second_uvs,
                bends_by_first_uvs,
                times,
                ..Texture::new(name.value.clone(), kind)
            });
        }
        Ok(())
    }

    /// The texture by which one is multiplied.
    fn times(&self, index: usize, written: &[TextureEntry]) -> Result<Option<TextureId>, SceneError> {
        let Some(name) = written[index].common().times else { return Ok(None) };
        let other = self.texture_id(name)?;
        if other == index || written.get(other).is_none_or(|entry| entry.common().times.is_some()) {
            let message = format!("`times` names `{}`, which is multiplied by another texture itself", name.value.0);
            return Err(self
                .error(&name.place, message)
                .with_help("a product has two textures, of which the second has no `times`"));
        }
        Ok(Some(other))
    }

    fn texture_kind(&mut self, entry: &TextureEntry) -> Result<TextureKind, SceneError> {
        Ok(match entry {
            TextureEntry::Image(image) => match (self.image_texture(image), &image.fallback) {
                (Ok(texture), _) => TextureKind::Image(texture),
                (Err(error), Some(fallback)) => self.fallback(error, image, fallback.0)?,
                (Err(error), None) => return Err(error),
            },
            TextureEntry::Checker(checker) => {
                TextureKind::Checker { a: checker.a.0, b: checker.b.0, scale: factors(checker.scale) }
            }
            TextureEntry::Perlin(perlin) => {
                let octaves = perlin.octaves.as_ref().map_or(1, |octaves| octaves.value.get());
                if let Some(written) = &perlin.octaves
                    && octaves > MOST_OCTAVES
                {
                    return Err(self.error(&written.place, format!("at most {MOST_OCTAVES} octaves")));
                }
                let (scale, seed) = (factor(perlin.scale), perlin.seed.unwrap_or(0));
                TextureKind::Perlin { scale, octaves, a: perlin.a.0, b: perlin.b.0, seed }
            }
            TextureEntry::Worley(worley) => {
                let (scale, seed) = (factor(worley.scale), worley.seed.unwrap_or(0));
                TextureKind::Worley { scale, a: worley.a.0, b: worley.b.0, seed }
            }
        })
    }

    /// Reads the files of all image textures on all cores. What cannot be read is left to be found again, and reported, in its turn.
    fn decode_side_by_side(&mut self, written: &[TextureEntry]) {
        let key = |entry: &TextureEntry| match entry {
            TextureEntry::Image(image) => Some((self.picture_source(&image.file.value), image.color_space.map(Into::into))),
            _ => None,
        };
        let keys: HashSet<(PictureSource, Option<ColorSpace>)> = written.iter().filter_map(key).collect();
        let progress = self.pictures.files().progress();
        progress.expect(keys.len());
        let decode = |key: (PictureSource, Option<ColorSpace>)| {
            let picture = self.pictures.read(&key.0, key.1);
            progress.one_was_read();
            picture.ok().map(|picture| (key, CachedImage::from(picture)))
        };
        let decoded: Vec<_> = keys.into_par_iter().filter_map(decode).collect();
        self.images.extend(decoded);
    }

    fn image_texture(&mut self, written: &ImageEntry) -> Result<ImageTexture, SceneError> {
        let space = written.color_space.map(Into::into);
        let image = self.image(&written.file, space)?;
        let source = self.picture_source(&written.file.value);
        let hints = self.hints(&source, space);
        if hints.envelope == Some(Envelope::Cube) {
            let note = "its envmap is a cube, which only environments use: as a texture, it lies flat";
            self.name_unused(&source, note).map_err(|reason| self.error(&written.file.place, format!("{source}: {reason}")))?;
        }
        let by_file = match hints.wrap_modes.as_deref().filter(|_| written.wrap.is_none()) {
            None => [TextureWrap::Repeat; 2],
            Some(modes) => match wraps_of(modes) {
                Some(wraps) => wraps,
                None => {
                    let note = format!(
                        "its wrapmodes is `{modes}`, which is not used: the texture repeats unless its key `wrap` says otherwise"
                    );
                    self.name_unused(&source, &note)
                        .map_err(|reason| self.error(&written.file.place, format!("{source}: {reason}")))?;
                    [TextureWrap::Repeat; 2]
                }
            },
        };
        let written_wraps = [written.wrap, written.wrap_v.or(written.wrap)];
        let wrap = std::array::from_fn(|axis| match written_wraps[axis] {
            None => by_file[axis],
            Some(WrapEntry::Repeat) => TextureWrap::Repeat,
            Some(WrapEntry::Clamp) => TextureWrap::Clamp,
            Some(WrapEntry::Mirror) => TextureWrap::Mirror,
        });
        Ok(ImageTexture {
            image,
            wrap,
            filter: match written.filter {
                None | Some(TextureFilterEntry::Bilinear) => TextureFilter::Bilinear,
                Some(TextureFilterEntry::Nearest) => TextureFilter::Nearest,
                Some(TextureFilterEntry::Triangle) => TextureFilter::Triangle,
            },
            scale: factors(written.scale),
        })
    }

    /// A colour in the place of a picture that cannot be read.
    fn fallback(&mut self, error: SceneError, written: &ImageEntry, colour: Spectrum) -> Result<TextureKind, SceneError> {
        if self.strict {
            return Err(error.with_help("without --strict, its `fallback` stands for it"));
        }
        let source = self.picture_source(&written.file.value).to_source(written.color_space.map(Into::into));
        self.scene.sources.add_unreadable(&written.name.value, source);
        let [r, g, b] = colour.to_rgb();
        self.scene.warnings.push(format!("{error}; the colour [{r}, {g}, {b}] stands for it"));
        Ok(TextureKind::Checker { a: colour, b: colour, scale: [1.0; 2] })
    }

    /// Reads the image file that a key names.
    pub(in crate::load::file) fn image(
        &mut self,
        file: &Located<FileOr<EmbeddedFile>>,
        space: Option<ColorSpace>,
    ) -> Result<Arc<ImageData>, SceneError> {
        self.image_and_bits(file, space).map(|(image, _)| image)
    }

    /// An image and its bits, where its format has integers.
    pub(in crate::load::file) fn image_and_bits(
        &mut self,
        file: &Located<FileOr<EmbeddedFile>>,
        space: Option<ColorSpace>,
    ) -> Result<(Arc<ImageData>, Option<u16>), SceneError> {
        let source = self.picture_source(&file.value);
        self.picture(&source, space).map_err(|reason| {
            let error = self.error(&file.place, format!("{source}: {reason}"));
            match formats::unread_picture(source.name()) {
                Some(advice) => error.with_help(advice),
                None => error,
            }
        })
    }

    /// Reads an image once, however often it is named. The error says what is wrong with it, without its name.
    pub(super) fn picture(
        &mut self,
        file: &PictureSource,
        space: Option<ColorSpace>,
    ) -> Result<(Arc<ImageData>, Option<u16>), String> {
        let cached = match self.images.entry((file.clone(), space)) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => entry.insert(self.pictures.read(file, space)?.into()),
        };
        // A written scene names files that everyone reads alike; pixels of others are written anew.
        if cached.is_plain {
            self.scene.sources.add_image(&cached.image, file.to_source(space));
        }
        if let Some(change) = cached.change.take() {
            self.scene.warnings.push(format!("{file}: {change}"));
        }
        let (notes, read) = (take(&mut cached.notes), (cached.image.clone(), cached.integer_bits));
        notes.iter().try_for_each(|note| self.name_unused(file, note))?;
        Ok(read)
    }
}

impl From<ColorSpaceEntry> for ColorSpace {
    fn from(written: ColorSpaceEntry) -> Self {
        match written {
            ColorSpaceEntry::Srgb => Self::Srgb,
            ColorSpaceEntry::Linear => Self::Linear,
        }
    }
}

/// How a texture goes on along u and v by what its file says, of both or of each (`wrapmodes` of OpenEXR); None of what no texture here does.
fn wraps_of(modes: &str) -> Option<[TextureWrap; 2]> {
    let along = |mode: &str| match mode.trim() {
        "periodic" => Some(TextureWrap::Repeat),
        "clamp" => Some(TextureWrap::Clamp),
        "mirror" => Some(TextureWrap::Mirror),
        _ => None,
    };
    let (horizontal, vertical) = modes.split_once(',').unwrap_or((modes, modes));
    Some([along(horizontal)?, along(vertical)?])
}

fn factor(written: Option<Checked<Positive>>) -> f64 {
    written.map_or(1.0, |scale| scale.0)
}

fn factors(written: Option<Exactly<Number, 2>>) -> [f64; 2] {
    written.map_or([1.0, 1.0], |scale| scale.map(|factor| factor.0))
}
