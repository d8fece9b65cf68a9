//! Light from surface to surface: closed sums, limits of depth, and light by way of mirrors.

use std::f64::consts::FRAC_1_PI;

use super::super::formulas;
use super::super::test::Test;
use super::stage::{SCREEN, diffuse, emissive, fan, frontal, light, material, on_plane, scaled, scene, shape, sized};

const COLOR: [f64; 3] = [3.0, 2.0, 1.0];
const UP: [f64; 3] = [0.0, 0.0, 1.0];
const INSIDE: &str = "position = [0.1, 0.2, 0.3]\nlook_at = [-0.5, 0.1, -1]\nvfov = 60\n";
const GLOW: [f64; 3] = [0.3, 0.2, 0.1];
const REFLECTANCE: [f64; 3] = [0.5, 0.6, 0.7];

pub fn tests() -> Vec<Test> {
    [closed(), bounces(), estimated()].into_iter().flatten().collect()
}

/// A closed box whose walls glow and reflect, seen from within, and its light after so many edges of a path; 0: all.
fn glowing_box(texts: [&'static str; 3], depth: i32) -> Test {
    let walls = material("m", &format!("type = \"diffuse\"\nreflectance = {REFLECTANCE:?}\nemission = {GLOW:?}"));
    // Their fronts are towards the middle.
    let wall = |corner: [f64; 3], u: [f64; 3], v: [f64; 3]| {
        shape("rectangle", "m", &format!("corner = {corner:?}\nedge_u = {u:?}\nedge_v = {v:?}"))
    };
    let (x, y, z) = ([2.0, 0.0, 0.0], [0.0, 2.5, 0.0], [0.0, 0.0, 4.0]);
    let (low, high) = ([-1.0, -1.0, -2.0], [1.0, 1.5, 2.0]);
    let box_of_walls = [
        wall(low, x, y),
        wall(low, y, z),
        wall(low, z, x),
        wall(high, y.map(|axis| -axis), x.map(|axis| -axis)),
        wall(high, z.map(|axis| -axis), y.map(|axis| -axis)),
        wall(high, x.map(|axis| -axis), z.map(|axis| -axis)),
    ]
    .concat();
    let mut text = scene(INSIDE, &format!("{walls}{box_of_walls}"));
    if depth > 0 {
        text = text.replace("max_depth = 64", &format!("max_depth = {depth}"));
    } else {
        text = text.replace("max_depth = 64", "max_depth = 0");
    }
    let sum = |edges: i32| -> [f64; 3] {
        std::array::from_fn(|i| {
            let rest = if edges > 0 { REFLECTANCE[i].powi(edges) } else { 0.0 };
            GLOW[i] * (1.0 - rest) / (1.0 - REFLECTANCE[i])
        })
    };
    let test = Test::of_constant(texts, text, sum(depth));
    if depth > 0 {
        test.mistake("one edge too many", move |_, _| sum(depth + 1)).mistake("all light, whatever the depth", move |_, _| sum(0))
    } else {
        test.mistake("light of at most eight edges", move |_, _| sum(8))
            .mistake("light of the walls themselves alone", |_, _| GLOW)
    }
}

fn closed() -> Vec<Test> {
    const DECIDES: &str = "`max_depth` of the scene file: edges of a path from the camera";
    let sphere = |albedo: f64| scaled(COLOR, albedo * FRAC_1_PI / (1.0 - albedo) / 4.0);
    vec![
        glowing_box(
            [
                "transport/closed-box",
                "In a closed box whose walls glow, radiance is emission/(1 − reflectance) everywhere.",
                "Geometric series; Smits and Jensen 2000",
            ],
            0,
        ),
        glowing_box(["transport/depth-1", "Paths of one edge: what glows, and nothing reflected.", DECIDES], 1),
        glowing_box(["transport/depth-2", "Paths of two edges: one reflection.", DECIDES], 2),
        glowing_box(["transport/depth-4", "Paths of four edges: three reflections.", DECIDES], 4),
        Test::of_constant(
            [
                "transport/integrating-sphere",
                "A point light in the middle of a white sphere: radiance is ρ·I/(π·r²·(1 − ρ)) everywhere.",
                "Integrating sphere; CIE 84:1989",
            ],
            scene(
                INSIDE,
                &format!(
                    "{}{}{}",
                    diffuse(0.6),
                    shape("sphere", "m", "center = [0, 0, 0]\nradius = 2"),
                    light("point", &format!("position = [0, 0, 0]\nintensity = {COLOR:?}"))
                ),
            )
            .replace("max_depth = 64", "max_depth = 0"),
            sphere(0.6),
        )
        .mistake("direct light alone", |_, _| scaled(COLOR, 0.6 * FRAC_1_PI / 4.0))
        .mistake("a sphere that is black within, as seen from behind", |_, _| [0.0; 3]),
    ]
}

fn place(s: f64, t: f64) -> [f64; 3] {
    let [x, y] = on_plane(s, t);
    [x, y, 0.0]
}

fn bounces() -> Vec<Test> {
    let seen = |irradiance: f64| scaled(COLOR, 0.5 * FRAC_1_PI * irradiance);
    let wall = [[-1.5, -3.0, 0.0], [-1.5, 3.0, 0.0], [-1.5, 3.0, 2.0], [-1.5, -3.0, 2.0]];
    let from_wall = move |s, t| 0.8 * FRAC_1_PI * formulas::polygon(place(s, t), UP, &wall).abs();
    let white = material("white", "type = \"diffuse\"\nreflectance = 0.8");
    let along = light("directional", &format!("direction = [-1, 0, 0]\nirradiance = {COLOR:?}"));
    let lamp = [[0.9, -1.2, 2.0], [0.9, 1.2, 2.0], [2.5, 1.2, 2.0], [2.5, -1.2, 2.0]];
    let image = lamp.map(|[x, y, z]| [-2.1 - x, y, z]);
    let direct = move |s, t| formulas::polygon(place(s, t), UP, &lamp).abs();
    let mirrored = move |s, t| formulas::polygon(place(s, t), UP, &image).abs();
    let mirror = material("mirror", "type = \"mirror\"");
    let big = shape("rectangle", "mirror", "corner = [-1.05, -60, 0]\nedge_u = [0, 120, 0]\nedge_v = [0, 0, 60]");
    vec![
        Test::of_formula(
            [
                "transport/wall-to-floor",
                "Parallel light on a wall lights the floor at its foot: one diffuse reflection, exactly.",
                "Lambert 1760: the wall is an even light",
            ],
            frontal(&format!("{}{SCREEN}{white}{}{along}", diffuse(0.5), fan("white", &wall, "")))
                .replace("max_depth = 64", "max_depth = 3"),
            move |s, t| seen(from_wall(s, t)),
        )
        .mistake("no indirect light", |_, _| [0.0; 3])
        .mistake("a reflectance that is divided by π twice", move |s, t| seen(FRAC_1_PI * from_wall(s, t))),
        Test::of_formula(
            [
                "transport/by-mirror",
                "A rectangle lights the floor directly and by way of a mirror, as its mirror image does.",
                "Law of reflection; Lambert 1760",
            ],
            frontal(&format!("{}{SCREEN}{mirror}{big}{}{}", diffuse(0.5), emissive("light", COLOR), fan("light", &lamp, "")))
                .replace("max_depth = 64", "max_depth = 3"),
            move |s, t| seen(direct(s, t) + mirrored(s, t)),
        )
        .mistake("no light by way of the mirror", move |s, t| seen(direct(s, t)))
        .mistake("light by way of the mirror that counts twice", move |s, t| seen(direct(s, t) + 2.0 * mirrored(s, t))),
    ]
}

/// Scenes that no formula tells.
fn estimated() -> Vec<Test> {
    let plates = {
        let camera = "position = [0, 1.2, 6]\nlook_at = [0, 0.4, 0]\nvfov = 30\n";
        let metal = |name: &str, alpha: f64| material(name, &format!("type = \"conductor\"\nreflectance = 0.9\nalpha = {alpha}"));
        let plate = |name: &str, z: f64, y: f64, tilt: f64| {
            shape("rectangle", name, &format!("corner = [-1.5, {y}, {z}]\nedge_u = [3, 0, 0]\nedge_v = [0, {tilt}, {}]", -0.8))
        };
        let tables = [
            metal("sharp", 0.05),
            metal("broad", 0.3),
            plate("sharp", 1.0, 0.0, 0.25),
            plate("broad", 2.2, -0.4, 0.2),
            emissive("small", [60.0, 20.0, 10.0]),
            emissive("large", [0.5, 1.0, 3.0]),
            shape("sphere", "small", "center = [-0.8, 1.6, -1]\nradius = 0.1"),
            shape("sphere", "large", "center = [0.8, 1.6, -1]\nradius = 0.6"),
        ];
        let both = tables.concat();
        Test::estimated(
            [
                "transport/glossy-plates",
                "Light samples and BSDF samples of glossy plates add up to one picture.",
                "Multiple importance sampling is unbiased: Veach and Guibas 1995",
            ],
            sized([32, 32], camera, &both),
        )
        .mistake_in_scene(
            "light by samples of lights and of the BSDF, added without weights",
            "radiance = [0.5, 1, 3]",
            "radiance = [1, 2, 6]",
        )
    };
    let room = {
        let camera = "position = [0, 1, 3.6]\nlook_at = [0, 1, 0]\nvfov = 40\n";
        let wall = |name: &str, color: &str| material(name, &format!("type = \"diffuse\"\nreflectance = {color}"));
        let tables = [
            wall("white", "0.73"),
            wall("red", "[0.6, 0.05, 0.05]"),
            wall("green", "[0.1, 0.4, 0.1]"),
            emissive("lamp", [12.0, 9.0, 5.0]),
            shape("rectangle", "white", "corner = [-1, 0, 1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, -2]"),
            shape("rectangle", "white", "corner = [-1, 2, -1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, 2]"),
            shape("rectangle", "white", "corner = [-1, 0, -1]\nedge_u = [2, 0, 0]\nedge_v = [0, 2, 0]"),
            shape("rectangle", "red", "corner = [-1, 0, 1]\nedge_u = [0, 0, -2]\nedge_v = [0, 2, 0]"),
            shape("rectangle", "green", "corner = [1, 0, -1]\nedge_u = [0, 0, 2]\nedge_v = [0, 2, 0]"),
            shape("rectangle", "lamp", "corner = [-0.3, 1.99, -0.3]\nedge_u = [0.6, 0, 0]\nedge_v = [0, 0, 0.6]"),
            shape("box", "white", "min = [-0.6, 0, -0.6]\nmax = [0, 1.1, 0]\ntransform = [{ rotate = [0, 1, 0], degrees = 18 }]"),
        ];
        Test::estimated(
            ["transport/room", "A room with coloured walls, a box and one lamp.", "The rendering equation, Kajiya 1986"],
            sized([32, 32], camera, &tables.concat()),
        )
        .mistake_in_scene("light of few reflections alone", "max_depth = 64", "max_depth = 3")
        .mistake_in_scene("exchanged walls", "[0.6, 0.05, 0.05]", "[0.1, 0.4, 0.1]")
    };
    vec![plates, room]
}
