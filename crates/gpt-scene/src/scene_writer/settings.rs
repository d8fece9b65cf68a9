//! `[film]`, `[render]`, `[output]` and, by `camera`, `[camera]`.

use std::fmt::Write;

use super::camera;
use crate::choice::Choice;
use crate::load::file::writer::{Writer, line, list, number, table, text};
use crate::scene::{FilmSettings, Filter, PixelSampler, RenderSettings};

/// All four; of the settings, those that are not at their defaults.
pub fn settings(writer: &Writer<'_>) -> String {
    let scene = writer.scene;
    let mut out = film(&scene.film);
    let written = render(&scene.render);
    if !written.is_empty() {
        let _ = write!(out, "\n[render]\n{written}");
    }
    if !scene.layers.is_empty() {
        let names = scene.layers.iter().map(|layer| text(layer.name()));
        let _ = write!(out, "\n[output]\n{}", line("aov", &list(names)));
    }
    out += &camera::camera(&scene.camera);
    if let Some(medium) = scene.camera_medium {
        out += &line("medium", &writer.media.quoted(medium));
    }
    out
}

fn film(film: &FilmSettings) -> String {
    let mut out = "[film]\n".to_owned() + &line("size", &list(film.size.map(|side| side.to_string())));
    if film.filter != Filter::default() {
        let Filter { kind, radius } = film.filter;
        out += &line("filter", &table([("type", text(kind.name())), ("radius", number(radius))]));
    }
    out
}

fn render(settings: &RenderSettings) -> String {
    // The pixel's sampler is the path's where it is no other.
    let is_same = [PixelSampler::SameAsPath, PixelSampler::Other(settings.sampler)].contains(&settings.pixel_sampler);
    let written = settings.values().filter(|(setting, value)| match setting.name {
        "pixel_sampler" => !is_same,
        _ => *value != setting.default(),
    });
    written
        .map(|(setting, value)| {
            // A number or a name: both are values of TOML.
            let value = toml::Value::try_from(value).map_or_else(|_| value.to_string(), |value| value.to_string());
            line(setting.name, &value)
        })
        .collect()
}
