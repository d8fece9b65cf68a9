//! Lights that are wrong: each is one error that names the place, the key and what would be right. And some that look wrong and have a
//! meaning.

use std::path::Path;

use gpt::cpu::ReferenceRenderer;
use gpt::film::Band;
use gpt::load;
use gpt::load::SceneError;
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::Scene;

const HEADER: &str = r#"
[film]
size = [4, 4]
[render]
spp = 16
[camera]
position = [0, 1, 5]
look_at = [0, 0, 0]
vfov = 40
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.8
[[material]]
name = "lamp"
type = "emissive"
radiance = 5
[[material]]
name = "gone"
type = "pass"
[[shape]]
type = "rectangle"
corner = [-9, 0, 9]
edge_u = [18, 0, 0]
edge_v = [0, 0, -18]
material = "white"
"#;

fn load_in(folder: &Path, lights: &str) -> Result<Scene, SceneError> {
    load::load_toml_str(&format!("{HEADER}{lights}"), "test.toml", folder)
}

fn load(lights: &str) -> Scene {
    load_in(Path::new(""), lights).unwrap_or_else(|error| panic!("{error}"))
}

fn complaint_in(folder: &Path, lights: &str) -> String {
    match load_in(folder, lights) {
        Ok(_) => panic!("no complaint about\n{lights}"),
        Err(error) => match error.help_text() {
            Some(help) => format!("{error} [{help}]"),
            None => error.to_string(),
        },
    }
}

fn spot(keys: &str) -> String {
    format!("[[light]]\ntype = \"spot\"\nposition = [0, 3, 0]\nintensity = 1\n{keys}")
}

#[test]
fn numbers_and_directions_out_of_range_name_the_key() {
    let down = "direction = [0, -1, 0]";
    let rows = [
        (spot(&format!("{down}\nangle = 0")), "light[0].angle: expected an angle above 0, at most 90 (degrees), found 0"),
        (spot(&format!("{down}\nangle = 90.5")), "light[0].angle: expected an angle above 0, at most 90 (degrees), found 90.5"),
        (spot(&format!("{down}\nangle = nan")), "light[0].angle: "),
        (spot(&format!("{down}\nangle = 30\nfalloff = 31")), "light[0].falloff: `falloff` is at most `angle`, 30 degrees"),
        (spot(&format!("{down}\nangle = 30\nfalloff = -1")), "light[0].falloff: "),
        (spot("direction = [0, 0, 0]\nangle = 30"), "light[0].direction: a direction cannot have length 0"),
        (spot(down), "angle"),
        (
            "[[light]]\ntype = \"directional\"\ndirection = [0, 0, 0]\nirradiance = 1".into(),
            "light[0].direction: a direction cannot have length 0",
        ),
        ("[[light]]\ntype = \"directional\"\ndirection = [0, -1, 0]\nirradiance = -1".into(), "light[0].irradiance"),
        ("[[light]]\ntype = \"sky\"\nzenith = 1\nhorizon = -1\nground = 0".into(), "light[0].horizon"),
        (
            "[[light]]\ntype = \"environment\"\nradiance = 1\ntransform = [{ rotate = [1, 0, 0], degrees = 9 }, { scale = 2 }]"
                .into(),
            "the `transform` of an environment only turns it",
        ),
        (
            "[[light]]\ntype = \"environment\"\nradiance = 1\ntransform = [{ scale = [-1, 1, 1] }]".into(),
            "the `transform` of an environment only turns it",
        ),
        (
            "[[light]]\ntype = \"environment\"\nradiance = 1\ntransform = [{ translate = [0, 1, 0] }]".into(),
            "the `transform` of an environment only turns it",
        ),
        ("[[light]]\ntype = \"sky\"\nzenith = 1\nhorizon = 1".into(), "ground"),
        ("[[light]]\ntype = \"environment\"\nradiance = 1\nscale = -2".into(), "light[0].scale"),
        ("[[light]]\ntype = \"environment\"\nradiance = 1\nrotate = inf".into(), "light[0].rotate"),
        ("[[light]]\ntype = \"environment\"".into(), "an environment needs the key `radiance`, `file` or `daylight`"),
        ("[[light]]\ntype = \"environment\"\nradiance = 1\nfile = \"a.exr\"".into(), "either `radiance`, `file` or `daylight`"),
        (
            "[[light]]\ntype = \"environment\"\nradiance = 1\ndaylight = { to_sun = [0, 1, 0] }".into(),
            "either `radiance`, `file` or `daylight`",
        ),
        (
            "[[light]]\ntype = \"environment\"\ndaylight = { to_sun = [0, -1, 1] }".into(),
            "the sun is 45.0 degrees below the horizon",
        ),
        ("[[light]]\ntype = \"environment\"\ndaylight = { to_sun = [0, 0, 0] }".into(), "a direction cannot have length 0"),
        (
            "[[light]]\ntype = \"environment\"\ndaylight = { turbidity = 3 }".into(),
            "either `to_sun`, or `time`, `latitude` and `longitude`",
        ),
        (
            "[[light]]\ntype = \"environment\"\ndaylight = { to_sun = [0, 1, 0], turbidity = 1 }".into(),
            "a turbidity from 2 to 10",
        ),
        (
            "[[light]]\ntype = \"environment\"\ndaylight = { time = \"noon\", latitude = 1, longitude = 2 }".into(),
            "expected a time like \"2026-06-21T12:00:00+02:00\"",
        ),
        (
            "[[light]]\ntype = \"environment\"\ndaylight = { time = \"2026-12-21T00:00Z\", latitude = 50, longitude = 0 }".into(),
            "below the horizon",
        ),
        (
            "[[light]]\ntype = \"environment\"\nradiance = 1\n[[light]]\ntype = \"sky\"\nzenith = 1\nhorizon = 1\nground = 1"
                .into(),
            "a scene has one environment or sky, this is the second",
        ),
        ("[[light]]\ntype = \"laser\"".into(), "valid choices"),
    ];
    for (text, expected) in rows {
        let complaint = complaint_in(Path::new(""), &text);
        assert!(complaint.starts_with("test.toml:") && complaint.contains(expected), "{text}\n{complaint}");
    }
}

