//! Light links: how scene files say them, what is refused, and what is left of them in other files. `tests/gpu/estimators` holds what they mean.

use std::path::Path;

use gpt::cpu::ReferenceRenderer;
use gpt::load::{self, SceneError};
use gpt::scene::Scene;
use gpt::scene_writer::{self, ExportFormat};

const GOOD: &str = r#"
[camera]
position = [0, 1, 6]
look_at = [0, 1, 0]
vfov = 40
[film]
size = [24, 16]
[[medium]]
name = "fog"
scattering = 0.1
receiver = "air"
[[material]]
name = "clay"
type = "diffuse"
reflectance = 0.6
[[material]]
name = "smoke"
type = "pass"
interior = "fog"
[[material]]
name = "lamp"
type = "emissive"
radiance = 8
lights_only = ["hero", "air"]
[[shape]]
type = "rectangle"
corner = [-3, 0, 3]
edge_u = [6, 0, 0]
edge_v = [0, 0, -6]
material = "clay"
[[shape]]
type = "sphere"
center = [0, 0.7, 0]
radius = 0.7
material = "clay"
receiver = "hero"
[[shape]]
type = "sphere"
center = [1.5, 0.7, 0]
radius = 0.6
material = "smoke"
[[shape]]
type = "sphere"
center = [0.5, 3, 1]
radius = 0.4
material = "lamp"
[[group]]
name = "leaf"
[[group.shape]]
type = "mesh"
positions = [[-2, 0, 0], [-1, 0, 0], [-1.5, 1, 0]]
faces = [[0, 1, 2]]
material = "clay"
[[instance]]
group = "leaf"
receiver = "leaves"
[[light]]
type = "point"
position = [0, 4, 2]
intensity = 9
lights_all_but = ["hero", "rest"]
[[light]]
type = "environment"
radiance = 0.2
lights_only = ["rest"]
"#;

fn read(text: &str) -> Result<Scene, SceneError> {
    load::load_toml_str(text, "test.toml", Path::new(""))
}

fn pixels(scene: &Scene) -> Vec<[f64; 3]> {
    let renderer = ReferenceRenderer::new(scene).expect("the scene is supported");
    (0..24 * 16).flat_map(|pixel| [0, 1].map(|sample| renderer.radiance_of_sample(pixel % 24, pixel / 24, sample))).collect()
}

#[test]
fn links_go_through_a_scene_file() {
    let scene = read(GOOD).expect("a scene");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("again.toml");
    scene_writer::save_scene(&scene, &path).expect("it is written");
    let again = load::load(Some(&path.to_string_lossy())).expect("it is a scene");
    assert_eq!(pixels(&scene), pixels(&again));
    // The control: each of the links decides about some pixel.
    for link in GOOD.lines().filter(|line| line.starts_with("lights_") || line.starts_with("receiver")) {
        let without = GOOD.replace(link, "");
        let names = ["hero", "air", "leaves"].into_iter().find(|name| link == format!("receiver = \"{name}\""));
        // Lamps that name what nothing is would be refused.
        let without = names.map_or(without.clone(), |name| {
            let listed = without.replace(&format!(", \"{name}\""), "").replace(&format!("\"{name}\", "), "");
            listed.replace(&format!("[\"{name}\"]"), "[]")
        });
        let other = read(&without).unwrap_or_else(|error| panic!("{link}: {error}"));
        assert!(pixels(&other) != pixels(&scene), "{link}");
    }
}

/// Scenes whose lamps light everything are the scenes that they were, whatever receivers objects name.
#[test]
fn receivers_alone_change_nothing() {
    let unlinked: String = GOOD.lines().filter(|line| !line.starts_with("lights_")).map(|line| line.to_owned() + "\n").collect();
    let plain: String =
        unlinked.lines().filter(|line| !line.starts_with("receiver")).map(|line| line.to_owned() + "\n").collect();
    let [unlinked, plain] = [unlinked, plain].map(|text| read(&text).expect("a scene"));
    assert_eq!(pixels(&unlinked), pixels(&plain));
    assert!(gpt::packed::PackedScene::new(&unlinked).expect("it packs").links.is_empty());
    assert!(!gpt::packed::PackedScene::new(&read(GOOD).expect("a scene")).expect("it packs").links.is_empty(), "the control");
}

