//! Cameras that see around, through calibrated lenses and with two eyes: where they show things, what files of calibrations say, and what is written.

use std::path::Path;

use gpt::cpu::ReferenceRenderer;
use gpt::film::KernelLayer;
use gpt::load;
use gpt::reference::layer::layer_scene;
use gpt::scene::Scene;

use crate::common::projections::{farthest_off, projections, within_a_sphere};

/// Every pixel sees the point that the camera's formula shows at its middle, to a thousandth of a pixel; with other keys it does not.
#[test]
fn every_camera_shows_points_where_its_formula_says() {
    for case in projections() {
        let off = |keys: &str| {
            let scene = within_a_sphere(case.size, keys);
            let layer = layer_scene(&scene, KernelLayer::Position);
            let mut renderer = ReferenceRenderer::of_layer(&layer, Some(KernelLayer::Position)).expect("it can be rendered");
            farthest_off(&mut renderer, &scene, &case)
        };
        let (right, wrong) = (off(case.keys), off(case.wrong));
        assert!(right < 1e-3, "{}: {right} pixels", case.name);
        assert!(wrong > 1e-3, "{}: the control is off by {wrong} pixels alone", case.name);
    }
}

fn with_camera(size: &str, keys: &str) -> String {
    format!(
        "{size}[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n{keys}[[light]]\ntype = \"environment\"\nradiance = 1\n\
         [[material]]\nname = \"m\"\ntype = \"diffuse\"\nreflectance = 0.5\n[[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\n"
    )
}

#[test]
fn every_camera_comes_back_from_a_scene_file() {
    for example in load::file::CAMERA_EXAMPLES {
        let size = format!("[film]\nsize = [{}, {}]\n", example.size[0], example.size[1]);
        let scene = load::load_toml_str(&with_camera(&size, example.keys), "test.toml", Path::new("")).expect(example.name);
        let written = gpt::scene_writer::as_scene_file(&scene, Path::new("out.toml")).expect("it can be written");
        let text = String::from_utf8(written.content).expect("text");
        let read = load::load_toml_str(&text, "out.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(read.camera, scene.camera, "{}\n{text}", example.name);
        // Negative control: the comparison sees another camera.
        assert_ne!(read.camera, Scene::default().camera);
    }
}

/// A scene whose camera has this calibration, from a file of this name.
fn calibrated(name: &str, text: &str, size: &str, keys: &str) -> Result<Scene, String> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join(name), text).expect("the file is written");
    let scene = with_camera(size, &format!("calibration = \"{name}\"\n{keys}"));
    let of_folder = |error: load::SceneError| {
        let help = error.help_text().map_or_else(String::new, |help| format!(" [{help}]"));
        format!("{error}{help}").replace(&format!("{}/", folder.path().display()), "")
    };
    load::load_toml_str(&scene, "test.toml", folder.path()).map_err(of_folder)
}

const OPENCV_YAML: &str = "%YAML:1.0
---
calibration_time: \"Sat 28 Nov 2026\"
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.5e+02, 0., 3.195e+02, 0., 5.4e+02, 2.395e+02, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -0.3, 0.1, 1.0e-03,
       -2.0e-03, 0.02 ]
avg_reprojection_error: 0.25
";

