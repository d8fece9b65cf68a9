//! The closed forms that `gpt verify` asks a device for hold, and stop holding with each fault that has something to act on.

use crate::common::device::DEVICE;
use gpt::cpu::ReferenceRenderer;
use gpt::gpu::{Device, GpuRenderer};
use gpt::plan::{Fault, PlanOptions};
use gpt::renderer::RenderError;
use gpt::scene::{Disk, Geometry, Scene, Shape, Transform};
use gpt::verify;
use gpt::verify::closed_forms::{self, ClosedForm};

fn check_all(device: &Device, fault: Option<Fault>) -> Vec<ClosedForm> {
    let options = PlanOptions { fault, ..PlanOptions::default() };
    (0..closed_forms::count()).map(|index| closed_forms::check(index, device, &options).expect("it renders")).collect()
}

#[test]
fn closed_forms_hold_on_the_device() {
    let Some(device) = DEVICE.as_ref() else { return };
    for closed in check_all(device, None) {
        assert!(closed.agrees && closed.planted.is_none(), "{closed:#?}");
    }
}

#[test]
#[ignore = "slow"]
fn closed_forms_notice_each_fault() {
    let Some(device) = DEVICE.as_ref() else { return };
    // How many of them have something for the fault to act on.
    for (fault, acted_on) in [(Fault::Brdf, closed_forms::count()), (Fault::Mis, 3), (Fault::Light, 3)] {
        let found = check_all(device, Some(fault));
        assert_eq!(found.iter().filter(|closed| closed.planted.is_some()).count(), acted_on, "{fault:?}");
        for closed in found {
            assert_eq!(closed.agrees, closed.planted.is_none(), "{fault:?}: {closed:#?}");
        }
    }
}

/// A scene built by hand whose shape names a material that is not there: packing it would end the program.
#[test]
fn a_scene_that_is_not_valid_is_refused_by_the_device() {
    let Some(device) = DEVICE.as_ref() else { return };
    let mut scene = gpt::load::load(Some("furnace-mirror")).expect("it is built in");
    assert!(GpuRenderer::on(device, &scene, &PlanOptions::default()).is_ok());
    scene.shapes.push(Shape {
        label: "a disk".into(),
        geometry: Geometry::Disk(Disk { center: glam::DVec3::ZERO, normal: glam::DVec3::Y, radius: 1.0 }),
        material: 99,
        transform: Transform::default(),
        motion: None,
        portal: false,
        receiver: 0,
    });
    match GpuRenderer::on(device, &scene, &PlanOptions::default()).map(drop) {
        Err(RenderError::InvalidScene(invalid)) => assert_eq!(invalid.to_string(), "a disk: there is no material 99"),
        other => panic!("{other:?}"),
    }
    assert!(matches!(ReferenceRenderer::new(&scene), Err(RenderError::InvalidScene(_))), "the reference asks too");
}

/// A normal map on a smooth and on a rough metal under a sky with a sun: one path in thirty differs by more than 10⁻⁴, and none by mistake.
const STEEP: &str = r#"
[film]
size = [64, 48]
[render]
spp = 8
max_depth = 4
[camera]
position = [0, 0.4, 4]
look_at  = [0, 0, 0]
vfov     = 34
[[texture]]
name = "dents"
type = "image"
file = "textures/hammered.png"
color_space = "linear"
scale = [7, 5]
[[material]]
name = "smooth"
type = "conductor"
preset = "silver"
alpha = 0
normal_map = "dents"
[[material]]
name = "rough"
type = "conductor"
preset = "gold"
alpha = 0.004
normal_map = "dents"
[[shape]]
type = "sphere"
center = [-0.8, 0, 0]
radius = 0.75
material = "smooth"
[[shape]]
type = "sphere"
center = [0.8, 0, 0]
radius = 0.75
material = "rough"
[[light]]
type = "environment"
file = "textures/evening.hdr"
scale = 20
"#;

fn steep() -> Scene {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
    gpt::load::load_toml_str(STEEP, "steep", std::path::Path::new(folder)).expect("it is valid")
}

#[test]
fn steep_paths_are_no_false_alarm() {
    let Some(device) = DEVICE.as_ref() else { return };
    let verdict = verify::verify_on(device, &steep(), &PlanOptions::default(), None).expect("it renders");
    assert!(verdict.agrees && verdict.followed_paths > 100, "{verdict:#?}");
    // Some thousand paths of a glossy scene, of which a few differ by up to a thousandth.
    let mut glossy =
        gpt::load::load(Some(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/figures/veach-glossy.toml"))).expect("it is valid");
    glossy.film.size = [24, 16];
    glossy.render.spp = 8;
    let verdict = verify::verify_on(device, &glossy, &PlanOptions::default(), None).expect("it renders");
    assert!(verdict.agrees && verdict.followed_paths > 2, "{verdict:#?}");
}

/// A lamp seen under a small solid angle, with a texture that changes a lot over what single precision is off by there.
const FINE_LAMP: &str = r#"
[film]
size = [64, 48]
[render]
spp = 16
light_sampling = "cone"
[camera]
position = [0, 1.5, 6]
look_at = [0, 1, 0]
vfov = 40
[[texture]]
name = "fine"
type = "perlin"
a = 0
b = [20, 15, 10]
scale = 60
[[material]]
name = "clay"
type = "diffuse"
reflectance = 0.6
[[material]]
name = "lamp"
type = "emissive"
radiance = { texture = "fine" }
[[shape]]
type = "rectangle"
corner = [-5, 0, 5]
edge_u = [10, 0, 0]
edge_v = [0, 0, -10]
material = "clay"
[[shape]]
type = "rectangle"
corner = [-1, 3, -1]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
material = "lamp"
"#;

#[test]
fn fine_textures_of_lamps_are_no_false_alarm() {
    let Some(device) = DEVICE.as_ref() else { return };
    let scene = gpt::load::load_toml_str(FINE_LAMP, "fine-lamp", std::path::Path::new("")).expect("it is valid");
    let verdict = verify::verify_on(device, &scene, &PlanOptions::default(), None).expect("it renders");
    assert!(verdict.agrees && verdict.followed_paths > 500, "{verdict:#?}");
    // The control: a surface that returns 1 % too much.
    let options = PlanOptions { fault: Some(Fault::Brdf), ..PlanOptions::default() };
    let verdict = verify::verify_on(device, &scene, &options, None).expect("it renders");
    assert!(!verdict.agrees && verdict.unexplained_paths.len() > 5, "{verdict:#?}");
}

/// The steep scene with a metal that returns 1 % too much.
#[test]
fn a_mistake_in_a_steep_scene_is_found() {
    let Some(device) = DEVICE.as_ref() else { return };
    let options = PlanOptions { fault: Some(Fault::Brdf), ..PlanOptions::default() };
    let verdict = verify::verify_on(device, &steep(), &options, None).expect("it renders");
    assert!(!verdict.agrees && verdict.unexplained_paths.len() > 5, "{verdict:#?}");
    assert!(verdict.missed[0].contains("differ by more than rounding explains, and none may"), "{:?}", verdict.missed);
}
