//! Media that differ from place to place, as grids say.

use super::text::{self, Medium};
use super::truth::{ALL, Truth, assert_all_hold};
use crate::common::media::grid::{Grid, Interpolation, Outside};
use crate::common::media::phase::Phase;
use crate::common::media::transmittance::through_box;

const FROM: [f64; 3] = [0.3, 0.8, 3.0];
const TO: [f64; 3] = [0.1, -0.1, 0.0];

/// A density that fills the cube from −1 to 1.
struct Density(Grid);

impl Density {
    /// The density as the value of a key of a scene file.
    fn entry(&self) -> String {
        let Grid { size, values, interpolation, .. } = &self.0;
        let filter = if *interpolation == Interpolation::Nearest { "nearest" } else { "trilinear" };
        format!("{{ resolution = {size:?}, values = {values:?}, bounds = [[-1, -1, -1], [1, 1, 1]], filter = \"{filter}\" }}")
    }

    /// Its integral along the ray on which all pixels look.
    fn depth(&self) -> f64 {
        let ends = through_box(FROM, direction(), [-1.0; 3], [1.0; 3]).expect("the ray goes through the cube");
        let to_index = |axis: usize| 0.5 * self.0.size[axis] as f64;
        let origin = std::array::from_fn(|axis| (FROM[axis] + 1.0) * to_index(axis) - 0.5);
        self.0.integral(origin, std::array::from_fn(|axis| direction()[axis] * to_index(axis)), ends)
    }

    /// The radiance at the camera before a sky of radiance 1, where what is absorbed and given off is as dense as this times a factor.
    fn radiance(&self, absorption: [f64; 3], emission: [f64; 3], factor: f64) -> [f64; 3] {
        let depth = self.depth() * factor;
        [0, 1, 2].map(|channel| {
            let left = (-absorption[channel] * depth).exp();
            let mean = if absorption[channel] == 0.0 { depth } else { (1.0 - left) / absorption[channel] };
            emission[channel] * mean + left
        })
    }
}

/// A lumpy density with voids and a peak.
fn lumps(is_blended: bool) -> Density {
    #[rustfmt::skip]
    let values = vec![0.9, 1.12, 1.85, 0.93, 1.02, 1.17, 0.37, 0.0, 0.0, 1.59, 0.19, 0.61, 0.18, 1.62, 1.39, 0.08, 1.96, 1.93, 1.31, 1.23, 0.31, 0.03, 1.06, 0.12, 0.38, 0.48, 0.06, 0.93, 0.88, 1.68, 4.0, 1.28, 1.0, 1.32, 0.91, 0.56, 2.0, 1.99, 1.68, 1.42, 0.63, 0.46, 0.58, 0.14, 1.53, 0.8, 1.69, 0.77, 1.92, 1.69, 0.0, 0.42, 1.82, 0.94, 1.96, 0.79, 0.15, 1.26, 1.56, 0.54];
    let interpolation = if is_blended { Interpolation::Trilinear } else { Interpolation::Nearest };
    Density(Grid { size: [4, 3, 5], values, interpolation, outside: Outside::Clamped })
}

fn direction() -> [f64; 3] {
    let way: [f64; 3] = std::array::from_fn(|axis| TO[axis] - FROM[axis]);
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    way.map(|x| x / length)
}

fn entry(medium: &Medium, density: &Density) -> String {
    medium.entry("fog") + &format!("density = {}\n", density.entry())
}

/// The grid's cube and a little more, with the density inside.
fn block() -> String {
    text::null_boundary("fog") + &text::block("fog", [-1.2, -1.1, -1.3], [1.1, 1.3, 1.2])
}

#[test]
#[ignore = "slow"]
fn light_along_a_line_through_a_grid_obeys_beers_law() {
    let medium =
        Medium { absorption: [0.3, 1.0, 3.0], emission: [0.0, 0.4, 0.1], ..Medium::new([0.0; 3], [0.0; 3], Phase::Isotropic) };
    let dark = Medium { absorption: [0.5, 0.7, 0.0], ..Medium::new([0.0; 3], [0.0; 3], Phase::Isotropic) };
    let glow = Medium { emission: [0.5, 0.2, 0.0], ..Medium::new([0.0; 3], [0.0; 3], Phase::Isotropic) };
    let cases = [("absorbs and glows", medium), ("absorbs", dark), ("glows alone", glow)];
    let truths = cases.iter().enumerate().map(|(number, (name, medium))| {
        let grid = lumps(number != 1);
        let radiance = |factor: f64| grid.radiance(medium.absorption, medium.emission, factor);
        Truth {
            name: format!("a grid that {name}"),
            text: text::scene(256, 0, FROM, TO, &[text::SKY.into(), entry(medium, &grid), block()]),
            expected: radiance(1.0),
            mistaken: radiance(1.05),
            estimators: ALL,
        }
    });
    assert_all_hold(&truths.collect::<Vec<_>>());
}

