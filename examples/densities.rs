//! Draws points of every density of Honsdorf's thesis, and compares them with what the densities say: `cargo run --release --example densities
//! [FILE]` (default docs/figures/densities.png). Prints a line of comma-separated values for each density.
//!
//! Panels, row by row: a line with p = 3x²; the disk by uniform polar coordinates, then uniform; the sphere; the half of a sphere that
//! faces a point below. The cone of directions to a sphere light of radius 1 at the distances 1.5, 2 and 5; the hemisphere, uniform, then
//! in proportion to the cosine. Phong's lobe with the exponents 1, 10 and 100; a triangle; the Halton sequence in the bases 2 and 3.
//! Points on a sphere are seen from a little above; those behind it are grey.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use gpt::reference::warp;
use gpt::sampling::halton::radical_inverse_bits;
use gpt::sampling::hash::dimension_bits;
use image::{GrayImage, Luma};

const POINTS: u32 = 1000;
const MEASURED: u32 = 1_000_000;
const BINS: usize = 32;
const SIDE: u32 = 200;
const GAP: u32 = 8;
const COLUMNS: u32 = 5;

/// A map of two uniform numbers.
enum Drawn {
    /// In the unit square, whose lower left corner is the origin.
    Square(fn(f64, f64) -> DVec2),
    /// In a disk of radius 1 about the origin.
    Disk(fn(f64, f64) -> DVec2),
    /// On the sphere of radius 1, z up.
    Sphere(Box<dyn Fn(f64, f64) -> DVec3>),
    /// The Halton sequence in the unit square, of no random numbers at all.
    Halton,
}

/// How a density is measured: a coordinate of a point, and the share of points for which it is at most so much.
struct Measured {
    coordinate: &'static str,
    range: [f64; 2],
    of: fn(DVec3) -> f64,
    share: Box<dyn Fn(f64) -> f64>,
}

struct Panel {
    name: String,
    drawn: Drawn,
    measured: Option<Measured>,
}

fn main() -> Result<(), image::ImageError> {
    let path = std::env::args().nth(1);
    let path = path.unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/docs/figures/densities.png").to_owned());
    let panels = panels();
    let rows = (panels.len() as u32).div_ceil(COLUMNS);
    let mut picture = GrayImage::from_pixel(COLUMNS * (SIDE + GAP) - GAP, rows * (SIDE + GAP) - GAP, Luma([120]));
    for (number, panel) in (0..).zip(&panels) {
        draw(&mut picture, [number % COLUMNS, number / COLUMNS].map(|place| place * (SIDE + GAP)), number, &panel.drawn);
        if let Some(measured) = &panel.measured {
            let (mean, predicted, worst) = compare(number, &panel.drawn, measured);
            println!("{},{},{mean},{predicted},{worst}", panel.name, measured.coordinate);
        }
    }
    picture.save(&path)
}

fn panels() -> Vec<Panel> {
    let on_sphere = |name: &str, drawn: Box<dyn Fn(f64, f64) -> DVec3>, lowest: f64, share: Box<dyn Fn(f64) -> f64>| Panel {
        name: name.to_owned(),
        drawn: Drawn::Sphere(drawn),
        measured: Some(Measured { coordinate: "cos θ", range: [lowest, 1.0], of: |point| point.z, share }),
    };
    let radius = |share: fn(f64) -> f64| {
        Some(Measured {
            coordinate: "r",
            range: [0.0, 1.0],
            of: |point: DVec3| point.truncate().length(),
            share: Box::new(share),
        })
    };
    let mut panels = vec![
        Panel {
            name: "p = 3x²".to_owned(),
            drawn: Drawn::Square(|u, v| DVec2::new(u.cbrt(), v)),
            measured: Some(Measured {
                coordinate: "x",
                range: [0.0, 1.0],
                of: |point| point.x,
                share: Box::new(|x: f64| x.powi(3)),
            }),
        },
        Panel {
            name: "disk, uniform polar coordinates".to_owned(),
            drawn: Drawn::Disk(|u, v| u * DVec2::from_angle(TAU * v)),
            measured: radius(|r| r),
        },
        Panel { name: "disk".to_owned(), drawn: Drawn::Disk(|u, v| warp::disk(1.0, u, v)), measured: radius(|r| r * r) },
        on_sphere("sphere", Box::new(warp::uniform_sphere), -1.0, Box::new(|z| 0.5 * (1.0 + z))),
        on_sphere("half of a sphere that a point sees", Box::new(facing_half), -1.0, Box::new(|z: f64| facing_share(z))),
    ];
    for distance in [1.5, 2.0, 5.0_f64] {
        let opening = 1.0 - (1.0 - distance.powi(-2)).sqrt();
        panels.push(on_sphere(
            &format!("cone to a sphere at {distance} radii"),
            Box::new(move |u, v| warp::cone(opening, u, v)),
            1.0 - opening,
            Box::new(move |z| 1.0 - TAU * warp::cone_pdf(opening) * (1.0 - z)),
        ));
    }
    panels.push(on_sphere("hemisphere, uniform", Box::new(warp::uniform_hemisphere), 0.0, Box::new(|z| z)));
    panels.push(on_sphere("hemisphere, cosine", Box::new(warp::cosine_hemisphere), 0.0, Box::new(|z| z * z)));
    for exponent in [1.0, 10.0, 100.0_f64] {
        panels.push(on_sphere(
            &format!("Phong, n = {exponent}"),
            Box::new(move |u, v| warp::phong_lobe(exponent, u, v)),
            0.0,
            Box::new(move |z| z.powf(exponent + 1.0)),
        ));
    }
    panels.push(Panel {
        name: "triangle".to_owned(),
        drawn: Drawn::Square(warp::triangle),
        measured: Some(Measured {
            coordinate: "second weight",
            range: [0.0, 1.0],
            of: |point| point.x,
            share: Box::new(|x: f64| 1.0 - (1.0 - x).powi(2)),
        }),
    });
    panels.push(Panel { name: "halton".to_owned(), drawn: Drawn::Halton, measured: None });
    panels
}

