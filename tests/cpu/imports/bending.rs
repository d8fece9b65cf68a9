//! Meshes of glTF that are bent at frames: skins and morph targets.

use std::f32::consts::FRAC_1_SQRT_2;

use glam::Vec3;
use gpt::scene::Scene;
use serde_json::json;

use super::gltf::{File, mesh};
use super::{Folder, picture, report};

/// A sheet along +x from 0 to 2 that two bones take along, the second one from x = 1 on; it is turned by 90 degrees about +z within a second.
/// Vertices at x = 1 hang on both by half.
fn arm() -> File {
    let mut file = File::new();
    let places = [0.0, 1.0, 2.0].map(|x| [[x, 0.0, 0.0], [x, 0.5, 0.0]]);
    let positions = file.add("VEC3", places.as_flattened().as_flattened());
    let normals = file.add("VEC3", &[0.0, 0.0, 1.0].repeat(6));
    let indices = file.bytes(&[0, 2, 3, 0, 3, 1, 2, 4, 5, 2, 5, 3]);
    let indices = file.enter(json!({ "bufferView": indices, "componentType": 5121, "type": "SCALAR", "count": 12 }));
    // 16-bit joints, and 8-bit weights that stand for fractions.
    let joints: Vec<u8> = [0_u16, 1, 0, 0].repeat(6).into_iter().flat_map(u16::to_le_bytes).collect();
    let joints = file.bytes(&joints);
    let joints = file.enter(json!({ "bufferView": joints, "componentType": 5123, "type": "VEC4", "count": 6 }));
    let weights = [[255, 0, 0, 0], [127, 127, 0, 0], [0, 255, 0, 0]].map(|weights| [weights; 2]);
    let weights = file.bytes(weights.as_flattened().as_flattened());
    let weights =
        file.enter(json!({ "bufferView": weights, "componentType": 5121, "type": "VEC4", "count": 6, "normalized": true }));
    let mut binds = [0.0; 32];
    for bone in 0..2 {
        (0..4).for_each(|at| binds[16 * bone + 5 * at] = 1.0);
    }
    // The elbow's space begins at x = 1.
    binds[16 + 12] = -1.0;
    let binds = file.add("MAT4", &binds);
    file.root["meshes"] = json!([{ "primitives": [{ "material": 0, "indices": indices, "attributes": {
        "POSITION": positions, "NORMAL": normals, "JOINTS_0": joints, "WEIGHTS_0": weights } }] }]);
    file.root["skins"] = json!([{ "joints": [3, 4], "inverseBindMatrices": binds }]);
    file.root["nodes"][0] = json!({ "mesh": 0, "skin": 0, "translation": [50.0, 0.0, 0.0] });
    let nodes = file.root["nodes"].as_array_mut().expect("a list");
    nodes.push(json!({ "name": "shoulder", "children": [4] }));
    nodes.push(json!({ "name": "elbow", "translation": [1.0, 0.0, 0.0] }));
    file.root["scenes"] = json!([{ "nodes": [0, 1, 2, 3] }]);
    let times = file.add("SCALAR", &[0.0, 1.0]);
    let turns = file.add("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2]);
    file.root["animations"] = json!([{
        "channels": [{ "sampler": 0, "target": { "node": 4, "path": "rotation" } }],
        "samplers": [{ "input": times, "output": turns }],
    }]);
    file
}

fn at(scene: &Scene, seconds: f64) -> Scene {
    scene.at_frame(seconds * scene.animation.frames_per_second).expect("it can be rendered")
}

fn is_near(found: &[Vec3], expected: &[[f32; 3]]) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((*found - Vec3::from(*expected)).length() < 1e-6, "{found} and not {expected:?}");
    }
}