/// In light that is the same everywhere, lumps that scatter without loss change nothing: blended or not, in colours, behind glass, around the camera,
/// and where a grid says that all is scattered.
fn furnaces(albedo: f64) -> Vec<Truth> {
    let hg = Phase::HenyeyGreenstein;
    let medium = |extinction: [f64; 3], phase: Phase| Medium::new(extinction, [albedo; 3], phase);
    let ball = text::glass_boundary("fog", 1.4) + &text::ball("fog", [0.1, 0.0, 0.0], 0.9);
    let around = "medium = \"fog\"\n".to_owned();
    let of_albedo = format!(
        "[[medium]]\nname = \"fog\"\nmean_free_path = [0.5, 0.4, 0.6]\nphase = {{ type = \"rayleigh\" }}\ndensity = {}\n\
         albedo_grid = {{ resolution = [2, 1, 1], values = [{albedo}, {albedo}], outside = \"border\" }}\n",
        lumps(true).entry()
    );
    let in_colours = |filter: &str| {
        let other = lumps(true).0;
        let values: Vec<f64> =
            (0..3 * other.values.len()).map(|index| other.values[(index * 7 + 3) % other.values.len()]).collect();
        let bounds = "bounds = [[-1, -1, -1], [1, 1, 1]]";
        medium([1.0, 2.0, 1.5], hg(0.2)).entry("fog")
            + &format!("density = {{ resolution = {:?}, values = {values:?}, {bounds}, filter = \"{filter}\" }}\n", other.size)
            + &block()
    };
    let cases = [
        ("a density in colours", in_colours("trilinear")),
        ("a density of voxels in colours", in_colours("nearest")),
        ("blended lumps", entry(&medium([2.0; 3], hg(0.5)), &lumps(true)) + &block()),
        ("lumps of voxels", entry(&medium([2.0; 3], Phase::Isotropic), &lumps(false)) + &block()),
        ("coloured lumps", entry(&medium([0.7, 1.0, 1.6], hg(-0.3)), &lumps(true)) + &block()),
        ("lumps in glass", entry(&medium([2.0; 3], Phase::Rayleigh), &lumps(true)) + &ball),
        ("lumps around the camera", around + &entry(&medium([1.0; 3], hg(0.3)), &lumps(true))),
        ("a grid of albedos", of_albedo + &block()),
    ];
    cases
        .into_iter()
        .map(|(name, text)| Truth {
            name: name.into(),
            text: text::scene(128, 0, FROM, TO, &[text, text::SKY.into()]),
            expected: [1.0; 3],
            mistaken: [0.98; 3],
            estimators: ALL,
        })
        .collect()
}

#[test]
#[ignore = "slow"]
fn grids_without_absorption_show_the_sky() {
    assert_all_hold(&furnaces(1.0));
}

/// The control.
#[test]
#[should_panic(expected = "blended lumps")]
fn grids_with_a_little_absorption_do_not() {
    assert_all_hold(&furnaces(0.97)[2..3]);
}

/// Lumps that glow by as much as they absorb, and scatter as well, are in balance with the sky (Kirchhoff), whatever a grid of albedos says about the
/// rest.
#[test]
fn glowing_lumps_in_balance_with_the_sky_are_not_to_be_seen() {
    let absorption = [0.5, 1.0, 0.2];
    let medium =
        Medium { absorption, emission: absorption, ..Medium::new([0.5, 1.0, 2.0], [1.0; 3], Phase::HenyeyGreenstein(0.4)) };
    let text = text::scene(128, 0, FROM, TO, &[entry(&medium, &lumps(true)), block(), text::SKY.into()]);
    assert_all_hold(&[Truth { name: "glowing lumps".into(), text, expected: [1.0; 3], mistaken: [0.98; 3], estimators: ALL }]);
}

/// A grid that has one density everywhere is a homogeneous medium.
#[test]
fn even_grids_are_homogeneous() {
    let even = |size: [usize; 3], interpolation: Interpolation| {
        let values = vec![0.6; size.iter().product()];
        Density(Grid { size, values, interpolation, outside: Outside::Clamped })
    };
    let absorption = [0.5, 1.0, 2.0];
    let dark = Medium { absorption, ..Medium::new([0.0; 3], [0.0; 3], Phase::Isotropic) };
    let cases =
        [([1, 1, 1], Interpolation::Trilinear), ([3, 2, 1], Interpolation::Nearest), ([7, 5, 33], Interpolation::Trilinear)];
    let truths = cases.map(|(size, interpolation)| {
        let density = even(size, interpolation);
        Truth {
            name: format!("{size:?} voxels"),
            text: text::scene(4, 0, FROM, TO, &[entry(&dark, &density), block(), text::SKY.into()]),
            expected: density.radiance(absorption, [0.0; 3], 1.0),
            mistaken: density.radiance(absorption, [0.0; 3], 1.02),
            estimators: ALL,
        }
    });
    assert_all_hold(&truths);
}
