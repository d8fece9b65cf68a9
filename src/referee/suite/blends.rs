//! Blends of materials: shares of a delta lobe and of a broad one, by a constant, a picture or Fresnel's term.

use std::f64::consts::FRAC_1_PI;

use super::super::formulas;
use super::super::picture::png;
use super::super::test::Test;
use super::stage::{SCREEN, frontal, grazing, grazing_direction, light, material, on_plane, scaled};

const SKY: [f64; 3] = [1.0, 0.75, 0.5];
const COLOR: [f64; 3] = [3.0, 2.0, 1.0];
const DIRECTION: [f64; 3] = [-0.5, -0.3, -0.8];

const PARTS: [(&str, &str); 5] = [
    ("red", "type = \"diffuse\"\nreflectance = [0.8, 0.1, 0.1]"),
    ("blue", "type = \"diffuse\"\nreflectance = [0.1, 0.2, 0.9]"),
    ("black", "type = \"diffuse\"\nreflectance = 0"),
    ("mirror", "type = \"mirror\""),
    ("metal", "type = \"conductor\"\nreflectance = [0.9, 0.6, 0.3]\nalpha = 0.4"),
];

/// The parts that are named, and a blend of two materials as `m`.
fn blend(first: &str, second: &str, weight: &str) -> String {
    let named =
        |name: &str| [first, second].contains(&name) || ([first, second].contains(&"inner") && ["mirror", "red"].contains(&name));
    let parts: String = PARTS.iter().filter(|(name, _)| named(name)).map(|(name, keys)| material(name, keys)).collect();
    parts + &material("m", &format!("type = \"blend\"\nmaterials = [\"{first}\", \"{second}\"]\nweight = {weight}"))
}

fn sky() -> String {
    light("environment", &format!("radiance = {SKY:?}"))
}

fn mixed(share: f64, first: [f64; 3], second: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| share * first[i] + (1.0 - share) * second[i])
}

const RED: [f64; 3] = [0.8, 0.1, 0.1];
const BLUE: [f64; 3] = [0.1, 0.2, 0.9];

pub fn tests() -> Vec<Test> {
    let under_sky = |table: &str| frontal(&format!("{table}{SCREEN}{}", sky()));
    let seen = |reflectance: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| SKY[i] * reflectance[i]) };
    vec![
        Test::of_constant(
            [
                "blends/mirror-and-black",
                "Half a mirror and half a black surface show half of the sky.",
                "A blend is the sum of its parts by their weights",
            ],
            under_sky(&blend("mirror", "black", "{ type = \"constant\", value = 0.5 }")),
            scaled(SKY, 0.5),
        )
        .mistake("a delta lobe that is weighed twice", |_, _| scaled(SKY, 0.25))
        .mistake("a delta lobe that is lost where the broad one is chosen by light samples alone", |_, _| scaled(SKY, 0.379)),
        Test::of_constant(
            [
                "blends/mirror-and-red",
                "0.3 of a mirror and 0.7 of a red surface.",
                "A blend is the sum of its parts by their weights",
            ],
            under_sky(&blend("mirror", "red", "{ type = \"constant\", value = 0.3 }")),
            seen(mixed(0.3, [1.0; 3], RED)),
        )
        .mistake("exchanged weights", move |_, _| seen(mixed(0.7, [1.0; 3], RED))),
        Test::of_constant(
            [
                "blends/red-and-blue",
                "0.3 of a red surface and 0.7 of a blue one.",
                "A blend is the sum of its parts by their weights",
            ],
            under_sky(&blend("red", "blue", "{ type = \"constant\", value = 0.3 }")),
            seen(mixed(0.3, RED, BLUE)),
        )
        .mistake("exchanged weights", move |_, _| seen(mixed(0.7, RED, BLUE)))
        .mistake("equal weights", move |_, _| seen(mixed(0.5, RED, BLUE))),
        textured(),
        fresnel(),
        with_metal(),
        Test::of_constant(
            [
                "blends/nested",
                "A blend of a blend: 0.5 of (0.5 of a mirror and red) and blue.",
                "A blend is the sum of its parts by their weights",
            ],
            under_sky(&format!(
                "{}{}",
                blend("inner", "blue", "{ type = \"constant\", value = 0.5 }"),
                material(
                    "inner",
                    "type = \"blend\"\nmaterials = [\"mirror\", \"red\"]\nweight = { type = \"constant\", value = 0.5 }"
                )
            )),
            seen(mixed(0.5, mixed(0.5, [1.0; 3], RED), BLUE)),
        )
        .mistake("the inner blend's first part alone", move |_, _| seen(mixed(0.5, [1.0; 3], BLUE)))
        .mistake("weights that are not multiplied", move |_, _| seen(mixed(0.5, [1.0; 3], mixed(0.5, RED, BLUE)))),
    ]
}

