//! A scene file of ours as a scene of Mitsuba 3, as far as it can be said there.
//!
//! The scene file has been read and found right before: a key that is missing here is one that may be left out.

mod material;
mod shape;
mod xml;

use std::path::{Path, PathBuf};

use glam::DVec3;
use toml::{Table, Value};

use self::xml::{Element, Xml};
use crate::load::error::SceneError;
use crate::load::files::{Files, MOST_MODEL_BYTES};
use crate::scene::ImportReport;

/// A scene of Mitsuba, and the files that it names beside those on disk.
#[derive(Debug)]
pub struct WrittenMitsuba {
    /// XML
    pub text: String,
    /// Names of files beside the scene's own, with their contents.
    pub files: Vec<(String, Vec<u8>)>,
    /// What is not exact.
    pub report: ImportReport,
}

/// The scene whose text this is. `beside` is the folder of the files that are written, relative to the scene of Mitsuba.
///
/// # Errors
/// A text that is no scene file, and files that cannot be read.
pub fn write(text: &str, name: &str, folder: &Path, files: &Files, beside: &str) -> Result<WrittenMitsuba, SceneError> {
    let scene: Table = text.parse().map_err(|error: toml::de::Error| SceneError::in_file(name, error.message().to_owned()))?;
    let mut writer = Writer {
        name,
        scene: &scene,
        folder,
        files,
        beside,
        xml: Xml::default(),
        written: Vec::new(),
        report: ImportReport::default(),
    };
    writer.all()?;
    Ok(WrittenMitsuba { text: writer.xml.finish(), files: writer.written, report: writer.report })
}

struct Writer<'w> {
    name: &'w str,
    scene: &'w Table,
    folder: &'w Path,
    files: &'w Files,
    beside: &'w str,
    xml: Xml,
    written: Vec<(String, Vec<u8>)>,
    report: ImportReport,
}

