//! `[film]`, `[render]`, `[output]` and `[camera]`.

use std::fmt::Write;

use glam::DVec3;

use crate::choice::Choice;
use crate::load::file::writer::{Writer, line, list, number, numbers, table, text, vector};
use crate::scene::{Aperture, ApertureShape, Camera, FilmSettings, Filter, PixelSampler, Projection, RenderSettings};

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
    out += &camera(&scene.camera);
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

fn camera(camera: &Camera) -> String {
    let mut out =
        "\n[camera]\n".to_owned() + &line("position", &vector(camera.position)) + &line("look_at", &vector(camera.look_at));
    if camera.up != DVec3::Y {
        out += &line("up", &vector(camera.up));
    }
    match camera.projection {
        Projection::Perspective { vertical_fov_degrees } => out += &line("vfov", &number(vertical_fov_degrees)),
        Projection::Orthographic { height } => {
            out += &line("projection", &text("orthographic"));
            out += &line("height", &number(height));
        }
    }
    if camera.shift != [0.0; 2] {
        out += &line("shift", &numbers(&camera.shift));
    }
    if camera.stretch != 1.0 {
        out += &line("stretch", &number(camera.stretch));
    }
    if let Some(aperture) = &camera.aperture {
        out += &line("aperture", &opening(aperture));
    }
    if camera.aperture.is_some() || camera.focus_distance != (camera.look_at - camera.position).length() {
        out += &line("focus_distance", &number(camera.focus_distance));
    }
    if camera.shutter != Camera::default().shutter {
        out += &line("shutter", &numbers(&camera.shutter));
    }
    out
}

fn opening(aperture: &Aperture) -> String {
    let (shape, further) = match aperture.shape {
        ApertureShape::Disk => ("disk", Vec::new()),
        ApertureShape::Square => ("square", Vec::new()),
        ApertureShape::Polygon { blades, rotation_degrees } => {
            ("polygon", vec![("blades", blades.to_string()), ("rotation", number(rotation_degrees))])
        }
    };
    table([("shape", text(shape)), ("radius", number(aperture.radius))].into_iter().chain(further))
}
