//! `deformation` of meshes in scene files.

use std::fs;

use glam::Vec3;
use gpt::load::{LoadOptions, load_with};
use gpt::scene::{Geometry, Scene};

const JSON: &str = r#"{ "influences": [[[0, 1.0]], [[0, 0.5], [1, 1.5]], []], "targets": [{ "positions": [[0, 0, 1], [0, 0, 2], [0, 0, 4]] }] }"#;
const KEYS: &str = "deformation = { file = \"bent.json\", joints = [{}, { node = \"lift\", matrix = [1, 0, 0, 10, 0, 1, 0, 0, 0, 0, 1, 0] }], \
    weights = [0.5], keyframes = [{ frame = 0, weights = [0] }, { time = 1, weights = [1] }] }";

fn load(keys: &str, json: &str) -> Result<Scene, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let text = format!(
        "[animation]\nfps = 10\n[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\nvfov = 40\n\
         [[node]]\nname = \"lift\"\nkeyframes = [{{ frame = 0, translate = [0, 0, 0] }}, {{ frame = 10, translate = [0, 8, 0] }}]\n\
         [[material]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n[[shape]]\ntype = \"mesh\"\nmaterial = \"grey\"\n\
         positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n{keys}\n[[light]]\ntype = \"environment\"\nradiance = 1\n"
    );
    fs::write(folder.path().join("a.toml"), text).expect("it is written");
    fs::write(folder.path().join("bent.json"), json).expect("it is written");
    load_with(Some(folder.path().join("a.toml").as_os_str()), &LoadOptions::default()).map_err(|error| error.to_string())
}

fn positions(scene: &Scene) -> Vec<[f32; 3]> {
    match &scene.shapes[0].geometry {
        Geometry::Mesh(mesh) => mesh.positions.iter().map(Vec3::to_array).collect(),
        other => panic!("{other:?}"),
    }
}

/// By hand: targets first, then the mean of where joints put a vertex, by their weights; a vertex without joints stays.
#[test]
fn targets_and_joints_bend_a_mesh() {
    let scene = load(KEYS, JSON).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(positions(&scene), [[0.0, 0.0, 0.5], [8.5, 0.0, 1.0], [0.0, 1.0, 2.0]]);
    for (frame, expected) in [
        (0.0, [[0.0, 0.0, 0.0], [8.5, 0.0, 0.0], [0.0, 1.0, 0.0]]),
        (5.0, [[0.0, 0.0, 0.5], [8.5, 3.0, 1.0], [0.0, 1.0, 2.0]]),
        (99.0, [[0.0, 0.0, 1.0], [8.5, 6.0, 2.0], [0.0, 1.0, 4.0]]),
    ] {
        assert_eq!(positions(&scene.at_frame(frame).expect("it can be rendered")), expected, "{frame}");
    }
    assert_eq!(scene.animation.frames(), Some([0.0, 10.0]));
}

/// A motion of the shape moves the deformed mesh.
#[test]
fn joints_are_about_where_the_shape_stands() {
    let place = "transform = { rotate = [0, 0, 1], degrees = 90 }";
    let scene = load(&format!("{place}\n{KEYS}"), JSON).unwrap_or_else(|error| panic!("{error}"));
    let turned = scene.at_frame(10.0).expect("it can be rendered").shapes[0].world_positions()[1];
    // (8.5, 0) is turned to (0, 8.5), and three quarters of the lift are added in the world.
    assert!((turned - Vec3::new(0.0, 14.5, 2.0)).length() < 1e-5, "{turned}");
}

#[test]
fn what_does_not_fit_is_refused_with_its_place() {
    let rows: [(&str, &str, &str, &str, &str); 9] = [
        (KEYS, "node = \"lift\"", "node = \"left\"", "", "there is no node named `left`"),
        (KEYS, "weights = [0.5]", "weights = [0.5, 1]", "", "there are 2 weights for 1 targets"),
        (KEYS, "weights = [1] }", "weights = [] }", "", "there are 0 weights for 1 targets"),
        (KEYS, "bent.json", "absent.json", "", "absent.json: cannot be read"),
        (KEYS, "joints = [{}, ", "joints = [", "", "hangs on joint 1, and there are 1"),
        (KEYS, "", "", "{ \"influences\": [[[0, 1]]], \"targets\": [{}] }", "joints take along 1 vertices, and the mesh has 3"),
        (KEYS, "", "", "{\n\"influences\": 7 }", "bent.json:2:1: is no deformation"),
        (KEYS, "", "", "{ \"targets\": [{ \"positions\": [[0, 0, 1e300]] }] }", "number out of range"),
        (
            "deformation = { file = \"bent.json\", interpolation = \"step\" }",
            "",
            "",
            "",
            "`interpolation` belongs to `keyframes`",
        ),
    ];
    for (keys, from, to, json, expected) in rows {
        let json = if json.is_empty() { JSON } else { json };
        let message = load(&keys.replace(from, to), json).expect_err(expected);
        assert!(message.contains(expected), "{message}, not {expected}");
    }
}
