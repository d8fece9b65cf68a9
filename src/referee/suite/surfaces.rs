//! Surfaces: normals that are bent, sides, and what is partly there.

use std::f64::consts::FRAC_1_PI;

use super::super::formulas::{directional, normalized};
use super::super::picture::{SceneFile, png, srgb_to_linear};
use super::super::test::Test;
use super::stage::{SCREEN, diffuse, emissive, frontal, light, material, scaled, shape};

const COLOR: [f64; 3] = [3.0, 2.0, 1.0];
const DIRECTION: [f64; 3] = [-0.5, -0.3, -0.8];

fn seen(irradiance: f64) -> [f64; 3] {
    scaled(COLOR, 0.5 * FRAC_1_PI * irradiance)
}

fn sun() -> String {
    light("directional", &format!("direction = {DIRECTION:?}\nirradiance = {COLOR:?}"))
}

pub fn tests() -> Vec<Test> {
    [bent(), sides(), opacities()].into_iter().flatten().collect()
}

/// A normal map of one texel.
fn normals([r, g]: [u8; 2]) -> SceneFile {
    png("normals.png", [2, 2], move |_, _| [r, g, 255, 255])
}

fn bent() -> Vec<Test> {
    let of = |texts, [r, g]: [u8; 2], scale: f64| {
        let tangent = |code: u8| scale * (2.0 * f64::from(code) / 255.0 - 1.0);
        let from_srgb = |code: u8| scale * (2.0 * srgb_to_linear(code) - 1.0);
        let normal = normalized([tangent(r), tangent(g), 1.0]);
        let flipped = normalized([tangent(r), -tangent(g), 1.0]);
        let unscaled = normalized([tangent(r) / scale, tangent(g) / scale, 1.0]);
        let decoded = normalized([from_srgb(r), from_srgb(g), 1.0]);
        let texture = "[[texture]]\nname = \"normals\"\ntype = \"image\"\nfile = \"normals.png\"\ncolor_space = \"linear\"\n";
        let plane =
            material("m", &format!("type = \"diffuse\"\nreflectance = 0.5\nnormal_map = \"normals\"\nnormal_scale = {scale}"));
        let scene = frontal(&format!("{texture}{plane}{SCREEN}{}", sun()));
        let test = Test::of_constant(texts, scene, seen(directional(normal, DIRECTION)))
            .file(normals([r, g]))
            .mistake("a normal map that is read as sRGB", move |_, _| seen(directional(decoded, DIRECTION)))
            .mistake("a normal map that is left out", |_, _| seen(directional([0.0, 0.0, 1.0], DIRECTION)));
        if scale == 1.0 {
            test.mistake("a normal map whose green points down", move |_, _| seen(directional(flipped, DIRECTION)))
        } else {
            test.mistake("a scale of normals that is left out", move |_, _| seen(directional(unscaled, DIRECTION)))
        }
    };
    vec![
        of(
            [
                "surfaces/normal-map-x",
                "Red of a normal map bends the normal along u.",
                "glTF: normalTexture, red [0..255] to X [-1..1]",
            ],
            [200, 128],
            1.0,
        ),
        of(
            [
                "surfaces/normal-map-y",
                "Green of a normal map bends the normal along v, which points up.",
                "glTF: normalTexture, +Y up",
            ],
            [128, 210],
            1.0,
        ),
        of(
            [
                "surfaces/normal-scale",
                "The scale of a normal map multiplies red and green before the normal has length 1.",
                "glTF: normalTexture.scale",
            ],
            [180, 170],
            0.5,
        ),
    ]
}

