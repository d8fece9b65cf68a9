//! Textures, with their pictures and samplers.

use std::sync::Arc;

use glam::{DMat2, DVec2};
use serde_json::{Value, json};

use super::{Writer, container};
use crate::load::file::writer::{is_on_disk, picture};
use crate::scene::image::Code;
use crate::scene::{ColorSpace, ImageData, Texels, Texture, TextureFilter, TextureId, TextureKind, TextureWrap, UvTransform};

/// The meaning of a texture's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Colours, coded in sRGB.
    Colour,
    /// Numbers and directions, which are not.
    Numbers,
}

/// A texture as a picture.
#[derive(Debug, Clone)]
pub struct Pictured {
    pub image: Arc<ImageData>,
    pub wrap: [TextureWrap; 2],
    pub filter: TextureFilter,
    pub scale: [f64; 2],
    pub transform: UvTransform,
    pub by_second_uvs: bool,
}

impl Role {
    fn space(self) -> ColorSpace {
        match self {
            Self::Colour => ColorSpace::Srgb,
            Self::Numbers => ColorSpace::Linear,
        }
    }
}

impl Writer<'_> {
    /// The texture as a picture; None of noise, which is reported.
    pub fn pictured(&mut self, id: TextureId, place: &str) -> Option<Pictured> {
        let texture = &self.scene.textures[id];
        let Texture { transform, by_second_uvs, .. } = *texture;
        match &texture.kind {
            TextureKind::Image(image) => Some(Pictured {
                image: image.image.clone(),
                wrap: image.wrap,
                filter: image.filter,
                scale: image.scale,
                transform,
                by_second_uvs,
            }),
            TextureKind::Checker { a, b, scale } => {
                // The lowest row comes last.
                let texels = [b, a, a, b].map(|colour| colour.to_f32()).to_vec();
                let image = ImageData { width: 2, height: 2, texels: Texels::Float(texels), has_alpha: false };
                Some(Pictured {
                    image: Arc::new(image),
                    wrap: [TextureWrap::Repeat; 2],
                    filter: TextureFilter::Nearest,
                    scale: scale.map(|factor| 0.5 * factor),
                    transform: UvTransform { offset: transform.offset.map(|offset| 0.5 * offset), ..transform },
                    by_second_uvs,
                })
            }
            TextureKind::Perlin { .. } | TextureKind::Worley { .. } => {
                self.approximate("texture of noise", place, "its mean is taken");
                None
            }
        }
    }

    /// The reference to a texture that shows an image as a picture lies.
    pub fn reference(&mut self, pictured: &Pictured, image: usize, place: &str) -> Value {
        let sampler = self.sampler(pictured, place);
        let key = format!("texture {image} {sampler}");
        let index = match self.made_textures.get(&key) {
            Some(&index) => index,
            None => {
                self.lists.textures.push(json!({ "source": image, "sampler": sampler }));
                self.made_textures.insert(key, self.lists.textures.len() - 1);
                self.lists.textures.len() - 1
            }
        };
        let mut info = json!({ "index": index });
        self.uses_sets[usize::from(pictured.by_second_uvs)] = true;
        if pictured.by_second_uvs {
            info["texCoord"] = json!(1);
        }
        let rotation = pictured.transform.rotation_degrees.to_radians();
        let scale = DVec2::from(pictured.scale);
        // v runs downward there, and turns go the other way.
        let matrix = DMat2::from_angle(-rotation) * DMat2::from_diagonal(scale);
        let [right, up] = pictured.transform.offset;
        let offset = if rotation == 0.0 && scale == DVec2::ONE {
            [right, -up]
        } else {
            [right - matrix.y_axis.x, 1.0 - matrix.y_axis.y - up]
        };
        let mut transform = json!({});
        for (is_stated, name, value) in [
            (offset != [0.0; 2], "offset", json!(offset)),
            (rotation != 0.0, "rotation", json!(rotation)),
            (scale != DVec2::ONE, "scale", json!(scale.to_array())),
        ] {
            if is_stated {
                transform[name] = value;
            }
        }
        if transform != json!({}) {
            let name = self.uses("KHR_texture_transform");
            info["extensions"] = json!({ name: transform });
        }
        info
    }

    fn sampler(&mut self, pictured: &Pictured, place: &str) -> usize {
        let wrap = |wrap: TextureWrap| match wrap {
            TextureWrap::Repeat => 10_497,
            TextureWrap::Clamp => 33_071,
            TextureWrap::Mirror => 33_648,
        };
        let filter = match pictured.filter {
            TextureFilter::Nearest => 9728,
            TextureFilter::Bilinear => 9729,
            TextureFilter::Triangle => {
                self.approximate("colours of vertices", place, "they are a picture, in which neighbours run into each other");
                9729
            }
        };
        let [along_u, along_v] = pictured.wrap.map(wrap);
        let written = json!({ "magFilter": filter, "minFilter": filter, "wrapS": along_u, "wrapT": along_v });
        let key = format!("sampler {written}");
        if let Some(&index) = self.made_textures.get(&key) {
            return index;
        }
        self.lists.samplers.push(written);
        self.made_textures.insert(key, self.lists.samplers.len() - 1);
        self.lists.samplers.len() - 1
    }

    /// The index of an image that shows a picture's own texels, or what of them 8 or 16 bits hold.
    pub fn image(&mut self, image: &Arc<ImageData>, role: Role, place: &str) -> usize {
        let key = format!("image {:?} {role:?}", Arc::as_ptr(image));
        if let Some(&index) = self.made_textures.get(&key) {
            return index;
        }
        let is_coded_so =
            matches!(&image.texels, Texels::Bytes { space, .. } | Texels::Shorts { space, .. } if *space == role.space());
        let index = if is_coded_so {
            self.coded_image(image)
        } else {
            let texels: Vec<[f32; 4]> = (0..image.texels.len()).map(|index| image.texels.get(index)).collect();
            self.push_texels([image.width, image.height], &texels, role, place)
        };
        self.made_textures.insert(key, index);
        index
    }

    /// An image of texels that are made. `key` tells them from others.
    pub fn made_image(&mut self, key: String, size: [u32; 2], texels: &[[f32; 4]], role: Role, place: &str) -> usize {
        if let Some(&index) = self.made_textures.get(&key) {
            return index;
        }
        let index = self.push_texels(size, texels, role, place);
        self.made_textures.insert(key, index);
        index
    }

    fn push_texels(&mut self, [width, height]: [u32; 2], texels: &[[f32; 4]], role: Role, place: &str) -> usize {
        if texels.iter().flatten().any(|value| !(0.0..=1.0).contains(value)) {
            self.approximate("texels beyond 1", place, "1 is taken");
        }
        let texels = coded(texels, role.space());
        let has_alpha = false;
        let content = picture(&ImageData { width, height, texels, has_alpha });
        self.push_image(content, "png")
    }

    /// An image whose picture has the code that is wanted: its own file if there is one that glTF knows.
    fn coded_image(&mut self, image: &Arc<ImageData>) -> usize {
        let source = self.scene.sources.image(image).filter(|source| source.scale == 1.0);
        if let Some(source) = source {
            let ending = source.path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
            let ending = if ending == "jpeg" { "jpg".to_owned() } else { ending };
            if ["png", "jpg"].contains(&ending.as_str()) {
                if let Some(content) = &source.embedded {
                    return self.push_image(content.to_vec(), &ending);
                }
                if !self.is_binary && is_on_disk(&source.path) {
                    let uri = container::uri(&self.files.path_to(&source.path).to_string_lossy());
                    self.lists.images.push(json!({ "uri": uri }));
                    return self.lists.images.len() - 1;
                }
            }
        }
        self.push_image(picture(image), "png")
    }

    fn push_image(&mut self, content: Vec<u8>, ending: &str) -> usize {
        let kind = if ending == "png" { "image/png" } else { "image/jpeg" };
        let image = if self.is_binary {
            json!({ "bufferView": self.buffer.picture(&content), "mimeType": kind })
        } else {
            let name = format!("picture-{}.{ending}", self.lists.images.len() + 1);
            json!({ "uri": container::uri(&self.files.add_file(&name, content)), "mimeType": kind })
        };
        self.lists.images.push(image);
        self.lists.images.len() - 1
    }
}

