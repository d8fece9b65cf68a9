//! Attributes of a header that change what pixels mean.

use exr::meta::attribute::{AttributeValue, Chromaticities, EnvironmentMap, Text};
use exr::meta::header::Header;
use exr::prelude::Vec2;
use glam::{DMat3, DVec2};

use crate::picture_file::pixels::{Envelope, Hints};
use crate::picture_file::primaries::Primaries;
use crate::scene::ColorSpace;

/// Names of colour spaces, in `colorInteropID` and in what OpenImageIO writes, that are linear Rec. 709, or say nothing.
const PLAIN: [&str; 16] = [
    "lin_rec709_scene",
    "lin_rec709",
    "lin_srgb",
    "lin_rec709_display",
    "linear",
    "linear rec.709 (srgb)",
    "linear rec.709",
    "scene_linear",
    "linear bt.709",
    "lin_srgb_scene",
    "srgblinear",
    "utility - linear - srgb",
    "raw",
    "data",
    "unknown",
    "",
];

/// The meaning of the numbers by the header.
#[derive(Debug, Clone)]
pub struct Attributes {
    pub primaries: Primaries,
    /// Turns the file's colours into linear Rec. 709, where they are not that.
    pub matrix: Option<DMat3>,
    pub color_space: ColorSpace,
    pub hints: Hints,
}

impl Attributes {
    /// Reads them, and notes those that are not used.
    pub fn of(header: &Header, color_space: Option<ColorSpace>, notes: &mut Vec<String>) -> Self {
        let (shared, own) = (&header.shared_attributes, &header.own_attributes);
        let text = |name: &str| {
            let name = Text::from(name);
            own.other.get(&name).or_else(|| shared.other.get(&name)).and_then(|value| match value {
                AttributeValue::Text(text) => Some(text.to_string()),
                _ => None,
            })
        };
        let is_aces = own.other.get(&Text::from("acesImageContainerFlag")) == Some(&AttributeValue::I32(1));
        let mut primaries = shared.chromaticities.map(of_chromaticities);
        let mut space = ColorSpace::Linear;
        if let Some(id) = text("colorInteropID") {
            let known = id.strip_prefix("lin_").and_then(|name| Primaries::named(name.split('_').next().unwrap_or_default()));
            match known {
                Some(known) => primaries = primaries.or(Some(known)),
                None if id.starts_with("srgb_rec709") => space = ColorSpace::Srgb,
                None if PLAIN.contains(&id.to_ascii_lowercase().as_str()) => {}
                None => notes.push(format!("its colorInteropID is `{id}`, which is not used: its numbers are taken for linear")),
            }
        } else if let Some(name) = text("oiio:ColorSpace").filter(|name| !PLAIN.contains(&name.to_ascii_lowercase().as_str())) {
            notes.push(format!("its oiio:ColorSpace is `{name}`, which is not used: its numbers are taken for linear"));
        }
        let primaries = primaries.or(is_aces.then_some(Primaries::ACES_AP0)).unwrap_or(Primaries::REC_709);
        let neutral = own.adopted_neutral.map(point);
        let mut matrix = primaries.to_rec_709(neutral).unwrap_or_else(|| {
            notes.push("its chromaticities span no colours: they are taken for those of Rec. 709".to_owned());
            None
        });
        if matrix.is_some() && color_space == Some(ColorSpace::Linear) {
            matrix = None;
            notes.push(
                "its chromaticities are not those of Rec. 709, and not used: color_space = \"linear\" takes numbers as they are"
                    .to_owned(),
            );
        }
        if (shared.pixel_aspect - 1.0).abs() > 1e-3 {
            notes.push(format!(
                "its pixelAspectRatio is {}, which is not used: pixels are taken for squares",
                shared.pixel_aspect
            ));
        }
        if let Some(luminance) = own.white_luminance {
            notes.push(format!(
                "its whiteLuminance is {luminance} cd/m², which is not used: its numbers are taken for radiance as they are"
            ));
        }
        if let [first, _, ..] = own.multi_view_names.as_deref().unwrap_or_default() {
            notes.push(format!("it holds several views, of which {first} is the picture"));
        }
        Self {
            primaries,
            matrix,
            color_space: color_space.unwrap_or(space),
            hints: Hints {
                envelope: own.environment_map.map(|envelope| match envelope {
                    EnvironmentMap::LatitudeLongitude => Envelope::LatLong,
                    EnvironmentMap::Cube => Envelope::Cube,
                }),
                wrap_modes: own.wrap_mode_name.as_ref().map(ToString::to_string),
                has_view: false,
            },
        }
    }
}

fn of_chromaticities(points: Chromaticities) -> Primaries {
    let Chromaticities { red, green, blue, white } = points;
    Primaries { red: point(red), green: point(green), blue: point(blue), white: point(white) }
}

fn point(Vec2(x, y): Vec2<f32>) -> DVec2 {
    DVec2::new(f64::from(x), f64::from(y))
}
