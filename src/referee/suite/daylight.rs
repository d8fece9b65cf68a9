//! Daylight in black rooms, after the cases of CIE 171:2006 that closed forms decide: openings, and reflection past an obstruction.

use std::f64::consts::FRAC_1_PI;

use super::super::formulas;
use super::super::test::Test;
use super::stage::{SCREEN, diffuse, fan, frontal, light, material, on_plane, scaled, shape};

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const COLOR: [f64; 3] = [3.0, 2.0, 1.0];
/// Half the length and the width of the rooms, and their height, above the camera.
const HALF: f64 = 4.0;
const HEIGHT: f64 = 4.2;
/// The opening in the roof.
const ROOF: [[f64; 2]; 2] = [[-1.5, -2.0], [2.5, 1.2]];
/// The wall with a window, and the window's (y, z).
const WALL: f64 = -2.0;
const WINDOW: [[f64; 2]; 2] = [[-1.5, 0.8], [1.5, 2.6]];

fn place(s: f64, t: f64) -> [f64; 3] {
    let [x, y] = on_plane(s, t);
    [x, y, 0.0]
}

/// The radiance of the floor, whose reflectance is 1/2.
fn seen(irradiance: f64) -> [f64; 3] {
    scaled(COLOR, 0.5 * FRAC_1_PI * irradiance)
}

/// A black rectangle between two corners of a plane across the axis `across`, at this place on it.
fn black(across: usize, at: f64, [a0, b0]: [f64; 2], [a1, b1]: [f64; 2]) -> String {
    let put = |a: f64, b: f64, at: f64| match across {
        0 => [at, a, b],
        1 => [a, at, b],
        _ => [a, b, at],
    };
    let keys =
        format!("corner = {:?}\nedge_u = {:?}\nedge_v = {:?}", put(a0, b0, at), put(a1 - a0, 0.0, 0.0), put(0.0, b1 - b0, 0.0));
    shape("rectangle", "black", &keys)
}

/// Black strips that leave `hole` open of the rectangle from `low` to `high`.
fn around(across: usize, at: f64, [low, high]: [[f64; 2]; 2], [from, to]: [[f64; 2]; 2]) -> String {
    [
        black(across, at, low, [from[0], high[1]]),
        black(across, at, [to[0], low[1]], high),
        black(across, at, [from[0], low[1]], [to[0], from[1]]),
        black(across, at, [from[0], to[1]], [to[0], high[1]]),
    ]
    .concat()
}

/// A floor in a black room under an even sky, which begins at this x with the wall `left`; `roof` is the ceiling.
fn room(from: f64, left: &str, roof: &str) -> String {
    let walls = [
        black(0, HALF, [-HALF, 0.0], [HALF, HEIGHT]),
        black(1, -HALF, [from, 0.0], [HALF, HEIGHT]),
        black(1, HALF, [from, 0.0], [HALF, HEIGHT]),
        // No sky shines from below past the floor.
        black(2, -0.01, [from, -HALF], [HALF, HALF]),
    ];
    let coats = diffuse(0.5) + &material("black", "type = \"diffuse\"\nreflectance = 0");
    let sky = light("environment", &format!("radiance = {COLOR:?}"));
    frontal(&format!("{coats}{SCREEN}{}{left}{roof}{sky}", walls.concat()))
}

/// ∫ weight·cos θ·cos θ'/r² over a rectangle, for a point of the floor. `point` and `normal` are those of the rectangle; the weight is by the direction to it.
fn over(
    from: [f64; 3],
    [low, high]: [[f64; 2]; 2],
    point: impl Fn(f64, f64) -> [f64; 3],
    normal: [f64; 3],
    weight: impl Fn([f64; 3]) -> f64,
) -> f64 {
    let rule = formulas::gauss_legendre(24);
    let mut sum = 0.0;
    for &(x, weight_x) in &rule {
        for &(y, weight_y) in &rule {
            let at = point(low[0] + x * (high[0] - low[0]), low[1] + y * (high[1] - low[1]));
            let way = formulas::sub(at, from);
            let direction = formulas::normalized(way);
            let cosines = formulas::dot(direction, UP).max(0.0) * formulas::dot(direction, normal).abs();
            sum += weight_x * weight_y * weight(direction) * cosines / formulas::dot(way, way);
        }
    }
    sum * (high[0] - low[0]) * (high[1] - low[1])
}

