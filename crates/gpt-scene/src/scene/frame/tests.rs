use std::path::Path;

use glam::{DAffine3, DVec3, Vec3};

use super::*;
use crate::load::load_toml_str;
use crate::scene::{BlendWeight, ColorInput, EnvironmentRadiance, Light, MaterialKind, Projection};
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
    for frame in [f64::NAN, f64::INFINITY] {
        assert!(scene.at_frame(frame).is_err_and(|invalid| invalid.message == "a frame is a finite number"));
    }
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

/// A scene of materials with keyframes.
fn aging(materials: &str) -> Result<Scene, crate::load::SceneError> {
    let text = "camera = { position = [0, 0, 5], look_at = [0, 0, 0], vfov = 40 }\n\
        shape = [{ type = \"sphere\", center = [0, 0, 0], radius = 1, material = \"shown\" }]\n\
        light = [{ type = \"point\", position = [1, 0, 5], intensity = 2 }]\n";
    load_toml_str(&format!("{text}{materials}"), "aging", Path::new(""))
}

/// The colour, if it is no texture.
fn constant(input: ColorInput) -> Spectrum {
    let ColorInput::Constant(color) = input else { panic!("{input:?}") };
    color
}

/// A key that a keyframe leaves out goes through those that state it: the exponent from 10 at frame 0 to 30 at frame 10, the colours by frame 4.
#[test]
fn materials_go_through_their_keys() {
    let scene = aging(
        "[[material]]\nname = \"shown\"\ntype = \"phong\"\ndiffuse = 0.9\nspecular = 0.1\nexponent = 10\nkeyframes = [\n\
         { frame = 0, exponent = 10, diffuse = 0.9, specular = 0.1 }, { frame = 4, diffuse = [0.1, 0.3, 0.1], specular = 0.7 },\n\
         { frame = 10, exponent = 30 }]\n",
    )
    .expect("the scene is valid");
    assert_eq!(scene.animation.frames(), Some([0.0, 10.0]));
    for (frame, colors, power) in [(2.0, [0.5, 0.6, 0.4], 14.0), (4.0, [0.1, 0.3, 0.7], 18.0), (12.0, [0.1, 0.3, 0.7], 30.0)] {
        let at = scene.at_frame(frame).expect("a frame");
        let MaterialKind::Phong { diffuse, specular, exponent } = at.materials[0].kind else { panic!("{:?}", at.materials[0]) };
        let found = [constant(diffuse).r(), constant(diffuse).g(), constant(specular).r()];
        assert!(found.iter().zip(colors).all(|(a, b)| (a - b).abs() < 1e-12), "{frame}: {found:?}");
        assert!((constant(exponent).r() - power).abs() < 1e-12, "{frame}: {exponent:?}");
        assert!(!at.shapes_stand_as_in(&scene), "it looks otherwise");
    }
    let rest = scene.at_frame(0.0).expect("a frame");
    assert!(rest.shapes_stand_as_in(&scene.at_frame(-1.0).expect("a frame")));
}

/// Widths go evenly in their roots, weights in their numbers, and light comes out of darkness.
#[test]
fn roughness_weights_and_emission_have_keys() {
    let scene = aging(
        "[[material]]\nname = \"metal\"\ntype = \"conductor\"\npreset = \"gold\"\nroughness = 0.2\nopacity = 0.5\n\
         keyframes = [{ frame = 0, roughness = 0.2 }, { frame = 10, roughness = 0.6, emission = 3 }, { frame = 0x14, emission = 0 }]\n\
         [[material]]\nname = \"red\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
         [[material]]\nname = \"shown\"\ntype = \"blend\"\nmaterials = [\"metal\", \"red\"]\n\
         weight = { type = \"threshold\", tau = 0, of = { type = \"facing\", power = 1 } }\n\
         keyframes = [{ frame = 0, weight = { type = \"threshold\", tau = 0, of = { type = \"facing\", power = 1 } } },\n\
         { frame = 10, weight = { type = \"threshold\", tau = 1, of = { type = \"facing\", power = 3 } } }]\n",
    )
    .expect("the scene is valid");
    let at = scene.at_frame(5.0).expect("a frame");
    let MaterialKind::Blend { ref weight, .. } = at.materials[2].kind else { panic!("a blend") };
    let halfway = BlendWeight::Threshold { tau: 0.5, of: Box::new(BlendWeight::Facing { power: 2.0 }) };
    assert_eq!(*weight, halfway);
    // The metal is keyed, which a blend with nothing stands for.
    let metal = at.materials[0].parts()[0];
    let MaterialKind::Conductor { facets, .. } = &at.materials[metal].kind else { panic!("{:?}", at.materials[metal]) };
    assert!((constant(facets.alpha).r() - 0.16).abs() < 1e-12, "{facets:?}");
    let radiance =
        |frame: f64| scene.at_frame(frame).expect("a frame").materials[metal].emission.map(|emission| emission.radiance);
    assert_eq!(
        [radiance(10.0), radiance(15.0), radiance(20.0)],
        [Some(ColorInput::grey(3.0)), Some(ColorInput::grey(1.5)), None]
    );
    assert_eq!(scene.materials[metal].emission, None, "without a frame it is dark");
}

#[test]
fn keyframes_change_numbers_alone() {
    let diffuse = |keys: &str| aging(&format!("[[material]]\nname = \"shown\"\ntype = \"diffuse\"\nreflectance = 0.5\n{keys}"));
    let texture = "[[texture]]\nname = \"tiles\"\ntype = \"checker\"\na = 0\nb = 1\nscale = [1, 1]\n";
    for (keys, message) in [
        ("keyframes = [{ frame = 0 }]", "states one of the keys"),
        ("keyframes = [{ frame = 0, exponent = 3 }]", "exponent"),
        ("keyframes = [{ frame = 0, reflectance = 1.5 }]", "reflectance"),
        ("keyframes = [{ frame = 3, reflectance = 0.5 }, { frame = 3, reflectance = 1 }]", "the order of their frames"),
        ("interpolation = \"step\"", "of which there are none"),
        (&format!("keyframes = [{{ frame = 0, reflectance = {{ texture = \"tiles\" }} }}]\n{texture}"), "changes more"),
    ] {
        let error = diffuse(keys).expect_err(keys).to_string();
        assert!(error.contains(message), "{keys}: {error}");
    }
    assert!(diffuse("keyframes = [{ frame = 0, reflectance = 1 }]").is_ok(), "the control");
}