fn sides() -> Vec<Test> {
    // A rectangle whose back is towards the camera and the sun.
    let back =
        "[[shape]]\ntype = \"rectangle\"\ncorner = [1, -1, 0]\nedge_u = [-2, 0, 0]\nedge_v = [0, 2, 0]\nmaterial = \"m\"\n";
    let irradiance = directional([0.0, 0.0, 1.0], DIRECTION);
    vec![
        Test::of_constant(
            ["surfaces/back-two-sided", "The back of a two-sided surface is as its front.", "glTF: doubleSided"],
            frontal(&format!("{}{back}{}", diffuse(0.5), sun())),
            seen(irradiance),
        )
        .mistake("a two-sided surface that is black from behind", |_, _| [0.0; 3]),
        Test::of_constant(
            ["surfaces/back-one-sided", "The back of a one-sided surface is black.", "`two_sided` of the scene file"],
            frontal(&format!("{}{back}{}", material("m", "type = \"diffuse\"\nreflectance = 0.5\ntwo_sided = false"), sun())),
            [0.0; 3],
        )
        .mistake("a one-sided surface that reflects on both sides", move |_, _| seen(irradiance)),
        Test::of_constant(
            ["surfaces/emission-and-reflection", "A surface that glows reflects besides.", "Radiance adds up"],
            frontal(&format!(
                "{}{SCREEN}{}",
                material("m", "type = \"diffuse\"\nreflectance = 0.5\nemission = [0.1, 0.2, 0.3]"),
                sun()
            )),
            std::array::from_fn(|channel| seen(irradiance)[channel] + [0.1, 0.2, 0.3][channel]),
        )
        .mistake("a surface that glows and reflects nothing", |_, _| [0.1, 0.2, 0.3])
        .mistake("a surface that reflects and does not glow", move |_, _| seen(irradiance)),
    ]
}

/// A black surface of this opacity before a bright one.
fn before_light(keys: &str, textures: &str) -> String {
    let bright = emissive("bright", COLOR);
    let behind = shape("rectangle", "bright", "corner = [-4, -4, -1]\nedge_u = [8, 0, 0]\nedge_v = [0, 8, 0]");
    frontal(&format!(
        "{textures}{}{SCREEN}{bright}{behind}",
        material("m", &format!("type = \"diffuse\"\nreflectance = 0\n{keys}"))
    ))
}

fn opacities() -> Vec<Test> {
    let codes = |x: u32, y: u32| 30 + ((x * 3 + y * 5) % 8 * 30) as u8;
    let file = png("holes.png", [4, 4], move |x, y| [255, 255, 255, codes(x, y)]);
    let texture =
        "[[texture]]\nname = \"holes\"\ntype = \"image\"\nfile = \"holes.png\"\ncolor_space = \"linear\"\nfilter = \"nearest\"\n";
    let alpha = move |s: f64, t: f64| f64::from(codes((4.0 * s) as u32, (4.0 * t) as u32)) / 255.0;
    let masked = move |threshold: f64| move |s: f64, t: f64| if alpha(s, t) >= threshold { [0.0; 3] } else { COLOR };
    vec![
        Test::of_constant(
            [
                "surfaces/opacity",
                "A black surface of opacity 0.3 lets 0.7 of what is behind it through.",
                "Coverage: glTF alphaMode BLEND",
            ],
            before_light("opacity = 0.3", ""),
            scaled(COLOR, 0.7),
        )
        .mistake("an opacity that is taken for transparency", |_, _| scaled(COLOR, 0.3))
        .mistake("an opaque surface", |_, _| [0.0; 3]),
        Test::of_formula(
            ["surfaces/opacity-texture", "The alpha of a picture as opacity.", "glTF: baseColorTexture.a, linear"],
            before_light("opacity = { texture = \"holes\", channel = \"a\" }", texture),
            move |s, t| scaled(COLOR, 1.0 - alpha(s, t)),
        )
        .with_edges()
        .file(file.clone())
        .mistake("an opacity that is decoded as sRGB", move |s, t| {
            scaled(COLOR, 1.0 - srgb_to_linear((alpha(s, t) * 255.0).round() as u8))
        })
        .mistake("an opacity that is a threshold", masked(0.5)),
        Test::of_formula(
            ["surfaces/opacity-cutoff", "With a cutoff a surface is there or not.", "glTF: alphaMode MASK, alphaCutoff"],
            before_light("opacity = { texture = \"holes\", channel = \"a\", cutoff = 0.5 }", texture),
            masked(0.5),
        )
        .with_edges()
        .file(file)
        .mistake("a cutoff that is left out", move |s, t| scaled(COLOR, 1.0 - alpha(s, t)))
        .mistake("a cutoff of the opposite sense", move |s, t| if alpha(s, t) < 0.5 { [0.0; 3] } else { COLOR }),
    ]
}
