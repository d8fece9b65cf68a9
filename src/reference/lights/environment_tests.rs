//! Environments of every kind: what they show, and how directions to them are drawn.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DMat3, DVec3, Vec3};

use super::{Outside, outside_light};
use crate::compare::sidak;
use crate::reference::warp;
use crate::scene::{Environment, EnvironmentRadiance, ImageData, Light, MapRows, Sky};
use crate::spectrum::Spectrum;
use crate::statistics::chi_squared_test;
use crate::statistics::random::SplitMix64;

fn of_light(light: Light) -> Outside {
    Outside::of(outside_light(&light).into_iter())
}

fn map(width: u32, height: u32, rotation: f64, texel: impl Fn(u32, u32) -> Vec3) -> Outside {
    map_of([width, height], rotation, MapRows::Inside, texel)
}

fn map_of([width, height]: [u32; 2], rotation: f64, rows: MapRows, texel: impl Fn(u32, u32) -> Vec3) -> Outside {
    let texels: Vec<_> = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect();
    of_image(Arc::new(ImageData { width, height, texels: texels.into(), has_alpha: false }), rotation, rows, None)
}

fn of_image(image: Arc<ImageData>, rotation_degrees: f64, rows: MapRows, turn: Option<DMat3>) -> Outside {
    let radiance = EnvironmentRadiance::Map(image);
    of_light(Light::Environment(Environment { radiance, rotation_degrees, turn, rows, mirrored: false }))
}

/// A map that is turned about +Y by an angle, and then by a rotation.
fn turned_map(rotation: f64, turn: Option<DMat3>) -> Outside {
    let texels: Vec<_> = (0..128_u32).map(|i| Vec3::new((i * 37 % 11) as f32, (i * 17 % 5) as f32 + 0.1, 1.0)).collect();
    let image = ImageData { width: 16, height: 8, texels: texels.into(), has_alpha: false };
    of_image(Arc::new(image), rotation, MapRows::Inside, turn)
}

fn sky(zenith: f64, horizon: f64, ground: f64) -> Outside {
    let [zenith, horizon, ground] = [zenith, horizon, ground].map(Spectrum::grey);
    of_light(Light::Sky(Sky { zenith, horizon, ground }))
}

fn dotted(width: u32, height: u32, x: u32, y: u32) -> Outside {
    map(width, height, 0.0, |column, row| if (column, row) == (x, y) { Vec3::splat(50.0) } else { Vec3::ZERO })
}

fn environments() -> Vec<(&'static str, Outside)> {
    let noise = |x: u32, y: u32| Vec3::new((x * 37 % 11) as f32, (y * 17 % 5) as f32 + 0.1, ((x + y) * 7 % 13) as f32);
    let radiance = EnvironmentRadiance::Constant(Spectrum::WHITE);
    let constant = of_light(Light::Environment(Environment {
        radiance,
        rotation_degrees: 0.0,
        turn: None,
        rows: MapRows::Inside,
        mirrored: false,
    }));
    vec![
        ("1 x 1", map(1, 1, 0.0, |_, _| Vec3::ONE)),
        ("2 x 1", map(2, 1, 0.0, |x, _| Vec3::splat(1.0 + 4.0 * x as f32))),
        ("16 x 8, turned", map(16, 8, 130.0, noise)),
        ("7 x 5, turned back", map(7, 5, -20.0, noise)),
        ("7 x 5, to the poles", map_of([7, 5], 10.0, MapRows::ToPoles, noise)),
        ("a row, to the poles", map_of([3, 1], 0.0, MapRows::ToPoles, noise)),
        ("turned about any axis", turned_map(25.0, Some(DMat3::from_axis_angle(DVec3::new(0.6, -0.64, 0.48), 1.1)))),
        ("a bright texel", dotted(16, 8, 3, 2)),
        ("a bright texel at a pole", dotted(16, 8, 0, 0)),
        ("a texel 10¹² times the others", map(16, 8, 0.0, |x, y| Vec3::splat(if (x, y) == (5, 3) { 1e12 } else { 1.0 }))),
        ("sky", sky(0.3, 1.0, 0.2)),
        ("sky, dark at the horizon", sky(1.0, 0.0, 0.0)),
        ("sky, all ground", sky(0.0, 0.0, 1.0)),
        ("constant", constant),
    ]
}

