//! A scene as one of Mitsuba 3, as far as it can be said there.
//!
//! The scene is first written as a TOML scene file, whose keys are then converted one by one: colours are
//! numbers there, and opacity is a blend.

mod keys;
mod material;
mod media;
mod shape;
mod xml;

use std::path::{Path, PathBuf};

use glam::DVec3;
use toml::Table;

use self::keys::{Keys, colour, entries, flag, integer, number, numbers, table, text, transform, vector};
use self::xml::{Element, Xml, matrix};
use super::flat_camera::with_flat_camera;
use super::losses::Losses;
use super::scene_file::scene_text;
use super::surroundings::{Surroundings, has_media};
use super::written::WrittenScene;
use crate::load::SceneError;
use crate::load::file::writer::SideFiles;
use crate::scene::{Light, MeterKind, Scene};
use crate::spectrum::Spectrum;

/// A scene as one of Mitsuba that is to be written to `target`; meshes and pictures that come from no file lie in the folder `NAME.files` beside
/// it. `name` is how reports call the scene.
///
/// # Errors
/// None that is known: what cannot be said there is in the report.
pub fn as_mitsuba(scene: &Scene, name: &str, target: &Path) -> Result<WrittenScene, SceneError> {
    let mut losses = Losses::of(name);
    losses.drop_links(scene);
    let scene = &*with_flat_camera(scene, &mut losses, |_| false);
    let (text, files) = scene_text(scene, target, false);
    let tables: Table = text.parse().map_err(|error: toml::de::Error| SceneError::in_file(name, error.message().to_owned()))?;
    let surroundings = Surroundings::of(scene);
    let mut writer = Writer { name, scene: &tables, original: scene, surroundings, files, xml: Xml::default(), losses };
    writer.all()?;
    let content = writer.xml.finish().into_bytes();
    Ok(WrittenScene { content, files: writer.files.into_files(), report: writer.losses.into_report() })
}

struct Writer<'w> {
    name: &'w str,
    /// The scene as a scene file of ours.
    scene: &'w Table,
    original: &'w Scene,
    surroundings: Surroundings,
    files: SideFiles,
    xml: Xml,
    losses: Losses,
}

