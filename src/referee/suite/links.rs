//! Lamps that light some receivers and not others. The frontal plane is two halves, of which the left one names itself.

use std::f64::consts::FRAC_1_PI;

use super::super::formulas;
use super::super::test::Test;
use super::stage::{diffuse, emissive, fan, frontal, light, material, on_plane, scaled, shape};

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const COLOR: [f64; 3] = [3.0, 2.0, 1.0];
const LAW: &str = "Light links: light of a lamp counts where it lights the receiver of the last place that scatters it";

fn place(s: f64, t: f64) -> [f64; 3] {
    let [x, y] = on_plane(s, t);
    [x, y, 0.0]
}

/// The left half of the film.
fn is_left(s: f64) -> bool {
    s < 0.5
}

fn seen(irradiance: f64) -> [f64; 3] {
    scaled(COLOR, 0.5 * FRAC_1_PI * irradiance)
}

/// Both halves of the screen, whose border lies between two pixels, of this material.
fn halves(of: &str) -> String {
    let half = |x: i32, receiver: &str| {
        shape("rectangle", of, &format!("corner = [{x}, -1, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 2, 0]\n{receiver}"))
    };
    half(-1, "receiver = \"left\"") + &half(0, "")
}

pub fn tests() -> Vec<Test> {
    vec![point(), area(), shadow(), mirror()]
}

/// Two point lights, of which one lights the left half alone.
fn point() -> Test {
    const LINKED: [f64; 3] = [0.3, 0.4, 1.0];
    const OTHER: [f64; 3] = [-0.5, -0.2, 1.2];
    let linked = light("point", &format!("position = {LINKED:?}\nintensity = {COLOR:?}\nlights_only = [\"left\"]"));
    let other = light("point", &format!("position = {OTHER:?}\nintensity = {COLOR:?}"));
    let [of_linked, of_other] = [LINKED, OTHER].map(|lamp| move |s: f64, t: f64| formulas::point(place(s, t), UP, lamp));
    let with = move |share: fn(f64) -> f64| move |s: f64, t: f64| seen(share(s) * of_linked(s, t) + of_other(s, t));
    Test::of_formula(
        ["links/point-only", "Of two point lights above a plane of two halves, one lights the left half alone.", LAW],
        frontal(&format!("{}{}{linked}{other}", diffuse(0.5), halves("m"))),
        with(|s| f64::from(u8::from(is_left(s)))),
    )
    .mistake("a link that is not heeded", with(|_| 1.0))
    .mistake("a link to all but what it names", with(|s| f64::from(u8::from(!is_left(s)))))
    .mistake("a linked lamp that lights nothing", with(|_| 0.0))
    .mistake_in_scene(
        "a link that every lamp has",
        &other,
        &other.replace("intensity", "lights_only = [\"left\"]\nintensity"),
    )
}

/// A rectangle that lights all but the left half, beside a point light.
fn area() -> Test {
    const LAMP: [f64; 3] = [-0.4, 0.5, 1.0];
    let corners = [[1.0, -0.5, 1.0], [1.0, 0.5, 1.0], [2.2, 0.5, 1.0], [2.2, -0.5, 1.0]];
    let irradiance = move |s: f64, t: f64| formulas::polygon(place(s, t), UP, &corners).abs();
    let lamp = light("point", &format!("position = {LAMP:?}\nintensity = {:?}", scaled(COLOR, 0.2)));
    let link = "lights_all_but = [\"left\"]\n";
    let scene = frontal(&format!(
        "{}{}{}{link}{}{lamp}",
        diffuse(0.5),
        halves("m"),
        emissive("light", COLOR),
        fan("light", &corners, "")
    ));
    let with = move |share: fn(f64) -> f64| {
        move |s: f64, t: f64| seen(share(s) * irradiance(s, t) + 0.2 * formulas::point(place(s, t), UP, LAMP))
    };
    Test::of_formula(
        ["links/area-all-but", "A rectangle of light above a plane of two halves does not light the left one.", LAW],
        scene,
        with(|s| f64::from(u8::from(!is_left(s)))),
    )
    .mistake("a link of a surface that is not heeded", with(|_| 1.0))
    .mistake("a link to nothing but what it leaves out", with(|s| f64::from(u8::from(is_left(s)))))
    .mistake_in_scene("links that say one for the other", "lights_all_but", "lights_only")
}

/// A blocker that the lamp does not light throws its shadow all the same.
fn shadow() -> Test {
    const LAMP: [f64; 3] = [-2.5, 0.2, 2.0];
    const EDGE: f64 = -1.2;
    let keys = format!("corner = [-20, -20, 1]\nedge_u = [{}, 0, 0]\nedge_v = [0, 40, 0]\nreceiver = \"blocker\"", 20.0 + EDGE);
    let blocker = shape("rectangle", "blocker", &keys);
    let linked = light("point", &format!("position = {LAMP:?}\nintensity = {COLOR:?}\nlights_all_but = [\"blocker\"]"));
    let scene = frontal(&format!(
        "{}{}{}{blocker}{linked}",
        diffuse(0.5),
        halves("m"),
        material("blocker", "type = \"diffuse\"\nreflectance = 0")
    ));
    let open = |s, t| formulas::point(place(s, t), UP, LAMP);
    let is_lit = |s: f64, t: f64| {
        let x = place(s, t)[0];
        x + (LAMP[0] - x) / LAMP[2] > EDGE
    };
    Test::of_formula(
        [
            "links/shadow",
            "What a lamp does not light throws its shadow all the same.",
            "Links say what is lit, not what throws shadows",
        ],
        scene,
        move |s, t| seen(if is_lit(s, t) { open(s, t) } else { 0.0 }),
    )
    .with_edges()
    .mistake("no shadow of what is not lit", move |s, t| seen(open(s, t)))
    .mistake("a lamp with a link that lights nothing", |_, _| [0.0; 3])
}

/// Two halves of a mirror under an even sky that lights one of them.
fn mirror() -> Test {
    const REFLECTANCE: f64 = 0.8;
    let sky = light("environment", &format!("radiance = {COLOR:?}\nlights_only = [\"left\"]"));
    let glass = material("m", &format!("type = \"mirror\"\nreflectance = {REFLECTANCE}"));
    let with = |share: fn(f64) -> f64| move |s: f64, _: f64| scaled(COLOR, REFLECTANCE * share(s));
    Test::of_formula(
        ["links/mirror", "A mirror that the sky does not light does not show it.", LAW],
        frontal(&format!("{glass}{}{sky}", halves("m"))),
        with(|s| f64::from(u8::from(is_left(s)))),
    )
    .mistake("a mirror that shows whatever is there", with(|_| 1.0))
    .mistake("a link that ends at mirrors", with(|_| 0.0))
    .mistake("a link to all but what it names", with(|s| f64::from(u8::from(!is_left(s)))))
}