fn bits(u: f64) -> u32 {
    (u * 4_294_967_296.0) as u32
}

/// Bins across and down, even in azimuth and in θ.
const BINS: [usize; 2] = [16, 8];

/// How many of `samples` directions fall into each bin, counted and as the density has it. In θ and φ a map's density times the sine is
/// bounded, at the poles as well.
fn count(environment: &Outside, samples: u32, density: impl Fn(DVec3) -> f64) -> (Vec<u64>, Vec<f64>) {
    let [across, down] = BINS;
    let mut observed = vec![0; across * down];
    let mut random = SplitMix64::new(u64::from(samples));
    for _ in 0..samples {
        if let Some(drawn) = environment.sample(bits(random.uniform()), bits(random.uniform())) {
            let turn = (drawn.wi.x.atan2(-drawn.wi.z) / TAU).rem_euclid(1.0);
            let polar = drawn.wi.x.hypot(drawn.wi.z).atan2(drawn.wi.y) / PI;
            let bin = |x: f64, bins: usize| ((x * bins as f64) as usize).min(bins - 1);
            observed[bin(polar, down) * across + bin(turn, across)] += 1;
        }
    }
    let fine = 60;
    let mut expected = vec![0.0; across * down];
    let area = TAU * PI / (across * down * fine * fine) as f64;
    for (x, y) in (0..down * fine).flat_map(|y| (0..across * fine).map(move |x| (x, y))) {
        let (sine, cosine) = (PI * (y as f64 + 0.5) / (down * fine) as f64).sin_cos();
        let (sin_phi, cos_phi) = (TAU * (x as f64 + 0.5) / (across * fine) as f64).sin_cos();
        let wi = DVec3::new(sine * sin_phi, cosine, -sine * cos_phi);
        expected[y / fine * across + x / fine] += density(wi) * sine * area * f64::from(samples);
    }
    (observed, expected)
}

/// Directions follow their density, which integrates to 1; the density of a sample is that of its direction, and so is its radiance.
#[test]
fn directions_follow_their_densities() {
    let family = environments();
    let level = sidak(0.01, family.len());
    for (name, environment) in &family {
        let (observed, expected) = count(environment, 200_000, |wi| environment.pdf(wi));
        let total = expected.iter().sum::<f64>() / 200_000.0;
        assert!((total - 1.0).abs() < 1e-3, "{name}: {total}");
        let scaled: Vec<f64> = expected.iter().map(|count| count / total).collect();
        let result = chi_squared_test(&observed, &scaled);
        assert!(result.p_value >= level, "{name}: {result:?}");
        let (_, wrong) = count(environment, 200_000, |wi| environment.pdf(wi) * (1.0 + 0.1 * wi.y + 0.02));
        let result = chi_squared_test(&observed, &wrong);
        assert!(result.p_value < level, "{name} with a wrong density: {result:?}");

        for i in 0..4000_u32 {
            let Some(drawn) = environment.sample(i.wrapping_mul(0x9e37_79b9), i.wrapping_mul(0x85eb_ca6b)) else { continue };
            let (pdf, radiance) = (environment.pdf(drawn.wi), environment.radiance(drawn.wi));
            assert!((drawn.wi.length() - 1.0).abs() < 1e-12 && drawn.pdf > 0.0);
            // A direction at a cell's very border may count as its neighbour's: rare.
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-6 * a.abs().max(b.abs()) + 1e-12;
            assert!(close(pdf, drawn.pdf), "{name}: {pdf} and {}", drawn.pdf);
            assert!(close(radiance.luminance(), drawn.radiance.luminance()), "{name}: {radiance} and {}", drawn.radiance);
        }
    }
}

#[test]
fn wherever_light_comes_from_a_direction_can_be_drawn() {
    for (name, environment) in environments() {
        for i in 0..20_000 {
            let (u1, u2) = (f64::from(i) / 20_000.0, f64::from(i * 7919 % 20_000) / 20_000.0);
            let wi = warp::uniform_sphere(u1, u2);
            assert!(environment.radiance(wi).luminance() == 0.0 || environment.pdf(wi) > 0.0, "{name}: {wi}");
        }
    }
}

