//! Stacks of layers: closed sums of reflections.

use super::super::formulas;
use super::super::test::Test;
use super::stage::{frontal, grazing, grazing_direction, light, material, scaled, shape};

const SKY: [f64; 3] = [1.0, 0.75, 0.5];
const BASE: [f64; 3] = [0.8, 0.5, 0.2];

pub fn tests() -> Vec<Test> {
    vec![plastic(false), plastic(true), plate(), furnace()]
}

/// Share of even light within a dielectric that its surface throws back.
fn thrown_back() -> f64 {
    // The edge of total reflection parts the integral.
    let edge = (1.0f64 - 1.0 / 2.25).sqrt();
    let below = edge * edge;
    below + formulas::integrate(edge, 1.0, 64, |cosine| 2.0 * cosine * formulas::dielectric(cosine, 1.0 / 1.5))
}

/// A diffuse base below a smooth dielectric, as the closed form or as a stack.
fn plastic(is_stack: bool) -> Test {
    let back = thrown_back();
    let value = move |again: f64, s: f64, t: f64| -> [f64; 3] {
        let once = formulas::dielectric(-grazing_direction(s, t)[2], 1.5);
        std::array::from_fn(|i| SKY[i] * (once + (1.0 - once) * BASE[i] * (1.0 - back) / (1.0 - BASE[i] * again)))
    };
    let materials = if is_stack {
        [
            material("varnish", "type = \"glass\"\nior = 1.5"),
            material("base", &format!("type = \"diffuse\"\nreflectance = {BASE:?}")),
            material("m", "type = \"layered\"\ninterfaces = [\"varnish\", \"base\"]"),
        ]
        .concat()
    } else {
        material("m", &format!("type = \"plastic\"\nreflectance = {BASE:?}\nnonlinear = true"))
    };
    let texts = if is_stack {
        [
            "layers/varnish",
            "A smooth varnish on a diffuse base, as a stack of layers.",
            "Fresnel's equations and Lambert's law, all reflections summed",
        ]
    } else {
        [
            "layers/plastic",
            "A diffuse base below a smooth dielectric, all reflections between them summed.",
            "Fresnel's equations and Lambert's law, all reflections summed",
        ]
    };
    Test::of_formula(
        texts,
        grazing(&format!("{materials}{}", light("environment", &format!("radiance = {SKY:?}")))),
        move |s, t| value(back, s, t),
    )
    .mistake("light that the surface throws back only once", move |s, t| value(0.0, s, t))
    .mistake("the base alone", |_, _| std::array::from_fn(|i| SKY[i] * BASE[i]))
}

/// A plate of glass with a slab that absorbs, above black.
fn plate() -> Test {
    const SIGMA: [f64; 3] = [0.5, 1.0, 2.0];
    const THICKNESS: f64 = 0.3;
    let value = |sigma: f64, s: f64, t: f64| {
        let cosine = -grazing_direction(s, t)[2];
        let once = formulas::dielectric(cosine, 1.5);
        let within = (1.0 - (1.0 - cosine * cosine) / 2.25).sqrt();
        let left = (-sigma * THICKNESS / within).exp();
        once + (1.0 - once).powi(2) * once * left * left / (1.0 - (once * left).powi(2))
    };
    let black = material("black", "type = \"diffuse\"\nreflectance = 0");
    let below = shape("rectangle", "black", "corner = [-200, -200, -0.5]\nedge_u = [400, 0, 0]\nedge_v = [0, 400, 0]");
    let stack = [
        format!("[[medium]]\nname = \"tint\"\nabsorption = {SIGMA:?}\n"),
        material("front", "type = \"glass\"\nior = 1.5"),
        material("back", "type = \"glass\"\nior = 0.6666666666666666"),
        material(
            "m",
            &format!("type = \"layered\"\ninterfaces = [\"front\", \"back\"]\nslabs = [{{ thickness = {THICKNESS}, medium = \"tint\" }}]"),
        ),
    ]
    .concat();
    Test::of_formula(
        [
            "layers/plate",
            "A plate of glass that absorbs, as a stack of layers: the sum of its reflections.",
            "Beer's law between Fresnel's reflections",
        ],
        grazing(&format!("{stack}{black}{below}{}", light("environment", &format!("radiance = {SKY:?}")))),
        move |s, t| std::array::from_fn(|i| SKY[i] * value(SIGMA[i], s, t)),
    )
    .mistake("the front alone", |s, t| scaled(SKY, formulas::dielectric(-grazing_direction(s, t)[2], 1.5)))
    .mistake("a slab that does not absorb", move |s, t| scaled(SKY, value(0.0, s, t)))
}

fn furnace() -> Test {
    let tables = [
        "[[medium]]\nname = \"haze\"\nscattering = 3\n".to_owned(),
        material("front", "type = \"glass\"\nior = 1.5"),
        material("silver", "type = \"mirror\""),
        material(
            "m",
            "type = \"layered\"\ninterfaces = [\"front\", \"silver\"]\nslabs = [{ thickness = 0.4, medium = \"haze\" }]",
        ),
        shape("sphere", "m", "center = [0, 0, 0]\nradius = 0.7"),
        light("environment", "radiance = 1"),
    ];
    Test::of_constant(
        [
            "layers/furnace",
            "In an even sky a smooth stack that scatters and does not absorb cannot be seen.",
            "Conservation of energy",
        ],
        frontal(&tables.concat()),
        [1.0; 3],
    )
    .mistake("a twentieth of the light that is lost in the stack", |s, t| {
        let [x, y] = super::stage::on_plane(s, t);
        [if x.hypot(y) < 0.7 { 0.95 } else { 1.0 }; 3]
    })
}
