//! Lights as the examples of the scene format have them, for tests.

use std::path::Path;

use crate::load::file::light_examples;
use crate::load::load_toml_str;
use crate::scene::Light;

/// By its type, every example of a light to which one direction leads from each point.
pub fn delta_light_examples() -> Vec<(&'static str, Light)> {
    let load = |(name, light)| {
        let text = format!("camera = {{ position = [0, 0, 1], look_at = [0, 0, 0], vfov = 40 }}\n{light}");
        // The file that an environment names is not there.
        let scene = load_toml_str(&text, "example", Path::new("no-folder")).ok()?;
        Some((name, scene.lights.into_iter().find(|light| light.delta().is_some())?))
    };
    light_examples().filter_map(load).collect()
}
