//! Scenes of glTF are read by the importer, and come back as they were.

mod materials;
mod textures;

use std::ffi::OsStr;
use std::path::Path;

use glam::DVec3;
use serde_json::Value;
use tempfile::tempdir;

use super::as_gltf;
use crate::load::file::{example_materials, light_examples, material_examples, shape_examples};
use crate::load::{LoadOptions, builtin_names, load, load_toml_str, load_with};
use crate::scene::{Geometry, ImportReport, Light, Projection, Scene, Shape};

const HEAD: &str = "[film]\nsize = [400, 200]\n[camera]\nposition = [3, 2, 5]\nlook_at = [0, 1, 0]\nvfov = 40\n";
const RED: &str = "[[material]]\nname = \"red\"\ntype = \"diffuse\"\nreflectance = [0.6, 0.1, 0.1]\n";
const SQUARE: &str =
    "[[shape]]\ntype = \"rectangle\"\ncorner = [0, 0, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]\nmaterial = \"probe\"\n";
const POINT: &str = "[[light]]\ntype = \"point\"\nposition = [1, 3, 2]\nintensity = [9, 8, 7]\n";

fn scene(tables: &str) -> Scene {
    load_toml_str(&format!("{HEAD}{tables}"), "test.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}\n{tables}"))
}

/// The scene that was read again, the reports of the way there and of the way back, and the JSON between.
struct Trip {
    read: Scene,
    lost: Vec<String>,
    back: Vec<String>,
    json: Value,
}

fn reported(report: &ImportReport) -> Vec<String> {
    report.dropped.iter().chain(&report.approximated).map(|item| item.what.clone()).collect()
}

fn round_trip_as(scene: &Scene, name: &str) -> Trip {
    let folder = tempdir().unwrap();
    let path = folder.path().join(name);
    let written = as_gltf(scene, "test", &path);
    let lost = reported(&written.report);
    let json = json_of(&written.content);
    written.write(&path, &LoadOptions::default().log).unwrap();
    let read = load_with(Some(OsStr::new(&path)), &LoadOptions::default());
    let read = read.unwrap_or_else(|error| panic!("{error}\n{json:#}"));
    let back = reported(&read.import_report);
    Trip { read, lost, back, json }
}

fn round_trip(scene: &Scene) -> Trip {
    round_trip_as(scene, "out.glb")
}

fn json_of(content: &[u8]) -> Value {
    let json = if content.starts_with(b"glTF") {
        let length = u32::from_le_bytes(content[12..16].try_into().unwrap()) as usize;
        &content[20..20 + length]
    } else {
        content
    };
    serde_json::from_slice(json).unwrap()
}

/// Corners of all triangles in the world.
fn corners(shape: &Shape) -> Vec<DVec3> {
    let positions = shape.world_positions();
    shape.world_faces().as_flattened().iter().map(|corner| positions[*corner as usize].as_dvec3()).collect()
}

#[test]
fn every_example_and_every_built_in_scene_is_read() {
    for name in builtin_names() {
        let trip = round_trip(&load(Some(name)).unwrap());
        assert_eq!(trip.back, Vec::<String>::new(), "{name}");
    }
    for (name, keys) in material_examples() {
        let text = format!("{HEAD}{}[[material]]\nname = \"probe\"\n{keys}{SQUARE}{POINT}", example_materials());
        let read = load_toml_str(&text, "test.toml", Path::new("")).unwrap_or_else(|error| panic!("{name}: {error}"));
        // An invisible surface is left out, and then there is nothing to read.
        if name != "pass" {
            round_trip(&read);
        }
    }
    for (_, keys) in light_examples().filter(|(_, keys)| !keys.contains("map.exr")) {
        round_trip(&scene(&format!("{RED}{}{keys}", SQUARE.replace("probe", "red"))));
    }
}

#[test]
fn both_forms_are_one_scene() {
    let tables = format!(
        "[[texture]]\nname = \"tiles\"\ntype = \"checker\"\na = [0.1, 0.5, 0.9]\nb = 0.9\n\
         [[material]]\nname = \"probe\"\ntype = \"diffuse\"\nreflectance = {{ texture = \"tiles\" }}\n{SQUARE}{POINT}"
    );
    let digest = |tables: &str, name: &str| crate::scene::digest(&round_trip_as(&scene(tables), name).read);
    assert_eq!(digest(&tables, "out.glb"), digest(&tables, "a room.gltf"));
    assert_ne!(digest(&tables, "out.glb"), digest(&tables.replace("0.5, 0.9]", "0.5, 0.8]"), "out.gltf"), "the control");
}

