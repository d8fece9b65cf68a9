//! Light from all around, from a map of 16 × 8 texels: where each texel is, and what a map lights.

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use super::super::formulas::normalized;
use super::super::picture::{SceneFile, hdr};
use super::super::test::Test;
use super::stage::{SCREEN, diffuse, frontal, light, material, on_plane, scaled, scene, shape, sized};

const WIDTH: u32 = 16;
const HEIGHT: u32 = 8;
/// Half the angle of view of the camera within the map.
const HALF: f64 = 35.0;

/// Multiples of 1/16 up to 2, which Radiance pictures hold exactly.
fn texel(x: u32, y: u32) -> [f64; 3] {
    let level = |a: u32, b: u32| f64::from(2 + (x * a + y * b) % 11 * 3) / 16.0;
    [level(3, 4), level(5, 2), level(1, 7)]
}

fn file() -> SceneFile {
    hdr("sky.hdr", [WIDTH, HEIGHT], |x, y| texel(x, y).map(|value| value as f32))
}

fn map(keys: &str) -> String {
    light("environment", &format!("file = \"sky.hdr\"\n{keys}"))
}

/// Interpolation between the middles of texels, at u and v from the upper left corner, where these lie `middle` texels from their corners.
fn at([u, v]: [f64; 2], middle: f64) -> [f64; 3] {
    let (x, y) = (u * f64::from(WIDTH) - middle, v * f64::from(HEIGHT) - middle);
    let (left, top) = (x.floor(), y.floor());
    let (fx, fy) = (x - left, y - top);
    let value = |dx: i64, dy: i64| {
        let column = (left as i64 + dx).rem_euclid(i64::from(WIDTH)) as u32;
        let row = (top as i64 + dy).clamp(0, i64::from(HEIGHT) - 1) as u32;
        texel(column, row)
    };
    let [a, b, c, d] = [value(0, 0), value(1, 0), value(0, 1), value(1, 1)];
    std::array::from_fn(|i| (1.0 - fy) * ((1.0 - fx) * a[i] + fx * b[i]) + fy * ((1.0 - fx) * c[i] + fx * d[i]))
}

/// u = atan2(x, −z)/2π and v = acos(y)/π of a direction.
fn uv(direction: [f64; 3]) -> [f64; 2] {
    let [x, y, z] = direction;
    [(x.atan2(-z) / TAU).rem_euclid(1.0), y.clamp(-1.0, 1.0).acos() / PI]
}

fn seen(direction: [f64; 3]) -> [f64; 3] {
    at(uv(direction), 0.5)
}

/// A camera at the origin, by its axes.
#[derive(Clone, Copy)]
struct View {
    forward: [f64; 3],
    right: [f64; 3],
    up: [f64; 3],
}

impl View {
    fn direction(self, s: f64, t: f64) -> [f64; 3] {
        let half = HALF.to_radians().tan();
        let (a, b) = (half * (2.0 * s - 1.0), half * (1.0 - 2.0 * t));
        normalized(std::array::from_fn(|axis| self.forward[axis] + a * self.right[axis] + b * self.up[axis]))
    }

    fn scene(self, keys: &str) -> String {
        let Self { forward, up, .. } = self;
        scene(&format!("position = [0, 0, 0]\nlook_at = {forward:?}\nup = {up:?}\nvfov = {}\n", 2.0 * HALF), &surroundings(keys))
    }
}

/// The map alone, since the one shape is too small to be seen.
fn surroundings(keys: &str) -> String {
    let far = shape("sphere", "m", "center = [0, -50, 0]\nradius = 0.001");
    format!("{}{far}{}", diffuse(0.5), map(keys))
}

const FRONT: View = View { forward: [0.0, 0.0, -1.0], right: [1.0, 0.0, 0.0], up: [0.0, 1.0, 0.0] };
const RIGHT: View = View { forward: [1.0, 0.0, 0.0], right: [0.0, 0.0, 1.0], up: [0.0, 1.0, 0.0] };
const ABOVE: View = View { forward: [0.0, 1.0, 0.0], right: [1.0, 0.0, 0.0], up: [0.0, 0.0, 1.0] };