#[test]
fn shapes_of_an_import_are_receivers_together() {
    let folder = tempfile::tempdir().expect("a folder");
    let inner = "<scene version=\"3.0.0\"><shape type=\"sphere\"><bsdf type=\"diffuse\"/></shape></scene>";
    std::fs::write(folder.path().join("inner.xml"), inner).expect("it is written");
    let text = format!("{GOOD}[[import]]\nfile = \"inner.xml\"\nreceiver = \"leaves\"\n");
    let scene = load::load_toml_str(&text, "test.toml", folder.path()).expect("a scene");
    let names: Vec<&str> = scene.shapes.iter().map(|shape| scene.light_links.name(shape.receiver)).collect();
    assert_eq!(names.iter().filter(|name| **name == "leaves").count(), 1, "{names:?}");
    assert!(names.contains(&"hero") && names.contains(&"rest"), "{names:?}");
}

#[test]
fn links_that_cannot_be_are_refused() {
    let complaint = |from: &str, to: &str| {
        assert!(GOOD.contains(from), "{from}");
        read(&GOOD.replacen(from, to, 1)).err().unwrap_or_else(|| panic!("no complaint about {to}")).to_string()
    };
    let only = "lights_only = [\"hero\", \"air\"]";
    let said = complaint(only, "lights_only = [\"heroes\"]");
    assert!(said.contains("`receiver = \"heroes\"`") && said.contains("rest, air, hero, leaves"), "{said}");
    let said = complaint(only, &format!("{only}\nlights_all_but = [\"air\"]"));
    assert!(said.contains("`lights_only` or `lights_all_but`, not both"), "{said}");
    let said = complaint("reflectance = 0.6", "reflectance = 0.6\nlights_only = [\"hero\"]");
    assert!(said.contains("are of what gives light: this material has no `emission`"), "{said}");
    let said = complaint("receiver = \"hero\"", "receiver = \"A hero\"");
    assert!(said.contains("a receiver's name is a letter"), "{said}");
    let said = complaint("faces = [[0, 1, 2]]", "faces = [[0, 1, 2]]\nreceiver = \"hero\"");
    assert!(said.contains("an [[instance]] has `receiver`"), "{said}");
    let blend = "[[material]]\nname = \"both\"\ntype = \"blend\"\nmaterials = [\"clay\", \"lamp\"]\nweight = { type = \"constant\", value = 0.5 }\n";
    let shown = format!("{blend}[[shape]]\ntype = \"sphere\"\ncenter = [9, 9, 9]\nradius = 1\nmaterial = \"both\"\n");
    let said = read(&(GOOD.to_owned() + &shown)).expect_err("it is refused").to_string();
    assert!(said.contains("surfaces of the blend light as the blend says") && said.contains("test.toml:"), "{said}");
    let same = shown.replace("value = 0.5 }", "value = 0.5 }\nlights_only = [\"hero\", \"air\"]");
    assert!(ReferenceRenderer::new(&read(&(GOOD.to_owned() + &same)).expect("it is read")).is_ok());
    let many: String = (0..29)
        .map(|number| format!("[[shape]]\ntype = \"sphere\"\ncenter = [9, 9, {number}]\nradius = 0.1\nmaterial = \"clay\"\nreceiver = \"r{number}\"\n"))
        .collect();
    let said = read(&(GOOD.to_owned() + &many)).expect_err("too many").to_string();
    assert!(said.contains("at most 32 groups of receivers"), "{said}");
}

#[test]
fn other_formats_list_the_lamps_that_lose_their_links() {
    let scene = read(GOOD).expect("a scene");
    for name in ["a.xml", "a.pbrt", "a.gltf"] {
        let format = ExportFormat::of(Path::new(name)).expect("a format");
        let written = format.write(&scene, "test", Path::new(name)).expect("it is written");
        let lost = |scene: &gpt::scene_writer::WrittenScene| {
            scene.report.dropped.iter().filter(|item| item.what == "light link").map(|item| item.count).sum::<usize>()
        };
        assert_eq!(lost(&written), 3, "{name}");
    }
}
