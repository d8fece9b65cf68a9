//! Meshes that are stored once and stand in many places: the device against the reference, and both against the same scene with copies.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use gpt::cpu::ReferenceRenderer;
use gpt::load;
use gpt::plan::{Chunks, GeometryPlacement, PlanOptions, StageMode};
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::{Scene, Shape, TransformStep};

use super::strategies::compare_unequal;
use super::{assert_agrees, assert_agrees_on};
use crate::common::device::{DEVICE, with_limits};
use crate::common::effort::in_full;
use crate::common::pixel_bits::pixel_bits;

/// The folder of the built-in scenes, whose textures are used here too.
const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");

/// A floor under a lamp and a sky; groups and instances are added.
const STAGE: &str = r#"
[film]
size = [32, 32]
[render]
spp = 12
max_depth = 5
[camera]
position = [0, 2.2, 7]
look_at = [0, 0.8, 0]
vfov = 42
shutter = [0.25, 1.25]
[[texture]]
name = "checks"
type = "checker"
a = [0.9, 0.2, 0.1]
b = [0.1, 0.3, 0.8]
scale = [8, 6]
[[texture]]
name = "bumps"
type = "image"
file = "textures/hammered.png"
color_space = "linear"
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.8
[[material]]
name = "checked"
type = "diffuse"
reflectance = { texture = "checks" }
normal_map = "bumps"
[[material]]
name = "gold"
type = "conductor"
preset = "gold"
roughness = 0.4
[[material]]
name = "glass"
type = "glass"
ior = 1.5
[[material]]
name = "veil"
type = "diffuse"
reflectance = [0.3, 0.8, 0.3]
opacity = 0.4
[[material]]
name = "holes"
type = "diffuse"
reflectance = 0.7
opacity = { texture = "checks", channel = "r" }
[[material]]
name = "two"
type = "blend"
materials = ["checked-plain", "gold"]
weight = { type = "fresnel", ior = 1.4 }
[[material]]
name = "checked-plain"
type = "diffuse"
reflectance = { texture = "checks" }
[[material]]
name = "nothing"
type = "pass"
[[material]]
name = "glow"
type = "emissive"
radiance = [9, 7, 5]
[[shape]]
type = "rectangle"
corner = [-6, 0, -6]
edge_u = [0, 0, 12]
edge_v = [12, 0, 0]
material = "white"
[[shape]]
type = "rectangle"
corner = [-1, 4, -1]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
material = "glow"
[[light]]
type = "environment"
radiance = [0.2, 0.3, 0.4]
"#;

/// Uneven, turned, sheared and mirrored places.
const PLACES: &str = "places = [[0.7, 0, 0, -1.4, 0, 0.9, 0, 0.9, 0, 0, 0.7, 0.3], [-0.5, 0.1, 0, 0.2, 0, 0.8, 0.3, 0.8, 0, -0.2, 0.6, 0.9], \
    [0.4, 0, -0.5, 1.6, 0.2, 0.7, 0, 0.8, 0.6, 0, 0.5, -0.4]]\n";

/// A ball of squares, uneven so that no two triangles lie alike, with normals and texture coordinates.
fn ball(side: usize) -> String {
    let (mut positions, mut normals, mut uvs, mut faces) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for row in 0..=side {
        for column in 0..=side {
            let (u, v) = (column as f64 / side as f64, row as f64 / side as f64);
            let ((sine, cosine), (across, up)) = ((std::f64::consts::TAU * u).sin_cos(), (std::f64::consts::PI * v).sin_cos());
            let normal = DVec3::new(across * cosine, up, across * sine);
            let radius = 1.0 + 0.07 * (9.0 * u + 4.0 * v).sin() * across;
            positions.push((normal * radius).to_array());
            normals.push(if across == 0.0 { DVec3::Y * up.signum() } else { normal }.to_array());
            uvs.push([u, v]);
        }
    }
    for a in (0..side * side).map(|square| square / side * (side + 1) + square % side) {
        faces.extend([[a, a + 1, a + side + 1], [a + 1, a + side + 2, a + side + 1]]);
    }
    let mut text = String::new();
    let _ = write!(text, "type = \"mesh\"\npositions = {positions:?}\nnormals = {normals:?}\nuvs = {uvs:?}\nfaces = {faces:?}\n");
    text
}