#[test]
fn cameras_come_back() {
    let square = format!("{RED}{}", SQUARE.replace("probe", "red"));
    let close = |read: &Scene, written: &Scene| {
        let ([read, written], size) = ([&read.camera, &written.camera], read.film.size);
        let frames = read.frame().into_iter().zip(written.frame());
        let opening = match (read.projection, written.projection) {
            (Projection::Perspective { vertical_fov_degrees: a }, Projection::Perspective { vertical_fov_degrees: b }) => {
                (a - b).abs()
            }
            (Projection::Orthographic { height: a }, Projection::Orthographic { height: b }) => (a - b).abs(),
            _ => f64::INFINITY,
        };
        let turned = frames.map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        size == [512, 256] && opening < 1e-9 && turned < 1e-12 && read.position.distance(written.position) < 1e-12
    };
    let perspective = scene(&format!("{square}{POINT}"));
    let trip = round_trip(&perspective);
    assert!(close(&trip.read, &perspective), "{:?}", trip.read.camera);
    assert_eq!((trip.lost.len(), trip.back.len()), (0, 0), "{:?} {:?}", trip.lost, trip.back);
    let orthographic = HEAD.replace("vfov = 40\n", "projection = \"orthographic\"\nheight = 3\n") + &square + POINT;
    let orthographic = load_toml_str(&orthographic, "test.toml", Path::new("")).unwrap();
    assert!(close(&round_trip(&orthographic).read, &orthographic));
    // The controls: another camera, and what cannot be said.
    assert!(!close(&trip.read, &orthographic));
    let mut shifted = perspective;
    shifted.camera.shift = [0.25, 0.0];
    assert_eq!(round_trip(&shifted).lost, ["shift of the camera's window"]);
    // A calibrated camera is a perspective one there; a panorama cannot be said.
    let half = (0.5 * 40_f64.to_radians()).tan();
    let focal = 0.5 * 200.0 / half;
    let lens = format!("projection = \"brown_conrady\"\nfocal = [{focal}, {focal}]\n");
    let calibrated = load_toml_str(&(HEAD.replace("vfov = 40\n", &lens) + &square + POINT), "test.toml", Path::new("")).unwrap();
    let trip = round_trip(&calibrated);
    assert!(trip.lost.is_empty() && close(&trip.read, &scene(&format!("{square}{POINT}"))), "{:?}", trip.read.camera);
    let around = HEAD.replace("vfov = 40\n", "projection = \"cylindrical\"\n") + &square + POINT;
    let around = load_toml_str(&around, "test.toml", Path::new("")).unwrap();
    assert_eq!(round_trip(&around).lost, ["projection cylindrical"]);
}

#[test]
fn lights_come_back() {
    let tables = format!(
        "{RED}{}{POINT}[[light]]\ntype = \"spot\"\nposition = [0, 3, 0]\ndirection = [0.1, -1, 0.3]\nintensity = [4, 2, 1]\nangle = 50\nfalloff = 35\ncurve = \"square\"\n\
         [[light]]\ntype = \"directional\"\ndirection = [0, 0, 1]\nirradiance = [1, 2, 3]\n",
        SQUARE.replace("probe", "red")
    );
    let written = scene(&tables);
    let trip = round_trip(&written);
    assert_eq!((trip.lost.len(), trip.back.len()), (0, 0), "{:?} {:?}", trip.lost, trip.back);
    let differ = |read: &[Light], written: &[Light]| {
        let near = |a: DVec3, b: DVec3| a.distance(b) < 1e-9;
        let is_like = |(a, b): (&Light, &Light)| match (a, b) {
            (Light::Point(a), Light::Point(b)) => {
                near(a.position, b.position) && near(a.intensity.to_vector(), b.intensity.to_vector())
            }
            (Light::Spot(a), Light::Spot(b)) => {
                near(a.position, b.position)
                    && near(a.direction, b.direction)
                    && near(a.intensity.to_vector(), b.intensity.to_vector())
                    && (a.angle_degrees - b.angle_degrees).abs() < 1e-9
                    && (a.falloff_degrees - b.falloff_degrees).abs() < 1e-6
                    && a.curve == b.curve
            }
            (Light::Directional(a), Light::Directional(b)) => {
                near(a.direction, b.direction) && near(a.irradiance.to_vector(), b.irradiance.to_vector())
            }
            _ => false,
        };
        read.len() != written.len() || !read.iter().zip(written).all(is_like)
    };
    assert!(!differ(&trip.read.lights, &written.lights), "{:?}", trip.read.lights);
    for (from, to) in [("[9, 8, 7]", "[9, 8, 6]"), ("angle = 50", "angle = 51"), ("irradiance = [1", "irradiance = [2")] {
        assert!(differ(&round_trip(&scene(&tables.replace(from, to))).read.lights, &written.lights), "the control: {to}");
    }
    let smooth = tables.replace("curve = \"square\"\n", "");
    assert_eq!(round_trip(&scene(&smooth)).lost, ["falloff of a spot light"]);
    let sky = format!("{RED}{}[[light]]\ntype = \"environment\"\nradiance = 0.5\n", SQUARE.replace("probe", "red"));
    assert_eq!(round_trip(&scene(&sky)).lost, ["light `environment`"]);
}

