//! Scenes that are wrong: each is one error that names the file, the line, the key and what would be right.

mod camera;
mod geometry;
mod keys;
mod numbers;
mod several;
mod textures;

use std::sync::LazyLock;

use crate::common::sphere::grey_sphere;
use gpt::load;
use gpt::load::SceneError;

/// A scene that is right, to put mistakes into.
static GOOD: LazyLock<String> =
    LazyLock::new(|| grey_sphere("[film]\nsize = [4, 4]\n[render]\nspp = 1", "type = \"environment\"\nradiance = 1"));

fn error_of(text: &str) -> SceneError {
    match load::load_toml_str(text, "test.toml", std::path::Path::new("")) {
        Ok(_) => panic!("no complaint about\n{text}"),
        Err(error) => error,
    }
}

/// The error's text and help, for the good scene with one piece of text replaced.
fn complaint(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from} is not in the good scene");
    show(&error_of(&GOOD.replacen(from, to, 1)))
}

fn show(error: &SceneError) -> String {
    match error.help_text() {
        Some(help) => format!("{error} [{help}]"),
        None => error.to_string(),
    }
}

/// Each row: what is replaced by what in the good scene, and the complaint.
fn check(rows: &[(&str, &str, &str)]) {
    let complaints: Vec<String> = rows.iter().map(|(from, to, _)| complaint(from, to)).collect();
    let expected: Vec<&str> = rows.iter().map(|(_, _, expected)| *expected).collect();
    let different = complaints.iter().zip(&expected).filter(|(found, expected)| found != *expected);
    let report: Vec<String> = different.map(|(found, expected)| format!("found    {found}\nexpected {expected}")).collect();
    assert!(report.is_empty(), "\n{}", report.join("\n"));
}

#[test]
fn the_good_scene_is_good() {
    assert!(load::load_toml_str(&GOOD, "test.toml", std::path::Path::new("")).is_ok());
}

#[test]
fn blends_that_contain_themselves_are_refused() {
    let text = GOOD.replace(
        "type = \"diffuse\"\nreflectance = 0.5",
        "type = \"blend\"\nmaterials = [\"grey\", \"grey\"]\nweight = { type = \"constant\", value = 0.5 }",
    );
    assert!(error_of(&text).message().contains("the blend `grey` contains itself"));
}

#[test]
fn a_scene_without_light_is_refused() {
    let dark = GOOD.split("[[light]]").next().unwrap_or_default();
    let error = error_of(dark);
    assert_eq!(error.to_string(), "test.toml: nothing in the scene gives light, so the picture would be black");
    assert!(error.help_text().is_some_and(|help| help.contains("[[light]]") && help.contains("emissive")));
    // An emissive material that no shape uses lights nothing.
    let unused = format!("{dark}[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 1\n");
    assert_eq!(error_of(&unused).to_string(), error.to_string());
    assert!(load::load_toml_str(&unused.replace("material = \"grey\"", "material = \"lamp\""), "test.toml", "".as_ref()).is_ok());
}

#[test]
fn the_error_holds_the_text_and_the_place_in_it() {
    let text = GOOD.replace("radius = 1", "radius = -1");
    let error = error_of(&text);
    assert_eq!((error.file(), error.line(), error.column()), ("test.toml", Some(17), Some(10)));
    let excerpt = error.excerpt().expect("the mistake is in the text");
    let line = excerpt.text.lines().nth(17 - excerpt.first_line).expect("it is among the lines");
    assert_eq!((line, &excerpt.text[excerpt.span.clone()]), ("radius = -1", "-1"));
}

#[test]
fn sources_that_are_not_there_are_named() {
    let complaint = |name: &str| load::load(Some(name)).map(|_| ()).map_err(|error| show(&error)).unwrap_err();
    assert!(complaint("absent.toml").starts_with("absent.toml: cannot be read: No such file"));
    assert!(complaint("absent.obj").starts_with("absent.obj: cannot be read: No such file"));
    let misspelt = complaint("cornel");
    assert!(
        misspelt.contains("cornel: is no built-in scene [did you mean `cornell`? valid choices: cornell, spheres"),
        "{misspelt}"
    );
    assert!(complaint("Cargo.lock").contains("is neither a scene file nor a model"));
}

#[test]
fn deep_nesting_is_an_error_not_a_stack_overflow() {
    let weight = format!("weight{} = 1", ".of".repeat(200_000));
    let text = GOOD.replace("reflectance = 0.5", &weight);
    assert!(load::load_toml_str(&text, "test.toml", "".as_ref()).is_err());
    let inline = format!("weight = {}1{}", "{ of = ".repeat(100_000), " }".repeat(100_000));
    assert!(load::load_toml_str(&GOOD.replace("reflectance = 0.5", &inline), "test.toml", "".as_ref()).is_err());
}
