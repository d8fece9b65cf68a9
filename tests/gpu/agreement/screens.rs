//! Lamps that show a picture, on both devices.

use gpt::load;
use gpt::plan::PlanOptions;
use gpt::scene::{LightChoice, Scene};

use super::assert_agrees;
use super::lights::{HEAD, SPOT, by_wavefront, compare_unequal};
use crate::common::effort::in_full;

/// A screen that shows a picture of few bright texels: as a rectangle, mirrored, leaning, moving, as the faces of a box, as a mesh, as cylinders and as
/// spheres, from within as well; the picture scaled, turned and repeated, multiplied by another, and a blend's weight; among few lights and among
/// many. The first way is not right-angled.
#[test]
#[ignore = "slow"]
fn screens_agree() {
    let picture = "[[texture]]\nname = \"picture\"\ntype = \"image\"\nfile = \"picture.exr\"\n";
    let folder = tempfile::tempdir().expect("a temporary folder");
    let texel = |x: usize, y: usize| {
        if (x * 5 + y * 7).is_multiple_of(23) { (1.0, 0.8, 0.1 * x as f32) } else { (0.02, 0.01 * y as f32, 0.03) }
    };
    exr::prelude::write_rgb_file(folder.path().join("picture.exr"), 13, 10, texel).expect("the picture is written");
    let keys = ["", "filter = \"nearest\"\n", "scale = [2.5, 1.5]\nrotation = 30\nwrap = \"mirror\"\n"];
    let material =
        "[[material]]\nname = \"screen\"\ntype = \"emissive\"\nradiance = { texture = \"picture\", factor = [9, 8, 7] }\n";
    let more = "[[texture]]\nname = \"checks\"\ntype = \"checker\"\na = 0\nb = 1\nscale = [6, 5]\ntimes = \"picture\"\n\
                [[material]]\nname = \"inward\"\ntype = \"emissive\"\nradiance = { texture = \"picture\" }\ntwo_sided = true\n\
                [[material]]\nname = \"worn\"\ntype = \"emissive\"\nradiance = { texture = \"checks\", factor = [9, 8, 7] }\n\
                [[material]]\nname = \"stencil\"\ntype = \"blend\"\nmaterials = [\"screen\", \"grey\"]\n\
                weight = { type = \"texture\", texture = \"picture\" }\n";
    let tube = "[[shape]]\ntype = \"cylinder\"\nfrom = [-1, 2, -0.4]\nto = [1, 2.3, 0.2]\nradius = 0.4\nmaterial = \"screen\"\n";
    let globe = "[[shape]]\ntype = \"sphere\"\ncenter = [0.3, 2, 0.2]\nradius = 0.5\nmaterial = \"screen\"\n";
    let quad = "[[shape]]\ntype = \"rectangle\"\ncorner = [-1.5, 2.4, -1]\nedge_u = [3, 0.2, 0]\nedge_v = [0.2, 0, 2]\nmaterial = \"screen\"\n";
    let shapes = [
        quad.to_owned(),
        format!("{quad}transform = [{{ scale = [-1, 1, 1] }}]\n"),
        format!("{quad}motion = [{{ rotate = [0, 1, 0.2], degrees = 40 }}]\n"),
        "[[shape]]\ntype = \"box\"\nmin = [-1, 1.8, -0.5]\nmax = [0.5, 2.5, 0.5]\nmaterial = \"screen\"\n".to_owned(),
        "[[shape]]\ntype = \"mesh\"\npositions = [[-1.5, 2, -1], [1.5, 2.2, -1], [1.5, 2.4, 1], [-1.5, 2.1, 1]]\n\
         uvs = [[0, 0], [1, 0], [1, 1], [0, 1]]\nfaces = [[0, 1, 2], [0, 2, 3]]\nmaterial = \"screen\"\n"
            .to_owned(),
        tube.to_owned(),
        format!("{tube}transform = [{{ scale = [-1, 1, 1] }}, {{ rotate = [0, 0, 1], degrees = 20 }}]\n"),
        format!("{tube}motion = [{{ rotate = [0, 1, 0.2], degrees = 40 }}]\n"),
        format!("{globe}transform = [{{ scale = [-1, 1, 1] }}, {{ rotate = [0.2, 1, 1], degrees = 70 }}]\n"),
        format!("{globe}motion = [{{ rotate = [0.3, 1, 0.2], degrees = 40 }}]\n"),
        "[[shape]]\ntype = \"sphere\"\ncenter = [0, 1, 2]\nradius = 7\nmaterial = \"inward\"\n".to_owned(),
        quad.replace("\"screen\"", "\"stencil\""),
        globe.replace("\"screen\"", "\"worn\""),
    ];
    let load = |shapes: &str, keys: &str| {
        let text = format!("{HEAD}{picture}{keys}{material}{more}{shapes}{SPOT}");
        load::load_toml_str(&text, "screens.toml", folder.path()).unwrap_or_else(|error| panic!("{error}\n{text}"))
    };
    let is_warped = |scene: &Scene| {
        let packed = gpt::packed::PackedScene::new(scene).expect("it can be packed");
        packed.lights.iter().any(|light| light.is_warped())
    };
    let ways = [(PlanOptions::default(), LightChoice::Power), (by_wavefront(), LightChoice::Tree)];
    // All that have the same keys in one room: three scenes, each by one way to run.
    for (number, keys) in keys.into_iter().enumerate() {
        let together: String = shapes.iter().skip(number).step_by(3).map(String::as_str).collect();
        let mut scene = load(&together, keys);
        let (way, choice) = &ways[number % 2];
        scene.render.light_choice = *choice;
        assert!(is_warped(&scene));
        assert_agrees(&format!("screens {number}, {choice:?}"), &scene, way);
        // The control: the reference draws points by another picture.
        if number == 0 {
            assert_notices(&scene, &format!("screens {number}"));
        }
    }
    let everywhere = in_full("each kind of screen alone, by either way to run");
    for (index, shape) in shapes.iter().enumerate() {
        let mut scene = load(shape, keys[index % keys.len()]);
        assert_eq!(is_warped(&scene), !shape.contains("mesh"), "screen {index}");
        for (way, choice) in ways.iter().filter(|_| everywhere) {
            scene.render.light_choice = *choice;
            assert_agrees(&format!("screen {index}, {choice:?}"), &scene, way);
        }
        if everywhere {
            scene.render.light_choice = LightChoice::Power;
            assert_notices(&scene, &format!("screen {index}"));
        }
    }
}

/// A reference that draws points by another picture is noticed.
fn assert_notices(scene: &Scene, what: &str) {
    let mut other = scene.clone();
    other.textures[0].transform.offset = [0.02, 0.0];
    let Some(verdict) = compare_unequal(scene, &other) else { return };
    assert!(verdict.matching_share() < 0.97, "{what}: {verdict:#?}");
}
