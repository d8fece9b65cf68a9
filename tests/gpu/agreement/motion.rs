//! Shapes that move while the shutter is open: the device's paths against the reference's.

use gpt::load;
use gpt::plan::{PlanOptions, StageMode};
use gpt::scene::{Estimator, LightSampling, MotionStep, SamplerKind, Scene};

use super::assert_agrees;
use super::strategies::compare_unequal;
use crate::common::effort::in_full;

/// A floor under a lamp and an environment; `[[shape]]`s are added.
const STAGE: &str = r#"
[film]
size = [32, 32]
[render]
spp = 12
max_depth = 5
[camera]
position = [0, 1.6, 6]
look_at = [0, 0.8, 0]
vfov = 40
shutter = [0.25, 1.5]
[[texture]]
name = "checks"
type = "checker"
a = [0.9, 0.2, 0.1]
b = [0.1, 0.3, 0.8]
scale = [6, 4]
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.8
[[material]]
name = "checked"
type = "diffuse"
reflectance = { texture = "checks" }
[[material]]
name = "gold"
type = "conductor"
preset = "gold"
roughness = 0.4
[[material]]
name = "glow"
type = "emissive"
radiance = [9, 7, 5]
[[material]]
name = "checked-glow"
type = "emissive"
radiance = { texture = "checks" }
two_sided = true
[[material]]
name = "nothing"
type = "pass"
[[material]]
name = "half-glow"
type = "blend"
materials = ["checked-glow", "white"]
weight = { type = "facing", power = 0.5 }
[[shape]]
type = "rectangle"
corner = [-6, 0, -6]
edge_u = [0, 0, 12]
edge_v = [12, 0, 0]
material = "white"
[[shape]]
type = "rectangle"
corner = [-1, 4, -1]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
material = "glow"
[[light]]
type = "environment"
radiance = [0.2, 0.3, 0.4]
"#;

/// A mesh of a few smooth faces with texture coordinates.
const TETRAHEDRON: &str = "type = \"mesh\"\npositions = [[1, 0, -0.7], [-1, 0, -0.7], [0, 1, 0.7], [0, -1, 0.7]]\n\
    faces = [[0, 1, 2], [1, 0, 3], [2, 3, 0], [3, 2, 1]]\nuvs = [[0, 0], [1, 0], [1, 1], [0, 1]]\n\
    normals = [[1, 0.1, -0.7], [-1, 0.1, -0.7], [0, 1, 0.7], [0, -1, 0.7]]\nsmooth = true\n";

/// Name and lines of a shape that moves.
const MOVING: &[(&str, &str)] = &[
    (
        "sphere that flies",
        "type = \"sphere\"\ncenter = [-1, 1, 0]\nradius = 0.8\nmaterial = \"gold\"\nmotion = [{ translate = [1.5, 0.3, 0.5] }]",
    ),
    (
        "textured sphere that turns and grows",
        "type = \"sphere\"\ncenter = [0.1, 0, 0]\nradius = 0.8\nmaterial = \"checked\"\n\
         transform = [{ rotate = [1, 0, 1], degrees = 30 }, { translate = [0, 1, 0] }]\n\
         motion = [{ rotate = [0.2, 1, 0.1], degrees = 200 }, { scale = 1.4 }]",
    ),
    (
        "box that changes its shape",
        "type = \"box\"\nmin = [-0.6, 0.2, -0.6]\nmax = [0.6, 1.4, 0.6]\nmaterial = \"checked\"\nmotion = [{ scale = [1.5, 0.6, 1] }]",
    ),
    (
        "disk that tumbles",
        "type = \"disk\"\ncenter = [0.2, 0.3, 0]\nnormal = [0.1, 1, 0.2]\nradius = 1\nmaterial = \"white\"\n\
         transform = [{ translate = [0, 1, 0] }]\n\
         motion = [{ scale = 0.6 }, { rotate = [0, 0, 1], degrees = 80 }, { translate = [0.2, 0.1, 0] }]",
    ),
    (
        "lamp that turns",
        "type = \"rectangle\"\ncorner = [-0.3, 0, -0.3]\nedge_u = [0.6, 0, 0]\nedge_v = [0, 0, 0.6]\nmaterial = \"glow\"\n\
         transform = [{ translate = [-1.5, 2, 0] }]\n\
         motion = [{ scale = [1.6, 1, 0.7] }, { rotate = [0, 0, 1], degrees = 70 }, { translate = [2, -0.3, 0.5] }]",
    ),
    (
        "textured lamp that turns",
        "type = \"rectangle\"\ncorner = [-0.3, 2, -0.3]\nedge_u = [0.6, 0, 0]\nedge_v = [0, 0, 0.6]\nmaterial = \"checked-glow\"\n\
         motion = [{ rotate = [1, 0, 0.3], degrees = 70 }]",
    ),
    (
        "glowing sphere that flies and grows",
        "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0.4\nmaterial = \"glow\"\ntransform = [{ translate = [-1.2, 1, 0.4] }]\n\
         motion = [{ scale = 1.5 }, { translate = [1.4, 0.3, 0.5] }]",
    ),
    (
        "blended sphere that turns",
        "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0.5\nmaterial = \"half-glow\"\ntransform = [{ translate = [-0.5, 1, 0.4] }]\n\
         motion = [{ rotate = [0, 1, 0.3], degrees = 100 }, { translate = [1, 0.3, 0.5] }]",
    ),
    (
        "glowing disk that tumbles",
        "type = \"disk\"\ncenter = [0, 0, 0]\nnormal = [0, -1, 0]\nradius = 0.6\nmaterial = \"glow\"\n\
         transform = [{ translate = [0, 2, 0.5] }]\nmotion = [{ rotate = [0, 0, 1], degrees = 60 }, { scale = 1.3 }]",
    ),
];