/// The direction from a sphere's centre to a point of it that is seen from below.
fn facing_half(u: f64, v: f64) -> DVec3 {
    let up = warp::uniform_hemisphere(u, v);
    DVec3::new(up.x, up.y, -up.z)
}

fn facing_share(z: f64) -> f64 {
    (1.0 + z).min(1.0)
}

/// Two uniform numbers of a panel.
fn numbers(panel: u32, point: u32) -> [f64; 2] {
    [0, 1].map(|axis| (f64::from(dimension_bits(dimension_bits(panel, axis), point)) + 0.5) / 4_294_967_296.0)
}

/// A point of the Halton sequence in the bases 2 and 3.
fn halton(point: u32) -> DVec2 {
    DVec2::from([0, 1].map(|dimension| f64::from(radical_inverse_bits(0, dimension, point)) / 4_294_967_296.0))
}

/// The mean of the coordinate, measured and predicted, and the largest deviation of a bin's count in standard deviations.
fn compare(panel: u32, drawn: &Drawn, measured: &Measured) -> (f64, f64, f64) {
    let [low, high] = measured.range;
    let edge = |index: usize| low + (high - low) * index as f64 / BINS as f64;
    let mut counts = [0_u32; BINS];
    let mut sum = 0.0;
    for point in 0..MEASURED {
        let [u, v] = numbers(panel, point);
        let value = (measured.of)(match drawn {
            Drawn::Square(map) | Drawn::Disk(map) => map(u, v).extend(0.0),
            Drawn::Sphere(map) => map(u, v),
            Drawn::Halton => halton(point).extend(0.0),
        });
        sum += value;
        let bin = ((value - low) / (high - low) * BINS as f64).max(0.0) as usize;
        counts[bin.min(BINS - 1)] += 1;
    }
    // The mean is the upper end less the integral of the share, by the midpoint rule.
    let steps = 100_000;
    let width = (high - low) / f64::from(steps);
    let predicted = high - width * (0..steps).map(|i| (measured.share)(low + (f64::from(i) + 0.5) * width)).sum::<f64>();
    let deviation = |index: usize| {
        let share = (measured.share)(edge(index + 1)) - (measured.share)(edge(index));
        let expected = share * f64::from(MEASURED);
        // A bin where nothing is expected holds nothing.
        let spread = (expected * (1.0 - share)).max(1e-6).sqrt();
        (f64::from(counts[index]) - expected).abs() / spread
    };
    (sum / f64::from(MEASURED), predicted, (0..BINS).map(deviation).fold(0.0, f64::max))
}

/// A white square with its upper left corner at `corner`, and a dot for each point.
fn draw(picture: &mut GrayImage, corner: [u32; 2], panel: u32, drawn: &Drawn) {
    let side = f64::from(SIDE);
    let mut dot = |x: f64, y: f64, size: u32, shade: u8| {
        // From the square's centre, y up.
        let place = [x, -y].map(|value| (0.5 * side + 0.46 * side * value) as u32);
        for (dx, dy) in (0..size).flat_map(|dx| (0..size).map(move |dy| (dx, dy))) {
            let [x, y] = [(0, dx), (1, dy)].map(|(axis, step): (usize, u32)| corner[axis] + (place[axis] + step).min(SIDE - 1));
            picture.put_pixel(x, y, Luma([shade]));
        }
    };
    for (x, y) in (0..SIDE).flat_map(|x| (0..SIDE).map(move |y| (x, y))) {
        let [x, y] = [x, y].map(|pixel| ((f64::from(pixel) + 0.5) / side - 0.5) / 0.46);
        dot(x, y, 1, 255);
    }
    if matches!(drawn, Drawn::Disk(_) | Drawn::Sphere(_)) {
        for step in 0..2000 {
            let around = DVec2::from_angle(TAU * f64::from(step) / 2000.0);
            dot(around.x, around.y, 1, 200);
        }
    }
    let mut points: Vec<(bool, DVec2)> = (0..POINTS)
        .map(|point| {
            let [u, v] = numbers(panel, point);
            match drawn {
                Drawn::Square(map) => (true, 2.0 * map(u, v) - 1.0),
                Drawn::Disk(map) => (true, map(u, v)),
                Drawn::Sphere(map) => seen(map(u, v)),
                Drawn::Halton => (true, 2.0 * halton(point) - 1.0),
            }
        })
        .collect();
    points.sort_by_key(|(is_in_front, _)| *is_in_front);
    for (is_in_front, DVec2 { x, y }) in points {
        dot(x, y, 2, if is_in_front { 0 } else { 170 });
    }
}

/// A point of the unit sphere seen from the side and 20 degrees above: whether it is in front, and where.
fn seen(point: DVec3) -> (bool, DVec2) {
    let (sine, cosine) = (PI / 9.0).sin_cos();
    let towards = DVec3::new(0.0, -cosine, sine);
    let up = DVec3::new(0.0, sine, cosine);
    (point.dot(towards) >= 0.0, DVec2::new(point.x, point.dot(up)))
}
