use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::*;
use crate::compare::sidak;
use crate::sampling::hash::{dimension_bits, mix};
use crate::scene::{Light, LightParameters, PointLight, SpotLight};
use crate::spectrum::Spectrum;
use crate::statistics::chi_squared_test;

fn number(key: u32, dimension: u32) -> f64 {
    f64::from(dimension_bits(mix(key + 1), dimension)) / 4_294_967_296.0
}

fn place(key: u32) -> DVec3 {
    DVec3::new(number(key, 0), number(key, 1), number(key, 2))
}

fn direction(key: u32) -> DVec3 {
    (2.0 * place(key) - 1.0).try_normalize().unwrap_or(DVec3::X)
}

/// Points and squares of many sizes, powers and directions over a room of 10 × 10 × 10, one of them in many places.
fn emitters(count: u32) -> Vec<Emitter> {
    let emitter = |index: u32| {
        let (at, power) = (10.0 * place(index), 0.01 * 1000.0_f64.powf(number(index, 3)));
        match index % 4 {
            0 => Emitter::surface([at, at + 0.2], None, false, power),
            1 => Emitter::surface([at, at + DVec3::new(0.3, 0.0, 0.3)], Some(DVec3::NEG_Y), index % 8 == 1, power),
            2 => Emitter::surface([at - 0.1, at + 0.1], Some(direction(index + 9999)), index % 8 == 2, power),
            _ => {
                let (intensity, direction) = (Spectrum::grey(power), direction(index + 777));
                let (falloff_degrees, angle_degrees) = [(0.0, 90.0), (30.0, 30.0), (170.0, 180.0)][index as usize % 3];
                let spot = SpotLight {
                    position: at,
                    direction,
                    intensity,
                    angle_degrees,
                    falloff_degrees,
                    curve: Default::default(),
                    picture: None,
                    profile: None,
                };
                Emitter::delta(&parameters(Light::Spot(spot))).expect("it is inside the scene")
            }
        }
    };
    (0..count).map(emitter).collect()
}

fn parameters(light: Light) -> LightParameters {
    light.delta().expect("it is a delta light")
}

/// Within the room, in the lights and far away.
fn points() -> impl Iterator<Item = DVec3> {
    let far = [DVec3::new(1e4, -2e3, 5.0), DVec3::new(0.0, 1e9, 0.0), DVec3::splat(-0.001)];
    (0..40).map(|key| 10.0 * place(5000 + key)).chain(far)
}

fn tree(count: u32) -> LightTree {
    LightTree::new(&emitters(count), AliasTable::new(&[]))
}

#[test]
fn probabilities_sum_to_one_everywhere() {
    for count in [2, 3, 17, 500] {
        let tree = tree(count);
        assert_eq!((tree.nodes.len() + 1, tree.trails.len()), (count as usize, count as usize));
        for point in points() {
            let sum: f64 = (0..count as usize).map(|light| tree.probability(point, light)).sum();
            assert!((sum - 1.0).abs() < 1e-9, "{count} lights at {point}: {sum}");
        }
    }
}

/// Random bits choose each light as often as its probability says; one light's share given to another is
/// noticed.
#[test]
fn lights_are_chosen_as_often_as_their_probabilities_say() {
    let (tree, draws) = (tree(60), 40_000);
    let level = sidak(0.01, 12);
    for (point, key) in points().step_by(4).zip(0_u32..) {
        let expected: Vec<f64> = (0..60).map(|light| f64::from(draws) * tree.probability(point, light)).collect();
        let mut counts = [0_u64; 60];
        for draw in 0..draws {
            let (light, probability) = tree.choose(point, dimension_bits(mix(key), draw));
            assert_eq!(probability, tree.probability(point, light));
            counts[light] += 1;
        }
        assert!(chi_squared_test(&counts, &expected).p_value > level, "at {point}");
        let largest = (0..60).max_by(|&a, &b| expected[a].total_cmp(&expected[b])).unwrap_or(0);
        let mut wrong = expected.clone();
        wrong[largest] *= 0.9;
        wrong[(largest + 1) % 60] += 0.1 * expected[largest];
        assert!(chi_squared_test(&counts, &wrong).p_value < level, "a tenth moved at {point} goes unseen");
    }
}

/// Light that reaches a point: the cosine at a flat light and the cone of a spot.
#[test]
fn no_light_that_reaches_a_point_is_left_out() {
    let (emitters, tree) = (emitters(400), tree(400));
    let mut reached = [0; 2];
    for point in points() {
        for (light, emitter) in emitters.iter().enumerate() {
            let [low, high] = emitter.bounds;
            let away = (point - 0.5 * (low + high)).normalize();
            let angle = emitter.cone.axis.dot(away).clamp(-1.0, 1.0).acos();
            let angle = if emitter.cone.two_sided { angle.min(PI - angle) } else { angle };
            let reaches = angle < emitter.cone.spread + emitter.cone.reach;
            reached[usize::from(reaches)] += 1;
            assert!(!reaches || tree.probability(point, light) > 0.0, "light {light} at {point}");
        }
    }
    assert!(reached.iter().all(|count| *count > 1000), "{reached:?}");
}