/// By hand: about (1, 0), (2, y) goes to (1 − y, 1); (1, y), which hangs on both, to the middle of (1, y) and (1 − y, 0). The angle goes evenly.
#[test]
fn an_arm_bends_at_its_elbow() {
    let scene = arm().read();
    assert_eq!(report(&scene), "");
    let rest = [[0.0, 0.0, 0.0], [0.0, 0.5, 0.0], [1.0, 0.0, 0.0], [1.0, 0.5, 0.0], [2.0, 0.0, 0.0], [2.0, 0.5, 0.0]];
    is_near(&mesh(&scene, 0).positions, &rest);
    let bent = [[0.0, 0.0, 0.0], [0.0, 0.5, 0.0], [1.0, 0.0, 0.0], [0.75, 0.25, 0.0], [1.0, 1.0, 0.0], [0.5, 1.0, 0.0]];
    is_near(&mesh(&at(&scene, 1.0), 0).positions, &bent);
    let half = FRAC_1_SQRT_2;
    is_near(&mesh(&at(&scene, 0.5), 0).positions[4..], &[[1.0 + half, half, 0.0], [1.0 + 0.5 * half, 1.5 * half, 0.0]]);
    // The turn is about the normals.
    is_near(&mesh(&at(&scene, 1.0), 0).normals, &[[0.0, 0.0, 1.0]; 6]);
}

/// The bent arm and the same vertices in a scene file make the same picture, and so does the scene file that the import writes; the arm at rest and a
/// moment earlier do not.
#[test]
fn what_is_bent_is_the_mesh_that_it_becomes() {
    let folder = Folder::new(&[("a.gltf", &arm().text())]);
    let scene = folder.valid("a.gltf");
    let bent = at(&scene, 1.0);
    let mesh = mesh(&bent, 0);
    let list =
        |vectors: &[Vec3]| vectors.iter().map(|v| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)).collect::<Vec<_>>().join(", ");
    let toml = format!(
        "[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = {}\n[film]\nsize = [512, 256]\n\
         [[material]]\nname = \"red\"\ntype = \"diffuse\"\nreflectance = [0.7, 0.2, 0.1]\n\
         [[shape]]\ntype = \"mesh\"\nmaterial = \"red\"\npositions = [{}]\nnormals = [{}]\nfaces = {:?}\n\
         [[light]]\ntype = \"point\"\nposition = [1, 2, 3]\nintensity = [40, 20, 10]\n",
        0.7_f64.to_degrees(),
        list(&mesh.positions),
        list(&mesh.normals),
        mesh.faces,
    );
    std::fs::write(folder.path("b.toml"), toml).expect("it is written");
    let expected = picture(&folder.valid("b.toml"));
    assert_eq!(picture(&bent), expected);
    assert_eq!(picture(&at(&folder.written("a.gltf"), 1.0)), expected);
    assert_eq!(picture(&folder.written("a.gltf")), picture(&scene));
    for other in [scene.clone(), at(&scene, 0.9)] {
        assert_ne!(picture(&other), expected);
    }
    // Within another scene, moved there and back.
    let within = "[film]\nsize = [512, 256]\n[[import]]\nfile = \"a.gltf\"\ntransform = { translate = [0, 0, -3] }\n";
    std::fs::write(folder.path("c.toml"), within).expect("it is written");
    let placed = at(&folder.valid("c.toml"), 1.0);
    let corner = placed.shapes[0].world_positions()[5];
    assert!((corner - Vec3::new(0.5, 1.0, -3.0)).length() < 1e-6, "{corner}");
}

/// A scene that was read, saved and read again shows the same at every frame.
#[test]
fn saved_scenes_bend_alike() {
    let mut file = arm();
    let target = file.add("VEC3", &[0.0, 0.0, 0.25].repeat(6));
    let turned = file.add("VEC3", &[0.5, 0.0, 0.0].repeat(6));
    file.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target, "NORMAL": turned }]);
    let counts = file.add("SCALAR", &[0.0, 1.0]);
    let animation = &mut file.root["animations"][0];
    let times = animation["samplers"][0]["input"].clone();
    animation["samplers"].as_array_mut().expect("a list").push(json!({ "input": times, "output": counts }));
    let channel = json!({ "sampler": 1, "target": { "node": 0, "path": "weights" } });
    animation["channels"].as_array_mut().expect("a list").push(channel);
    let folder = Folder::new(&[("a.gltf", &file.text())]);
    let scene = folder.valid("a.gltf");
    let target = folder.path("saved.toml");
    gpt::scene_writer::save_scene(&scene, &target).unwrap_or_else(|error| panic!("{error}"));
    let saved = folder.valid("saved.toml");
    for seconds in [0.0, 0.3, 1.0] {
        let (bent, other) = (at(&scene, seconds), at(&saved, seconds));
        assert_eq!(mesh(&bent, 0).positions, mesh(&other, 0).positions);
        assert_eq!(mesh(&bent, 0).normals, mesh(&other, 0).normals);
        assert_eq!(picture(&bent), picture(&other));
    }
    // By hand: half of the target, before the joints.
    let lifted = mesh(&at(&scene, 0.5), 0).positions[0];
    assert!((lifted - Vec3::new(0.0, 0.0, 0.125)).length() < 1e-6, "{lifted}");
    let normal = mesh(&at(&scene, 1.0), 0).normals[0];
    assert!((normal - Vec3::new(0.5, 0.0, 1.0).normalize()).length() < 1e-6, "{normal}");
}