/// A flat map of one radiance with one texel replaced.
fn exr_with(folder: &Path, name: &str, odd: f32) {
    let texel = |x: usize, y: usize| if (x, y) == (2, 1) { (0.5, odd, 0.5) } else { (0.5, 0.5, 0.5) };
    exr::prelude::write_rgb_file(folder.join(name), 4, 2, texel).expect("the map is written");
}

fn environment(file: &str) -> String {
    format!("[[light]]\ntype = \"environment\"\nfile = \"{file}\"\n")
}

/// The header of a Radiance picture, without its pixels.
fn hdr_header(width: u32, height: u32) -> Vec<u8> {
    format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes()
}

#[test]
fn maps_that_are_no_light_are_one_error_at_the_file() {
    let [huge, empty] = [hdr_header(20_000, 20_000), hdr_header(0, 0)];
    let folder = tempfile::tempdir().expect("the system has a folder for temporary files");
    let files: [(&str, &[u8]); 4] =
        [("huge.hdr", &huge), ("empty.hdr", &empty), ("short.hdr", &hdr_header(8, 4)), ("text.exr", b"not a picture")];
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).expect("a new folder can be written to");
    }
    let path = folder.path();
    for (name, odd) in [("nan.exr", f32::NAN), ("infinite.exr", f32::INFINITY), ("negative.exr", -0.1)] {
        exr_with(path, name, odd);
        let scene = load_in(path, &environment(name)).unwrap_or_else(|error| panic!("{error}"));
        assert!(scene.warnings[0].contains("one texel that is negative or not finite"), "{:?}", scene.warnings);
    }
    for (name, expected) in [
        ("huge.hdr", "too large: 20000 x 20000 pixels, at most 16384 on a side"),
        ("empty.hdr", "empty.hdr"),
        ("short.hdr", "not a valid image"),
        ("text.exr", "not a valid EXR"),
        ("absent.exr", "absent.exr"),
        (".", "."),
    ] {
        let complaint = complaint_in(path, &environment(name));
        assert!(complaint.starts_with("test.toml:") && complaint.contains("light[0].file"), "{complaint}");
        assert!(complaint.contains(expected), "{complaint}");
    }
    exr_with(path, "good.exr", 0.5);
    assert!(load_in(path, &environment("good.exr")).is_ok());
    // The scaled radiance must be a number too.
    let scaled = format!("{}scale = 1e18\n", environment("bright.exr"));
    exr_with(path, "bright.exr", 1e30);
    let complaint = complaint_in(path, &scaled);
    assert!(complaint.contains("light[0].scale") && complaint.contains("too large"), "{complaint}");
}