pub fn tests() -> Vec<Test> {
    vec![roof_opening(), roof_glazed(), window(), obstruction()]
}

const FLOOR: [[f64; 2]; 2] = [[-HALF, -HALF], [HALF, HALF]];

fn roof_corners() -> [[f64; 3]; 4] {
    let [[x0, y0], [x1, y1]] = ROOF;
    [[x0, y0, HEIGHT], [x0, y1, HEIGHT], [x1, y1, HEIGHT], [x1, y0, HEIGHT]]
}

fn closed_left() -> String {
    black(0, -HALF, [-HALF, 0.0], [HALF, HEIGHT])
}

fn roof_opening() -> Test {
    let direct = |s, t| formulas::polygon(place(s, t), UP, &roof_corners()).abs();
    let without_cosine = |s: f64, t: f64| over(place(s, t), ROOF, |x, y| [x, y, HEIGHT], UP, |direction| 1.0 / direction[2]);
    Test::of_formula(
        [
            "daylight/roof-opening",
            "An even sky lights the floor of a black room through an opening in its roof.",
            "Lambert 1760; configuration factor of a polygon; after CIE 171:2006, sky component under a roof opening",
        ],
        room(-HALF, &closed_left(), &around(2, HEIGHT, FLOOR, ROOF)),
        move |s, t| seen(direct(s, t)),
    )
    .mistake("a missing cosine at the floor", move |s, t| seen(without_cosine(s, t)))
    .mistake("a sky that is seen whole, as if there were no roof", |_, _| scaled(COLOR, 0.5))
    .mistake("light from one half of the opening", {
        let [[x0, y0], [x1, y1]] = ROOF;
        move |s, t| {
            let middle = 0.5 * (x0 + x1);
            let corners = [[x0, y0, HEIGHT], [x0, y1, HEIGHT], [middle, y1, HEIGHT], [middle, y0, HEIGHT]];
            seen(formulas::polygon(place(s, t), UP, &corners).abs())
        }
    })
}

/// The opening with a pane in it.
fn roof_glazed() -> Test {
    let through = |weight: fn(f64) -> f64| {
        move |s: f64, t: f64| seen(over(place(s, t), ROOF, |x, y| [x, y, HEIGHT], UP, |direction| weight(direction[2])))
    };
    let [[x0, y0], [x1, y1]] = ROOF;
    let pane = material("pane", "type = \"glass\"\nior = 1.5\nthin = true")
        + &shape(
            "rectangle",
            "pane",
            &format!("corner = {:?}\nedge_u = {:?}\nedge_v = {:?}", [x0, y0, HEIGHT], [x1 - x0, 0.0, 0.0], [0.0, y1 - y0, 0.0]),
        );
    let scene = room(-HALF, &closed_left(), &(around(2, HEIGHT, FLOOR, ROOF) + &pane));
    Test::of_formula(
        [
            "daylight/roof-glazed",
            "An even sky lights the floor of a black room through a pane of glass in its roof.",
            "Fresnel 1823, (1 - R)/(1 + R) of a plate for each direction; after CIE 171:2006, sky component under a glazed roof opening",
        ],
        // Light that the floor throws back is not followed up to the pane.
        scene.replace("max_depth = 64", "max_depth = 3"),
        through(|cosine| 1.0 - formulas::plate(cosine, 1.5)),
    )
    .mistake("an opening without a pane", through(|_| 1.0))
    .mistake("a pane with one surface", through(|cosine| 1.0 - formulas::dielectric(cosine, 1.5)))
    .mistake("a pane that is passed twice", through(|cosine| (1.0 - formulas::plate(cosine, 1.5)).powi(2)))
}

