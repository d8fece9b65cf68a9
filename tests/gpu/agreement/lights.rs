//! Every kind of light, every way of drawing directions to it, and portals, on both devices.

use glam::Vec3;
use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::scene::{Estimator, Geometry, Light, LightChoice, LightSampling, Mesh, Scene, Shape};
use gpt::verify::{self, Verdict};

use super::{DEVICE, assert_agrees, compare};
use crate::common::effort::in_full;

/// A floor and two spheres for lights to fall on, and what lamps and portals are made of.
pub const HEAD: &str = r#"
[film]
size = [32, 32]
[render]
spp = 8
max_depth = 4
[camera]
position = [0.3, 2.2, 6]
look_at = [0, 0.8, 0]
vfov = 45
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.6
[[material]]
name = "mirror"
type = "mirror"
[[material]]
name = "glossy"
type = "phong"
diffuse = 0.3
specular = 0.5
exponent = 30
[[material]]
name = "gone"
type = "pass"
[[material]]
name = "lamp"
type = "emissive"
radiance = [9, 8, 7]
[[material]]
name = "both"
type = "emissive"
radiance = [0.1, 0.2, 0.3]
two_sided = true
[[shape]]
type = "rectangle"
corner = [-4, 0, 4]
edge_u = [8, 0, 0]
edge_v = [0, 0, -8]
material = "grey"
[[shape]]
type = "sphere"
center = [-1, 0.7, 0]
radius = 0.7
material = "glossy"
[[shape]]
type = "sphere"
center = [1.2, 0.6, -0.5]
radius = 0.6
material = "mirror"
"#;

/// One seen from outside, one from both sides half in the ground, one that holds everything.
const SPHERES: &str = r#"
[[shape]]
type = "sphere"
center = [0, 2.4, 0.5]
radius = 0.4
material = "lamp"
[[shape]]
type = "sphere"
center = [0, 0.1, 1.5]
radius = 0.3
material = "both"
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 12
material = "both"
"#;

/// One light that is no surface.
pub const SPOT: &str = r#"
[[light]]
type = "spot"
position = [1, 3, 2]
direction = [-0.5, -1, -0.6]
intensity = [20, 18, 15]
angle = 35
falloff = 10
"#;

const SLIDE: &str = r#"
[[texture]]
name = "slide"
type = "checker"
a = [0.9, 0.2, 0.1]
b = [0.1, 0.9, 0.8]
scale = [5, 4]
rotation = 20
"#;

/// The slide as a spot light throws it, and as a projector does.
const THROWN: &str = r#"
[[light]]
type = "spot"
position = [1, 3, 2]
direction = [-0.5, -1, -0.6]
intensity = [20, 18, 15]
angle = 35
falloff = 10
curve = "linear"
texture = "slide"
up = [0.3, 0.4, 1]
[[light]]
type = "projector"
position = [-2, 3, 1]
direction = [0.6, -1, -0.2]
irradiance = [3, 4, 5]
vfov = 40
aspect = 1.7
texture = "slide"
"#;

const SKY: &str = r#"
[[light]]
type = "sky"
zenith = [0.2, 0.4, 0.9]
horizon = [0.8, 0.8, 0.7]
ground = [0.2, 0.15, 0.1]
"#;

const MAP: &str = r#"[[light]]
type = "environment"
file = "map.exr"
scale = 1.5
rotate = 40
"#;

/// A map that lies on its side and is turned further.
const TURNED_MAP: &str = r#"[[light]]
type = "environment"
file = "map.exr"
rotate = 40
transform = [{ rotate = [1, 0, 0], degrees = 90 }, { rotate = [1, 2, -0.5], degrees = 35 }]
"#;

/// One texel 10¹² times as bright as the others, sides that are no powers of two.
const EXTREME_MAP: &str = r#"
[[light]]
type = "environment"
file = "extreme.exr"
rotate = -75
"#;

const CONSTANT: &str = "[[light]]\ntype = \"environment\"\nradiance = [0.2, 0.5, 1]\n";

