//! The camera as the page moves it: it is held beside the text, until it is asked to be kept in the file.

use gpt::scene::{Camera, Projection, Scene};
use serde::{Deserialize, Serialize};
use serde_json::{Value as Json, json};
use toml_edit::{DocumentMut, Item, Table, TableLike};

use super::changes::Refused;
use super::values::set_key;

/// Sine of the least angle between the viewing direction and the upward direction.
const LEAST_SINE: f64 = 1e-3;

/// A place of the camera and what it looks at, in scene units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Look {
    position: [f64; 3],
    look_at: [f64; 3],
    up: [f64; 3],
}

impl Look {
    fn of(camera: &Camera) -> Self {
        Self { position: camera.position.into(), look_at: camera.look_at.into(), up: camera.up.into() }
    }

    /// The camera here; None where that is no place for one.
    fn applied(self, camera: &Camera) -> Option<Camera> {
        let mut moved = camera.clone();
        (moved.position, moved.look_at, moved.up) = (self.position.into(), self.look_at.into(), self.up.into());
        let towards = moved.look_at - moved.position;
        let sine = towards.normalize_or_zero().cross(moved.up.normalize_or_zero()).length();
        (towards.is_finite() && sine > LEAST_SINE).then_some(moved)
    }

    fn keys(self) -> [(&'static str, Json); 3] {
        [("position", json!(self.position)), ("look_at", json!(self.look_at)), ("up", json!(self.up))]
    }
}

/// The camera of the scene that is rendered, and where the page moved it.
#[derive(Debug, Clone, Default)]
pub struct Looking {
    /// None before the first scene was read.
    seen: Option<Seen>,
    moved: Option<Look>,
}

#[derive(Debug, Clone)]
struct Seen {
    of_file: Look,
    /// Degrees, of a camera that has a vertical field of view.
    vertical_fov: Option<f64>,
    /// Why it cannot be moved.
    fixed: Option<&'static str>,
}

/// The camera as the page gets it.
#[derive(Serialize)]
pub struct CameraModel {
    look: Look,
    is_moved: bool,
    vertical_fov: Option<f64>,
    fixed: Option<&'static str>,
}

impl Looking {
    /// Moves the camera, or with None back to where the file has it.
    ///
    /// # Errors
    /// A place that no camera can have, and a camera that cannot be moved.
    pub fn turn(&mut self, to: Option<Look>) -> Result<(), Refused> {
        if self.seen.as_ref().is_some_and(|seen| seen.fixed.is_some()) {
            return Err(Refused("the camera of this scene cannot be moved here"));
        }
        if to.is_some_and(|look| look.applied(&Camera::default()).is_none()) {
            return Err(Refused("a camera cannot stand there"));
        }
        self.moved = to.filter(|look| self.seen.as_ref().is_none_or(|seen| seen.of_file != *look));
        Ok(())
    }

    /// Notes the camera of a scene as it was read, and puts it where the page moved it.
    pub fn apply(&mut self, scene: &mut Scene) {
        let fixed = if scene.animation.camera.is_some() {
            Some("The camera has keyframes, which say where it is.")
        } else if !scene.exposure.is_empty() {
            Some("The camera moves while its shutter is open.")
        } else {
            None
        };
        let vertical_fov = match scene.camera.projection {
            Projection::Perspective { vertical_fov_degrees } => Some(vertical_fov_degrees),
            _ => None,
        };
        self.seen = Some(Seen { of_file: Look::of(&scene.camera), vertical_fov, fixed });
        if let Some(moved) = self.moved.filter(|_| fixed.is_none()).and_then(|look| look.applied(&scene.camera)) {
            scene.camera = moved;
        }
    }

    /// The text has the camera where the page moved it.
    pub fn is_kept(&mut self) {
        if let (Some(look), Some(seen)) = (self.moved.take(), &mut self.seen) {
            seen.of_file = look;
        }
    }