/// All say the same, each in its way.
#[test]
fn calibrations_are_read() {
    let of = |name: &str, text: &str, keys: &str| calibrated(name, text, "", keys).unwrap_or_else(|error| panic!("{error}"));
    let json = r#"{ "camera_matrix": { "type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d", "data": [550, 0, 319.5, 0, 540, 239.5, 0, 0, 1] },
        "distortion_coefficients": { "rows": 1, "cols": 5, "data": [-0.3, 0.1, 0.001, -0.002, 0.02] }, "image_width": 640, "image_height": 480 }"#;
    let plain = r#"{ "camera_matrix": [[550, 0, 319.5], [0, 540, 239.5], [0, 0, 1]], "dist_coeff": [[-0.3, 0.1, 0.001, -0.002, 0.02]],
        "image_width": 640, "image_height": 480 }"#;
    let list = "# Camera list\n# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n\
                7 FULL_OPENCV 640 480 550 540 320 240 -0.3 0.1 0.001 -0.002 0.02 0 0 0\n\
                3 OPENCV_FISHEYE 640 480 200 201 320 240 0.01 0.002 0.0003 -0.00004\n9 SIMPLE_RADIAL 320 200 100 160 100 -0.1\n";
    let keys = "projection = \"brown_conrady\"\nfocal = [550, 540]\nprincipal_point = [320, 240]\nimage_size = [640, 480]\n\
                radial = [-0.3, 0.1, 0.02]\ntangential = [0.001, -0.002]\n";
    let by_hand = load::load_toml_str(&with_camera("", keys), "test.toml", Path::new("")).expect("it is right");
    for (name, text, keys) in [
        ("camera.yml", OPENCV_YAML, ""),
        ("camera.json", json, ""),
        ("plain.json", plain, "projection = \"brown_conrady\"\n"),
        ("cameras.txt", list, "calibration_id = 7\n"),
    ] {
        let scene = of(name, text, keys);
        assert_eq!(scene.camera, by_hand.camera, "{name}");
        assert_eq!(scene.film.size, [640, 480], "{name}");
    }
    // A picture with a size of its own keeps it.
    let small = calibrated("camera.yml", OPENCV_YAML, "[film]\nsize = [64, 48]\n", "").expect("it is right");
    assert_eq!((small.film.size, &small.camera), ([64, 48], &by_hand.camera));
    let fisheye = "projection = \"kannala_brandt\"\nfocal = [200, 201]\nprincipal_point = [320, 240]\nimage_size = [640, 480]\n\
                   radial = [0.01, 0.002, 0.0003, -0.00004]\n";
    let by_hand = load::load_toml_str(&with_camera("", fisheye), "test.toml", Path::new("")).expect("it is right");
    assert_eq!(of("cameras.txt", list, "calibration_id = 3\n").camera, by_hand.camera);
    let ros = "image_width: 640\nimage_height: 480\ncamera_name: front\ndistortion_model: equidistant\n\
               camera_matrix:\n  rows: 3\n  cols: 3\n  data: [200, 0, 319.5, 0, 201, 239.5, 0, 0, 1]\n\
               distortion_coefficients:\n  rows: 1\n  cols: 4\n  data: [0.01, 0.002, 0.0003, -0.00004]\n";
    assert_eq!(of("front.yaml", ros, "").camera, by_hand.camera);
    assert_eq!(
        of("front.yaml", &ros.replace("distortion_model: equidistant\n", ""), "projection = \"kannala_brandt\"\n").camera,
        by_hand.camera
    );
    // Negative control: another number is another camera.
    assert_ne!(of("front.yaml", &ros.replace("201", "202"), "").camera, by_hand.camera);
}