/// One of every shape.
const PORTALS: &str = r#"
[[shape]]
type = "rectangle"
corner = [-1, 1, 3]
edge_u = [2, 0, 0]
edge_v = [0, 1.4, 0]
material = "gone"
portal = true
[[shape]]
type = "disk"
center = [0, 4, 0]
normal = [0, 1, 0.2]
radius = 1
material = "gone"
portal = true
[[shape]]
type = "sphere"
center = [-3, 2, 0]
radius = 0.7
material = "gone"
portal = true
[[shape]]
type = "box"
min = [2, 0, 1]
max = [3, 1.5, 1.2]
material = "gone"
portal = true
[[shape]]
type = "mesh"
positions = [[-1, 1, -3], [1, 1, -3], [0, 2.5, -3]]
faces = [[0, 1, 2]]
material = "gone"
portal = true
[[shape]]
type = "cylinder"
from = [-2, 0.5, 2]
to = [-2, 1.5, 2.2]
radius = 0.3
material = "gone"
portal = true
"#;

/// These parts after the [`HEAD`]; without any, under a sky of one colour.
pub fn load(parts: &[&str]) -> Scene {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let texel = |x: usize, y: usize| {
        let sun = if (x, y) == (9, 4) { 80.0 } else { 0.0 };
        (0.2 + sun + if y < 8 { 0.5 } else { 0.0 }, 0.3 + 0.02 * x as f32, 0.9 - 0.03 * y as f32)
    };
    exr::prelude::write_rgb_file(folder.path().join("map.exr"), 32, 16, texel).expect("the map is written");
    let extreme = |x: usize, y: usize| if (x, y) == (3, 1) { (1e6, 2e6, 1e6) } else { (1e-6, 1e-6, 2e-6) };
    exr::prelude::write_rgb_file(folder.path().join("extreme.exr"), 13, 7, extreme).expect("the map is written");
    let dim = if parts.is_empty() { CONSTANT } else { "" };
    let text = [&[HEAD], parts, &[dim]].concat().concat();
    load::load_toml_str(&text, "lights", folder.path()).unwrap_or_else(|error| panic!("{error}"))
}

/// All of a wavefront's stages, over a hierarchy.
pub fn by_wavefront() -> PlanOptions {
    let (traversal, stages) = (TraversalChoice::Bvh, Some(StageMode::Wavefront));
    PlanOptions { traversal, stages, ..PlanOptions::default() }
}

/// Both estimators that sample lights, each by a way to run of its own; one of them, by turns, where not everything is asked for.
fn by_turns(everywhere: bool, index: usize) -> impl Iterator<Item = (usize, (Estimator, PlanOptions))> {
    let both = [(Estimator::Mis, PlanOptions::default()), (Estimator::Nee, by_wavefront())];
    both.into_iter().enumerate().filter(move |(other, _)| everywhere || *other == index % 2)
}

#[test]
fn every_way_of_sampling_spheres_agrees() {
    let mut scene = load(&[SPHERES]);
    let everywhere = in_full("every way of sampling spheres by either way to run");
    for (index, light_sampling) in [LightSampling::Cone, LightSampling::Visible, LightSampling::Area].into_iter().enumerate() {
        scene.render.light_sampling = light_sampling;
        for (_, (estimator, way)) in by_turns(everywhere, index) {
            scene.render.estimator = estimator;
            assert_agrees(&format!("spheres, {light_sampling:?}, {estimator:?}"), &scene, &way);
        }
    }
}