    /// The camera for the page; None before the first scene was read.
    pub fn model(&self) -> Option<CameraModel> {
        let seen = self.seen.as_ref()?;
        let look = self.moved.unwrap_or(seen.of_file);
        Some(CameraModel { look, is_moved: self.moved.is_some(), vertical_fov: seen.vertical_fov, fixed: seen.fixed })
    }

    /// Writes the moved camera into the document, whose other keys and comments stay. A file without a camera gets one.
    ///
    /// # Errors
    /// A camera that nobody moved.
    pub fn keep(&self, document: &mut DocumentMut) -> Result<(), Refused> {
        let (Some(look), Some(seen)) = (self.moved, &self.seen) else { return Err(Refused("the camera was not moved")) };
        let is_new = document.get("camera").is_none();
        if is_new {
            document.insert("camera", Item::Table(Table::new()));
        }
        let camera: &mut dyn TableLike = document.get_mut("camera").and_then(Item::as_table_like_mut).ok_or(NO_TABLE)?;
        for (key, value) in look.keys() {
            let is_as_before = key == "up" && look.up == seen.of_file.up && !is_new;
            if !is_as_before {
                set_key(camera, key, &value).ok_or(NO_TABLE)?;
            }
        }
        if let Some(fov) = seen.vertical_fov.filter(|_| is_new) {
            set_key(camera, "vfov", &json!(fov)).ok_or(NO_TABLE)?;
        }
        Ok(())
    }
}

const NO_TABLE: Refused = Refused("`camera` of this file is no table");

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        "# A room.\n[camera] # seen from the door\nposition = [0.0, 0, 4] # metres\nlook_at = [0, 0, 0]\nvfov = 40\n";

    fn looking() -> Looking {
        let mut scene = Scene::default();
        scene.camera.position = glam::DVec3::new(0.0, 0.0, 4.0);
        let mut looking = Looking::default();
        looking.apply(&mut scene);
        looking
    }

    fn at(position: [f64; 3]) -> Option<Look> {
        Some(Look { position, look_at: [0.0; 3], up: [0.0, 1.0, 0.0] })
    }

    #[test]
    fn a_moved_camera_renders_and_is_kept_in_place() {
        let mut looking = looking();
        let mut document: DocumentMut = TEXT.parse().expect("TOML");
        assert!(looking.keep(&mut document).is_err(), "nobody moved it");
        looking.turn(at([1.0, 2.0, 3.5])).expect("a place for a camera");
        let mut scene = Scene::default();
        looking.apply(&mut scene);
        assert_eq!(scene.camera.position, glam::DVec3::new(1.0, 2.0, 3.5));
        looking.keep(&mut document).expect("it was moved");
        assert_eq!(document.to_string(), TEXT.replace("[0.0, 0, 4]", "[1.0, 2.0, 3.5]"));
        looking.is_kept();
        // The next move begins there, though the text was not read again yet.
        assert!(looking.model().is_some_and(|model| !model.is_moved && model.look.position == [1.0, 2.0, 3.5]));
        assert!(looking.keep(&mut document).is_err());
    }

    #[test]
    fn a_file_without_a_camera_gets_one() {
        let mut looking = looking();
        looking.turn(at([1.0, 0.0, 0.0])).expect("a place for a camera");
        let mut document: DocumentMut = "[film]\nsize = [8, 8]\n".parse().expect("TOML");
        looking.keep(&mut document).expect("it was moved");
        assert!(document["camera"]["vfov"].as_float() == Some(40.0) && document["camera"].get("up").is_some(), "{document}");
    }

    #[test]
    fn places_without_a_view_are_refused_and_cameras_that_move_stay() {
        let mut looking = looking();
        for position in [[0.0; 3], [0.0, 5.0, 0.0], [f64::NAN, 0.0, 1.0]] {
            assert!(looking.turn(at(position)).is_err(), "{position:?}");
        }
        let mut moving = Scene::default();
        moving.exposure = vec![moving.camera.clone()];
        looking.apply(&mut moving);
        assert!(looking.turn(at([1.0, 0.0, 0.0])).is_err());
        assert!(looking.model().is_some_and(|model| model.fixed.is_some()));
    }
}
