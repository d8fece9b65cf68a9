//! Light groups: how scene files name them, and that the light of all groups is the light of the scene, path by path.

use std::path::Path;

use gpt::cpu::ReferenceRenderer;
use gpt::load::{self, SceneError};
use gpt::scene::{ColorInput, Estimator, Scene};
use gpt::scene_writer;
use gpt::verify;

use crate::common::light_groups::{GROUPS, in_groups, lit_by};

const GOOD: &str = r#"
[camera]
position = [0, 1, 6]
look_at = [0, 1, 0]
vfov = 40
[[medium]]
name = "glow"
absorption = 0.1
emission = [0.1, 0.2, 0.1]
light_group = "fog"
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.5
[[material]]
name = "mist"
type = "pass"
interior = "glow"
[[material]]
name = "lamp"
type = "emissive"
radiance = 5
light_group = "key"
[[material]]
name = "veil"
type = "diffuse"
reflectance = 0.5
emission = [0, 1, 2]
opacity = 0.5
light_group = "fill"
[[shape]]
type = "sphere"
center = [0, 1, 0]
radius = 1
material = "white"
[[shape]]
type = "sphere"
center = [0, 1, 2]
radius = 0.7
material = "mist"
[[shape]]
type = "sphere"
center = [-3, 3, 1]
radius = 0.5
material = "lamp"
[[shape]]
type = "sphere"
center = [3, 2, 0]
radius = 0.5
material = "veil"
[[light]]
type = "environment"
radiance = 0.1
[[light]]
type = "point"
position = [0, 5, 2]
intensity = 4
light_group = "key"
"#;

fn read(text: &str) -> Result<Scene, SceneError> {
    load::load_toml_str(text, "test.toml", Path::new(""))
}

/// Radiance of some samples of some pixels.
fn samples(scene: &Scene) -> Vec<[f64; 3]> {
    let renderer = ReferenceRenderer::new(scene).expect("the scene is supported");
    let [width, height] = scene.film.size;
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    places.flat_map(|(x, y)| [0, 1].map(|sample| renderer.radiance_of_sample(x, y, sample))).collect()
}

/// By how much the light of these groups together differs from that of the scene, at most, in parts of it.
fn largest_difference(scene: &Scene, groups: &[&str]) -> f64 {
    let mut sums = vec![[0.0; 3]; samples(scene).len()];
    for group in groups {
        let of_group = samples(&lit_by(scene, group));
        sums.iter_mut().flatten().zip(of_group.iter().flatten()).for_each(|(sum, light)| *sum += light);
    }
    let all = samples(scene);
    let differences = sums.iter().flatten().zip(all.iter().flatten());
    differences.map(|(sum, light)| (sum - light).abs() / light.max(1e-6)).fold(0.0, f64::max)
}

/// Among them are lights of every kind, textured and blended emitters, portals, maps, skies, and media that glow, with grids and without.
#[test]
fn groups_add_up_to_the_light_of_the_scene_path_by_path() {
    for name in ["examples", "bonfire", "lanterns", "theatre", "terrace", "arbour", "loft", "vitrine"] {
        let mut scene = load::load(Some(name)).expect("it is built in");
        verify::shrink(&mut scene, 16);
        scene.render.spp = 2;
        for estimator in [Estimator::Mis, Estimator::Nee, Estimator::Bsdf] {
            scene.render.estimator = estimator;
            let grouped = in_groups(scene.clone());
            let found = grouped.light_group_names();
            let found: Vec<&str> = GROUPS.into_iter().filter(|group| found.contains(group)).collect();
            assert!(samples(&grouped) == samples(&scene), "{name}: a scene with groups is the scene");
            let apart = largest_difference(&grouped, &found);
            assert!(apart < 1e-12, "{name}, {estimator:?}: {apart:e}");
        }
    }
}

/// The control of the sum: without one of the groups, there is no such sum.
#[test]
fn a_group_that_is_missing_is_noticed() {
    let scene = read(GOOD).expect("a scene");
    let mut scene = scene;
    scene.film.size = [24, 16];
    let all = ["fog", "key", "fill", "rest"];
    assert_eq!(scene.light_group_names(), all);
    assert!(largest_difference(&scene, &all) < 1e-12);
    for left_out in all {
        let others: Vec<&str> = all.into_iter().filter(|group| *group != left_out).collect();
        let apart = largest_difference(&scene, &others);
        assert!(apart > 0.01, "without {left_out}: {apart}");
    }
}

