//! Media: what is absorbed, given off and scattered on the way.

use std::f64::consts::{FRAC_1_PI, PI};

use super::super::formulas::{dot, normalized};
use super::super::test::Test;
use super::stage::{emissive, frontal, light, on_plane, scaled, scene, shape, sized};

const COLOR: [f64; 3] = [3.0, 2.0, 1.0];
const PARALLEL: &str = "position = [0, 0, 4]\nlook_at = [0, 0, 0]\nprojection = \"orthographic\"\nheight = 2\n";
const BOUNDARY: &str = "[[material]]\nname = \"m\"\ntype = \"pass\"\ninterior = \"fog\"\n";
/// A block before z = −1, wide enough for all rays.
const BLOCK: &str = "[[shape]]\ntype = \"box\"\nmaterial = \"m\"\nmin = [-90, -90, -1]\nmax = [90, 90, 0]\n";
const BALL: &str = "[[shape]]\ntype = \"sphere\"\nmaterial = \"m\"\ncenter = [0, 0, 0]\nradius = 0.8\n";

fn fog(keys: &str) -> String {
    format!("[[medium]]\nname = \"fog\"\n{keys}\n")
}

fn backdrop() -> String {
    let keys = "corner = [-4, -4, -2]\nedge_u = [8, 0, 0]\nedge_v = [0, 8, 0]";
    format!("{}{}", emissive("bright", COLOR), shape("rectangle", "bright", keys))
}

/// The way through the block along the frontal camera's ray.
fn way(s: f64, t: f64) -> f64 {
    let [x, y] = on_plane(s, t);
    (x * x + y * y + 16.0).sqrt() / 4.0
}

pub fn tests() -> Vec<Test> {
    [absorbed(), scattered()].into_iter().flatten().collect()
}

fn absorbed() -> Vec<Test> {
    const SIGMA: [f64; 3] = [0.3, 0.8, 1.5];
    const GLOW: [f64; 3] = [0.4, 0.3, 0.2];
    let through = |length: f64| -> [f64; 3] { std::array::from_fn(|i| COLOR[i] * (-SIGMA[i] * length).exp()) };
    let chord = |s: f64, t: f64| {
        let [x, y] = on_plane(s, t);
        2.0 * (0.64 - x * x - y * y).max(0.0).sqrt()
    };
    let glowing = |length: f64| -> [f64; 3] { std::array::from_fn(|i| GLOW[i] / SIGMA[i] * (1.0 - (-SIGMA[i] * length).exp())) };
    let halves = |s: f64| if s < 0.5 { 0.5 } else { 2.0 };
    let absorption = format!("absorption = {SIGMA:?}");
    vec![
        Test::of_formula(
            ["media/beer", "A block that absorbs lets exp(−σ·d) through.", "Beer's law"],
            frontal(&format!("{}{BOUNDARY}{BLOCK}{}", fog(&absorption), backdrop())),
            move |s, t| through(way(s, t)),
        )
        .mistake("powers of ten in place of e", move |s, t| through(way(s, t) * std::f64::consts::LN_10))
        .mistake("a medium that is left out", |_, _| COLOR)
        .mistake("a way that is counted twice", move |s, t| through(2.0 * way(s, t))),
        Test::of_formula(
            ["media/beer-sphere", "A ball that absorbs, along its chords.", "Beer's law"],
            scene(PARALLEL, &format!("{}{BOUNDARY}{BALL}{}", fog(&absorption), backdrop())),
            move |s, t| through(chord(s, t)),
        )
        .with_edges()
        .mistake("the diameter in place of the chord", move |s, t| through(if chord(s, t) > 0.0 { 1.6 } else { 0.0 })),
        Test::of_formula(
            ["media/glow", "A block that glows and absorbs: ε/σ·(1 − exp(−σ·d)).", "Radiative transfer without scattering"],
            frontal(&format!("{}{BOUNDARY}{BLOCK}", fog(&format!("{absorption}\nemission = {GLOW:?}")))),
            move |s, t| glowing(way(s, t)),
        )
        .mistake("light that its own medium does not absorb", move |s, t| scaled(GLOW, way(s, t)))
        .mistake("light that the medium gives off in proportion to what it absorbs", move |s, t| {
            let value = glowing(way(s, t));
            std::array::from_fn(|i| SIGMA[i] * value[i])
        }),
        Test::of_formula(
            ["media/grid", "A grid of two voxels, of density 1/2 and 2.", "Beer's law, voxel by voxel"],
            scene(
                PARALLEL,
                &format!(
                    "{}{BOUNDARY}[[shape]]\ntype = \"box\"\nmaterial = \"m\"\nmin = [-1.5, -1.5, -1]\nmax = [1.5, 1.5, 0]\n{}",
                    fog(&format!(
                        "{absorption}\ndensity = {{ resolution = [2, 1, 1], values = [0.5, 2], bounds = [[-1.5, -1.5, -1], [1.5, 1.5, 0]], filter = \"nearest\" }}"
                    )),
                    backdrop()
                ),
            ),
            move |s, _| through(halves(s)),
        )
        .mistake("exchanged voxels", move |s, _| through(halves(1.0 - s)))
        .mistake("voxels that are interpolated", move |s, _| through(0.5 + 1.5 * (2.0 * (1.5 * (2.0 * s - 1.0) + 0.75) / 3.0).clamp(0.0, 1.0))),
    ]
}

