//! Shadows: of points, of areas, and of what is partly there.

use std::f64::consts::FRAC_1_PI;

use super::super::formulas;
use super::super::test::Test;
use super::stage::{SCREEN, diffuse, emissive, fan, frontal, light, material, on_plane, scaled, shape};

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const COLOR: [f64; 3] = [3.0, 2.0, 1.0];
/// A blocker at z = 1, from far left to this x, which the camera does not see.
const EDGE: f64 = -1.2;

fn seen(irradiance: f64) -> [f64; 3] {
    scaled(COLOR, 0.5 * FRAC_1_PI * irradiance)
}

fn place(s: f64, t: f64) -> [f64; 3] {
    let [x, y] = on_plane(s, t);
    [x, y, 0.0]
}

fn scene(blocker: &str, lights: &str) -> String {
    let keys = format!("corner = [-20, -20, 1]\nedge_u = [{}, 0, 0]\nedge_v = [0, 40, 0]", 20.0 + EDGE);
    frontal(&format!("{}{SCREEN}{}{}{lights}", diffuse(0.5), material("blocker", blocker), shape("rectangle", "blocker", &keys)))
}

/// True if a point of a light at this height is seen from x on the plane.
fn is_lit(light_x: f64, height: f64, x: f64) -> bool {
    x + (light_x - x) / height > EDGE
}

pub fn tests() -> Vec<Test> {
    const POINT: [f64; 3] = [-2.5, 0.2, 2.0];
    let point = light("point", &format!("position = {POINT:?}\nintensity = {COLOR:?}"));
    let open = |s, t| formulas::point(place(s, t), UP, POINT);
    let lit = |s, t| is_lit(POINT[0], POINT[2], place(s, t)[0]);
    let hard = Test::of_formula(
        [
            "shadows/point",
            "The shadow of a straight edge under a point light is sharp and where geometry puts it.",
            "Light goes straight",
        ],
        scene("type = \"diffuse\"\nreflectance = 0", &point),
        move |s, t| seen(if lit(s, t) { open(s, t) } else { 0.0 }),
    )
    .with_edges()
    .mistake("no shadow", move |s, t| seen(open(s, t)));
    let half = Test::of_formula(
        [
            "shadows/half-opaque",
            "A surface of opacity 1/2 lets half of the light through to what is behind it.",
            "Coverage: glTF alphaMode BLEND",
        ],
        scene("type = \"diffuse\"\nreflectance = 0\nopacity = 0.5", &point),
        move |s, t| seen(if lit(s, t) { open(s, t) } else { 0.5 * open(s, t) }),
    )
    .with_edges()
    .mistake("a shadow as if the surface were opaque", move |s, t| seen(if lit(s, t) { open(s, t) } else { 0.0 }))
    .mistake("a surface of opacity 1/2 that is passed twice", move |s, t| {
        seen(if lit(s, t) { open(s, t) } else { 0.25 * open(s, t) })
    });
    vec![hard, half, penumbra()]
}

/// A rectangle light that lies parallel to the plane, cut by the edge's image.
fn penumbra() -> Test {
    const LEFT: f64 = -3.5;
    const RIGHT: f64 = -2.5;
    const HEIGHT: f64 = 2.0;
    let part = |from: f64, s: f64, t: f64| {
        let corners = [[from, -0.5, HEIGHT], [from, 0.5, HEIGHT], [RIGHT, 0.5, HEIGHT], [RIGHT, -0.5, HEIGHT]];
        if from < RIGHT { formulas::polygon(place(s, t), UP, &corners).abs() } else { 0.0 }
    };
    // The part to the right of the edge's image on the light is seen.
    let visible_from = |s: f64, t: f64| {
        let x = place(s, t)[0];
        (x + (EDGE - x) * HEIGHT).max(LEFT)
    };
    let corners = [[LEFT, -0.5, HEIGHT], [LEFT, 0.5, HEIGHT], [RIGHT, 0.5, HEIGHT], [RIGHT, -0.5, HEIGHT]];
    let lights = format!("{}{}", emissive("light", COLOR), fan("light", &corners, ""));
    Test::of_formula(
        [
            "shadows/penumbra",
            "The soft shadow of a straight edge under a rectangle.",
            "Lambert 1760, over the part of the light that is seen",
        ],
        scene("type = \"diffuse\"\nreflectance = 0", &lights),
        move |s, t| seen(part(visible_from(s, t), s, t)),
    )
    .with_edges()
    .mistake("no shadow", move |s, t| seen(part(LEFT, s, t)))
    .mistake("a hard shadow, as of a light in one point", move |s, t| {
        seen(if is_lit(0.5 * (LEFT + RIGHT), HEIGHT, place(s, t)[0]) { part(LEFT, s, t) } else { 0.0 })
    })
}