/// A direction in the map's own space, of a map that is turned by so many degrees about +y, counter-clockwise seen from above.
fn turned_back([x, y, z]: [f64; 3], degrees: f64) -> [f64; 3] {
    let (sine, cosine) = (-degrees).to_radians().sin_cos();
    [cosine * x + sine * z, y, -sine * x + cosine * z]
}

pub fn tests() -> Vec<Test> {
    const DECIDES: &str = "`environment` of the scene file: u = atan2(x, -z)/2π, v = acos(y)/π from the top row";
    let looking = |name, about, view: View| {
        Test::of_formula([name, about, DECIDES], view.scene(""), move |s, t| seen(view.direction(s, t)))
            .with_kinks()
            .file(file())
            .mistake("a map whose left is its right", move |s, t| {
                let [u, v] = uv(view.direction(s, t));
                at([1.0 - u, v], 0.5)
            })
            .mistake("a map that lies half a texel off", move |s, t| at(uv(view.direction(s, t)), 0.0))
            .mistake("a map that is turned by a quarter", move |s, t| seen(turned_back(view.direction(s, t), 90.0)))
            .mistake("a map that stands upside down", move |s, t| {
                let [u, v] = uv(view.direction(s, t));
                at([u, 1.0 - v], 0.5)
            })
    };
    let irradiance = {
        let (rows, columns) = (256, 1024);
        let mut sum = [0.0; 3];
        for row in 0..rows {
            for column in 0..columns {
                let theta = PI * (f64::from(row) + 0.5) / f64::from(rows);
                let phi = TAU * (f64::from(column) + 0.5) / f64::from(columns);
                let direction = [theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()];
                let weight = direction[2].max(0.0) * theta.sin() * (PI / f64::from(rows)) * (TAU / f64::from(columns));
                let value = seen(direction);
                for channel in 0..3 {
                    sum[channel] += weight * value[channel];
                }
            }
        }
        sum
    };
    let on_paper = scaled(irradiance, 0.5 * FRAC_1_PI);
    let reflected = |s: f64, t: f64| {
        let [x, y] = on_plane(s, t);
        normalized([x, y, 4.0])
    };
    vec![
        looking("environments/front", "A map of the surroundings, looking along −z: its middle column is behind.", FRONT),
        looking("environments/right", "A map of the surroundings, looking along +x.", RIGHT),
        looking("environments/pole", "A map of the surroundings, looking up at its pole.", ABOVE),
        Test::of_formula(
            ["environments/turned", "A map that is turned by 50 degrees, counter-clockwise seen from above.", DECIDES],
            FRONT.scene("rotate = 50"),
            |s, t| seen(turned_back(FRONT.direction(s, t), 50.0)),
        )
        .with_kinks()
        .file(file())
        .mistake("a map that is turned the other way", |s, t| seen(turned_back(FRONT.direction(s, t), -50.0)))
        .mistake("a map that is not turned", |s, t| seen(FRONT.direction(s, t))),
        Test::of_formula(
            ["environments/in-mirror", "A map of the surroundings in a mirror.", "Law of reflection"],
            frontal(&format!("{}{SCREEN}{}", material("m", "type = \"mirror\""), map(""))),
            move |s, t| seen(reflected(s, t)),
        )
        .with_kinks()
        .file(file())
        .mistake("a map whose left is its right", move |s, t| {
            let [u, v] = uv(reflected(s, t));
            at([1.0 - u, v], 0.5)
        }),
        Test::of_constant(
            [
                "environments/on-paper",
                "A diffuse plane under a map: the integral of its texels with the cosine.",
                "Cosine law; texels count by their solid angle",
            ],
            frontal(&format!("{}{SCREEN}{}", diffuse(0.5), map(""))),
            on_paper,
        )
        .file(file())
        .mistake("texels that count alike, whatever their solid angle", move |_, _| scaled(on_paper, PI / 2.0))
        .mistake("a missing cosine", move |_, _| scaled(on_paper, 2.0)),
        Test::of_formula(
            ["environments/scaled", "A map whose radiance is multiplied by 3.", "`scale` of the scene file"],
            FRONT.scene("scale = 3"),
            |s, t| scaled(seen(FRONT.direction(s, t)), 3.0),
        )
        .with_kinks()
        .file(file())
        .mistake("a factor that is left out", |s, t| seen(FRONT.direction(s, t))),
        panorama(),
        fisheye(),
    ]
}

