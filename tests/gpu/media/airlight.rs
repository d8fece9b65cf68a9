//! Light scattered once in a medium without end, of a point light and of a glowing ball, against quadrature.

use super::text::{self, Medium};
use super::truth::{Truth, WITH_LIGHT_SAMPLES, assert_all_hold};
use crate::common::media::airlight::{self, of_ball_of_light, of_point_light};
use crate::common::media::phase::Phase;
use gpt::scene::Estimator;

const LAMP: [f64; 3] = [0.6, -0.5, -2.0];

fn in_channel(medium: &Medium, channel: usize) -> airlight::Medium {
    airlight::Medium {
        scattering: medium.scattering[channel],
        extinction: medium.extinction(channel),
        phase: medium.phase.clone(),
    }
}

fn fog(phase: Phase) -> Medium {
    Medium::new([0.15, 0.4, 1.0], [0.8, 0.6, 0.9], phase)
}

/// The radiance in each channel, from the origin along −z.
fn per_channel(medium: &Medium, of: &dyn Fn(&airlight::Medium) -> f64) -> [f64; 3] {
    std::array::from_fn(|channel| of(&in_channel(medium, channel)))
}

#[test]
#[ignore = "slow"]
fn a_point_light_in_fog_shows_its_airlight() {
    let hg = Phase::HenyeyGreenstein;
    let phases = [Phase::Isotropic, hg(0.7), hg(-0.5), Phase::Rayleigh, Phase::blend(hg(0.6), Phase::Rayleigh, 0.5)];
    let truths = phases.into_iter().enumerate().map(|(number, phase)| {
        let medium = fog(phase);
        // A black wall ends every second ray.
        let (wall, length) = if number % 2 == 0 { (String::new(), f64::INFINITY) } else { (WALL.to_owned(), 3.0) };
        let lamp = format!("[[light]]\ntype = \"point\"\nposition = {LAMP:?}\nintensity = 3\n");
        let radiance =
            |medium: &Medium| per_channel(medium, &|channel| of_point_light(channel, LAMP, 3.0, [0.0, 0.0, -1.0], length, 1e-12));
        Truth {
            name: format!("a point light, {:?}", medium.phase),
            text: text::scene(
                512,
                2,
                [0.0; 3],
                [0.0, 0.0, -1.0],
                &["medium = \"fog\"\n".into(), medium.entry("fog"), lamp, wall],
            ),
            expected: radiance(&medium),
            mistaken: radiance(&medium.scattering_less(0.98)),
            estimators: WITH_LIGHT_SAMPLES,
        }
    });
    assert_all_hold(&truths.collect::<Vec<_>>());
}

const WALL: &str = "[[material]]\nname = \"black\"\ntype = \"diffuse\"\nreflectance = 0\n\
                    [[shape]]\ntype = \"plane\"\npoint = [0, 0, -3]\nnormal = [0, 0, 1]\nmaterial = \"black\"\n";

/// Here paths meet the light by chance as well. Those that have nothing else tell less with more samples.
#[test]
fn a_glowing_ball_in_fog_shows_its_airlight() {
    let medium = fog(Phase::Isotropic);
    let radiance =
        |medium: &Medium| per_channel(medium, &|channel| of_ball_of_light(channel, LAMP, 0.7, 2.0, [0.0, 0.0, -1.0], 3.0));
    let lamp = format!(
        "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 2\n\
         [[shape]]\ntype = \"sphere\"\ncenter = {LAMP:?}\nradius = 0.7\nmaterial = \"lamp\"\n"
    );
    let parts = ["medium = \"fog\"\n".into(), medium.entry("fog"), lamp, WALL.into()];
    let truth = |name: &str, spp, factor, estimators| Truth {
        name: name.into(),
        text: text::scene(spp, 2, [0.0; 3], [0.0, 0.0, -1.0], &parts),
        expected: radiance(&medium),
        mistaken: radiance(&medium.scattering_less(factor)),
        estimators,
    };
    assert_all_hold(&[
        truth("a glowing ball", 256, 0.98, WITH_LIGHT_SAMPLES),
        truth("a glowing ball met by chance", 1024, 0.95, &[Estimator::Bsdf]),
    ]);
}
