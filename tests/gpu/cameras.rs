//! Rays of the device's cameras against formulas that know nothing of rays. `tests/cpu/cameras.rs` does the same with the reference.

use gpt::film::KernelLayer;
use gpt::gpu::GpuRenderer;
use gpt::plan::{PlanOptions, StageMode};
use gpt::reference::layer::layer_scene;

use crate::common::device::DEVICE;
use crate::common::projections::{farthest_off, projections, within_a_sphere};

/// Every pixel sees the point that the camera's formula shows at its middle, to a thousandth of a pixel. Negative control: with other keys the first does not.
#[test]
fn every_camera_of_the_device_shows_points_where_its_formula_says() {
    let Some(device) = DEVICE.as_ref() else { return };
    for (index, case) in projections().iter().enumerate() {
        let stages = Some(if index % 3 == 1 { StageMode::Wavefront } else { StageMode::Fused });
        let off = |keys: &str| {
            let scene = within_a_sphere(case.size, keys);
            let layer = layer_scene(&scene, KernelLayer::Position);
            let options = PlanOptions { stages, layer: Some(KernelLayer::Position), ..PlanOptions::default() };
            let mut renderer = GpuRenderer::on(device, &layer, &options).expect("the scene fits");
            farthest_off(&mut renderer, &scene, case)
        };
        let right = off(case.keys);
        println!("{}: {right:.1e} pixels", case.name);
        assert!(right < 1e-3, "{}: {right} pixels", case.name);
        if ["panorama", "distorted perspective", "polynomial fisheye", "omnidirectional stereo"].contains(&case.name) {
            let wrong = off(case.wrong);
            assert!(wrong > 1e-3, "{}: the control is off by {wrong} pixels alone", case.name);
        }
    }
}
