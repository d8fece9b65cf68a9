//! The checked-in files that are made from the program itself: the JSON Schema of scene files and the pages on scene files and the command
//! line. These tests fail where one is out of date, and [`REMAKE`] makes all of them again.

mod command_line;
mod scene_files;

use std::path::Path;

/// The command that writes the files anew.
const REMAKE: &str = "GPT_BLESS=1 cargo test --bin gpt reference_pages";

#[test]
fn the_schema_is_current() {
    is_current("scenes/scene.schema.json", &gpt::load::make_json_schema());
}

#[test]
fn the_page_on_scene_files_is_current() {
    let schema = serde_json::from_str(&gpt::load::make_json_schema()).expect("the schema is JSON");
    is_current("docs/scene-format.md", &scene_files::page(&schema, REMAKE));
}

#[test]
fn the_page_on_the_command_line_is_current() {
    is_current("docs/cli.md", &command_line::page(REMAKE));
}

#[test]
fn the_pages_example_is_a_scene() {
    let scene = gpt::load::load_toml_str(scene_files::EXAMPLE, "example.toml", Path::new("")).expect("the example");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

/// Compares a file of the repository with what it should hold, or writes it where `GPT_BLESS` is set.
fn is_current(file: &str, made: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    if std::env::var_os("GPT_BLESS").is_some() {
        std::fs::write(&path, made).expect("the file can be written");
    }
    let checked_in = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(checked_in == made, "{file} is out of date: {REMAKE}");
}