#[test]
fn every_light_that_is_no_surface_agrees() {
    let examples: Vec<(&str, String)> = load::file::light_examples().collect();
    let delta: String = examples
        .iter()
        .filter(|(_, light)| load(&[light]).lights.iter().all(|light| light.delta().is_some()))
        .map(|(_, light)| light.as_str())
        .collect();
    let all = ("all with a map", [SLIDE, THROWN, &delta, MAP, SPHERES].concat());
    // In the short form those that are no part of all.
    let everywhere = in_full("each light that is no surface alone");
    let skies = examples.into_iter().filter(|(_, light)| everywhere || light.contains("\"sky\""));
    let thrown = everywhere.then(|| ("thrown pictures", [SLIDE, THROWN].concat()));
    let lights = [all, ("extreme map", EXTREME_MAP.to_owned()), ("turned map", TURNED_MAP.to_owned())]
        .into_iter()
        .chain(skies)
        .chain(thrown);
    for (index, (name, lights)) in lights.enumerate() {
        let mut scene = load(&[&lights]);
        // The other scenes are compared by one way to run.
        for (_, (estimator, way)) in by_turns(everywhere || index == 0, index) {
            scene.render.estimator = if lights == MAP && estimator == Estimator::Nee { Estimator::Bsdf } else { estimator };
            assert_agrees(&format!("{name}, {:?}", scene.render.estimator), &scene, &way);
        }
    }
}

#[test]
fn portals_of_every_shape_agree() {
    let everywhere = in_full("portals before every sky by either way to run");
    for (index, (name, light)) in [("constant", CONSTANT), ("sky", SKY), ("map", MAP)].into_iter().enumerate() {
        let mut scene = load(&[PORTALS, light]);
        for (_, (estimator, way)) in by_turns(everywhere, index) {
            scene.render.estimator = estimator;
            assert_agrees(&format!("portals, {name}, {estimator:?}"), &scene, &way);
        }
    }
}

/// A wavy panel of 10,000 triangles, every seventh of which is dark: each primitive that a ray meets knows the light it is.
#[test]
fn ten_thousand_emitting_triangles_agree() {
    let mut scene = load(&[]);
    let find = |name: &str| scene.materials.iter().position(|material| material.name == name).expect("the material exists");
    let (dark, bright) = (find("grey"), find("both"));
    let (columns, rows) = (100_u32, 50_u32);
    let height = |x: u32, y: u32| 2.5 + 0.2 * (x as f32 * 0.3).sin() * (y as f32 * 0.4).cos();
    let positions = (0..=rows)
        .flat_map(|y| (0..=columns).map(move |x| (x, y)))
        .map(|(x, y)| Vec3::new(x as f32 / 25.0 - 2.0, height(x, y), y as f32 / 25.0 - 1.0));
    let faces: Vec<[u32; 3]> = (0..rows)
        .flat_map(|y| (0..columns).map(move |x| y * (columns + 1) + x))
        .flat_map(|a| [[a, a + 1, a + columns + 2], [a, a + columns + 2, a + columns + 1]])
        .collect();
    let face_materials = (0..faces.len()).map(|face| if face % 7 == 0 { dark } else { bright }).collect();
    let mesh = Mesh { positions: positions.collect(), faces, face_materials, ..Mesh::default() };
    let shape = Shape { label: "panel".into(), geometry: Geometry::Mesh(mesh.into()), ..scene.shapes[0].clone() };
    scene.shapes.push(shape);
    assert_agrees("10,000 emitting triangles", &scene, &PlanOptions::default());
}

/// A wide panel of two triangles in a coordinate plane, whose own coordinates give shadow rays no margin to stop by.
const WIDE_PANEL: &str = r#"
[film]
size = [32, 32]
[render]
spp = 16
max_depth = 2
estimator = "nee"
[camera]
position = [0, 30, 60]
look_at = [0, 8, 0]
vfov = 40
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.6
[[material]]
name = "panel"
type = "emissive"
radiance = [1, 0.8, 0.6]
[[shape]]
type = "mesh"
positions = [[-700, 0, 900], [1100, 0, 600], [300, 0, -1300]]
faces = [[0, 1, 2]]
material = "panel"
[[shape]]
type = "sphere"
center = [0, 9, 0]
radius = 8
material = "grey"
"#;

#[test]
fn a_wide_panel_in_a_coordinate_plane_does_not_shade_itself() {
    let scene = load::load_toml_str(WIDE_PANEL, "wide panel", std::path::Path::new(".")).expect("the scene loads");
    for traversal in [TraversalChoice::Auto, TraversalChoice::Bvh] {
        let options = PlanOptions { traversal, ..PlanOptions::default() };
        let Some(verdict) = compare(&scene, &options) else { return };
        // A panel in its own shadow loses whole light samples, of few paths: no test of means would see it.
        assert!(verdict.agrees && verdict.largest_difference < 0.01, "wide panel, {traversal:?}: {verdict:#?}");
    }
}

