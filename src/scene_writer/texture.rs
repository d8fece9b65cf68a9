//! `[[texture]]`

use std::sync::Arc;

use super::picture::picture;
use super::side_files::is_on_disk;
use super::value::{colour, line, number, numbers};
use super::writer::Writer;
use crate::scene::{ColorSpace, ImageData, ImageTexture, TextureFilter, TextureId, TextureKind, TextureWrap};

impl Writer<'_> {
    pub fn texture(&mut self, id: TextureId) -> String {
        let mut out = format!("\n[[texture]]\nname = {}\n", self.textures.quoted(id));
        let scene = self.scene;
        let texture = &scene.textures[id];
        match &texture.kind {
            TextureKind::Image(image) => out += &self.image_texture(image),
            TextureKind::Checker { a, b, scale } => {
                out += "type = \"checker\"\n";
                out += &(line("a", &colour(*a)) + &line("b", &colour(*b)));
                out += &pair("scale", *scale, 1.0);
            }
            TextureKind::Perlin { scale, octaves, a, b, seed } => {
                out += "type = \"perlin\"\n";
                out += &(line("a", &colour(*a)) + &line("b", &colour(*b)) + &line("scale", &number(*scale)));
                out += &format!("octaves = {octaves}\nseed = {seed}\n");
            }
            TextureKind::Worley { scale, a, b, seed } => {
                out += "type = \"worley\"\n";
                out += &(line("a", &colour(*a)) + &line("b", &colour(*b)) + &line("scale", &number(*scale)));
                out += &format!("seed = {seed}\n");
            }
        }
        if texture.transform.rotation_degrees != 0.0 {
            out += &line("rotation", &number(texture.transform.rotation_degrees));
        }
        out + &pair("offset", texture.transform.offset, 0.0)
    }

    fn image_texture(&mut self, texture: &ImageTexture) -> String {
        let (file, space, _) = self.image(&texture.image);
        let mut out = "type = \"image\"\n".to_owned() + &line("file", &file);
        match space {
            None => {}
            Some(ColorSpace::Srgb) => out += "color_space = \"srgb\"\n",
            Some(ColorSpace::Linear) => out += "color_space = \"linear\"\n",
        }
        out += match texture.wrap {
            TextureWrap::Repeat => "",
            TextureWrap::Clamp => "wrap = \"clamp\"\n",
            TextureWrap::Mirror => "wrap = \"mirror\"\n",
        };
        out += match texture.filter {
            TextureFilter::Bilinear => "",
            TextureFilter::Nearest => "filter = \"nearest\"\n",
        };
        out + &pair("scale", texture.scale, 1.0)
    }

    /// The file that a picture came from, or else one beside the scene file; the colour space that it is read in, and the factor of its values.
    pub fn image(&mut self, image: &Arc<ImageData>) -> (String, Option<ColorSpace>, f64) {
        match self.scene.sources.image(image).filter(|source| is_on_disk(&source.path)) {
            Some(source) => (self.files.name_of(&source.path), source.color_space, source.scale),
            None => {
                let (ending, space, content) = picture(image);
                let name = format!("picture-{}.{ending}", self.files.len() + 1);
                (self.files.add(&name, content), Some(space), 1.0)
            }
        }
    }
}

/// Nothing where both are the default.
fn pair(key: &str, values: [f64; 2], default: f64) -> String {
    if values == [default; 2] { String::new() } else { line(key, &numbers(&values)) }
}
