//! Scattering below the surface of a `principled` material.

use std::path::Path;

use super::text;
use super::truth::{ALL, Truth, assert_all_hold};
use gpt::load::load_toml_str;
use gpt::plan::PlanOptions;
use gpt::scene::Scene;

const FROM: [f64; 3] = [0.3, 0.8, 3.0];
const TO: [f64; 3] = [0.1, -0.1, 0.0];

fn material(keys: &str) -> String {
    format!("[[material]]\nname = \"around fog\"\ntype = \"principled\"\nmetallic = 0\n{keys}\n")
}

/// A smooth surface below which nothing is absorbed sends all light back.
fn furnaces(color: f64) -> Vec<Truth> {
    let below = |g: f64| {
        format!(
            "subsurface = 1\nsubsurface_color = {color:?}\nsubsurface_radius = [0.3, 0.5, 0.8]\nsubsurface_anisotropy = {g:?}"
        )
    };
    let ball = text::ball("fog", [0.0; 3], 1.0);
    let block = text::block("fog", [-0.8, -1.0, -0.6], [0.9, 0.7, 1.0]);
    [("a ball", below(0.0), ball, 1.4), ("a box", below(0.7), block, 1.33)]
        .into_iter()
        .map(|(name, below, shape, ior)| {
            let material = material(&format!("roughness = 0\nior = {ior:?}\nbase_color = [0.2, 0.5, 0.1]\n{below}"));
            Truth {
                name: name.into(),
                text: text::scene(128, 0, FROM, TO, &[text::SKY.into(), material, shape]),
                expected: [1.0; 3],
                mistaken: [0.98; 3],
                estimators: ALL,
            }
        })
        .collect()
}

#[test]
fn white_bodies_send_all_light_back() {
    assert_all_hold(&furnaces(1.0));
}

/// The control.
#[test]
#[should_panic(expected = "a ball")]
fn bodies_that_are_not_white_do_not() {
    assert_all_hold(&furnaces(0.6)[..1]);
}

fn scene(keys: &str) -> Scene {
    let lamp = "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 5\n\
                [[shape]]\ntype = \"sphere\"\ncenter = [1, 2.5, 1]\nradius = 0.5\nmaterial = \"lamp\"\n";
    let medium = "[[medium]]\nname = \"flesh\"\nscattering = [4, 3, 1]\nabsorption = [0.1, 0.5, 1]\n";
    let parts = [material(keys), text::ball("fog", [0.0; 3], 0.9), lamp.into(), medium.into()];
    let text = text::scene(16, 20, FROM, TO, &parts).replace("vfov = 0.001", "vfov = 40");
    load_toml_str(&text, "below", Path::new("")).expect("a scene")
}

/// A body that lets all light in is a medium within a white boundary, also where that is rough.
#[test]
fn what_is_below_is_a_medium() {
    let color = [0.9, 0.6, 0.2];
    let below = scene(&format!(
        "roughness = 0.5\nbase_color = {color:?}\nsubsurface = 1\nsubsurface_radius = [0.1, 0.2, 0.3]\nsubsurface_anisotropy = 0.3"
    ));
    let mut by_hand = scene("roughness = 0.5\ntransmission = 1\ninterior = \"flesh\"");
    // The colours of van de Hulst's relation, inverted here by hand.
    let albedo = color.map(|color: f64| {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let albedo = 0.5 * (low + high);
            let s: f64 = ((1.0_f64 - albedo) / (1.0 - albedo * 0.3)).sqrt();
            let sent_back = (1.0 - s) * (1.0 - 0.139 * s) / (1.0 + 1.17 * s);
            if sent_back < color { low = albedo } else { high = albedo }
        }
        low
    });
    let medium = &mut by_hand.media[0];
    medium.phase = gpt::scene::Phase::of(gpt::scene::PhaseKind::HenyeyGreenstein { g: 0.3 });
    for (channel, radius) in [0.1, 0.2, 0.3].into_iter().enumerate() {
        let mut set = |value: f64, of: fn(&mut gpt::scene::Medium) -> &mut gpt::spectrum::Spectrum| {
            let mut rgb = of(medium).to_rgb();
            rgb[channel] = value / radius;
            *of(medium) = gpt::spectrum::Spectrum::from_rgb(rgb);
        };
        set(albedo[channel], |medium| &mut medium.scattering);
        set(1.0 - albedo[channel], |medium| &mut medium.absorption);
    }
    let mean = |scene: &Scene| {
        let pixels = (crate::closed_forms::devices()[0].1)(scene);
        let count = pixels.len() as f64;
        [0, 1, 2].map(|channel| pixels.iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>() / count)
    };
    let [below, by_hand] = [mean(&below), mean(&by_hand)];
    for channel in 0..3 {
        assert!((below[channel] / by_hand[channel] - 1.0).abs() < 2e-3, "{below:?} {by_hand:?}");
    }
}

/// Part of the light is scattered back by the base, the rest below.
#[test]
fn partly_translucent_bodies_agree_path_by_path() {
    let keys =
        "roughness = 0.3\nbase_color = [0.8, 0.5, 0.4]\nsubsurface = 0.6\nsubsurface_radius = [0.4, 0.2, 0.1]\nclearcoat = 0.5";
    crate::agreement::assert_agrees("partly translucent", &scene(keys), &PlanOptions::default());
}