/// Lines that follow the stage.
fn stage(lines: &str) -> Scene {
    let text = format!("{STAGE}{lines}");
    load::load_toml_str(&text, "instances.toml", Path::new(SCENES)).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A smooth ball of a material, and a flat fin of another.
fn group(material: &str, smooth: bool) -> String {
    let fin = "type = \"mesh\"\npositions = [[-0.3, 0.8, 0], [0.3, 0.8, 0.1], [0, 1.5, 0]]\nuvs = [[0, 0], [1, 0], [0.5, 1]]\nfaces = [[0, 1, 2]]\nmaterial = \"gold\"\n";
    format!(
        "[[group]]\nname = \"thing\"\n[[group.shape]]\n{}smooth = {smooth}\nmaterial = \"{material}\"\n[[group.shape]]\n{fin}",
        ball(6)
    )
}

fn instances(keys: &str) -> String {
    format!("[[instance]]\ngroup = \"thing\"\n{keys}")
}

fn ways() -> [PlanOptions; 2] {
    [StageMode::Fused, StageMode::Wavefront].map(|mode| PlanOptions { stages: Some(mode), ..PlanOptions::default() })
}

/// The scene with a shape of its own for every mesh of every instance.
fn with_copies(scene: &Scene) -> Scene {
    let mut copies = scene.clone();
    for entry in std::mem::take(&mut copies.instances) {
        for map in entry.maps() {
            for shape in &scene.groups[entry.group].shapes {
                let mut shape: Shape = shape.clone();
                shape.transform.steps.push(TransformStep::Matrix(map));
                shape.motion.clone_from(&entry.motion);
                shape.material = entry.material.unwrap_or(shape.material);
                copies.shapes.push(shape);
            }
        }
    }
    copies.groups.clear();
    copies
}

#[test]
fn instances_agree_path_by_path() {
    let motion = "motion = [{ scale = [1.2, 0.8, 1] }, { rotate = [0.3, 1, 0], degrees = 90 }, { translate = [0.3, 0.2, 0] }]\n";
    let cases = [
        ("smooth, textured, bent", group("checked", true) + &instances(PLACES)),
        ("flat glass", group("glass", false) + &instances(PLACES)),
        ("blend", group("two", true) + &instances(PLACES)),
        ("translucent surfaces", group("veil", true) + &instances(PLACES)),
        ("holes of a material of their own", group("white", true) + &instances(&format!("{PLACES}material = \"holes\"\n"))),
        ("moving", group("checked", true) + &instances(&format!("{PLACES}{motion}"))),
        (
            "moving translucent surfaces, at rest beside",
            group("veil", false) + &instances(&format!("{PLACES}{motion}")) + &instances(""),
        ),
    ];
    // The others' parts are in these, in `instances_look_like_copies` and in the built-in scenes `model-town` and `grove`.
    let everywhere = in_full("each kind of instance alone");
    let enough = ["flat glass", "holes of a material of their own", "moving translucent surfaces, at rest beside"];
    for (index, (name, lines)) in cases.iter().enumerate().filter(|(_, (name, _))| everywhere || enough.contains(name)) {
        assert_agrees(name, &stage(lines), &ways()[index % 2]);
    }
}

/// A fin with two balls on its flanks, in two places, and the same without groups within groups: numbers are exact in binary.
const PAIRS: [&str; 2] = [
    "[[group.instance]]\ngroup = \"thing\"\nplaces = [[0.5, 0, 0, -1, 0, 0.5, 0, 0.5, 0, 0, 0.5, 0], [0, 0, -0.5, 1, 0, 0.5, 0, 0.75, 0.5, 0, 0, 0.25]]\n\
     [[instance]]\ngroup = \"pair\"\nplaces = [[1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0], [-0.5, 0, 0, -1.5, 0, 0.5, 0, 1.5, 0, 0, 0.5, 1]]\n",
    "[[instance]]\ngroup = \"pair\"\nplaces = [[1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0], [-0.5, 0, 0, -1.5, 0, 0.5, 0, 1.5, 0, 0, 0.5, 1]]\n\
     [[instance]]\ngroup = \"thing\"\nplaces = [[0.5, 0, 0, -0.5, 0, 0.5, 0, 0.5, 0, 0, 0.5, 0], [0, 0, -0.5, 1.5, 0, 0.5, 0, 0.75, 0.5, 0, 0, 0.25], \
     [-0.25, 0, 0, -1, 0, 0.25, 0, 1.75, 0, 0, 0.25, 1], [0, 0, 0.25, -2, 0, 0.25, 0, 1.875, 0.25, 0, 0, 1.125]]\n",
];

fn pairs(lines: &str) -> Scene {
    let fin = "type = \"mesh\"\npositions = [[-0.5, 0.25, 0], [0.5, 0.25, 0.125], [0, 2, 0]]\nfaces = [[0, 1, 2]]\nmaterial = \"white\"\n";
    stage(&format!("{}[[group]]\nname = \"pair\"\n[[group.shape]]\n{fin}{lines}", group("checked", true)))
}

/// Instances within instances are the instances that they come to, on the device and on the reference, to the last bit.
#[test]
fn groups_within_groups_show_the_same_picture_bit_for_bit() {
    let [nested, flat] = PAIRS.map(pairs);
    assert_eq!((nested.instance_count(), flat.instance_count()), (6, 6));
    let elsewhere = pairs(&PAIRS[0].replace("0.5, 0, 0, -1,", "0.5, 0, 0, -1.0625,"));
    let of_reference = reference_bits(&nested);
    assert!(of_reference == reference_bits(&flat));
    assert!(of_reference != reference_bits(&elsewhere), "a ball stands elsewhere, and nobody notices");
    let Some(device) = DEVICE.as_ref() else { return };
    let everywhere = in_full("groups within groups by either way to run");
    for options in ways().into_iter().take(if everywhere { 2 } else { 1 }) {
        let bits = |scene: &Scene| pixel_bits(device, scene, &options, 0..scene.render.spp).0;
        let of_nested = bits(&nested);
        assert!(of_nested == bits(&flat), "{options:?}");
        assert!(of_nested != bits(&elsewhere), "{options:?}: a ball stands elsewhere, and nobody notices");
    }
}

fn reference_bits(scene: &Scene) -> Vec<[u32; 3]> {
    let mut pixels = Vec::new();
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..scene.render.spp };
    let mut on_band = |band: gpt::film::Band| {
        pixels.extend(band.mean.iter().map(|pixel| pixel.map(f32::to_bits)));
        Ok(())
    };
    let mut renderer = ReferenceRenderer::new(scene).expect("the scene is supported");
    renderer.render(&request, &Silent, &mut on_band).expect("rendering succeeds");
    pixels
}