/// The nearest of equal emitters, the one of two that faces the point, and the stronger one.
#[test]
fn near_strong_lights_that_face_a_point_come_first() {
    let emitter = |x: f64, normal: DVec3, power: f64| {
        let corner = DVec3::new(x, 2.0, 0.0);
        Emitter::surface([corner, corner + DVec3::new(0.1, 0.0, 0.1)], Some(normal), false, power)
    };
    let of = |emitters: &[Emitter], point: DVec3| {
        let tree = LightTree::new(emitters, AliasTable::new(&[]));
        (0..emitters.len()).map(|light| tree.probability(point, light)).collect::<Vec<f64>>()
    };
    let row: Vec<Emitter> = (0..50).map(|index| emitter(f64::from(index), DVec3::NEG_Y, 1.0)).collect();
    let nearest = of(&row, DVec3::new(20.05, 1.0, 0.05));
    assert!(nearest[20] > 0.15 && nearest[45] < 0.01, "{nearest:?}");
    let below = DVec3::new(0.55, 0.0, 0.0);
    let facing = of(&[emitter(0.0, DVec3::NEG_Y, 1.0), emitter(1.0, DVec3::Y, 1.0)], below);
    assert_eq!(facing[1], 0.0);
    let stronger = of(&[emitter(0.0, DVec3::NEG_Y, 1.0), emitter(1.0, DVec3::NEG_Y, 3.0)], below);
    assert!((stronger[1] - 0.75).abs() < 1e-3, "{stronger:?}");
}

/// Many lights in one place and in a row whose gaps grow: trails are never longer than a word.
#[test]
fn trails_fit_whatever_the_lights() {
    let point_light = |position: DVec3| {
        let light = PointLight { position, intensity: Spectrum::WHITE, profile: None };
        Emitter::delta(&parameters(Light::Point(light))).expect("it is inside the scene")
    };
    for emitters in [
        (0..3000).map(|_| point_light(DVec3::splat(1e5))).collect::<Vec<_>>(),
        (0..900).map(|index| point_light(DVec3::X * 1.05_f64.powi(index))).collect(),
        vec![point_light(DVec3::ZERO), point_light(DVec3::ZERO)],
    ] {
        let tree = LightTree::new(&emitters, AliasTable::new(&[]));
        let sum: f64 = (0..emitters.len()).map(|light| tree.probability(DVec3::ONE, light)).sum();
        assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    }
}

#[test]
fn lights_at_infinity_make_half_of_the_choices() {
    let tree = LightTree::new(&emitters(5), AliasTable::new(&[3.0, 1.0]));
    let mut counts = [0_u32; 7];
    for draw in 0..1 << 14 {
        let (light, probability) = tree.choose(DVec3::ONE, draw << 18 | 0x1ffff);
        counts[light] += 1;
        if light >= 5 {
            assert_eq!(probability, [0.375, 0.125][light - 5]);
        }
    }
    assert_eq!(counts[..5].iter().sum::<u32>(), 1 << 13);
    assert_eq!(counts[5..], [3 << 11, 1 << 11]);
}

/// Rounding of what is known of lights, as two devices may have, changes no bit of the tree.
#[test]
fn what_differs_by_rounding_makes_the_same_tree() {
    let exact = emitters(300);
    let rounded: Vec<Emitter> = exact
        .iter()
        .map(|emitter| {
            let bounds = emitter.bounds.map(|corner| corner * (1.0 + 3e-16) + 1e-16);
            Emitter { bounds, power: emitter.power * (1.0 - 2e-16), ..*emitter }
        })
        .collect();
    let [exact, rounded] = [exact, rounded].map(|emitters| LightTree::new(&emitters, AliasTable::new(&[])));
    assert_eq!(exact.trails, rounded.trails);
    let links = |tree: &LightTree| tree.nodes.iter().map(|node| node.clusters.map(|cluster| cluster.link)).collect::<Vec<_>>();
    assert_eq!(links(&exact), links(&rounded));
    let tilted = Emitter::surface([DVec3::ZERO; 2], Some(DVec3::new(1e-17, -1.0, 1e-17)), false, 1.0);
    assert_eq!(tilted, Emitter::surface([DVec3::ZERO; 2], Some(DVec3::NEG_Y), false, 1.0));
    assert!(tilted.cone.reach > FRAC_PI_2);
}