/// Triangles stand where shapes do, their fronts where those are, also behind a mirror.
#[test]
fn shapes_come_back_as_triangles() {
    let places = [
        "transform = [{ rotate = [1, 2, 3], degrees = 31 }, { scale = 0.7 }, { translate = [0.1, 0, -0.3] }]\n",
        "transform = [{ scale = [-1, 1, 1] }, { translate = [0.1, 0, -0.3] }]\n",
        "",
    ];
    for (name, keys) in shape_examples() {
        for place in places {
            let place = if name == "plane" { "" } else { place };
            let written = scene(&format!("{RED}{keys}material = \"red\"\n{place}{POINT}"));
            let trip = round_trip(&written);
            let expected = match name {
                "sphere" | "disk" | "cylinder" | "plane" => vec![format!("shape `{name}`")],
                _ => Vec::new(),
            };
            assert_eq!((&trip.lost, trip.back.len()), (&expected, 0), "{name} {:?}", trip.back);
            let made = written.shapes[0].geometry.tessellated();
            let expected = corners(&Shape { geometry: Geometry::Mesh(made.mesh), ..written.shapes[0].clone() });
            let found = corners(&trip.read.shapes[0]);
            let apart = |found: &[DVec3]| {
                found.len() != expected.len()
                    || found.iter().zip(&expected).any(|(a, b)| a.distance(*b) > 1e-5 * (1.0 + b.length()))
            };
            assert!(!apart(&found), "{name} {place}");
            assert!(
                apart(&found.iter().map(|at| *at + DVec3::X * 1e-2 * (1.0 + at.length())).collect::<Vec<_>>()),
                "the control"
            );
        }
    }
}

/// A mesh of a group is stored once, and stands where its instances do.
#[test]
fn instances_come_back() {
    let mut text =
        format!("{RED}[[group]]\nname = \"pile\"\n[[group.shape]]\ntype = \"mesh\"\nmaterial = \"red\"\npositions = [");
    let count = 40;
    (0..count).for_each(|index| text += &format!("[{index}, {}, 0], [{index}, 0, 1], ", index % 7));
    text += "]\nfaces = [";
    (0..count - 1).for_each(|index| text += &format!("[{}, {}, {}], ", 2 * index, 2 * index + 1, 2 * index + 2));
    text += "]\n[[instance]]\ngroup = \"pile\"\nplaces = [[1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 1, 6], [-1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0], [0, 0, 1, 2, 0, 1, 0, 0, -1, 0, 0, 0]]\n";
    let written = scene(&format!("{text}{POINT}"));
    let trip = round_trip(&written);
    assert_eq!((trip.lost.len(), trip.back.len()), (0, 0), "{:?} {:?}", trip.lost, trip.back);
    assert_eq!(trip.json["meshes"].as_array().map(Vec::len), Some(1));
    assert_eq!(trip.json["nodes"].as_array().map(Vec::len), Some(1 + 3 + 1));
    let points = |scene: &Scene| -> Vec<DVec3> {
        let of_instances = scene.instances.iter().flat_map(|instances| {
            let shapes = &scene.groups[instances.group].shapes;
            instances
                .maps()
                .flat_map(|map| shapes.iter().flat_map(corners).map(move |at| map.transform_point3(at)).collect::<Vec<_>>())
        });
        of_instances.chain(scene.shapes.iter().flat_map(corners)).collect()
    };
    let (found, expected) = (points(&trip.read), points(&written));
    let sum = |points: &[DVec3]| points.iter().map(|at| *at * *at + *at).sum::<DVec3>();
    assert_eq!(found.len(), expected.len());
    assert!(sum(&found).distance(sum(&expected)) < 1e-3 * sum(&expected).length());
    assert!(sum(&found[1..]).distance(sum(&expected)) > 0.0, "the control");
}

#[test]
fn what_is_lost_is_named() {
    let lost = |tables: &str| round_trip(&scene(tables)).lost;
    let square = SQUARE.replace("probe", "red");
    assert_eq!(lost(&format!("{RED}{square}motion = [{{ translate = [1, 0, 0] }}]\n{POINT}")), ["motion"]);
    let projector = "[[light]]\ntype = \"projector\"\nposition = [0, 0, 3]\ndirection = [0, 0, -1]\nup = [0, 1, 0]\nvfov = 30\nirradiance = 2\n";
    assert_eq!(lost(&format!("{RED}{square}{projector}")), ["light `projector`"]);
    let black = RED.replace("reflectance", "two_sided = false\nreflectance");
    assert_eq!(lost(&format!("{black}{square}{POINT}")), ["two_sided = false"]);
    assert_eq!(lost(&format!("{RED}{square}{POINT}")), Vec::<String>::new(), "the control");
}
