use std::path::Path;

use glam::{DAffine3, DVec3, Vec3};

use super::*;
use crate::load::load_toml_str;
use crate::scene::{EnvironmentRadiance, Light, Projection};
use crate::spectrum::Spectrum;

fn scene(more: &str) -> Scene {
    let text = format!(
        "[animation]\nfps = 5\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvfov = 40\nshutter = [0, 0.5]\n{more}\n\
         [[light]]\ntype = \"environment\"\nradiance = 1\n"
    );
    load_toml_str(&text, "scene", Path::new("")).expect("the scene is valid")
}

const MESH: &str = "[[material]]\nname = \"a\"\ntype = \"diffuse\"\nreflectance = 0.5\n[[shape]]\ntype = \"mesh\"\nmaterial = \"a\"\n\
    positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n";

/// The corners at a shutter time of a frame.
fn corners(scene: &Scene, frame: f64, time: f64) -> Vec<Vec3> {
    let scene = scene.at_frame(frame).expect("it can be rendered");
    let shape = &scene.shapes[0];
    let along = shape.moved_by(time).unwrap_or(DAffine3::IDENTITY);
    shape.world_positions().into_iter().map(|corner| along.transform_point3(corner.as_dvec3()).as_vec3()).collect()
}

fn is_at(found: &[Vec3], expected: [[f32; 3]; 3]) -> bool {
    found.iter().zip(expected).all(|(found, expected)| (*found - Vec3::from(expected)).length() < 1e-5)
}

#[test]
fn a_scene_without_keyframes_has_no_animation() {
    let scene = scene(MESH);
    assert!(scene.animation.is_empty() && scene.animation.shapes.is_empty());
    assert_eq!(scene.at_frame(7.0).expect("it is the same").camera, scene.camera);
}

/// By hand: half way there the shape is turned by 45 degrees, and while the shutter is open it goes on with the same speed.
#[test]
fn shapes_stand_where_their_keyframes_put_them_and_move_on_while_the_shutter_is_open() {
    let keys = "keyframes = [{ frame = 0, translate = [0, 0, 0], rotate = [0, 0, 1], degrees = 0 }, \
                { time = 2, translate = [10, 0, 0], rotate = [0, 0, 1], degrees = 90 }]";
    let scene = scene(&format!("{MESH}transform = [{{ translate = [7, 7, 7] }}]\n{keys}\n"));
    assert_eq!(scene.animation.frames(), Some([0.0, 10.0]));
    assert!(is_at(&scene.shapes[0].world_positions(), [[7.0, 7.0, 7.0], [8.0, 7.0, 7.0], [7.0, 8.0, 7.0]]));
    let h = std::f32::consts::FRAC_1_SQRT_2;
    assert!(is_at(&corners(&scene, 5.0, 0.0), [[5.0, 0.0, 0.0], [5.0 + h, h, 0.0], [5.0 - h, h, 0.0]]));
    let (sin, cos) = 49.5_f32.to_radians().sin_cos();
    let closing = [[5.5, 0.0, 0.0], [5.5 + cos, sin, 0.0], [5.5 - sin, cos, 0.0]];
    assert!(is_at(&corners(&scene, 5.0, 0.5), closing), "{:?}", corners(&scene, 5.0, 0.5));
    // The control: at another time it is elsewhere.
    assert!(!is_at(&corners(&scene, 5.0, 0.4), closing));
    assert!(scene.at_frame(99.0).expect("it rests").shapes[0].motion.is_none());
}

