//! In light that is the same everywhere and in all directions, media change nothing: by any phase function, in any shape, behind any boundary.

use super::text::{self, Medium};
use super::truth::{ALL, Truth, assert_all_hold};
use crate::common::media::phase::Phase;

/// A closed mesh, without the header of its entry.
const OCTAHEDRON: &str = "type = \"mesh\"\nmaterial = \"around fog\"\n\
     positions = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]\n\
     faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]\n";

/// The end of a shape's entry.
const MOVED: &str =
    "transform = [{ scale = 0.9 }, { rotate = [1, 1, 0], degrees = 40 }]\nmotion = [{ translate = [0.3, 0, 0.2] }]\n";

fn instance(placed: &str) -> String {
    format!("[[group]]\nname = \"body\"\n[[group.shape]]\n{OCTAHEDRON}[[instance]]\ngroup = \"body\"\n{placed}\n")
}

/// Bodies of a medium.
fn furnaces(albedo: f64) -> Vec<Truth> {
    let hg = Phase::HenyeyGreenstein;
    let blend = Phase::blend(hg(0.7), hg(-0.4), 0.3);
    let ball = || text::ball("fog", [0.0; 3], 1.0);
    let block = || text::block("fog", [-0.8, -1.0, -0.6], [0.9, 0.7, 1.0]);
    let cases = [
        ("a ball, isotropic", Phase::Isotropic, text::null_boundary("fog"), ball()),
        ("a box, forward", hg(0.3), text::null_boundary("fog"), block()),
        ("a ball, backward", hg(-0.6), text::null_boundary("fog"), ball()),
        ("a ball of glass, Rayleigh", Phase::Rayleigh, text::glass_boundary("fog", 1.5), ball()),
        ("a box of glass, blend", blend, text::glass_boundary("fog", 1.33), block()),
        ("a ball thinner than its surroundings", hg(0.4), text::glass_boundary("fog", 0.8), ball()),
        ("a mesh", hg(0.5), text::null_boundary("fog"), format!("[[shape]]\n{OCTAHEDRON}")),
        ("a mesh of glass", Phase::Isotropic, text::glass_boundary("fog", 1.5), format!("[[shape]]\n{OCTAHEDRON}")),
        (
            "a mirrored instance of glass",
            hg(-0.3),
            text::glass_boundary("fog", 1.4),
            instance("transform = [{ scale = [-0.9, 0.8, 1] }]"),
        ),
        ("an instance in motion", hg(0.5), text::null_boundary("fog"), instance("motion = [{ translate = [0.4, 0.2, -0.3] }]")),
        ("a turned ball in motion", Phase::Rayleigh, text::glass_boundary("fog", 1.3), ball() + MOVED),
    ];
    cases
        .into_iter()
        .enumerate()
        .map(|(number, (name, phase, boundary, shape))| {
            // Colours make noise, since a place is drawn for one channel.
            let (spp, extinction) = if number % 3 == 0 { (128, [0.7, 1.0, 1.6]) } else { (64, [2.0; 3]) };
            let medium = Medium::new(extinction, [albedo; 3], phase).entry("fog");
            Truth {
                name: name.into(),
                text: text::scene(spp, 0, [0.3, 0.8, 3.0], [0.1, -0.1, 0.0], &[text::SKY.into(), medium, boundary, shape]),
                expected: [1.0; 3],
                mistaken: [0.98; 3],
                estimators: ALL,
            }
        })
        .collect()
}

#[test]
#[ignore = "slow"]
fn media_without_absorption_show_the_sky() {
    assert_all_hold(&furnaces(1.0));
}

/// A medium that absorbs and glows by as much as it absorbs is in balance with a sky of radiance 1 (Kirchhoff), with a body of another within it. In a
/// medium of index n everything is n² times as bright (Clausius).
#[test]
fn glowing_media_in_balance_with_the_sky_are_not_to_be_seen() {
    let glowing = |extinction, albedo, phase, part: f64| {
        let medium = Medium::new(extinction, albedo, phase);
        let emission = medium.absorption.map(|value| value * part);
        Medium { emission, ..medium }
    };
    let text = |part| {
        let outer = glowing([0.5, 1.0, 2.0], [0.3, 0.6, 0.9], Phase::HenyeyGreenstein(0.5), part);
        let inner = glowing([3.0, 0.2, 1.0], [0.9, 0.2, 0.0], Phase::Rayleigh, part * 1.4 * 1.4);
        let bodies = [
            outer.entry("outer") + &text::null_boundary("outer") + &text::block("outer", [-1.0; 3], [1.0, 0.8, 1.2]),
            inner.entry("inner") + &text::glass_boundary("inner", 1.4) + &text::ball("inner", [0.1, 0.0, 0.2], 0.6),
        ];
        text::scene(128, 0, [0.3, 0.8, 3.0], [0.1, -0.1, 0.0], &[bodies.concat(), text::SKY.into()])
    };
    let truth = Truth { name: "in balance".into(), text: text(1.0), expected: [1.0; 3], mistaken: [0.98; 3], estimators: ALL };
    assert_all_hold(&[truth]);
}

/// Walls of albedo ½ that glow by ½ all round are filled with light of radiance 1, and fog within them takes nothing away.
#[test]
fn a_room_of_glowing_walls_is_as_bright_full_of_fog() {
    let fog = Medium::new([0.3, 1.0, 3.0], [1.0; 3], Phase::HenyeyGreenstein(0.6));
    let walls = "[[material]]\nname = \"walls\"\ntype = \"diffuse\"\nreflectance = 0.5\nemission = 0.5\nemission_two_sided = true\n\
                 [[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"walls\"\n";
    let parts = ["medium = \"fog\"\n".to_owned(), fog.entry("fog"), walls.into()];
    assert_all_hold(&[Truth {
        name: "a room full of fog".into(),
        text: text::scene(256, 0, [0.2, -0.3, 0.1], [1.0, 0.5, -0.7], &parts),
        expected: [1.0; 3],
        mistaken: [0.98; 3],
        estimators: ALL,
    }]);
}

/// The control.
#[test]
#[should_panic(expected = "a box, forward")]
fn media_with_a_little_absorption_do_not() {
    assert_all_hold(&furnaces(0.98)[1..2]);
}