#[test]
fn portals_that_cannot_be_are_refused_and_useless_ones_named() {
    let plane = "[[shape]]\ntype = \"plane\"\npoint = [0, 9, 0]\nnormal = [0, 1, 0]\nmaterial = \"gone\"\nportal = true\n";
    let sky = "[[light]]\ntype = \"environment\"\nradiance = 1\n";
    let complaint = complaint_in(Path::new(""), &format!("{plane}{sky}"));
    assert!(complaint.contains("shape[1]") && complaint.contains("a plane cannot be a portal"), "{complaint}");

    let faces: Vec<String> = (0..257).map(|_| "[0, 1, 2]".to_owned()).collect();
    let mesh = format!(
        "[[shape]]\ntype = \"mesh\"\npositions = [[0, 2, 0], [1, 2, 0], [0, 2, 1]]\nfaces = [{}]\nmaterial = \"gone\"\nportal = true\n",
        faces.join(", ")
    );
    let complaint = complaint_in(Path::new(""), &format!("{mesh}{sky}"));
    assert!(complaint.contains("have 257 faces, at most 256"), "{complaint}");

    let sphere = |material: &str| {
        let shape = "[[shape]]\ntype = \"sphere\"\ncenter = [0, 3, 0]\nradius = 0.5\nportal = true\n";
        load(&format!("{shape}material = \"{material}\"\n{sky}")).warnings
    };
    assert_eq!(sphere("gone").len() + sphere("lamp").len(), 0);
    assert!(sphere("white")[0].contains("is a portal without effect: its material `white` lets no ray pass"));
}

fn render(scene: &Scene) -> Vec<[f32; 3]> {
    let mut pixels = Vec::new();
    let mut renderer = ReferenceRenderer::new(scene).expect("the scene is supported");
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..scene.render.spp };
    let report = renderer.render(&request, &Silent, &mut |band: Band| {
        pixels.extend(band.mean);
        Ok(())
    });
    assert_eq!(report.expect("rendering succeeds").non_finite_samples, 0);
    pixels
}

fn brightness(scene: &Scene) -> f32 {
    render(scene).iter().flatten().sum()
}

/// A light inside an opaque shape lights the shape's inside and nothing else; a lamp's surface may cut another's.
#[test]
fn a_light_inside_a_shape_lights_its_inside() {
    let bulb = "[[light]]\ntype = \"point\"\nposition = [0, 1, 0]\nintensity = 9\n";
    let spot = "[[light]]\ntype = \"spot\"\nposition = [0, 1, 0]\ndirection = [0, -1, 0]\nintensity = 9\nangle = 60\n";
    let lamp = "[[shape]]\ntype = \"sphere\"\ncenter = [0, 1, 0]\nradius = 0.2\nmaterial = \"lamp\"\n";
    let shell = "[[shape]]\ntype = \"sphere\"\ncenter = [0, 1, 0]\nradius = 0.6\nmaterial = \"white\"\n";
    for light in [bulb, spot, lamp] {
        let mut scene = load(&format!("{light}{shell}"));
        assert_eq!(brightness(&scene), 0.0, "{light}");
        scene.camera.position.y = 1.1;
        scene.camera.position.z = 0.4;
        scene.camera.look_at.y = 1.1;
        assert!(brightness(&scene) > 0.0, "{light}");
        assert!(brightness(&load(light)) > 0.0, "{light}");
    }
}

/// Lights without power send nothing, and nothing goes wrong; surfaces without area are refused.
#[test]
fn lights_without_area_or_power_are_dark() {
    let dark = [
        format!("{}direction = [0, -1, 0]\nangle = 40\n", spot("").replace("intensity = 1", "intensity = 0")),
        "[[light]]\ntype = \"directional\"\ndirection = [0, -1, 0]\nirradiance = 0\n".to_owned(),
        "[[light]]\ntype = \"sky\"\nzenith = 0\nhorizon = 0\nground = 0\n".to_owned(),
    ];
    for text in dark {
        assert_eq!(brightness(&load(&text)), 0.0, "{text}");
        let beside = load(&format!("{text}[[light]]\ntype = \"point\"\nposition = [0, 3, 0]\nintensity = 1\n"));
        assert!(brightness(&beside) > 0.0, "{text}");
    }
    for (body, expected) in [
        ("type = \"sphere\"\ncenter = [0, 2, 0]\nradius = 0", "radius: expected a number above 0, found 0"),
        ("type = \"disk\"\ncenter = [0, 2, 0]\nnormal = [0, 1, 0]\nradius = 0", "radius: expected a number above 0, found 0"),
        ("type = \"rectangle\"\ncorner = [0, 2, 0]\nedge_u = [1, 0, 0]\nedge_v = [2, 0, 0]", "the rectangle has no area"),
        (
            "type = \"mesh\"\npositions = [[0, 2, 0], [1, 2, 0], [2, 2, 0]]\nfaces = [[0, 1, 2]]",
            "the mesh has no faces with an area",
        ),
    ] {
        let complaint = complaint_in(Path::new(""), &format!("[[shape]]\nmaterial = \"lamp\"\n{body}\n"));
        assert!(complaint.contains("shape[1]") && complaint.contains(expected), "{complaint}");
    }
}
