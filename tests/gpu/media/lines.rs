//! Media that do not scatter: light along a straight line through bodies, by Beer's law and the glow of each.

use super::text::{self, Medium};
use super::truth::{ALL, Truth, assert_all_hold};
use crate::common::media::phase::Phase;
use crate::common::media::transmittance::{Stretch, radiance, through_box, through_sphere};

fn medium(absorption: [f64; 3], emission: [f64; 3]) -> Medium {
    Medium { absorption, emission, ..Medium::new([0.0; 3], [0.0; 3], Phase::Isotropic) }
}

const FROM: [f64; 3] = [0.2, 0.5, 5.0];
const TO: [f64; 3] = [-0.1, 0.15, 0.0];

fn direction() -> [f64; 3] {
    let way: [f64; 3] = std::array::from_fn(|axis| TO[axis] - FROM[axis]);
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    way.map(|x| x / length)
}

/// Bodies in each other, the outer ones first, as their entries and as stretches of the ray.
fn nested(thicker: f64) -> (Vec<String>, Vec<Stretch>) {
    let bodies = [
        ("outer", medium([0.1, 0.4, 0.9], [0.0; 3])),
        ("middle", medium([1.2 * thicker, 0.2, 0.0], [0.3, 0.0, 0.2])),
        ("inner", medium([0.0, 2.0 * thicker, 0.5], [0.0, 1.0, 0.0])),
    ];
    let (min, max) = ([-2.0, -1.5, -1.8], [1.9, 1.7, 2.2]);
    let shapes = [
        (text::block("outer", min, max), through_box(FROM, direction(), min, max)),
        (text::ball("middle", [0.1, 0.0, 0.2], 1.3), through_sphere(FROM, direction(), [0.1, 0.0, 0.2], 1.3)),
        (text::ball("inner", [0.0, 0.1, 0.3], 0.6), through_sphere(FROM, direction(), [0.0, 0.1, 0.3], 0.6)),
    ];
    let entries = bodies.iter().map(|(name, medium)| medium.entry(name) + &text::null_boundary(name));
    let entries = entries.chain(shapes.iter().map(|(shape, _)| shape.clone())).collect();
    let stretch = |medium: &Medium, ends: Option<[f64; 2]>| {
        let ends = ends.expect("the ray goes through every body");
        Stretch { emission: medium.emission, ..Stretch::new(ends, medium.absorption) }
    };
    let stretches = bodies.iter().zip(&shapes).map(|((_, medium), (_, ends))| stretch(medium, *ends)).collect();
    (entries, stretches)
}

#[test]
fn light_along_a_line_obeys_beers_law() {
    let (mut entries, stretches) = nested(1.0);
    entries.push(text::SKY.into());
    let truth = Truth {
        name: "bodies within bodies".into(),
        text: text::scene(16, 0, FROM, TO, &entries),
        expected: radiance(&stretches, 20.0, [1.0; 3]),
        mistaken: radiance(&nested(1.02).1, 20.0, [1.0; 3]),
        estimators: ALL,
    };
    // A lamp behind fog that surrounds the camera, and shines through 3 units of it.
    let fog = medium([0.2, 0.5, 1.0], [0.1, 0.0, 0.3]);
    let lamp = "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = [1, 2, 3]\n\
                [[shape]]\ntype = \"rectangle\"\ncorner = [-5, -5, 0]\nedge_u = [10, 0, 0]\nedge_v = [0, 10, 0]\nmaterial = \"lamp\"\n";
    let parts = ["medium = \"fog\"\n".to_owned(), fog.entry("fog"), lamp.into()];
    let through = |factor: f64| {
        let stretch = Stretch { emission: fog.emission, ..Stretch::new([0.0, 9.0], fog.absorption.map(|value| value * factor)) };
        radiance(&[stretch], 3.0, [1.0, 2.0, 3.0])
    };
    let around = Truth {
        name: "a lamp in fog around the camera".into(),
        text: text::scene(16, 0, [0.0, 0.0, 3.0], [0.0; 3], &parts),
        expected: through(1.0),
        mistaken: through(1.02),
        estimators: ALL,
    };
    assert_all_hold(&[truth, around]);
}
