//! The closed forms that `gpt verify` asks a device for hold, and stop holding with each fault that has something to act on.

use crate::common::device::DEVICE;
use gpt::gpu::{Device, GpuRenderer};
use gpt::plan::{Fault, PlanOptions};
use gpt::renderer::RenderError;
use gpt::scene::{Geometry, Shape, Transform};
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
        geometry: Geometry::Disk { center: glam::DVec3::ZERO, normal: glam::DVec3::Y, radius: 1.0 },
        material: 99,
        transform: Transform::default(),
        motion: None,
        portal: false,
    });
    match GpuRenderer::on(device, &scene, &PlanOptions::default()).map(drop) {
        Err(RenderError::InvalidScene(invalid)) => assert_eq!(invalid.to_string(), "a disk: there is no material 99"),
        other => panic!("{other:?}"),
    }
}
