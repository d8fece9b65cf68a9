//! The light of one group: the device's paths against the reference's, and the sum of all groups against the picture, on either device.

use gpt::cpu::ReferenceRenderer;
use gpt::film::Band;
use gpt::gpu::GpuRenderer;
use gpt::plan::{PlanOptions, StageMode};
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::Scene;
use gpt::verify;

use super::{assert_agrees, small};
use crate::common::device::DEVICE;
use crate::common::light_groups::{GROUPS, in_groups, lit_by};

const SPP: u32 = 4;

/// Glowing grids of a medium; a sky; lights without a surface.
const SCENES: [&str; 3] = ["bonfire", "terrace", "theatre"];

fn wavefront() -> PlanOptions {
    PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() }
}

#[test]
fn every_group_agrees_path_by_path() {
    for name in SCENES {
        let scene = in_groups(small(name, 32, SPP));
        let found = scene.light_group_names();
        for group in GROUPS.into_iter().filter(|group| found.contains(group)) {
            assert_agrees(&format!("{name}, {group}"), &lit_by(&scene, group), &PlanOptions::default());
            if name == "bonfire" {
                assert_agrees(&format!("{name}, {group}, wavefront"), &lit_by(&scene, group), &wavefront());
            }
        }
    }
}

/// The control: another group is another picture.
#[test]
fn the_light_of_another_group_is_noticed() {
    let Some(device) = DEVICE.as_ref() else { return };
    let scene = in_groups(small("bonfire", 32, SPP));
    let found = scene.light_group_names();
    for group in GROUPS.into_iter().filter(|group| found.contains(group)) {
        let other = found.iter().find(|other| **other != group).expect("several");
        let mut gpu = GpuRenderer::on(device, &lit_by(&scene, group), &PlanOptions::default()).expect("the scene fits");
        let mut cpu = ReferenceRenderer::new(&lit_by(&scene, other)).expect("the scene is supported");
        let verdict = verify::compare(&scene, &mut gpu, &mut cpu, None).expect("both render");
        assert!(!verdict.agrees, "{group} for {other}: {verdict:#?}");
    }
}

fn means(renderer: &mut dyn Renderer, scene: &Scene) -> Vec<[f32; 3]> {
    let mut means = Vec::new();
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..SPP };
    let mut on_band = |band: Band| {
        means.extend(band.mean);
        Ok(())
    };
    renderer.render(&request, &Silent, &mut on_band).expect("rendering succeeds");
    means
}

/// A way to render a scene: the means of its pixels.
type Render<'a> = Box<dyn Fn(&Scene) -> Vec<[f32; 3]> + 'a>;

/// By how much groups together differ from the picture, in parts of each number.
fn apart(scene: &Scene, groups: &[&str], render: &dyn Fn(&Scene) -> Vec<[f32; 3]>) -> f64 {
    let picture = render(scene);
    let mut sums = vec![[0.0_f64; 3]; picture.len()];
    for group in groups {
        let light = render(&lit_by(scene, group));
        sums.iter_mut().flatten().zip(light.iter().flatten()).for_each(|(sum, light)| *sum += f64::from(*light));
    }
    let pairs = sums.iter().flatten().zip(picture.iter().flatten());
    pairs.map(|(sum, mean)| (sum - f64::from(*mean)).abs() / f64::from(*mean).max(1e-6)).fold(0.0, f64::max)
}

/// Every addition along a path rounds once, on either side: a few units of 2⁻²⁴.
#[test]
fn groups_add_up_to_the_picture_to_the_last_places() {
    for name in SCENES {
        let scene = in_groups(small(name, 32, SPP));
        let found = scene.light_group_names();
        let on_cpu = |scene: &Scene| means(&mut ReferenceRenderer::new(scene).expect("the scene is supported"), scene);
        let mut ways: Vec<(&str, Render<'_>)> = vec![("reference", Box::new(on_cpu))];
        if let Some(device) = DEVICE.as_ref() {
            let by = |options: PlanOptions| {
                move |scene: &Scene| means(&mut GpuRenderer::on(device, scene, &options).expect("the scene fits"), scene)
            };
            ways.push(("device", Box::new(by(PlanOptions::default()))));
            if name == "bonfire" {
                ways.push(("device, wavefront", Box::new(by(wavefront()))));
            }
        }
        for (way, render) in &ways {
            let difference = apart(&scene, &found, render);
            println!("{name}, {way}: {difference:.1e}");
            assert!(difference < 1e-6, "{name}, {way}: {difference:e}");
            // The control: a group is missing.
            assert!(apart(&scene, &found[1..], render) > 0.1, "{name}, {way}");
        }
    }
}