/// A node within a node, each turned by a quarter: what they take along is turned by half a turn about the outer one, after the inner one moved it.
#[test]
fn nodes_take_along_what_names_them_and_each_other() {
    let nodes = "[[node]]\nname = \"outer\"\nkeyframes = [{ frame = 0, rotate = [0, 0, 1], degrees = 0 }, { frame = 10, rotate = [0, 0, 1], degrees = 90 }]\n\
        [[node]]\nname = \"inner\"\nparent = \"outer\"\ntransform = [{ translate = [2, 0, 0] }]\n\
        keyframes = [{ frame = 0, translate = [2, 0, 0] }, { frame = 10, translate = [4, 0, 0] }]\n";
    let scene = scene(&format!("node = \"outer\"\n{nodes}{MESH}node = \"inner\"\n"));
    assert!(is_at(&corners(&scene, 0.0, 0.0), [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
    // The shape stands at the origin, which the inner node takes along by (2, 0, 0), and the outer one turns.
    let found = corners(&scene, 10.0, 0.0);
    assert!(is_at(&found, [[0.0, 2.0, 0.0], [0.0, 3.0, 0.0], [-1.0, 2.0, 0.0]]), "{found:?}");
    let camera = scene.at_frame(10.0).expect("it can be rendered").camera;
    assert!((camera.up - DVec3::NEG_X).length() < 1e-12 && (camera.position - DVec3::Z * 5.0).length() < 1e-12, "{camera:?}");
}

#[test]
fn the_camera_goes_through_its_keyframes() {
    let keys = "keyframes = [{ frame = 0, position = [0, 0, 5] }, { frame = 4, vfov = 20 }, { frame = 10, position = [10, 0, 5], vfov = 50 }]\n";
    let scene = scene(&format!("{keys}{MESH}"));
    let camera = scene.at_frame(7.0).expect("it can be rendered").camera;
    assert_eq!((camera.position, camera.look_at), (DVec3::new(7.0, 0.0, 5.0), DVec3::ZERO));
    assert_eq!(camera.projection, Projection::Perspective { vertical_fov_degrees: 35.0 });
    let moved = scene.at_frame(7.0).expect("it can be rendered");
    assert!(moved.shapes_stand_as_in(&scene.at_frame(6.0).expect("it can be rendered")));
    assert_ne!(crate::scene::digest(&moved), crate::scene::digest(&scene));
}

/// The camera goes on while the shutter is open, to where it is as it closes; where it rests, and where keys jump, it is still.
#[test]
fn the_camera_moves_while_the_shutter_is_open() {
    let keys = "keyframes = [{ frame = 0, position = [0, 0, 5] }, { frame = 4, vfov = 20 }, { frame = 10, position = [10, 0, 5], vfov = 50 }]\n";
    let keyed = scene(&format!("{keys}{MESH}"));
    let exposed = keyed.at_frame(7.0).expect("it can be rendered");
    let ends = [&exposed.exposure[0], &exposed.exposure[crate::scene::EXPOSURE_STRETCHES]];
    assert_eq!(ends.map(|camera| camera.position), [DVec3::new(7.0, 0.0, 5.0), DVec3::new(7.5, 0.0, 5.0)]);
    let fov = [35.0, 37.5].map(|vertical_fov_degrees| Projection::Perspective { vertical_fov_degrees });
    assert_eq!(ends.map(|camera| camera.projection), fov);
    assert!(!exposed.shapes_stand_as_in(&keyed), "one moves, one rests");
    // With other things equal, the exposure makes another picture.
    let still = Scene { exposure: Vec::new(), ..exposed.clone() };
    assert_ne!(crate::scene::digest(&still), crate::scene::digest(&exposed));
    assert!(keyed.at_frame(20.0).expect("it can be rendered").exposure.is_empty(), "it rests");
    let jumping = scene(&format!("interpolation = \"step\"\n{keys}{MESH}"));
    assert!(jumping.at_frame(9.75).expect("it can be rendered").exposure.is_empty(), "it jumps");
    let keys = "keyframes = [{ frame = 0, translate = [0, 0, 0] }, { frame = 1, translate = [0, 2, 0] }]\n";
    for (interpolation, moves) in [("step", false), ("linear", true)] {
        let shape =
            scene(&format!("{MESH}interpolation = \"{interpolation}\"\n{keys}")).at_frame(0.75).expect("it can be rendered");
        assert_eq!(shape.shapes[0].motion.is_some(), moves, "{interpolation}");
    }
    let taken = "node = \"cart\"\n[[node]]\nname = \"cart\"\nkeyframes = [{ frame = 0, translate = [0, 0, 0] }, { frame = 1, translate = [0, 2, 0] }]\n";
    let taken = scene(&format!("{taken}{MESH}")).at_frame(0.5).expect("it can be rendered");
    assert_eq!(taken.exposure[crate::scene::EXPOSURE_STRETCHES].position, DVec3::new(0.0, 2.0, 5.0));
    let through = "keyframes = [{ frame = 0, position = [0, 0, 1] }, { frame = 1, position = [0, 0, -1] }]\n";
    let error = scene(&format!("{through}{MESH}")).at_frame(0.0).expect_err("it meets what it looks at");
    assert!(error.to_string().contains("while the shutter is open"), "{error}");
}

/// A scene whose lights have keyframes, and a node that takes two of them along.
fn lit() -> Scene {
    let text = "animation.fps = 10\n\
        camera = { position = [0, 0, 5], look_at = [0, 0, 0], vfov = 40, shutter = [0, 0] }\n\
        node = [{ name = \"turn\", keyframes = [{ frame = 0, rotate = [0, 1, 0], degrees = 0 }, { frame = 10, rotate = [0, 1, 0], degrees = 90 }] }]\n\
        [[light]]\ntype = \"point\"\nposition = [1, 0, 0]\nintensity = 2\n\
        keyframes = [{ frame = 0, position = [1, 0, 0] }, { time = 1, position = [3, 2, 0], intensity = [0, 4, 8] }]\n\
        [[light]]\ntype = \"spot\"\nposition = [1, 0, 0]\ndirection = [1, 0, 0]\nintensity = 2\nangle = 30\nnode = \"turn\"\n\
        [[light]]\ntype = \"directional\"\ndirection = [0, -1, 0]\nirradiance = 1\ninterpolation = \"smooth\"\n\
        keyframes = [{ frame = 0, direction = [0, -2, 0], irradiance = 1 }, { frame = 10, direction = [0, 0, -1], irradiance = 3 }]\n\
        [[light]]\ntype = \"environment\"\nradiance = 0.5\nscale = 2\nkeyframes = [{ frame = 0, radiance = 1, rotate = 0 }, { frame = 10, radiance = 2, rotate = 50 }]\n";
    load_toml_str(text, "lit", Path::new("")).expect("the scene is valid")
}

/// Lights are looked at halfway between two keys and at the last: where they are, and how bright.
#[test]
fn lights_go_through_their_keys_and_are_taken_along() {
    let scene = lit();
    assert_eq!(scene.animation.frames(), Some([0.0, 10.0]));
    let near = |a: DVec3, b: [f64; 3]| (a - DVec3::from_array(b)).length() < 1e-12;
    let shines = |a: Spectrum, b: [f64; 3]| a.distance(Spectrum::from_rgb(b)) < 1e-12;
    let half = std::f64::consts::FRAC_1_SQRT_2;
    for (frame, place, axis, sun, shine) in [
        (5.0, [2.0, 1.0, 0.0], [half, 0.0, -half], [0.0, -half, -half], 2.0),
        (10.0, [3.0, 2.0, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, -1.0], 3.0),
    ] {
        let at = scene.at_frame(frame).expect("it can be rendered");
        let [Light::Point(point), Light::Spot(spot), Light::Directional(directional), Light::Environment(environment)] =
            &at.lights[..]
        else {
            panic!("{:?}", at.lights)
        };
        assert!(near(point.position, place) && shines(point.intensity, [0.0, 4.0, 8.0]), "{point:?}");
        assert!(near(spot.position, axis) && near(spot.direction, axis), "{spot:?}");
        assert!(near(directional.direction, sun) && shines(directional.irradiance, [shine; 3]), "{directional:?}");
        assert_eq!(environment.rotation_degrees, 5.0 * frame);
        let EnvironmentRadiance::Constant(radiance) = environment.radiance else { panic!("it has no map") };
        assert!(shines(radiance, [2.0 + 0.2 * frame; 3]), "{radiance}");
        // The control: without a frame they are what stands beside the keys.
        assert!(!at.shapes_stand_as_in(&scene), "the lights shine otherwise");
    }
    let rest = scene.lights[0].delta().expect("a point light");
    assert_eq!((rest.position, rest.color), (DVec3::X, Spectrum::grey(2.0)));
    assert!(scene.at_frame(3.0).expect("a frame").shapes_stand_as_in(&scene.at_frame(3.0).expect("a frame")));
}