fn scattered() -> Vec<Test> {
    const DIRECTION: [f64; 3] = [-0.5, -0.3, -0.8];
    const SCATTERING: f64 = 0.8;
    const EXTINCTION: f64 = 1.2;
    let henyey_greenstein = |g: f64, cosine: f64| 0.25 * FRAC_1_PI * (1.0 - g * g) / (1.0 + g * g - 2.0 * g * cosine).powf(1.5);
    let rayleigh = |cosine: f64| 3.0 / (16.0 * PI) * (1.0 + cosine * cosine);
    // Light that is scattered once, from parallel light above a block of depth 1.
    let once = move |phase: &dyn Fn(f64) -> f64, s: f64, t: f64| {
        let [x, y] = on_plane(s, t);
        let wo = normalized([-x, -y, 4.0]);
        let (seen, lit) = (wo[2], 0.8 / dot(DIRECTION, DIRECTION).sqrt());
        let cosine = dot(normalized(DIRECTION), wo);
        let left = 1.0 - (-EXTINCTION * (1.0 / seen + 1.0 / lit)).exp();
        scaled(COLOR, phase(cosine) * SCATTERING * left / (EXTINCTION * (1.0 + seen / lit)))
    };
    let scene_once = |phase: &str| {
        let keys = format!("scattering = {SCATTERING}\nabsorption = {}\nphase = {phase}", EXTINCTION - SCATTERING);
        let sun = light("directional", &format!("direction = {DIRECTION:?}\nirradiance = {COLOR:?}"));
        frontal(&format!("{}{BOUNDARY}{BLOCK}{sun}", fog(&keys))).replace("max_depth = 64", "max_depth = 2")
    };
    let furnace = |texts, keys: &str| {
        Test::of_constant(
            texts,
            frontal(&format!("{}{BOUNDARY}{BALL}{}", fog(keys), light("environment", "radiance = 1")))
                .replace("max_depth = 64", "max_depth = 0"),
            [1.0; 3],
        )
        .mistake("light that is lost after few collisions, a twentieth within the ball", |s, t| {
            let [x, y] = on_plane(s, t);
            [if x.hypot(y) < 0.8 { 0.95 } else { 1.0 }; 3]
        })
    };
    let milk = Test::estimated(
        ["media/milk", "A ball of milk in a sky with one lamp: light that is scattered many times.", "Radiative transfer"],
        sized(
            [32, 32],
            "position = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = 28\n",
            &format!(
                "{}{BOUNDARY}{BALL}{}{}{}",
                fog("scattering = [4, 5, 6]\nabsorption = [0.02, 0.05, 0.2]\nphase = { type = \"henyey_greenstein\", g = 0.7 }"),
                light("environment", "radiance = 0.2"),
                emissive("lamp", [8.0, 7.0, 6.0]),
                shape("sphere", "lamp", "center = [2, 2, 1]\nradius = 0.5")
            ),
        ),
    )
    .mistake_in_scene("a phase function turned round", "g = 0.7", "g = -0.7")
    .mistake_in_scene("an isotropic phase function", "g = 0.7", "g = 0.001");
    vec![
        Test::of_formula(
            [
                "media/single-scattering",
                "Parallel light that a block scatters once, by Henyey and Greenstein's phase function.",
                "Radiative transfer, first order; Henyey and Greenstein 1941",
            ],
            scene_once("{ type = \"henyey_greenstein\", g = 0.4 }"),
            move |s, t| once(&|cosine| henyey_greenstein(0.4, cosine), s, t),
        )
        .mistake("a phase function turned round", move |s, t| once(&|cosine| henyey_greenstein(-0.4, cosine), s, t))
        .mistake("an isotropic phase function", move |s, t| once(&|cosine| henyey_greenstein(0.0, cosine), s, t))
        .mistake("a phase function that is 4π times too large", move |s, t| {
            scaled(once(&|cosine| henyey_greenstein(0.4, cosine), s, t), 4.0 * PI)
        }),
        Test::of_formula(
            [
                "media/rayleigh",
                "Parallel light that a block scatters once, by Rayleigh's phase function.",
                "Radiative transfer, first order; Rayleigh 1871",
            ],
            scene_once("{ type = \"rayleigh\" }"),
            move |s, t| once(&rayleigh, s, t),
        )
        .mistake("an isotropic phase function", move |s, t| once(&|_| 0.25 * FRAC_1_PI, s, t)),
        furnace(
            [
                "media/furnace",
                "In an even sky a ball that scatters and does not absorb cannot be seen.",
                "Conservation of energy",
            ],
            "scattering = 4\nphase = { type = \"henyey_greenstein\", g = 0.5 }",
        ),
        milk,
    ]
}