/// Paths do not depend on lights where none is sampled: they find what they find with all others off.
#[test]
fn a_group_is_the_scene_with_all_other_lights_off() {
    let mut scene = read(GOOD).expect("a scene");
    scene.film.size = [24, 16];
    scene.render.estimator = Estimator::Bsdf;
    let mut off = scene.clone();
    off.lights.clear();
    off.light_groups = Default::default();
    off.media[0].emission *= 0.0;
    for (id, material) in off.materials.iter_mut().enumerate() {
        let is_fill = scene.light_groups.name(scene.light_groups.of_material(id)) == "fill";
        if let Some(emission) = material.emission.as_mut().filter(|_| !is_fill) {
            emission.radiance = ColorInput::grey(0.0);
        }
    }
    let (of_group, alone) = (samples(&lit_by(&scene, "fill")), samples(&off));
    assert!(of_group == alone && of_group.iter().flatten().any(|light| *light > 0.0));
    assert!(samples(&lit_by(&scene, "key")) != alone);
}

/// With every estimator the mean is that of the scene with all other lights off.
#[test]
fn a_group_has_the_mean_of_the_scene_with_all_other_lights_off() {
    let mut scene = read(GOOD).expect("a scene");
    scene.film.size = [24, 16];
    let mut off = scene.clone();
    off.lights.remove(0);
    off.light_groups = Default::default();
    off.media[0].emission *= 0.0;
    let lamp = off.materials.iter().position(|material| material.name == "lamp").expect("the lamp");
    for (_, material) in off.materials.iter_mut().enumerate().filter(|(id, _)| *id != lamp) {
        material.emission = None;
    }
    let mean = |scene: &Scene, samples: std::ops::Range<u32>| {
        let renderer = ReferenceRenderer::new(scene).expect("the scene is supported");
        let of_sample = |sample| {
            let pixels = (0..16).flat_map(|y| (0..24).map(move |x| (x, y)));
            pixels.map(|(x, y)| renderer.radiance_of_sample(x, y, sample)[1]).sum::<f64>() / 384.0
        };
        let means: Vec<f64> = samples.map(of_sample).collect();
        let count = means.len() as f64;
        let mean = means.iter().sum::<f64>() / count;
        let variance = means.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / (count - 1.0) / count;
        (mean, variance)
    };
    let apart = |group: &str| {
        let [(a, variance_a), (b, variance_b)] = [mean(&lit_by(&scene, group), 0..64), mean(&off, 64..128)];
        (a - b).abs() / (variance_a + variance_b).sqrt()
    };
    assert!(apart("key") < 4.0, "{}", apart("key"));
    // The control: another group is further away than that.
    assert!(apart("fill") > 4.0, "{}", apart("fill"));
}

#[test]
fn groups_go_through_a_scene_file() {
    let scene = read(GOOD).expect("a scene");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("again.toml");
    scene_writer::save_scene(&scene, &path).expect("it is written");
    let text = std::fs::read_to_string(&path).expect("it is there");
    let again = read(&text).expect("it is a scene");
    let names = |scene: &Scene| {
        let groups = &scene.light_groups;
        let of_materials = scene.materials.iter().enumerate().filter(|(_, material)| material.emission.is_some());
        let of_materials = of_materials.map(|(id, _)| groups.name(groups.of_material(id)).to_owned());
        let of_lights = (0..scene.lights.len()).map(|light| groups.name(groups.of_light(light)).to_owned());
        let of_media = (0..scene.media.len()).map(|medium| groups.name(groups.of_medium(medium)).to_owned());
        (of_materials.collect::<Vec<_>>(), of_lights.collect::<Vec<_>>(), of_media.collect::<Vec<_>>())
    };
    assert_eq!(names(&scene), names(&again));
    assert_eq!(names(&scene).1, ["rest", "key"]);
    let silent = GOOD.replace("light_group", "# light_group");
    assert_ne!(names(&scene), names(&read(&silent).expect("a scene")), "the control");
}

#[test]
fn groups_that_cannot_be_are_refused() {
    let complaint = |from: &str, to: &str| {
        assert!(GOOD.contains(from), "{from}");
        read(&GOOD.replacen(from, to, 1)).err().unwrap_or_else(|| panic!("no complaint about {to}")).to_string()
    };
    for bad in ["\"Key\"", "\"a.b\"", "\"\"", "\"an-altogether-too-long-name-of-a-group\""] {
        let said = complaint("light_group = \"key\"", &format!("light_group = {bad}"));
        assert!(said.contains("a light group's name is") && said.contains("light_group"), "{said}");
    }
    let said = complaint("interior = \"glow\"", "interior = \"glow\"\nlight_group = \"key\"");
    assert!(said.contains("`light_group` is of what gives light: this material has no `emission`"), "{said}");
    let said = complaint("emission = [0.1, 0.2, 0.1]", "");
    assert!(said.contains("`light_group` is of what gives light: this medium has no `emission`"), "{said}");
    let lights: String = (0..14)
        .map(|number| format!("[[light]]\ntype = \"point\"\nposition = [0, 5, 2]\nintensity = 4\nlight_group = \"g{number}\"\n"))
        .collect();
    let said = read(&(GOOD.to_owned() + &lights)).expect_err("too many").to_string();
    assert!(said.contains("a scene has at most 16 light groups"), "{said}");
}