/// The content of a moving instance turns about the instance's place, not about itself.
#[test]
fn what_moving_instances_hold_moves_with_them() {
    let motion = "motion = [{ scale = [1.2, 0.8, 1] }, { rotate = [0.3, 1, 0], degrees = 90 }, { translate = [0.3, 0.2, 0] }]\n";
    let scene = pairs(&format!("{}{motion}", PAIRS[0]));
    let everywhere = in_full("moving pairs by either way to run");
    for options in ways().into_iter().skip(usize::from(!everywhere)) {
        assert_agrees("moving pairs", &scene, &options);
    }
    // One group with everything in it, which is about the same place by itself.
    let mut whole = scene.clone();
    let balls = whole.instances.split_off(1);
    let own = whole.instances[0].maps().collect::<Vec<_>>();
    let shapes = balls[..1].iter().flat_map(|entry| entry.maps()).map(|map| own[0].inverse() * map).flat_map(|map| {
        scene.groups[0].shapes.iter().map(move |shape| {
            let mut shape = shape.clone();
            shape.transform.steps.push(TransformStep::Matrix(map));
            shape
        })
    });
    let pair = whole.instances[0].group;
    whole.groups[pair].shapes.extend(shapes);
    let Some(verdict) = compare_unequal(&scene, &whole) else { return };
    assert!(verdict.agrees, "{verdict:#?}");
    // The control: each ball turns about itself.
    let mut apart = scene.clone();
    apart.instances.iter_mut().for_each(|entry| entry.pivot = None);
    let Some(verdict) = compare_unequal(&whole, &apart) else { return };
    assert!(!verdict.agrees, "balls turn about themselves, and nobody notices: {verdict:#?}");
}

/// Lanes that trace rays of their own, without packets.
#[test]
fn lone_lanes_agree() {
    let Some(device) = with_limits(|limits| limits.subgroup_size = None) else { return };
    let everywhere = in_full("lone lanes at translucent surfaces");
    for material in ["checked", "veil"].into_iter().take(if everywhere { 2 } else { 1 }) {
        let scene = stage(&(group(material, true) + &instances(PLACES)));
        assert_agrees_on(&device, &format!("{material}, lane by lane"), &scene, &ways()[0]);
    }
}