impl Writer<'_> {
    fn all(&mut self) -> Result<(), SceneError> {
        self.integrator();
        self.sensor();
        for material in entries(self.scene, "material") {
            self.material(material)?;
        }
        for (index, shape) in entries(self.scene, "shape").iter().enumerate() {
            self.shape(index, shape)?;
        }
        for (index, group) in entries(self.scene, "group").into_iter().enumerate() {
            self.group(index, group)?;
        }
        for (index, instances) in entries(self.scene, "instance").into_iter().enumerate() {
            self.instances(index, instances)?;
        }
        for (index, light) in entries(self.scene, "light").iter().enumerate() {
            self.light(index, light)?;
        }
        if self.scene.contains_key("import") {
            self.drop("import", "[[import]]", "`gpt import` writes a scene file of it that can be exported");
        }
        Ok(())
    }

    fn drop(&mut self, what: &str, place: &str, instead: &str) {
        self.report.drop(what, format!("{}: {place}", self.name), instead);
    }

    fn approximate(&mut self, what: &str, place: &str, instead: &str) {
        self.report.approximate(what, format!("{}: {place}", self.name), instead);
    }

    fn integrator(&mut self) {
        let render = table(self.scene, "render");
        let depth = render.and_then(|render| integer(render, "max_depth")).unwrap_or(16);
        let roulette = render.and_then(|render| integer(render, "roulette_depth")).unwrap_or(5);
        let integrator = Element::new("integrator", "path")
            .integer("max_depth", if depth == 0 { -1 } else { depth })
            .integer("rr_depth", if roulette == 0 { 1_000_000 } else { roulette });
        self.xml.push(integrator);
    }

    fn sensor(&mut self) {
        if table(self.scene, "camera").is_some_and(|camera| camera.contains_key("keyframes") || camera.contains_key("node")) {
            self.drop("keyframes", "camera", "the camera stands where it is without a frame");
        }
        let film = table(self.scene, "film");
        let size = film.and_then(|film| numbers(film, "size")).unwrap_or(vec![512.0, 512.0]);
        let filter = film.and_then(|film| table(film, "filter"));
        let (kind, radius) =
            filter.map_or(("box", None), |filter| (text(filter, "type").unwrap_or("box"), number(filter, "radius")));
        let filter = match kind {
            "box" => Element::new("rfilter", "box").float("radius", radius.unwrap_or(0.5)),
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
        let Some(camera) = table(self.scene, "camera") else { return };
        let position = vector(camera, "position").unwrap_or(DVec3::Z);
        let look_at = vector(camera, "look_at").unwrap_or(DVec3::ZERO);
        let up = vector(camera, "up").unwrap_or(DVec3::Y);
        let place = format!(
            "<lookat origin=\"{}\" target=\"{}\" up=\"{}\"/>",
            xml::triple(position),
            xml::triple(look_at),
            xml::triple(up)
        );
        let mut sensor = match (text(camera, "projection"), number(camera, "height")) {
            (Some("orthographic"), Some(height)) => {
                let scale = height / 2.0 * size[0] / size[1];
                Element::new("sensor", "orthographic")
                    .transform("to_world", &format!("<scale x=\"{scale}\" y=\"{scale}\"/>{place}"))
            }
            _ => {
                let aperture =
                    table(camera, "aperture").filter(|aperture| number(aperture, "radius").is_some_and(|radius| radius > 0.0));
                let kind = if aperture.is_some() { "thinlens" } else { "perspective" };
                let mut sensor = Element::new("sensor", kind)
                    .string("fov_axis", "y")
                    .float("fov", number(camera, "vfov").unwrap_or(40.0))
                    .transform("to_world", &place);
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
        sensor = sensor.with(sampler).with(film);
        self.xml.push(sensor);
    }

    fn light(&mut self, index: usize, light: &Table) -> Result<(), SceneError> {
        let place = format!("light[{index}]");
        let emitter = match text(light, "type").unwrap_or_default() {
            "point" => Element::new("emitter", "point")
                .point("position", vector(light, "position").unwrap_or_default())
                .rgb("intensity", colour(light, "intensity")),
            "spot" => {
                let (position, direction) =
                    (vector(light, "position").unwrap_or_default(), vector(light, "direction").unwrap_or(DVec3::Z));
                let angle = number(light, "angle").unwrap_or(90.0);
                let falloff = number(light, "falloff").unwrap_or(angle);
                if falloff < angle {
                    self.approximate("falloff of a spot light", &place, "it is straight in the angle, not smooth in its cosine");
                }
                Element::new("emitter", "spot")
                    .transform("to_world", &xml::look_along(position, direction))
                    .float("cutoff_angle", angle)
                    .float("beam_width", falloff)
                    .rgb("intensity", colour(light, "intensity"))
            }
            "directional" => Element::new("emitter", "directional")
                .vector("direction", vector(light, "direction").unwrap_or(DVec3::NEG_Y))
                .rgb("irradiance", colour(light, "irradiance")),
            "environment" => self.environment(light, &place)?,
            other => {
                self.drop(&format!("light `{other}`"), &place, "it gives no light");
                return Ok(());
            }
        };
        self.xml.push(emitter);
        Ok(())
    }

    fn environment(&mut self, light: &Table, place: &str) -> Result<Element, SceneError> {
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
        let file = self.file(file)?;
        Ok(Element::new("emitter", "envmap")
            .string("filename", &file)
            .float("scale", scale)
            .transform("to_world", &format!("<rotate y=\"1\" angle=\"{degrees}\"/>")))
    }

    /// The name of a file as the scene of Mitsuba has it: absolute, or beside it where it lies in no file.
    fn file(&mut self, written: &str) -> Result<String, SceneError> {
        let path = self.folder.join(written);
        let is_embedded = !path.is_file();
        if !is_embedded {
            let real = std::fs::canonicalize(&path).unwrap_or(path);
            return Ok(real.to_string_lossy().replace('\\', "/"));
        }
        let bytes = self.files.read(&path, MOST_MODEL_BYTES);
        let bytes = bytes.map_err(|error| SceneError::in_file(self.name, format!("{written}: cannot be read: {error}")))?;
        let name =
            PathBuf::from(written).file_name().map_or_else(|| "file".to_owned(), |name| name.to_string_lossy().into_owned());
        Ok(self.beside_file(&name, bytes.into_owned()))
    }

    /// Keeps a file that is written beside the scene; how the scene names it.
    fn beside_file(&mut self, name: &str, bytes: Vec<u8>) -> String {
        if !self.written.iter().any(|(known, _)| known == name) {
            self.written.push((name.to_owned(), bytes));
        }
        format!("{}/{name}", self.beside)
    }
}

/// The tables of a list.
fn entries<'t>(scene: &'t Table, key: &str) -> Vec<&'t Table> {
    let list = scene.get(key).and_then(Value::as_array);
    list.map(|list| list.iter().filter_map(Value::as_table).collect()).unwrap_or_default()
}

fn table<'t>(table: &'t Table, key: &str) -> Option<&'t Table> {
    table.get(key)?.as_table()
}

fn text<'t>(table: &'t Table, key: &str) -> Option<&'t str> {
    table.get(key)?.as_str()
}

fn flag(table: &Table, key: &str) -> Option<bool> {
    table.get(key)?.as_bool()
}

fn integer(table: &Table, key: &str) -> Option<i64> {
    table.get(key)?.as_integer()
}

fn as_number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|number| number as f64))
}

fn number(table: &Table, key: &str) -> Option<f64> {
    as_number(table.get(key)?)
}

fn numbers(table: &Table, key: &str) -> Option<Vec<f64>> {
    table.get(key)?.as_array()?.iter().map(as_number).collect()
}

fn vector(table: &Table, key: &str) -> Option<DVec3> {
    let numbers: [f64; 3] = numbers(table, key)?.try_into().ok()?;
    Some(DVec3::from_array(numbers))
}

/// Three numbers or one for grey; black where nothing is written.
fn colour(table: &Table, key: &str) -> DVec3 {
    vector(table, key).or(number(table, key).map(DVec3::splat)).unwrap_or_default()
}
