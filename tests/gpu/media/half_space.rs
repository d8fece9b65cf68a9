//! Light of any order of scattering from Chandrasekhar's half space: a block so deep that nothing comes through.

use super::text::{self, Medium};
use super::truth::{ALL, Truth, WITH_LIGHT_SAMPLES, assert_all_hold};
use crate::common::media::half_space::HalfSpace;
use crate::common::media::phase::Phase;

/// Cosine of the direction to the camera, which stands 3 units from the origin.
const EYE: f64 = 0.6;

fn from() -> [f64; 3] {
    let sine = (1.0 - EYE * EYE).sqrt();
    [3.0 * 0.6 * sine, 3.0 * EYE, 3.0 * 0.8 * sine]
}

#[test]
#[ignore = "slow"]
fn a_half_space_reflects_by_the_h_function() {
    let medium = Medium::new([1.0, 2.0, 4.0], [0.5, 0.8, 0.95], Phase::Isotropic);
    let lighter = medium.scattering_less(0.98);
    let of = |medium: &Medium, law: &dyn Fn(HalfSpace) -> f64| -> [f64; 3] {
        std::array::from_fn(|channel| law(HalfSpace::new(medium.albedo(channel))))
    };
    let ground =
        [medium.entry("ground"), text::null_boundary("ground"), text::block("ground", [-40.0, -40.0, -40.0], [40.0, 0.0, 40.0])]
            .concat();
    let scene = |light: String| text::scene(64, 0, from(), [0.0; 3], &[ground.clone(), light]);
    let under_sky = |half_space: HalfSpace| half_space.plane_albedo(EYE);
    let mut truths = vec![Truth {
        name: "a half space under the sky".into(),
        text: scene(text::SKY.into()),
        expected: of(&medium, &under_sky),
        mistaken: of(&lighter, &under_sky),
        estimators: ALL,
    }];
    for cosine in [0.8, 0.25] {
        let sine = (1.0f64 - cosine * cosine).sqrt();
        let law = |half_space: HalfSpace| 3.0 * half_space.radiance([cosine, EYE]);
        truths.push(Truth {
            name: format!("a half space in light of cosine {cosine}"),
            text: scene(format!("[[light]]\ntype = \"directional\"\ndirection = [{sine:?}, {:?}, 0]\nirradiance = 3\n", -cosine)),
            expected: of(&medium, &law),
            mistaken: of(&lighter, &law),
            estimators: WITH_LIGHT_SAMPLES,
        });
    }
    assert_all_hold(&truths);
}
