//! `[[texture]]`

use crate::load::file::writer::{Writer, colour, flag, line, number, numbers, text};
use crate::scene::{ColorSpace, ImageTexture, TextureFilter, TextureId, TextureKind, TextureWrap};

pub fn texture(id: TextureId, writer: &mut Writer<'_>) -> String {
    let mut out = "\n[[texture]]\n".to_owned() + &line("name", &writer.textures.quoted(id));
    let scene = writer.scene;
    let texture = &scene.textures[id];
    match &texture.kind {
        TextureKind::Image(image) => out += &image_texture(image, writer),
        TextureKind::Checker { a, b, scale } => match scene.sources.unreadable(&texture.name) {
            Some(source) if writer.names_unreadable => {
                let file = writer.file(source);
                out += &(line("type", &text("image")) + &line("file", &file) + &line("fallback", &colour(*a)));
                let space = source.color_space.map(space_name);
                out += &space.map_or_else(String::new, |space| line("color_space", &text(space)));
            }
            _ => {
                out += &line("type", &text("checker"));
                out += &(line("a", &colour(*a)) + &line("b", &colour(*b)));
                out += &pair("scale", *scale, 1.0);
            }
        },
        TextureKind::Perlin { scale, octaves, a, b, seed } => {
            out += &line("type", &text("perlin"));
            out += &(line("a", &colour(*a)) + &line("b", &colour(*b)) + &line("scale", &number(*scale)));
            out += &(line("octaves", &octaves.to_string()) + &line("seed", &seed.to_string()));
        }
        TextureKind::Worley { scale, a, b, seed } => {
            out += &line("type", &text("worley"));
            out += &(line("a", &colour(*a)) + &line("b", &colour(*b)) + &line("scale", &number(*scale)));
            out += &line("seed", &seed.to_string());
        }
    }
    if texture.transform.rotation_degrees != 0.0 {
        out += &line("rotation", &number(texture.transform.rotation_degrees));
    }
    out += &pair("offset", texture.transform.offset, 0.0);
    out += &flag("second_uvs", texture.by_second_uvs);
    out += &flag("bends_by_first_uvs", texture.bends_by_first_uvs);
    if let Some(other) = texture.times {
        out += &line("times", &writer.textures.quoted(other));
    }
    out
}

fn image_texture(texture: &ImageTexture, writer: &mut Writer<'_>) -> String {
    let (file, space, _) = writer.image(&texture.image);
    let space = space.map(space_name);
    let name = |wrap: TextureWrap| match wrap {
        TextureWrap::Repeat => "repeat",
        TextureWrap::Clamp => "clamp",
        TextureWrap::Mirror => "mirror",
    };
    let [along_u, along_v] = texture.wrap;
    let wrap = Some(along_u).filter(|wrap| *wrap != TextureWrap::Repeat).map(name);
    let wrap_v = Some(along_v).filter(|wrap| *wrap != along_u).map(name);
    let filter = match texture.filter {
        TextureFilter::Bilinear => None,
        TextureFilter::Nearest => Some("nearest"),
        TextureFilter::Triangle => Some("triangle"),
    };
    let names = [("color_space", space), ("wrap", wrap), ("wrap_v", wrap_v), ("filter", filter)];
    let written = names.into_iter().filter_map(|(key, name)| Some(line(key, &text(name?))));
    line("type", &text("image")) + &line("file", &file) + &written.collect::<String>() + &pair("scale", texture.scale, 1.0)
}

fn space_name(space: ColorSpace) -> &'static str {
    match space {
        ColorSpace::Srgb => "srgb",
        ColorSpace::Linear => "linear",
    }
}

/// Nothing where both are the default.
fn pair(key: &str, values: [f64; 2], default: f64) -> String {
    if values == [default; 2] { String::new() } else { line(key, &numbers(&values)) }
}