/// Instances on the device, and copies of their meshes on the reference.
#[test]
fn instances_look_like_copies() {
    let motion = "motion = [{ scale = [1.2, 0.8, 1] }, { rotate = [0.3, 1, 0], degrees = 90 }, { translate = [0.3, 0.2, 0] }]\n";
    let cases = [("moving", motion), ("replaced", "material = \"two\"\n"), ("at rest", "")];
    let count = if in_full("copies of instances at rest") { 3 } else { 2 };
    for (name, keys) in cases.into_iter().take(count) {
        let scene = stage(&(group("checked", true) + &instances(&format!("{PLACES}{keys}"))));
        let Some(verdict) = compare_unequal(&scene, &with_copies(&scene)) else { return };
        assert!(verdict.agrees, "{name}: {verdict:#?}");
        // The control: one of three places is a hundredth off.
        let mut moved = scene.clone();
        let mut places = scene.instances[0].places.to_vec();
        places[1] = DAffine3::from_translation(DVec3::new(0.02, 0.0, 0.0)) * places[1];
        moved.instances[0].places = Arc::new(places);
        let Some(verdict) = compare_unequal(&scene, &with_copies(&moved)) else { return };
        assert!(!verdict.agrees, "{name}: an instance stands elsewhere, and nobody notices: {verdict:#?}");
    }
}

/// Far from the origin and of very different sizes, rays neither meet the triangle that they leave nor slip through.
#[test]
fn places_far_away_and_of_any_size_agree() {
    for (offset, scale) in [(3000.0, 1.0), (0.0, 1e-4), (100.0, 300.0)] {
        let lines = group("checked", true)
            + &instances(&format!(
                "transform = [{{ scale = {scale} }}, {{ rotate = [1, 2, 3], degrees = 40 }}, {{ translate = [{offset}, 0, {offset}] }}]\n"
            ));
        let mut scene = stage(&lines);
        scene.shapes.clear();
        let center = DVec3::new(offset, 0.0, offset);
        scene.camera.look_at = center;
        scene.camera.position = center + DVec3::new(0.0, 0.7, 3.0) * scale;
        assert_agrees(&format!("scale {scale} at {offset}"), &scene, &ways()[0]);
    }
}

/// Arrays in chunks hold the same picture, bit for bit.
#[test]
fn instances_in_chunks_give_the_same_picture() {
    let Some(device) = DEVICE.as_ref() else { return };
    let mut lines = group("checked", true);
    for row in 0..10 {
        for column in 0..10 {
            let (x, z) = (0.6 * f64::from(column) - 2.7, 0.6 * f64::from(row) - 3.0);
            lines += &instances(&format!("transform = [{{ scale = 0.2 }}, {{ translate = [{x}, 0.3, {z}] }}]\n"));
        }
    }
    let scene = stage(&lines);
    let Some(small) = with_limits(|limits| limits.max_array = 5_000) else { return };
    let everywhere = in_full("instances in chunks by either way to run");
    for options in ways().into_iter().take(if everywhere { 2 } else { 1 }) {
        let samples = 0..scene.render.spp;
        let (whole, plan) = pixel_bits(device, &scene, &options, samples.clone());
        assert!(plan.geometry == GeometryPlacement::Hierarchy && plan.chunks.iter().all(Chunks::is_whole), "{plan}");
        let (cut, plan) = pixel_bits(&small, &scene, &options, samples);
        let names: Vec<&str> = plan.chunks.iter().filter(|array| !array.is_whole()).map(|array| array.array.name).collect();
        assert!(names.contains(&"instances") && names.contains(&"primitives"), "{names:?}");
        assert!(whole == cut, "{options:?}");
    }
}

/// Nothing is stored or compiled for what no ray meets.
#[test]
fn instances_of_pass_are_not_there() {
    let scene = stage(&(group("white", true) + &instances("material = \"nothing\"\n")));
    let packed = gpt::packed::PackedScene::new(&scene).expect("it can be packed");
    assert!(packed.instances.is_empty() && packed.hierarchy.roots.is_empty());
    assert_agrees("unseen", &scene, &ways()[0]);
}