/// Weights by each kind of interpolation, and of a target whose few offsets stand in a sparse accessor. By hand; a cubic at rest at both ends is
/// 3t² − 2t³.
#[test]
fn morph_weights_are_interpolated() {
    for (interpolation, values, expected) in [
        ("LINEAR", vec![0.0, 1.0], [0.25, 0.5]),
        ("STEP", vec![0.25, 1.0], [0.25, 0.25]),
        ("CUBICSPLINE", vec![0.0, 0.0, 0.0, 0.0, 1.0, 0.0], [0.15625, 0.5]),
    ] {
        let mut file = File::new();
        let places = file.bytes(&[2, 0]);
        let offsets = file.bytes(&[0.0_f32, 0.0, 4.0].map(f32::to_le_bytes).concat());
        let target = file.enter(json!({ "componentType": 5126, "type": "VEC3", "count": 3, "sparse": {
            "count": 1, "indices": { "bufferView": places, "componentType": 5121 }, "values": { "bufferView": offsets } } }));
        file.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
        let times = file.add("SCALAR", &[0.0, 1.0]);
        let values = file.add("SCALAR", &values);
        file.root["animations"] = json!([{
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "weights" } }],
            "samplers": [{ "input": times, "output": values, "interpolation": interpolation }],
        }]);
        let scene = file.read();
        for (seconds, expected) in [0.25, 0.5].into_iter().zip(expected) {
            let height = mesh(&at(&scene, seconds), 0).positions[2].z;
            assert!((height - 4.0 * expected).abs() < 1e-6, "{interpolation} at {seconds}: {height}");
        }
        assert_eq!(mesh(&scene, 0).positions[2].z, 0.0);
    }
}

#[test]
fn skins_that_do_not_fit_are_refused() {
    let refused = |change: &dyn Fn(&mut File), expected: &str| {
        let mut file = arm();
        change(&mut file);
        let message = file.refused();
        assert!(message.contains(expected), "{message}");
    };
    refused(&|file| file.root["skins"][0]["joints"] = json!([3, 17]), "its joint 17 is not part of the scene");
    refused(&|file| file.root["nodes"][0]["skin"] = json!(9), "there is no skins[9]");
    refused(&|file| file.root["nodes"][4]["children"] = json!([3]), "its own ancestor");
    refused(&|file| file.root["skins"][0]["joints"] = json!([3]), "hangs on joint 1, and there are 1");
    refused(&|file| file.root["skins"][0]["joints"] = json!([3, 4, 3]), "2 inverse bind matrices for 3 joints");
    let attributes = |file: &mut File, name: &str, value| file.root["meshes"][0]["primitives"][0]["attributes"][name] = value;
    refused(
        &|file| {
            let weights = file.add("VEC4", &[f32::NAN, 0.0, 0.0, 0.0].repeat(6));
            attributes(file, "WEIGHTS_0", json!(weights));
        },
        "with the weight NaN",
    );
    refused(
        &|file| {
            let weights = file.add("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(5));
            attributes(file, "WEIGHTS_0", json!(weights));
        },
        "5 WEIGHTS_0 for 6 positions",
    );
    refused(&|file| attributes(file, "JOINTS_1", json!(4)), "it has JOINTS_1 and no WEIGHTS_1");
    refused(
        &|file| {
            let target = file.add("VEC3", &[0.0; 15]);
            file.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
        },
        "targets[0] has 5 POSITION for 6 vertices",
    );
    // The control.
    arm().read();
}
