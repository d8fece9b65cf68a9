//! `[camera]`.

use glam::DVec3;

use crate::choice::Choice;
use crate::load::file::writer::{line, list, number, numbers, table, text, vector};
use crate::scene::{Aperture, ApertureShape, Camera, Cylindrical, Equirectangular, Intrinsics, Projection, Stereo};

/// The table, without the medium around it and without keyframes.
pub fn camera(camera: &Camera) -> String {
    let mut out =
        "\n[camera]\n".to_owned() + &line("position", &vector(camera.position)) + &line("look_at", &vector(camera.look_at));
    if camera.up != DVec3::Y {
        out += &line("up", &vector(camera.up));
    }
    out += &projection(&camera.projection);
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
    if let Some(stereo) = &camera.stereo {
        out += &line("stereo", &eyes(stereo));
    }
    if camera.shutter != Camera::default().shutter {
        out += &line("shutter", &numbers(&camera.shutter));
    }
    if camera.rolling_shutter != Camera::default().rolling_shutter {
        out += &line("rolling_shutter", &number(camera.rolling_shutter));
    }
    out
}

fn projection(projection: &Projection) -> String {
    let name = match projection {
        Projection::Perspective { .. } => String::new(),
        other => line("projection", &text(other.name())),
    };
    name + &match projection {
        Projection::Perspective { vertical_fov_degrees } => line("vfov", &number(*vertical_fov_degrees)),
        Projection::Orthographic { height } => line("height", &number(*height)),
        Projection::Equirectangular(model) => {
            let full = Equirectangular::default();
            let azimuth = range("azimuth", model.azimuth_degrees, full.azimuth_degrees);
            azimuth + &range("elevation", model.elevation_degrees, full.elevation_degrees)
        }
        Projection::Cylindrical(model) => {
            let azimuth = range("azimuth", model.azimuth_degrees, Cylindrical::default().azimuth_degrees);
            azimuth + &model.elevation_degrees.map_or_else(String::new, |range| line("elevation", &numbers(&range)))
        }
        Projection::Fisheye(model) => {
            let fov = line("fov", &number(model.fov_degrees));
            fov + &line("mapping", &text(model.mapping.name())) + &line("fit", &text(model.fit.name()))
        }
        Projection::CubeMap(model) => line("layout", &text(model.layout.name())),
        Projection::BrownConrady(model) => {
            intrinsics(&model.intrinsics)
                + &coefficients("radial", &model.radial)
                + &coefficients("tangential", &model.tangential)
        }
        Projection::KannalaBrandt(model) => {
            let fov = if model.fov_degrees == 360.0 { String::new() } else { line("fov", &number(model.fov_degrees)) };
            intrinsics(&model.intrinsics) + &coefficients("radial", &model.radial) + &fov
        }
    }
}

/// A range that is not the whole.
fn range(key: &str, range: [f64; 2], whole: [f64; 2]) -> String {
    if range == whole { String::new() } else { line(key, &numbers(&range)) }
}

/// Coefficients that are not all 0.
fn coefficients(key: &str, coefficients: &[f64]) -> String {
    if coefficients.iter().all(|coefficient| *coefficient == 0.0) { String::new() } else { line(key, &numbers(coefficients)) }
}

fn intrinsics(intrinsics: &Intrinsics) -> String {
    let size = list(intrinsics.image_size.map(|side| side.to_string()));
    let focal = line("focal", &numbers(&intrinsics.focal));
    focal + &line("principal_point", &numbers(&intrinsics.principal_point)) + &line("image_size", &size)
}

fn eyes(stereo: &Stereo) -> String {
    let keys = [("layout", text(stereo.layout.name())), ("eye_distance", number(stereo.eye_distance))];
    table(keys.into_iter().chain(stereo.convergence.map(|distance| ("convergence", number(distance)))))
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