#[test]
fn calibrations_that_are_wrong_are_refused() {
    let list = "1 PINHOLE 640 480 500 500 320 240\n";
    let check = |name: &str, text: &str, keys: &str, expected: &str| {
        let found = calibrated(name, text, "", keys).err().unwrap_or_default();
        assert!(found.starts_with(expected), "{found}\nand not\n{expected}");
    };
    let edited = |from: &str, to: &str| {
        assert!(OPENCV_YAML.contains(from), "{from}");
        OPENCV_YAML.replace(from, to)
    };
    let yaml = |from: &str, to: &str, expected: &str| check("camera.yml", &edited(from, to), "", expected);
    yaml("camera_matrix", "matrix", "camera.yml:4:1: the key `camera_matrix` is missing");
    yaml("5.5e+02, 0.,", "5.5e+02,", "camera.yml:6:1: `camera_matrix` has 3 rows of 3 numbers, and these are 8 numbers");
    yaml("5.5e+02, 0.,", "5.5e+02, 1.,", "camera.yml:10:1: the matrix has a skew of 1");
    yaml("5.5e+02", "-5", "camera.yml:10:1: a focal length is above 0, and this is -5");
    yaml("5.5e+02", "many", "camera.yml:10:1: expected a number, found `many`");
    yaml("-0.3, 0.1,", "-0.3,", "camera.yml:15:1: there are 4 coefficients");
    yaml("image_width: 640", "image_width: 6.5", "camera.yml:4:1: `image_width` is a whole number of at least 1, not 6.5");
    yaml("image_width: 640\n", "", "camera.yml:4:1: `image_width` and `image_height` go together");
    yaml("rows: 3", "rows: [3", "camera.yml:");
    yaml("avg_", "distortion_model: fov\navg_", "camera.yml:17:1: the distortion model `fov` cannot be said here");
    check(
        "camera.yml",
        OPENCV_YAML,
        "projection = \"kannala_brandt\"\n",
        "camera.yml:15:1: there are 5 coefficients, and such a camera has 4",
    );
    check("camera.yml", "", "", "camera.yml: is empty");
    check("camera.yml", &format!("a: {}{}", "[".repeat(100_000), "]".repeat(100_000)), "", "camera.yml:1:1: values are nested");
    check("camera.xml", OPENCV_YAML, "", "camera.xml: a calibration ends in .yml, .yaml or .json");
    check("camera.yml", OPENCV_YAML, "calibration_id = 2\n", "test.toml:5:18: camera.calibration_id: camera.yml has no camera 2");
    check(
        "cameras.txt",
        list,
        "focal = [1, 1]\n",
        "test.toml:5:9: camera.focal: `focal` is in the file that `calibration` names",
    );
    check("cameras.txt", "", "", "cameras.txt: has no cameras");
    check(
        "cameras.txt",
        &format!("{list}2 PINHOLE 640 480 500 500 320\n"),
        "",
        "cameras.txt:2:1: PINHOLE has 4 parameters, and these are 3",
    );
    check(
        "cameras.txt",
        &list.replace("PINHOLE", "PINHOLES"),
        "",
        "cameras.txt:1:1: the camera model `PINHOLES` cannot be said here [did you mean `PINHOLE`?",
    );
    check("cameras.txt", &list.replace("PINHOLE", "FOV"), "", "cameras.txt:1:1: the camera model `FOV` cannot be said here");
    check("cameras.txt", &list.replace("640", "0"), "", "cameras.txt:1:1: a picture of 0 × 480 pixels has none");
    check("cameras.txt", &format!("{list}{list}"), "", "cameras.txt:2:1: a second camera has the number 1");
    let two = format!("{list}{}", list.replace("1 ", "2 "));
    check(
        "cameras.txt",
        &two,
        "",
        "test.toml:4:15: camera.calibration: cameras.txt has 2 cameras: `calibration_id` says which one is meant [it has 1, 2]",
    );
    check(
        "cameras.txt",
        &two,
        "projection = \"kannala_brandt\"\n",
        "cameras.txt:1:1: the camera model PINHOLE is another than `projection` says",
    );
    let missing = load::load_toml_str(&with_camera("", "calibration = \"nowhere.yml\"\n"), "test.toml", Path::new(""))
        .expect_err("no file");
    assert_eq!(missing.to_string(), "test.toml:4:15: camera.calibration: there is no file nowhere.yml");
}

/// A part of a lens's picture that stays black is told of.
#[test]
fn a_lens_that_turns_back_is_warned_of() {
    let scene = |k1: f64| {
        let keys = format!("projection = \"brown_conrady\"\nfocal = [200, 200]\nradial = [{k1}]\n");
        load::load_toml_str(&with_camera("", &keys), "test.toml", Path::new("")).expect("it is right")
    };
    let warnings = scene(-0.3).warnings;
    assert!(warnings.len() == 1 && warnings[0].contains("% of the picture see nothing"), "{warnings:?}");
    assert!(scene(0.3).warnings.is_empty());
}