/// Numbers in 8 bits where that is exact, else in 16.
fn coded(texels: &[[f32; 4]], space: ColorSpace) -> Texels {
    let codes = |bits: u32| {
        let (colours, alpha) = match (space, bits) {
            (ColorSpace::Srgb, 8) => (Code::Srgb8, Code::Linear8),
            (ColorSpace::Linear, 8) => (Code::Linear8, Code::Linear8),
            (ColorSpace::Srgb, _) => (Code::Srgb16, Code::Linear16),
            (ColorSpace::Linear, _) => (Code::Linear16, Code::Linear16),
        };
        [colours, colours, colours, alpha].map(Code::values)
    };
    let all = |tables: [&'static [f32]; 4]| {
        texels.iter().map(move |texel| std::array::from_fn(|channel| nearest(tables[channel], texel[channel])))
    };
    let bytes = codes(8);
    let narrow: Vec<[u16; 4]> = all(bytes).collect();
    let is_exact = narrow
        .iter()
        .zip(texels)
        .all(|(code, texel)| (0..4).all(|channel| bytes[channel][usize::from(code[channel])] == texel[channel]));
    if is_exact {
        return Texels::Bytes { codes: narrow.into_iter().map(|code| code.map(|code| code as u8)).collect(), space };
    }
    Texels::Shorts { codes: all(codes(16)).collect(), space }
}

/// The place of the value in an ascending table that is nearest.
fn nearest(table: &[f32], value: f32) -> u16 {
    let above = table.partition_point(|entry| *entry < value).min(table.len() - 1);
    let below = above.saturating_sub(1);
    let nearer = if (table[above] - value).abs() <= (value - table[below]).abs() { above } else { below };
    nearer as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_coded_as_near_as_can_be() {
        let exact = [[0.0, 1.0, 128.0 / 255.0, 1.0]];
        assert!(matches!(coded(&exact, ColorSpace::Linear), Texels::Bytes { codes, .. } if codes == [[0, 255, 128, 255]]));
        for space in [ColorSpace::Linear, ColorSpace::Srgb] {
            let texels = [[0.1, 0.5, 0.9, 0.3]];
            let Texels::Shorts { codes, space } = coded(&texels, space) else { panic!("8 bits are not exact") };
            let read = Texels::Shorts { codes, space }.get(0);
            assert!(read.iter().zip(texels[0]).all(|(read, value)| (read - value).abs() < 2e-5), "{read:?}");
        }
    }
}
