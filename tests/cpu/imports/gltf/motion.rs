//! Motion and deformation in glTF.

use super::*;

#[test]
fn morph_targets_and_skins_bend_meshes() {
    let mut file = File::new();
    let target = file.add("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
    file.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
    file.root["meshes"][0]["weights"] = json!([0.5]);
    assert_eq!(mesh(&file.read(), 0).positions[2], glam::Vec3::new(0.0, 2.0, 0.0));
    let joints = file.bytes(&[0; 12]);
    let joints = file.enter(json!({ "bufferView": joints, "componentType": 5121, "type": "VEC4", "count": 3 }));
    let weights = file.add("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
    let attributes = &mut file.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    file.root["skins"] = json!([{ "joints": [3] }]);
    file.root["nodes"][0]["skin"] = json!(0);
    file.root["nodes"][0]["translation"] = json!([100.0, 0.0, 0.0]);
    file.root["nodes"].as_array_mut().expect("a list").push(json!({ "translation": [0.0, 0.0, 7.0] }));
    file.root["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    let scene = file.read();
    assert_eq!(mesh(&scene, 0).positions[2], glam::Vec3::new(0.0, 2.0, 7.0));
    assert_eq!(scene.shapes[0].origin(), glam::DVec3::ZERO);
    let times = file.add("SCALAR", &[0.0, 1.0]);
    let places = file.add("VEC3", &[0.0, 0.0, 7.0, 0.0, 0.0, 9.0]);
    let counts = file.add("SCALAR", &[0.5, 1.5]);
    let sampler = |output: usize| json!({ "input": times, "output": output });
    let channel = |sampler: u64, node: u64, path: &str| json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    let channels = [channel(0, 3, "translation"), channel(1, 0, "weights")];
    file.root["animations"] = json!([{ "channels": channels, "samplers": [sampler(places), sampler(counts)] }]);
    let scene = file.read();
    assert_eq!(report(&scene), "");
    // Without a time it is as the nodes have it.
    assert_eq!(mesh(&scene, 0).positions[2], glam::Vec3::new(0.0, 2.0, 7.0));
    for (seconds, expected) in [(0.0, [2.0, 7.0]), (0.5, [3.0, 8.0]), (9.0, [4.0, 9.0])] {
        let at = scene.at_frame(seconds * 24.0).expect("it can be rendered");
        assert_eq!(mesh(&at, 0).positions[2], glam::Vec3::new(0.0, expected[0], expected[1]), "{seconds}");
    }
}

/// The place of a corner of the first shape at a time in seconds.
fn corner(scene: &Scene, seconds: f64) -> glam::Vec3 {
    let scene = scene.at_frame(seconds * scene.animation.frames_per_second).expect("it can be rendered");
    scene.shapes[0].world_positions()[0]
}

/// A mesh below a node that turns, below one that stands still, below one that moves; each kind of interpolation. By hand.
#[test]
fn animations_become_keyframes() {
    let mut file = File::new();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let times = file.add("SCALAR", &[1.0, 3.0]);
    let turn = file.add("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half]);
    let moves = file.add("VEC3", &[0.0, 0.0, 0.0, 10.0, 0.0, 0.0]);
    let spline = file.add("VEC3", &[[0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3], [10.0, 0.0, 0.0], [0.0; 3]].concat());
    file.root["nodes"] = json!([
        { "mesh": 0, "name": "hand" },
        { "name": "eye", "camera": 0, "translation": [0.0, 0.0, 4.0] },
        { "extensions": { "KHR_lights_punctual": { "light": 0 } }, "translation": [1.0, 2.0, 3.0] },
        { "name": "body", "children": [4] },
        { "name": "shoulder", "translation": [0.0, 5.0, 0.0], "children": [0, 1, 2] },
    ]);
    file.root["scenes"][0]["nodes"] = json!([3]);
    let rest = file.read();
    let sampler =
        |output: usize, interpolation: &str| json!({ "input": times, "output": output, "interpolation": interpolation });
    let channel = |sampler: u64, node: u64, path: &str| json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    for (interpolation, output, at_two) in [("LINEAR", moves, 5.0), ("STEP", moves, 0.0), ("CUBICSPLINE", spline, 5.0)] {
        file.root["animations"] = json!([{
            "channels": [channel(0, 0, "rotation"), channel(1, 3, "translation")],
            "samplers": [sampler(turn, "LINEAR"), sampler(output, interpolation)],
        }]);
        let scene = file.read();
        // Without a frame nothing changes.
        let corners = |scene: &Scene| scene.shapes[0].world_positions();
        assert_eq!((corners(&scene), &scene.camera), (corners(&rest), &rest.camera));
        assert_eq!(report(&scene).contains("straight pieces"), interpolation == "CUBICSPLINE");
        // The body takes the light along.
        let light = |scene: &Scene| scene.lights[0].delta().expect("a light with a place").position;
        assert!(!report(&scene).contains("animation of a light"), "{}", report(&scene));
        assert!((light(&scene) - glam::DVec3::new(1.0, 7.0, 3.0)).length() < 1e-5, "{}", light(&scene));
        let at_three = scene.at_frame(72.0).expect("it can be rendered");
        assert!((light(&at_three) - glam::DVec3::new(11.0, 7.0, 3.0)).length() < 1e-5, "{}", light(&at_three));
        // The corner (-1, -1, 0) is turned by 0, 45 and 90 degrees about the shoulder's place, which the body moves.
        let near = |found: glam::Vec3, expected: [f32; 3]| {
            assert!((found - glam::Vec3::from(expected)).length() < 1e-4, "{interpolation} {found}")
        };
        near(corner(&scene, 0.0), [-1.0, 4.0, 0.0]);
        near(corner(&scene, 2.0), [at_two, 5.0 - 2.0 * half, 0.0]);
        near(corner(&scene, 3.0), [11.0, 4.0, 0.0]);
        let camera = scene.at_frame(72.0).expect("it can be rendered").camera;
        assert!((camera.position - glam::DVec3::new(10.0, 5.0, 4.0)).length() < 1e-5, "{}", camera.position);
    }
    // Cubics: three quarters of the way in time are 27/32 of the way along it, and straight pieces are near.
    let found = corner(&file.read(), 2.5).x + 67.5_f32.to_radians().cos() - 67.5_f32.to_radians().sin();
    assert!((found - 10.0 * 27.0 / 32.0).abs() < 0.05, "{found}");
}

#[test]
fn animations_that_are_broken_are_left_out_with_a_word() {
    for (animation, words) in [
        (json!({ "channels": 5 }), "it cannot be read"),
        (json!({ "channels": [{ "target": { "node": 99, "path": "scale" } }] }), "there is no nodes[99]"),
        (json!({ "channels": [{ "target": { "node": 0, "path": "scale" } }] }), "there is no samplers[0]"),
        (json!({ "channels": [{ "target": { "node": 0, "path": "colour" } }] }), "it moves the property `colour`"),
    ] {
        let mut file = File::new();
        file.root["animations"] = json!([animation]);
        let found = report(&file.read());
        assert!(found.contains(words), "{found}");
    }
}