/// Lamps of every kind, one of them moving, with the sky and without it; few of them, where it is asked for; and all of a wavefront's stages.
#[test]
#[ignore = "slow"]
fn a_tree_of_lights_agrees() {
    let mut bazaar = super::small("bazaar", 48, 8);
    if in_full("the tree of a bazaar's lights by the wavefront") {
        assert_agrees("bazaar", &bazaar, &by_wavefront());
    }
    bazaar.render.estimator = Estimator::Nee;
    bazaar.lights.retain(|light| light.delta().is_some_and(|light| light.cone.is_some()));
    bazaar.render.light_samples = 3.into();
    bazaar.render.light_samples_depth = 2;
    assert_agrees("bazaar, spots alone, nee", &bazaar, &PlanOptions::default());
    let mut few = load(&[SPHERES, MAP, SPOT]);
    few.render.light_choice = LightChoice::Tree;
    assert_agrees("few lights in a tree", &few, &PlanOptions::default());
    assert_agrees("few lights in a tree, wavefront", &few, &by_wavefront());
    // The control: the reference chooses by power.
    let mut by_power = few.clone();
    by_power.render.light_choice = LightChoice::Power;
    let Some(verdict) = compare_unequal(&few, &by_power) else { return };
    assert!(verdict.matching_share() < 0.97, "{verdict:#?}");
}

/// Lamps are chosen by what reaches the place; as a wavefront, where surfaces let light through, and with
/// several light samples.
#[test]
#[ignore = "slow"]
fn cells_of_lights_agree() {
    let mut bazaar = super::small("bazaar", 48, 8);
    bazaar.render.light_choice = LightChoice::Cells;
    assert_agrees("bazaar in cells", &bazaar, &PlanOptions::default());
    assert_agrees("bazaar in cells", &bazaar, &by_wavefront());
    (bazaar.render.estimator, bazaar.render.seed) = (Estimator::Nee, 1);
    bazaar.render.light_samples = 3.into();
    bazaar.render.light_samples_depth = 2;
    assert_agrees("bazaar in cells, nee", &bazaar, &by_wavefront());
    let mut few = load(&[SPHERES, MAP, SPOT]);
    few.render.light_choice = LightChoice::Cells;
    assert_agrees("few lights in cells", &few, &PlanOptions::default());
    // The environment and its portals are chosen by cells as well.
    let mut with_portals = load(&[SPHERES, PORTALS, MAP]);
    with_portals.render.light_choice = LightChoice::Cells;
    assert_agrees("portals in cells", &with_portals, &PlanOptions::default());
    with_portals.render.estimator = Estimator::Nee;
    assert_agrees("portals in cells, nee", &with_portals, &by_wavefront());
    // The grid goes on as the floor does, to the horizon: where it begins, a point loses more than its own error.
    assert_agrees("stage", &super::small("stage", 64, 16), &PlanOptions::default());
    // The controls: one device chooses by power, or has learned of another camera.
    let [mut by_power, mut moved] = [few.clone(), few.clone()];
    by_power.render.light_choice = LightChoice::Power;
    moved.camera.position.x += 1e-3;
    for ours in [by_power, moved] {
        let Some(verdict) = compare_unequal(&ours, &few) else { return };
        assert!(verdict.matching_share() < 0.97, "{verdict:#?}");
    }
}

/// The device renders `ours`, the reference `theirs`.
pub fn compare_unequal(ours: &Scene, theirs: &Scene) -> Option<Verdict> {
    let device = DEVICE.as_ref()?;
    let mut gpu = GpuRenderer::on(device, ours, &PlanOptions::default()).expect("the scene fits");
    let mut cpu = ReferenceRenderer::new(theirs).expect("the scene is supported");
    Some(verify::compare(theirs, &mut gpu, &mut cpu, None).expect("both render"))
}