fn window() -> Test {
    let [[y0, z0], [y1, z1]] = WINDOW;
    let corners = [[WALL, y0, z0], [WALL, y1, z0], [WALL, y1, z1], [WALL, y0, z1]];
    let direct = move |s, t| formulas::polygon(place(s, t), UP, &corners).abs();
    let by_sky = |weight: fn([f64; 3]) -> f64| {
        move |s: f64, t: f64| over(place(s, t), WINDOW, |y, z| [WALL, y, z], [1.0, 0.0, 0.0], weight)
    };
    let overcast = by_sky(|direction| (1.0 + 2.0 * direction[2]) / 3.0);
    let without_cosine = by_sky(|direction| 1.0 / direction[2]);
    let left = around(0, WALL, [[-HALF, 0.0], [HALF, HEIGHT]], WINDOW);
    Test::of_formula(
        [
            "daylight/window",
            "An even sky lights the floor of a black room through a window in its wall.",
            "Lambert 1760; configuration factor of a polygon; after CIE 171:2006, sky component under a facade opening",
        ],
        room(WALL, &left, &black(2, HEIGHT, [WALL, -HALF], FLOOR[1])),
        move |s, t| seen(direct(s, t)),
    )
    .mistake("a sky that is darker towards the horizon, as an overcast one", move |s, t| seen(overcast(s, t)))
    .mistake("a missing cosine at the floor", move |s, t| seen(without_cosine(s, t)))
}

/// A wall in parallel light sends light to the floor past a black screen, which also throws its shadow on the wall.
fn obstruction() -> Test {
    const SCREEN_X: f64 = -0.6;
    const SCREEN_HEIGHT: f64 = 0.3;
    const WALL_X: f64 = -1.5;
    // The wall above this height, as a point of the floor sees it.
    let part = |from: f64, s: f64, t: f64| {
        let corners = [[WALL_X, -3.0, from], [WALL_X, 3.0, from], [WALL_X, 3.0, 2.0], [WALL_X, -3.0, 2.0]];
        if from < 2.0 { 0.8 * FRAC_1_PI * formulas::polygon(place(s, t), UP, &corners).abs() } else { 0.0 }
    };
    // The camera is above x = 0 at a height of 4.
    let is_hidden = |x: f64| (SCREEN_X * 4.0 / (4.0 - SCREEN_HEIGHT)..SCREEN_X).contains(&x);
    let hidden_below = |x: f64| if x > SCREEN_X { SCREEN_HEIGHT * (x - WALL_X) / (x - SCREEN_X) } else { 0.0 };
    let value = move |hides: bool, shades: bool| {
        move |s: f64, t: f64| {
            let x = place(s, t)[0];
            let from = if hides { hidden_below(x) } else { 0.0 }.max(if shades { SCREEN_HEIGHT } else { 0.0 });
            if is_hidden(x) { [0.0; 3] } else { seen(part(from, s, t)) }
        }
    };
    let coats = diffuse(0.5)
        + &material("black", "type = \"diffuse\"\nreflectance = 0")
        + &material("white", "type = \"diffuse\"\nreflectance = 0.8");
    let wall = [[WALL_X, -3.0, 0.0], [WALL_X, 3.0, 0.0], [WALL_X, 3.0, 2.0], [WALL_X, -3.0, 2.0]];
    let screen = black(0, SCREEN_X, [-60.0, 0.0], [60.0, SCREEN_HEIGHT]);
    let along = light("directional", &format!("direction = [-1, 0, 0]\nirradiance = {COLOR:?}"));
    Test::of_formula(
        [
            "daylight/obstruction",
            "A white wall in parallel light lights the floor past a black screen, which shades the foot of the wall.",
            "Lambert 1760, over the part of the wall that is lit and seen; after CIE 171:2006, diffuse reflection with an obstruction",
        ],
        frontal(&format!("{coats}{SCREEN}{}{screen}{along}", fan("white", &wall, ""))).replace("max_depth = 64", "max_depth = 3"),
        value(true, true),
    )
    .with_edges()
    .mistake("light of the wall that goes through the screen", value(false, true))
    .mistake("a wall without the screen's shadow", value(true, false))
    .mistake("no indirect light", |_, _| [0.0; 3])
}
