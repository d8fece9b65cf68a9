//! `[[texture]]`

use crate::load::file::writer::{Writer, colour, line, number, numbers};
use crate::scene::{ColorSpace, ImageTexture, TextureFilter, TextureId, TextureKind, TextureWrap};

pub fn texture(id: TextureId, writer: &mut Writer<'_>) -> String {
    let mut out = format!("\n[[texture]]\nname = {}\n", writer.textures.quoted(id));
    let scene = writer.scene;
    let texture = &scene.textures[id];
    match &texture.kind {
        TextureKind::Image(image) => out += &image_texture(image, writer),
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
    out += &pair("offset", texture.transform.offset, 0.0);
    if texture.by_second_uvs {
        out += "second_uvs = true\n";
    }
    if let Some(other) = texture.times {
        out += &line("times", &writer.textures.quoted(other));
    }
    out
}

fn image_texture(texture: &ImageTexture, writer: &mut Writer<'_>) -> String {
    let (file, space, _) = writer.image(&texture.image);
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
        TextureFilter::Triangle => "filter = \"triangle\"\n",
    };
    out + &pair("scale", texture.scale, 1.0)
}

/// Nothing where both are the default.
fn pair(key: &str, values: [f64; 2], default: f64) -> String {
    if values == [default; 2] { String::new() } else { line(key, &numbers(&values)) }
}
