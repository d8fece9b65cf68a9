//! Scene files that are right, and what becomes of them.

use std::path::Path;

use gpt::scene::{self, Scene};

fn read(text: &str) -> Scene {
    scene::load_toml_str(text, "test.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_built_in_scene_loads_without_warnings() {
    for name in scene::builtin_names() {
        let scene = scene::load(Some(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.name, name);
        assert_eq!(scene.warnings, Vec::<String>::new());
        assert!(!scene.shapes.is_empty());
    }
    assert_eq!(scene::load(None).unwrap_or_else(|error| panic!("{error}")).name, "cornell");
}