fn stage(shapes: &[&str]) -> Scene {
    let shapes: String = shapes.iter().map(|shape| format!("[[shape]]\n{shape}\n")).collect();
    let text = format!("{STAGE}{shapes}");
    load::load_toml_str(&text, "motion.toml", std::path::Path::new("")).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn mesh(material: &str) -> String {
    format!(
        "{TETRAHEDRON}material = \"{material}\"\ntransform = [{{ rotate = [0, 1, 0.2], degrees = 30 }}, {{ translate = [0, 1, 0] }}]\n\
         motion = [{{ scale = [1.2, 0.8, 1] }}, {{ rotate = [0.3, 1, 0], degrees = 90 }}, {{ translate = [0.3, 0.2, 0] }}]"
    )
}

fn ways() -> [PlanOptions; 2] {
    [StageMode::Fused, StageMode::Wavefront].map(|mode| PlanOptions { stages: Some(mode), ..PlanOptions::default() })
}

#[test]
#[ignore = "long: each moving shape alone"]
fn long_every_moving_shape_agrees() {
    for (index, (name, shape)) in MOVING.iter().enumerate() {
        assert_agrees(name, &stage(&[shape]), &ways()[index % 2]);
    }
    for (index, material) in ["checked", "gold", "glow", "half-glow"].into_iter().enumerate() {
        assert_agrees(&format!("{material} mesh"), &stage(&[&mesh(material)]), &ways()[index % 2]);
    }
}

/// Still shapes and lights beside moving ones, and every way to draw lights and times.
#[test]
fn all_together_agree_for_every_strategy() {
    let meshes = ["checked", "gold", "glow", "half-glow"].map(mesh);
    // Side by side, behind the others.
    let meshes = [0, 1, 2, 3].map(|index| {
        let place = format!("translate = [{}, 1.4, -1.5] }}]\n", 1.6 * f64::from(index) - 2.4);
        meshes[index as usize].replacen("translate = [0, 1, 0] }]\n", &place, 1)
    });
    let shapes: Vec<&str> = MOVING.iter().map(|(_, shape)| *shape).chain(meshes.iter().map(String::as_str)).collect();
    let mut scene = stage(&shapes);
    let samplings = [LightSampling::Cone, LightSampling::Visible, LightSampling::Area];
    let count = if in_full("moving lamps by area and by paths alone") { 3 } else { 2 };
    for (index, sampling) in samplings.into_iter().take(count).enumerate() {
        scene.render.light_sampling = sampling;
        scene.render.estimator = [Estimator::Mis, Estimator::Nee, Estimator::Bsdf][index];
        scene.render.sampler = [SamplerKind::Sobol, SamplerKind::Stratified, SamplerKind::Independent][index];
        assert_agrees(&format!("all, {sampling:?}"), &scene, &ways()[index % 2]);
    }
}

/// Rows one after the other, with shapes and cameras that move, by either kernel; rows all at once are noticed.
#[test]
#[ignore = "slow"]
fn rolling_shutters_agree() {
    for (index, rolling_shutter) in [0.0, 0.3].into_iter().enumerate() {
        let mut scene = filmed("vfov = 40", ["vfov = 40", "vfov = 30"]);
        scene.camera.rolling_shutter = rolling_shutter;
        assert_agrees(&format!("rows exposed for {rolling_shutter}"), &scene, &ways()[index]);
        if index == 1 {
            let mut at_once = scene.clone();
            at_once.camera.rolling_shutter = 1.0;
            let Some(verdict) = compare_unequal(&scene, &at_once) else { return };
            assert!(!verdict.agrees && verdict.matching_share() < 0.97, "rows all at once: {verdict:#?}");
            scene.exposure.clear();
            assert_agrees("shapes alone", &scene, &ways()[0]);
        }
    }
}

/// The stage before a camera that flies, turns, zooms and focuses while the shutter is open, perspective or not.
fn filmed(projection: &str, [open, close]: [&str; 2]) -> Scene {
    let keys = format!(
        "shutter = [0.25, 1.5]\naperture = {{ shape = \"disk\", radius = 0.1 }}\nfocus_distance = 5\ninterpolation = \"smooth\"\n{projection}\n\
         keyframes = [{{ frame = 2, position = [-1, 1.2, 6], look_at = [0.5, 1, 0], {open} }}, \
         {{ frame = 4, position = [1, 2, 5], look_at = [0, 0.5, 0], up = [0.3, 1, 0], focus_distance = 6, {close} }}]\n"
    );
    let mesh = mesh("checked");
    let shapes = format!("[[shape]]\n{mesh}\n[[shape]]\n{}\n", MOVING[0].1);
    let text = format!("{STAGE}{shapes}").replace("vfov = 40\nshutter = [0.25, 1.5]\n", &keys);
    let scene =
        load::load_toml_str(&text, "camera.toml", std::path::Path::new("")).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.at_frame(2.5).expect("it can be rendered")
}

/// By both kernels, with and without shapes that move as well; another way of the camera is noticed, and so is none.
#[test]
#[ignore = "slow"]
fn a_camera_that_moves_agrees() {
    let everywhere = in_full("moving cameras of either projection with and without shapes that move");
    for (index, (projection, ends)) in
        [("vfov = 40", ["vfov = 40", "vfov = 30"]), ("projection = \"orthographic\"\nheight = 3", ["height = 3", "height = 4"])]
            .into_iter()
            .enumerate()
    {
        let mut scene = filmed(projection, ends);
        scene.render.sampler = [SamplerKind::Sobol, SamplerKind::Independent][index];
        if index == 0 || everywhere {
            assert_agrees(projection, &scene, &ways()[index]);
        }
        scene.shapes.iter_mut().for_each(|shape| shape.motion = None);
        if index == 1 || everywhere {
            assert_agrees(&format!("{projection}, at rest"), &scene, &ways()[1 - index]);
        }
        let mut changes = vec![scene.clone(); 3];
        changes[0].exposure.clear();
        changes[1].exposure.reverse();
        changes[2].exposure.iter_mut().for_each(|camera| camera.look_at.x += 0.01);
        for (change, changed) in changes.iter().enumerate() {
            let Some(verdict) = compare_unequal(&scene, changed) else { return };
            assert!(!verdict.agrees && verdict.matching_share() < 0.97, "{projection}, change {change}: {verdict:#?}");
        }
    }
}

/// A moving shape that no ray meets costs nothing: no code is compiled for it.
#[test]
fn a_moving_shape_of_pass_is_still() {
    let unseen =
        "type = \"sphere\"\ncenter = [0, 1, 0]\nradius = 0.5\nmaterial = \"nothing\"\nmotion = [{ translate = [1, 0, 0] }]";
    let scene = stage(&[unseen]);
    assert!(scene.shapes.last().is_some_and(|shape| shape.motion.is_some()));
    let packed = gpt::packed::PackedScene::new(&scene).expect("it can be packed");
    assert!(!packed.moves());
    assert_agrees("unseen", &scene, &ways()[0]);
}

/// A motion that differs by a hundredth in one step is noticed, and so is another shutter.
#[test]
#[ignore = "slow"]
fn another_motion_is_noticed() {
    let scene = stage(&[&mesh("checked")]);
    let mut changes = vec![scene.clone(); 4];
    changes[0].camera.shutter[1] += 0.02;
    for (index, change) in changes[1..].iter_mut().enumerate() {
        let steps = &mut change.shapes.last_mut().expect("the scene has shapes").motion.as_mut().expect("the last moves").steps;
        match &mut steps[index] {
            MotionStep::Scale(factors) => *factors *= 1.01,
            MotionStep::Rotate { degrees, .. } | MotionStep::Turned { degrees, .. } => *degrees *= 1.01,
            MotionStep::Translate(offset) => *offset *= 1.03,
        }
    }
    for (index, changed) in changes.iter().enumerate() {
        let Some(verdict) = compare_unequal(&scene, changed) else { return };
        assert!(!verdict.agrees && verdict.matching_share() < 0.97, "change {index}: {verdict:#?}");
    }
}
