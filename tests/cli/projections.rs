//! `--projection`: any scene by another camera from where its own stands.

use super::*;

const RENDER: &str = "render cornell -q --device cpu --spp 1 --max-depth 2";

/// Sizes follow from the height of the scene's picture, unless one is stated.
#[test]
fn every_projection_has_its_size() {
    let place = Workplace::new();
    let scene = gpt::load::load(Some("cornell")).expect("it is built in");
    let [width, height] = scene.film.size;
    for (name, size) in [
        ("perspective", [width, height]),
        ("orthographic", [width, height]),
        ("equirectangular", [2 * height, height]),
        ("cylindrical", [3 * height, height]),
        ("fisheye", [height, height]),
        ("cube_map", [6 * height.div_ceil(2), height.div_ceil(2)]),
        ("stereo", [2 * width, height]),
        ("stereo_panorama", [2 * height, 2 * height]),
    ] {
        let said = String::from_utf8(place.run(&format!("check cornell --projection {name} --json")).stdout).expect("text");
        let found: serde_json::Value = serde_json::from_str(&said).expect("JSON");
        assert_eq!(found["size"], serde_json::json!(size), "{name}");
    }
    place.expect(0, &format!("{RENDER} --projection equirectangular --size 40x20 -o a.exr"));
    let around = place.image("a.exr");
    assert_eq!([around.width, around.height], [40, 20]);
}

/// A panorama's middle is what the scene's camera sees in its own; a perspective by the flag is the scene's own picture.
#[test]
fn the_camera_stays_where_it_is() {
    let place = Workplace::new();
    place.expect(0, &format!("{RENDER} --size 32x24 -o own.exr"));
    place.expect(0, &format!("{RENDER} --size 32x24 --projection perspective -o same.exr"));
    assert!(place.image("own.exr") == place.image("same.exr"));
    place.expect(0, &format!("{RENDER} --size 32x24 --projection orthographic -o other.exr"));
    assert!(place.image("own.exr") != place.image("other.exr"), "the control");
    // The scene that is written has the camera.
    place.expect(0, &format!("{RENDER} --size 48x24 --projection equirectangular --save-scene around.toml -o a.exr"));
    place.expect(0, "render around.toml -q --device cpu --spp 1 --max-depth 2 --size 48x24 -o b.exr");
    assert!(place.image("a.exr") == place.image("b.exr"));
}

#[test]
fn what_cannot_be_is_said() {
    let place = Workplace::new();
    let said = place.expect(2, &format!("{RENDER} --projection mercator -o a.exr"));
    assert!(said.contains("equirectangular") && said.contains("cube_map"), "{said}");
    let said = place.expect(2, &format!("{RENDER} --projection cube_map --size 100x100 -o a.exr"));
    assert!(said.contains("6 × 1 views") && said.contains("--size"), "{said}");
    let said = place.expect(2, &format!("{RENDER} --projection fisheye --aov motion -o a.exr"));
    assert!(said.contains("motion") && said.contains("fisheye") && said.contains("--projection perspective"), "{said}");
}