impl Writer<'_> {
    fn all(&mut self) -> Result<(), SceneError> {
        self.integrator();
        self.media();
        self.sensor();
        self.meters();
        for material in self.parts_first().into_iter().map(Keys::of) {
            let place = self.material(&material)?;
            self.drop_rest(&material, &place);
        }
        for (index, shape) in entries(self.scene, "shape").into_iter().map(Keys::of).enumerate() {
            self.shape(index, &shape)?;
        }
        for (index, group) in entries(self.scene, "group").into_iter().enumerate() {
            self.group(index, group)?;
        }
        for (index, instances) in entries(self.scene, "instance").into_iter().map(Keys::of).enumerate() {
            self.instances(index, &instances);
            self.drop_rest(&instances, &format!("instance[{index}]"));
        }
        let lights = entries(self.scene, "light").into_iter().map(Keys::of);
        for (index, (light, original)) in lights.zip(&self.original.lights).enumerate() {
            let place = format!("light[{index}]");
            if self.light(&light, original, &place)? {
                self.drop_rest(&light, &place);
            }
        }
        Ok(())
    }

    /// Meters that need no surface to stand on; one of irradiance would hide light from the rest of the scene.
    fn meters(&mut self) {
        for (index, meter) in self.original.meters.iter().enumerate() {
            let (kind, position, direction) = match meter.kind {
                MeterKind::Radiance { position, direction } => ("radiancemeter", position, direction),
                MeterKind::Distant { direction, target, size: 0.0 } => ("distant", target, direction),
                _ => {
                    self.drop("meter", &format!("meter[{index}]"), "it is not written");
                    continue;
                }
            };
            let place = xml::look_at(position, position + direction, direction.any_orthonormal_vector());
            let film = Element::new("film", "hdrfilm").integer("width", 1).integer("height", 1).string("pixel_format", "rgb");
            let sensor = Element::new("sensor", kind).transform("to_world", &place);
            let sensor = if kind == "distant" { sensor.point("target", position) } else { sensor };
            self.xml.push(sensor.with(film.with(Element::new("rfilter", "box"))));
        }
    }

    fn drop(&mut self, what: &str, place: &str, instead: &str) {
        self.losses.drop(what, place, instead);
    }

    /// Reports the keys that nothing said.
    fn drop_rest(&mut self, keys: &Keys<'_>, place: &str) {
        keys.rest().into_iter().for_each(|key| self.drop(&format!("key `{key}`"), place, "it has no effect"));
    }

    /// Reports the keys of a table within a key that are not among those written.
    fn drop_others(&mut self, of: &Table, said: &[&str], place: &str) {
        // A factor of 1 is as if none were written.
        let is_one = |key: &str| key == "factor" && number(of, key) == Some(1.0);
        let others = of.keys().filter(|key| !said.contains(&key.as_str()) && !is_one(key));
        others.for_each(|key| self.drop(&format!("key `{key}`"), place, "it has no effect"));
    }

    fn approximate(&mut self, what: &str, place: &str, instead: &str) {
        self.losses.approximate(what, place, instead);
    }

    fn integrator(&mut self) {
        let render = table(self.scene, "render");
        if render.is_some_and(|render| number(render, "clamp").is_some_and(|clamp| clamp > 0.0)) {
            self.drop("clamp", "render", "bright samples stay as they are");
        }
        let depth = render.and_then(|render| integer(render, "max_depth")).unwrap_or(16);
        let roulette = render.and_then(|render| integer(render, "roulette_depth")).unwrap_or(5);
        // The roulette of volpathmis takes light away in version 3.9.1.
        let kind = if has_media(self.original) { "volpath" } else { "path" };
        let integrator = Element::new("integrator", kind)
            .integer("max_depth", if depth == 0 { -1 } else { depth })
            .integer("rr_depth", if roulette == 0 { 1_000_000 } else { roulette });
        let hides = render.and_then(|render| text(render, "emitters")) == Some("hidden");
        let integrator = if hides { integrator.boolean("hide_emitters", true) } else { integrator };
        self.xml.push(integrator);
    }

    fn sensor(&mut self) {
        let film = table(self.scene, "film");
        let size = film.and_then(|film| numbers(film, "size")).unwrap_or(vec![512.0, 512.0]);
        let filter = film.and_then(|film| table(film, "filter"));
        let (kind, radius) =
            filter.map_or(("box", None), |filter| (text(filter, "type").unwrap_or("box"), number(filter, "radius")));
        let filter = match kind {
            "box" => {
                if radius.is_some_and(|radius| radius != 0.5) {
                    self.approximate("box filter of another radius", "film.filter", "it is a pixel wide");
                }
                Element::new("rfilter", "box")
            }
            "tent" => Element::new("rfilter", "tent").float("radius", radius.unwrap_or(1.0)),
            other => {
                if other != "gaussian" {
                    self.approximate("filter blackman_harris", "film.filter", "a gaussian is taken");
                }
                Element::new("rfilter", "gaussian").float("stddev", radius.unwrap_or(1.5) / 3.0)
            }
        };
        let film = Element::new("film", "hdrfilm")
            .integer("width", size[0] as i64)
            .integer("height", size[1] as i64)
            .string("pixel_format", "rgb")
            .with(filter);
        let spp = table(self.scene, "render").and_then(|render| integer(render, "spp")).unwrap_or(256);
        let sampler = Element::new("sampler", "independent").integer("sample_count", spp);
        let Some(camera) = table(self.scene, "camera").map(Keys::of) else { return };
        let camera = &camera;
        let position = vector(camera, "position").unwrap_or(DVec3::Z);
        let look_at = vector(camera, "look_at").unwrap_or(DVec3::ZERO);
        let up = vector(camera, "up").unwrap_or(DVec3::Y);
        let stretch = number(camera, "stretch").unwrap_or(1.0);
        let place = xml::look_at(position, look_at, up);
        let mut sensor = match (text(camera, "projection"), number(camera, "height")) {
            (Some("orthographic"), Some(height)) => {
                let scale = height / 2.0 * size[0] / size[1];
                let across = scale * stretch;
                // +X is to the left there.
                let beside = numbers(camera, "shift").filter(|shift| shift.len() == 2).map_or(String::new(), |shift| {
                    format!("<translate x=\"{}\" y=\"{}\"/>", -2.0 * across * shift[0], height * shift[1])
                });
                Element::new("sensor", "orthographic")
                    .transform("to_world", &format!("<scale x=\"{across}\" y=\"{scale}\"/>{beside}{place}"))
            }
            _ => {
                let aperture =
                    table(camera, "aperture").filter(|aperture| number(*aperture, "radius").is_some_and(|radius| radius > 0.0));
                let kind = if aperture.is_some() { "thinlens" } else { "perspective" };
                if stretch.abs() != 1.0 {
                    self.drop("stretch", "camera", "the picture is as wide as its pixels say");
                }
                let mirror = if stretch < 0.0 { "<scale x=\"-1\"/>" } else { "" };
                let mut sensor = Element::new("sensor", kind)
                    .string("fov_axis", "y")
                    .float("fov", number(camera, "vfov").unwrap_or(40.0))
                    .transform("to_world", &format!("{mirror}{place}"));
                if kind == "perspective"
                    && let Some([right, above]) = numbers(camera, "shift").as_deref()
                {
                    sensor = sensor.float("principal_point_offset_x", *right).float("principal_point_offset_y", -above);
                }
                if let Some(aperture) = aperture {
                    if text(aperture, "shape").is_some_and(|shape| shape != "disk") {
                        self.approximate("aperture that is no disk", "camera.aperture", "a disk of the same radius is taken");
                    }
                    sensor = sensor.float("aperture_radius", number(aperture, "radius").unwrap_or(0.0));
                    sensor = sensor.float("focus_distance", number(camera, "focus_distance").unwrap_or(1.0));
                }
                sensor
            }
        };
        // Planes that cut the view off lie from 0.01 to 10,000 there unless they are written: very small and very large scenes need others.
        let distance = (look_at - position).length();
        if !(0.1..=1e3).contains(&distance) {
            sensor = sensor.float("near_clip", 1e-2 * distance).float("far_clip", 1e4 * distance);
        }
        sensor = sensor.with(sampler).with(film);
        if let Some(medium) = self.medium_around_camera() {
            sensor = sensor.reference(&medium);
        }
        // Without motion the shutter has no effect; moving objects are reported by themselves.
        let _ = (
            camera.contains_key("shutter"),
            camera.contains_key("rolling_shutter"),
            camera.contains_key("focus_distance"),
            camera.contains_key("aperture"),
        );
        let _ = camera.contains_key("medium");
        self.drop_rest(camera, "camera");
        self.xml.push(sensor);
    }

    /// Writes a light; returns false where Mitsuba has no such light.
    fn light(&mut self, light: &Keys<'_>, original: &Light, place: &str) -> Result<bool, SceneError> {
        let intensity = self.intensity(light, original, place);
        let emitter = match text(light, "type").unwrap_or_default() {
            "point" => Element::new("emitter", "point")
                .point("position", vector(light, "position").unwrap_or_default())
                .rgb("intensity", intensity),
            "spot" => {
                let (position, direction) =
                    (vector(light, "position").unwrap_or_default(), vector(light, "direction").unwrap_or(DVec3::Z));
                let angle = number(light, "angle").unwrap_or(90.0);
                let falloff = number(light, "falloff").unwrap_or(angle);
                if falloff < angle && text(light, "curve") != Some("linear") {
                    self.approximate("falloff of a spot light", place, "it is straight in the angle, not smooth in its cosine");
                }
                let _ = light.contains_key("curve");
                let aim = match vector(light, "up") {
                    Some(up) => xml::look_at(position, position + direction, up),
                    None => xml::look_along(position, direction),
                };
                let emitter = Element::new("emitter", "spot")
                    .transform("to_world", &aim)
                    .float("cutoff_angle", angle)
                    .float("beam_width", falloff)
                    .rgb("intensity", intensity);
                match text(light, "texture") {
                    // Its picture stands mirrored there.
                    Some(name) => {
                        let mirror = "<scale x=\"-1\"/><translate x=\"1\"/>";
                        emitter.with(self.texture_behind(name, "texture", false, mirror, None)?)
                    }
                    None => emitter,
                }
            }
            "projector" => self.projector(light, place)?,
            "directional" => Element::new("emitter", "directional")
                .vector("direction", vector(light, "direction").unwrap_or(DVec3::NEG_Y))
                .rgb("irradiance", colour(light, "irradiance")),
            "environment" => self.environment(light, place)?,
            other => {
                self.drop(&format!("light `{other}`"), place, "it gives no light");
                return Ok(false);
            }
        };
        self.xml.push(emitter);
        Ok(true)
    }

    /// The intensity of a point or spot light. Mitsuba has no profiles: without its own, a light is as strong.
    fn intensity(&mut self, light: &Keys<'_>, original: &Light, place: &str) -> Spectrum {
        let plain = match original {
            Light::Point(point) if point.profile.is_some() => point.mean_intensity(),
            Light::Spot(spot) if spot.profile.is_some() => spot.without_profile().intensity,
            _ => return colour(light, "intensity"),
        };
        let _ = ["intensity", "profile", "front"].map(|key| light.contains_key(key));
        if matches!(original, Light::Point(_)) {
            let _ = light.contains_key("direction");
        }
        self.approximate("profile of a light", place, "it is as strong without it");
        plain
    }

    /// The radiance that it throws is 1/π of the irradiance.
    fn projector(&mut self, light: &Keys<'_>, place: &str) -> Result<Element, SceneError> {
        let (position, direction) =
            (vector(light, "position").unwrap_or_default(), vector(light, "direction").unwrap_or(DVec3::Z));
        let up = vector(light, "up").unwrap_or(DVec3::Y);
        let strength = colour(light, "irradiance") / std::f64::consts::PI;
        let emitter = Element::new("emitter", "projector")
            .transform("to_world", &xml::look_at(position, position + direction, up))
            .string("fov_axis", "y")
            .float("fov", number(light, "vfov").unwrap_or(40.0));
        let aspect = number(light, "aspect");
        let Some(name) = text(light, "texture") else {
            if aspect.is_some_and(|aspect| aspect != 1.0) {
                self.drop("aspect", place, "what is projected is a square");
            }
            return Ok(emitter.rgb("irradiance", strength));
        };
        // The picture's own.
        let _ = aspect;
        if strength.min_component() != strength.max_component() {
            self.approximate("colour of a projector with a texture", place, "its mean multiplies the texture");
        }
        let upside_down = "<scale y=\"-1\"/><translate y=\"1\"/>";
        let texture = self.texture_behind(name, "irradiance", false, upside_down, None)?;
        Ok(emitter.float("scale", strength.mean()).with(texture))
    }

    fn environment(&mut self, light: &Keys<'_>, place: &str) -> Result<Element, SceneError> {
        let scale = number(light, "scale").unwrap_or(1.0);
        let Some(file) = text(light, "file") else {
            return Ok(
                Element::new("emitter", "constant").rgb("radiance", colour(light, "radiance").map(|channel| channel * scale))
            );
        };
        if text(light, "rows") != Some("to_poles") {
            self.approximate("rows of an environment map", place, "they stand half a row nearer to the poles");
        }
        let degrees = number(light, "rotate").unwrap_or(0.0);
        let mirror = if flag(light, "mirror") == Some(true) { "<scale x=\"-1\"/>" } else { "" };
        let turn = light.get("transform").map_or(String::new(), |written| matrix(&transform(written)));
        let file = self.file(file);
        Ok(Element::new("emitter", "envmap")
            .string("filename", &file)
            .float("scale", scale)
            .transform("to_world", &format!("{mirror}<rotate y=\"1\" angle=\"{degrees}\"/>{turn}")))
    }

    /// The name of a file as the scene of Mitsuba has it: absolute, or of one that is written beside it.
    fn file(&self, written: &str) -> String {
        let path = self.files.folder().join(written);
        let is_there = path.is_file() && !self.files.contains(&path);
        let name = if is_there {
            let whole = std::fs::canonicalize(&path).unwrap_or(path);
            // Files below the scene's own folder move with it.
            whole.strip_prefix(self.files.folder()).map(PathBuf::from).unwrap_or(whole)
        } else {
            PathBuf::from(written)
        };
        name.to_string_lossy().replace('\\', "/")
    }
}