/// The scene of [`View::scene`] with another projection and a film of this size.
fn by_lens(size: [u32; 2], projection: &str) -> String {
    sized(size, &format!("position = [0, 0, 0]\nlook_at = [0, 0, -1]\n{projection}\n"), &surroundings(""))
}

/// All directions in one picture.
fn panorama() -> Test {
    let direction = |s: f64, t: f64| {
        let (azimuth, elevation) = (PI * (2.0 * s - 1.0), PI * (0.5 - t));
        [azimuth.sin() * elevation.cos(), elevation.sin(), -azimuth.cos() * elevation.cos()]
    };
    Test::of_formula(
        [
            "cameras/panorama",
            "An equirectangular panorama: its middle is straight ahead, and equal steps to the right are equal angles.",
            "`equirectangular` of the scene file",
        ],
        by_lens([64, 32], "projection = \"equirectangular\""),
        move |s, t| seen(direction(s, t)),
    )
    .with_kinks()
    .file(file())
    .mistake("a panorama whose left is its right", move |s, t| seen(direction(1.0 - s, t)))
    .mistake("a panorama that is turned by a quarter", move |s, t| seen(turned_back(direction(s, t), 90.0)))
    .mistake("rows of equal solid angles", |s, t| {
        let (azimuth, height) = (PI * (2.0 * s - 1.0), 1.0 - 2.0 * t);
        let level = (1.0 - height * height).max(0.0).sqrt();
        seen([azimuth.sin() * level, height, -azimuth.cos() * level])
    })
}

/// A lens whose distances from the middle are angles from the axis.
fn fisheye() -> Test {
    const HALF_ANGLE: f64 = 70.0;
    let direction = |angle: fn(f64) -> f64| {
        move |s: f64, t: f64| {
            let [x, y] = [2.0 * s - 1.0, 1.0 - 2.0 * t];
            let distance = x.hypot(y);
            let (sine, cosine) = angle(distance / 2f64.sqrt()).sin_cos();
            [sine * x / distance, sine * y / distance, -cosine]
        }
    };
    let equidistant = direction(|distance| distance * HALF_ANGLE.to_radians());
    let equisolid = direction(|distance| 2.0 * (distance * (0.5 * HALF_ANGLE.to_radians()).sin()).asin());
    let flat = direction(|distance| (distance * HALF_ANGLE.to_radians().tan()).atan());
    Test::of_formula(
        [
            "cameras/fisheye",
            "An equidistant fisheye of 140 degrees from corner to corner.",
            "`fisheye` of the scene file: the distance from the middle is in proportion to the angle",
        ],
        by_lens([64, 64], "projection = \"fisheye\"\nfov = 140\nmapping = \"equidistant\"\nfit = \"diagonal\""),
        move |s, t| seen(equidistant(s, t)),
    )
    .with_kinks()
    .file(file())
    .mistake("an equisolid lens", move |s, t| seen(equisolid(s, t)))
    .mistake("a perspective of the same angle", move |s, t| seen(flat(s, t)))
    .mistake("a picture of the surroundings whose left is its right", move |s, t| seen(equidistant(1.0 - s, t)))
}
