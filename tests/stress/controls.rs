//! Controls of the cases: each kind of check complains about a scene that is wrong.

use gpt::plan::PlanOptions;
use gpt::scene::{ColorInput, Scene};

use super::support::{DEVICE, Finding, LEAST_MATCHING, compare_with, judged, render};
use super::{accumulation, intersections, scale, self_intersection};

/// The wrong scene that a check was given, and the finding.
pub fn complaints() -> Vec<(&'static str, Finding)> {
    if DEVICE.is_none() {
        return Vec::new();
    }
    let room = scale::room(scale::HERE);
    let verdict = compare_with(&brighter(&room), &room, &PlanOptions::default()).expect("there is a device");
    let pixels = |scene: &Scene| render(scene).expect("there is a device");
    vec![
        ("a lamp 1 % too bright", judged("room", &verdict, LEAST_MATCHING)),
        ("a mesh that lacks one triangle", intersections::holes("mesh".to_owned(), 0, &pixels(&intersections::cracked_mesh()))),
        (
            "a speck above a surface",
            self_intersection::seen_in_white("plate".to_owned(), &pixels(&self_intersection::with_speck())),
        ),
        ("a plain sum in single precision", accumulation::plain_sum(1 << 15)),
    ]
}

fn brighter(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for material in &mut scene.materials {
        if let Some(ColorInput::Constant(radiance)) = material.emission.as_mut().map(|emission| &mut emission.radiance) {
            *radiance *= 1.01;
        }
    }
    scene
}