/// u = atan2(x, −z)/2π, v = acos(y)/π from the top row; a rotation turns the picture counter-clockwise seen from above.
#[test]
fn maps_lie_where_the_contract_says() {
    let columns = map(8, 4, 0.0, |x, y| Vec3::new(x as f32, y as f32, 0.0));
    let at = |environment: &Outside, turns: f64, v: f64| {
        let (x, minus_z) = (TAU * turns).sin_cos();
        let (sine, cosine) = (PI * v).sin_cos();
        environment.radiance(DVec3::new(sine * x, cosine, -sine * minus_z))
    };
    for (x, y) in (0..8).flat_map(|x| (0..4).map(move |y| (f64::from(x), f64::from(y)))) {
        let found = at(&columns, (x + 0.5) / 8.0, (y + 0.5) / 4.0);
        assert!(found.distance(Spectrum::new(x, y, 0.0)) < 1e-9, "{x} {y}: {found}");
    }
    assert_eq!(columns.radiance(DVec3::Y).g(), 0.0);
    assert_eq!(columns.radiance(-DVec3::Y).g(), 3.0);
    // A rotation by 90 degrees shows along −z what is otherwise seen along +x.
    let turned = map(8, 4, 90.0, |x, y| Vec3::new(x as f32, y as f32, 0.0));
    assert!(turned.radiance(-DVec3::Z).distance(columns.radiance(DVec3::X)) < 1e-9);
    assert!(turned.radiance(DVec3::Z).distance(columns.radiance(DVec3::X)) > 1.0);
}

/// A map that a rotation turns shows in a direction what the map at rest shows in the direction turned back; about +Y a transform is the
/// key for that axis, and it comes after that.
#[test]
fn a_map_turns_about_any_axis() {
    let turn = DMat3::from_axis_angle(DVec3::new(2.0, -1.0, 0.5).normalize(), 2.1);
    let (rest, turned) = (turned_map(35.0, None), turned_map(35.0, Some(turn)));
    let (by_key, by_transform) = (turned_map(-50.0, None), turned_map(0.0, Some(DMat3::from_rotation_y(-50.0_f64.to_radians()))));
    let mut other = 0.0_f64;
    for i in 0..500 {
        let wi = warp::uniform_sphere(f64::from(i) / 500.0, f64::from(i * 211 % 500) / 500.0);
        assert!(turned.radiance(turn * wi).distance(rest.radiance(wi)) < 1e-9, "{wi}");
        assert!(by_key.radiance(wi).distance(by_transform.radiance(wi)) < 1e-9, "{wi}");
        other = other.max(turned.radiance(turn.transpose() * wi).distance(rest.radiance(wi)));
    }
    assert!(other > 1.0, "the control turns the other way: {other}");
}

#[test]
fn a_constant_map_is_a_constant_environment() {
    let constant = map(5, 3, 40.0, |_, _| Vec3::new(1.0, 2.0, 0.5));
    for wi in [DVec3::X, DVec3::Y, -DVec3::Y, DVec3::new(0.6, -0.64, 0.48)] {
        assert!(constant.radiance(wi).distance(Spectrum::new(1.0, 2.0, 0.5)) < 1e-9);
    }
    assert!(map(4, 4, 0.0, |_, _| Vec3::ZERO).is_constant());
}

/// A map whose rows grow evenly is a straight line of v: between the middles of its first and last row, or between the poles.
#[test]
fn rows_lie_within_or_reach_the_poles() {
    let map = |rows| map_of([3, 5], 0.0, rows, |_, row| Vec3::splat(row as f32));
    let at = |outside: &Outside, v: f64| {
        let (sine, cosine) = (PI * v).sin_cos();
        outside.radiance(DVec3::new(sine, cosine, 0.0)).r()
    };
    let (inside, to_poles) = (map(MapRows::Inside), map(MapRows::ToPoles));
    for v in [0.0, 0.05, 0.2, 0.5, 0.77, 1.0] {
        assert!((at(&to_poles, v) - 4.0 * v).abs() < 1e-12, "{v}");
        assert!((at(&inside, v) - (5.0 * v - 0.5).clamp(0.0, 4.0)).abs() < 1e-12, "{v}");
    }
}