fn textured() -> Test {
    // Thirds and fifths of 255: a third or a fifth of a number of samples is whole, or far from it. Of a share that is nearly whole, a renderer that spreads
    // its samples evenly chooses one part equally often in almost all pixels of a tile; where the few others are missing, the tile is a little off and
    // seems to have no noise.
    let code = |x: u32, y: u32| [51, 170, 102, 204, 85, 153][((x * 5 + y) % 6) as usize];
    let file = png("shares.png", [4, 4], move |x, y| {
        let code = code(x, y);
        [code, code, code, 255]
    });
    let texture = "[[texture]]\nname = \"shares\"\ntype = \"image\"\nfile = \"shares.png\"\ncolor_space = \"linear\"\nfilter = \"nearest\"\n";
    let share = move |s: f64, t: f64| f64::from(code((4.0 * s) as u32, (4.0 * t) as u32)) / 255.0;
    let seen = |reflectance: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| SKY[i] * reflectance[i]) };
    Test::of_formula(
        [
            "blends/by-picture",
            "A mirror and a red surface, weighed by a picture.",
            "A blend is the sum of its parts by their weights",
        ],
        frontal(&format!("{texture}{}{SCREEN}{}", blend("mirror", "red", "{ type = \"texture\", texture = \"shares\" }"), sky())),
        move |s, t| seen(mixed(share(s, t), [1.0; 3], RED)),
    )
    .with_edges()
    .file(file)
    .mistake("exchanged weights", move |s, t| seen(mixed(1.0 - share(s, t), [1.0; 3], RED)))
    .mistake("one weight for the whole picture", move |_, _| seen(mixed(0.45, [1.0; 3], RED)))
}

fn fresnel() -> Test {
    let cosine = |s, t| -grazing_direction(s, t)[2];
    Test::of_formula(
        [
            "blends/by-fresnel",
            "A mirror above black, weighed by Fresnel's equations, is a surface of glass above black.",
            "Fresnel's equations; n = 1.5",
        ],
        grazing(&format!("{}{}", blend("black", "mirror", "{ type = \"fresnel\", ior = 1.5, exact = true }"), sky())),
        move |s, t| scaled(SKY, formulas::dielectric(cosine(s, t), 1.5)),
    )
    .mistake("Schlick's approximation", move |s, t| scaled(SKY, formulas::schlick(cosine(s, t), 0.04)))
    .mistake("exchanged weights", move |s, t| scaled(SKY, 1.0 - formulas::dielectric(cosine(s, t), 1.5)))
}

fn with_metal() -> Test {
    let sun = light("directional", &format!("direction = {DIRECTION:?}\nirradiance = {COLOR:?}"));
    let value = |share: f64| {
        move |s: f64, t: f64| {
            let [x, y] = on_plane(s, t);
            let (wo, wi) = (formulas::normalized([-x, -y, 4.0]), formulas::normalized(DIRECTION.map(|axis| -axis)));
            let (f, cosine) = formulas::ggx_reflection(wo, wi, 0.4);
            let metal = [0.9, 0.6, 0.3].map(|channel| f * formulas::schlick(cosine, channel));
            let both = mixed(share, metal, scaled(RED, FRAC_1_PI));
            std::array::from_fn(|i| COLOR[i] * both[i] * wi[2])
        }
    };
    Test::of_formula(
        [
            "blends/rough-metal",
            "0.4 of a rough metal and 0.6 of a red surface in parallel light.",
            "A blend is the sum of its parts by their weights",
        ],
        frontal(&format!("{}{SCREEN}{sun}", blend("metal", "red", "{ type = \"constant\", value = 0.4 }"))),
        value(0.4),
    )
    .mistake("exchanged weights", value(0.6))
}
