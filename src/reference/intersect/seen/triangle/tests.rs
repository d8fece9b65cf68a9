use super::*;
use crate::compare::sidak;
use crate::reference::warp;
use crate::statistics::chi_squared_test;
use crate::statistics::random::SplitMix64;

/// Parts of an edge.
const PARTS: usize = 8;

/// A corner and two edges.
type Corners = [DVec3; 3];

fn triangle() -> Corners {
    [DVec3::new(-1.0, 2.0, 0.5), DVec3::new(2.0, 0.0, 1.0), DVec3::new(-0.5, 0.3, 1.0)]
}

/// Straight below, beside, near, near a corner, aslant, under a large one and far from a small one.
fn cases() -> Vec<(DVec3, Corners)> {
    let [corner, edge_u, edge_v] = triangle();
    let middle = corner + (edge_u + edge_v) / 3.0;
    let near = middle + 0.02 * edge_u.cross(edge_v);
    let points = [DVec3::ZERO, DVec3::new(-3.0, 0.5, 2.0), near, DVec3::new(-1.0, 1.9, 0.5), DVec3::new(4.0, 2.4, 1.0)];
    let large = (50.0 * middle - edge_u.cross(edge_v), triangle().map(|vector| 50.0 * vector));
    let small = (DVec3::ZERO, [corner, 0.01 * edge_u, 0.01 * edge_v]);
    points.into_iter().map(|from| (from, triangle())).chain([large, small]).collect()
}

/// By the angles between the planes through the point and the edges (Girard).
fn solid_angle(from: DVec3, corners: [DVec3; 3]) -> f64 {
    let directions = corners.map(|corner| (corner - from).normalize());
    let angle = |at: usize| {
        let [here, next, last] = [0, 1, 2].map(|step| directions[(at + step) % 3]);
        here.cross(next).angle_between(here.cross(last))
    };
    (0..3).map(angle).sum::<f64>() - std::f64::consts::PI
}

/// The part that holds a point of these coordinates along the edges, and the solid angle of each; there are `PARTS` squared.
fn part_of(local: DVec2) -> usize {
    let steps = local * PARTS as f64;
    let [column, row] = [steps.x as usize, steps.y as usize];
    // The triangles of a row of the grid stand beside each other, two for a square and one at the end.
    let beyond = usize::from(steps.x.fract() + steps.y.fract() > 1.0);
    (row * (2 * PARTS - row) + 2 * column + beyond).min(PARTS * PARTS - 1)
}

fn solid_angles_of_parts(from: DVec3, [corner, edge_u, edge_v]: Corners) -> Vec<f64> {
    let at = |column: usize, row: usize| corner + (edge_u * column as f64 + edge_v * row as f64) / PARTS as f64;
    let mut angles = Vec::new();
    for row in 0..PARTS {
        for column in 0..PARTS - row {
            angles.push(solid_angle(from, [at(column, row), at(column + 1, row), at(column, row + 1)]));
            if column + row + 1 < PARTS {
                angles.push(solid_angle(from, [at(column + 1, row), at(column + 1, row + 1), at(column, row + 1)]));
            }
        }
    }
    angles
}

/// The parts' solid angles make up the whole, and each holds its share of the points; those drawn by area do not, unless it is small.
#[test]
fn directions_are_uniform_over_the_solid_angle() {
    let samples = 200_000;
    let level = sidak(0.01, cases().len());
    for (seed, (from, corners)) in (0..).zip(cases()) {
        let seen = SeenTriangle::new(from, corners[0], corners[1], corners[2]).expect("it is large");
        let parts = solid_angles_of_parts(from, corners);
        let whole: f64 = parts.iter().sum();
        assert!((seen.solid_angle / whole - 1.0).abs() < 1e-6, "{from}: {} and {whole}", seen.solid_angle);
        let expected: Vec<f64> = parts.iter().map(|part| part / whole * f64::from(samples)).collect();
        let p_value = |numbers: &dyn Fn(f64, f64) -> DVec2| {
            let (mut random, mut counts) = (SplitMix64::new(seed), vec![0_u64; PARTS * PARTS]);
            for _ in 0..samples {
                let numbers = numbers(random.uniform(), random.uniform());
                counts[part_of(warp::triangle(numbers.x, numbers.y))] += 1;
            }
            chi_squared_test(&counts, &expected).p_value
        };
        let found = p_value(&|u, v| seen.numbers(u, v));
        assert!(found >= level, "{from}: {found}");
        assert_eq!(p_value(&DVec2::new) < 1e-9, whole > 1e-3, "{from}: by area");
    }
}

/// Whatever corner comes first and whichever side is seen.
#[test]
fn the_solid_angle_does_not_depend_on_the_order_of_the_corners() {
    for (from, [corner, edge_u, edge_v]) in cases() {
        let of = |[a, b, c]: [DVec3; 3]| SeenTriangle::new(from, a, b - a, c - a).expect("it is large").solid_angle;
        let [a, b, c] = [corner, corner + edge_u, corner + edge_v];
        let first = of([a, b, c]);
        for other in [[b, c, a], [c, a, b], [a, c, b], [c, b, a]].map(of) {
            assert!((other / first - 1.0).abs() < 1e-9, "{from}: {other} and {first}");
        }
    }
}

/// From afar, drawing by solid angle and by area is the same.
#[test]
fn small_triangles_are_drawn_as_by_area() {
    let [corner, edge_u, edge_v] = triangle();
    let seen = SeenTriangle::new(DVec3::new(100.0, -200.0, 50.0), corner, edge_u, edge_v).expect("it is large enough");
    for (u, v) in [(0.1, 0.9), (0.5, 0.5), (0.8, 0.05), (0.99, 0.3)] {
        assert!((seen.numbers(u, v) - DVec2::new(u, v)).length() < 0.02, "{u}, {v}");
    }
}

/// A point in the plane, a triangle as thin as a hair, and one too far away.
#[test]
fn some_triangles_are_drawn_by_area() {
    let [corner, edge_u, edge_v] = triangle();
    let aside = corner + 3.0 * edge_u;
    assert!(SeenTriangle::new(aside, corner, edge_u, edge_v).is_none());
    assert!(SeenTriangle::new(corner, corner, edge_u, edge_v).is_none());
    assert!(SeenTriangle::new(DVec3::ZERO, corner, edge_u, edge_u + 1e-4 * edge_v).is_none());
    assert!(SeenTriangle::new(DVec3::new(0.0, 1e4, 0.0), corner, edge_u, edge_v).is_none());
}