/// The comparison notices a spot that opens a degree wider, a picture thrown aslant, a map turned by a
/// degree, spheres drawn from otherwise, and portals that one device does not know of. The reference renders
/// the changed scene, so that the device needs few kernels.
#[test]
#[ignore = "slow"]
fn other_lights_are_noticed() {
    let thrown = load(&[SLIDE, THROWN]);
    let mut of_thrown = vec![thrown.clone(); 2];
    for light in &mut of_thrown[0].lights {
        if let Light::Spot(spot) = light {
            spot.angle_degrees += 1.0;
        }
    }
    for light in &mut of_thrown[1].lights {
        if let Light::Projector(projector) = light {
            projector.up.x += 1.0;
        }
    }
    let map = load(&[MAP]);
    let mut turned = map.clone();
    for light in &mut turned.lights {
        if let Light::Environment(environment) = light {
            environment.rotation_degrees += 1.0;
        }
    }
    let tilted = load(&[TURNED_MAP]);
    let mut upright = tilted.clone();
    for light in &mut upright.lights {
        if let Light::Environment(environment) = light {
            environment.turn = None;
        }
    }
    let spheres = load(&[SPHERES]);
    let mut by_area = spheres.clone();
    by_area.render.light_sampling = LightSampling::Area;
    let others = [(&map, &turned), (&tilted, &upright), (&spheres, &by_area), (&load(&[PORTALS, CONSTANT]), &load(&[CONSTANT]))];
    for (index, (ours, theirs)) in of_thrown.iter().map(|changed| (&thrown, changed)).chain(others).enumerate() {
        let Some(verdict) = compare_unequal(ours, theirs) else { return };
        assert!(!verdict.agrees && verdict.matching_share() < 0.97, "change {index}: {verdict:#?}");
    }
}

/// A wall beside a thin tube that glows on both sides, and a roll that lies on a floor at height 0.
const TUBES: &str = r#"
[film]
size = [48, 32]
[render]
spp = 16
max_depth = 4
light_samples = 1
[camera]
position = [0, 1.7, 7.5]
look_at = [0, 0.95, 0]
vfov = 30
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.4
[[material]]
name = "neon"
type = "emissive"
radiance = [2, 1, 0.5]
two_sided = true
[[shape]]
type = "rectangle"
corner = [-5, 0, 2.5]
edge_u = [10, 0, 0]
edge_v = [0, 0, -6]
material = "grey"
[[shape]]
type = "rectangle"
corner = [-5, 0, -1.6]
edge_u = [10, 0, 0]
edge_v = [0, 5, 0]
material = "grey"
[[shape]]
type = "cylinder"
from = [1.95, 0.02, -0.9]
to = [2.15, 1.9, -1.1]
radius = 0.12
material = "neon"
[[shape]]
type = "cylinder"
from = [-1.7, 0.25, 1]
to = [-0.2, 0.25, 0.6]
radius = 0.25
material = "grey"
"#;

/// Points of a tube that are seen from nearly beside them: shadow rays end before the wall in front of them on both devices, or on neither. Where a
/// device's ray meets that wall is off by more than the reference draws, so one path in some hundreds of those that differ stays unexplained. Ended by another share
/// of their way, it was one in seventeen.
#[test]
fn light_that_grazes_tubes_agrees() {
    let mut scene = load::load_toml_str(TUBES, "tubes", std::path::Path::new(".")).unwrap_or_else(|error| panic!("{error}"));
    let seeds = if in_full("a grazed tube with 16 seeds instead of four") { 16 } else { 4 };
    let [mut followed, mut unexplained] = [0, 0];
    for seed in 0..seeds {
        scene.render.seed = seed;
        let Some(verdict) = compare(&scene, &PlanOptions::default()) else { return };
        followed += verdict.followed_paths;
        unexplained += verdict.unexplained_paths.len() as u64;
    }
    println!("{unexplained} of {followed} paths are unexplained");
    assert!(followed > 40 * u64::from(seeds) && 100 * unexplained <= followed, "{unexplained} of {followed}");
}
