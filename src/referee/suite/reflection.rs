//! BSDFs by themselves: what they reflect and let through, and that they make no light.

use std::f64::consts::{FRAC_1_PI, PI};

use super::super::formulas;
use super::super::test::Test;
use super::stage::{SCREEN, emissive, frontal, grazing, grazing_direction, light, material, on_plane, scaled, shape};

const COLOR: [f64; 3] = [3.0, 2.0, 1.0];
const SKY: [f64; 3] = [1.0, 0.75, 0.5];
/// The way of parallel light, in a plane of the frontal camera.
const DIRECTION: [f64; 3] = [-0.5, -0.3, -0.8];

pub fn tests() -> Vec<Test> {
    [smooth(), slabs(), rough(), furnaces()].into_iter().flatten().collect()
}

/// The cosine at which the grazing camera's rays meet the plane.
fn cosine(s: f64, t: f64) -> f64 {
    -grazing_direction(s, t)[2]
}

/// A sky above a plane, and a black one below it.
fn above_black(keys: &str) -> String {
    let black = material("black", "type = \"diffuse\"\nreflectance = 0");
    let below = shape("rectangle", "black", "corner = [-200, -200, -0.5]\nedge_u = [400, 0, 0]\nedge_v = [0, 400, 0]");
    grazing(&format!("{}{black}{below}{}", material("m", keys), light("environment", &format!("radiance = {SKY:?}"))))
}

/// A bright plane below one, and no other light.
fn above_bright(keys: &str) -> String {
    let below = shape("rectangle", "bright", "corner = [-200, -200, -0.5]\nedge_u = [400, 0, 0]\nedge_v = [0, 400, 0]");
    grazing(&format!("{}{}{below}", material("m", keys), emissive("bright", COLOR)))
}

fn smooth() -> Vec<Test> {
    let dielectric = |ior: f64| move |s: f64, t: f64| scaled(SKY, formulas::dielectric(cosine(s, t), ior));
    let eta = [0.2, 0.9, 1.5];
    let k = [3.9, 2.4, 1.8];
    let metal = move |s: f64, t: f64| std::array::from_fn(|i| SKY[i] * formulas::conductor(cosine(s, t), eta[i], k[i]));
    vec![
        Test::of_constant(
            ["reflection/mirror", "A mirror of reflectance (0.9, 0.6, 0.3) below an even sky.", "Law of reflection"],
            grazing(&format!(
                "{}{}",
                material("m", "type = \"mirror\"\nreflectance = [0.9, 0.6, 0.3]"),
                light("environment", "radiance = 1")
            )),
            [0.9, 0.6, 0.3],
        )
        .mistake("a mirror that has a cosine", |_, _| [0.3, 0.2, 0.1]),
        mirror_image(),
        Test::of_formula(
            [
                "reflection/glass",
                "A smooth surface of glass reflects by Fresnel's equations.",
                "Fresnel's equations, unpolarized; n = 1.5",
            ],
            above_black("type = \"glass\"\nior = 1.5"),
            dielectric(1.5),
        )
        .mistake("Schlick's approximation", |s, t| scaled(SKY, formulas::schlick(cosine(s, t), 0.04)))
        .mistake("another index of refraction, 1.33", dielectric(1.33))
        .mistake("the parallel part of light alone", |s, t| {
            let c = cosine(s, t);
            let refracted = (1.0 - (1.0 - c * c) / 2.25).sqrt();
            scaled(SKY, ((1.5 * c - refracted) / (1.5 * c + refracted)).powi(2))
        }),
        Test::of_formula(
            [
                "reflection/metal",
                "A smooth metal reflects by Fresnel's equations for a complex index.",
                "Fresnel's equations, unpolarized",
            ],
            grazing(&format!(
                "{}{}",
                material("m", &format!("type = \"conductor\"\neta = {eta:?}\nk = {k:?}")),
                light("environment", &format!("radiance = {SKY:?}"))
            )),
            metal,
        )
        .mistake("Schlick's approximation", move |s, t| {
            std::array::from_fn(|i| SKY[i] * formulas::schlick(cosine(s, t), formulas::conductor(1.0, eta[i], k[i])))
        })
        .mistake("a metal whose absorption is left out", move |s, t| {
            std::array::from_fn(|i| SKY[i] * formulas::conductor(cosine(s, t), eta[i], 0.0))
        }),
        Test::of_formula(
            [
                "reflection/thin-plate",
                "A thin plate reflects 2R/(1 + R): all reflections between its sides.",
                "Geometric series of Fresnel's reflectances",
            ],
            above_black("type = \"glass\"\nior = 1.5\nthin = true"),
            |s, t| scaled(SKY, formulas::plate(cosine(s, t), 1.5)),
        )
        .mistake("one reflection alone", dielectric(1.5)),
    ]
}

/// A bright rectangle behind the camera, seen in a mirror.
fn mirror_image() -> Test {
    let bright = "corner = [-1.5, -1, 8]\nedge_u = [0, 2.2, 0]\nedge_v = [2.4, 0, 0]";
    let scene = frontal(&format!(
        "{}{SCREEN}{}{}",
        material("m", "type = \"mirror\""),
        emissive("bright", COLOR),
        shape("rectangle", "bright", bright)
    ));
    // Three times as far from the camera as the mirror is.
    let value = |side: f64| {
        move |s: f64, t: f64| {
            let [x, y] = on_plane(s, t).map(|axis| 3.0 * axis);
            if (-1.5..0.9).contains(&(side * x)) && (-1.0..1.2).contains(&y) { COLOR } else { [0.0; 3] }
        }
    };
    Test::of_formula(
        ["reflection/mirror-image", "The image in a mirror lies as far behind it as the object before it.", "Law of reflection"],
        scene,
        value(1.0),
    )
    .with_edges()
    .mistake("an image whose left is its right", value(-1.0))
}

fn slabs() -> Vec<Test> {
    let slab = |keys: &str| {
        let below = shape("rectangle", "bright", "corner = [-400, -400, -2]\nedge_u = [800, 0, 0]\nedge_v = [0, 800, 0]");
        let plate = shape("box", "m", "min = [-160, -160, -1]\nmax = [160, 160, 0]");
        super::stage::grazing_camera_scene(&format!("{keys}{}{below}{plate}", emissive("bright", COLOR)))
    };
    let through = |s, t| {
        let once = formulas::dielectric(cosine(s, t), 1.5);
        (1.0 - once) / (1.0 + once)
    };
    // Absorption along the refracted way within the plate, between as many reflections as there are.
    let colored = |sigma: f64, s: f64, t: f64| {
        let c = cosine(s, t);
        let once = formulas::dielectric(c, 1.5);
        let within = (1.0 - (1.0 - c * c) / 2.25).sqrt();
        let left = (-sigma / within).exp();
        (1.0 - once).powi(2) * left / (1.0 - (once * left).powi(2))
    };
    const SIGMA: [f64; 3] = [0.2, 0.5, 1.0];
    vec![
        Test::of_formula(
            [
                "reflection/thin-plate-through",
                "A thin plate lets (1 − R)/(1 + R) through, straight on.",
                "Geometric series of Fresnel's reflectances",
            ],
            above_bright("type = \"glass\"\nior = 1.5\nthin = true"),
            move |s, t| scaled(COLOR, through(s, t)),
        )
        .mistake("one passage alone, (1 − R)²", |s, t| scaled(COLOR, (1.0 - formulas::dielectric(cosine(s, t), 1.5)).powi(2)))
        .mistake("what a single surface lets through", |s, t| scaled(COLOR, 1.0 - formulas::dielectric(cosine(s, t), 1.5))),
        Test::of_formula(
            [
                "reflection/plate",
                "A thick plate of glass lets as much through as a thin one.",
                "Geometric series of Fresnel's reflectances; radiance over n² is kept",
            ],
            slab(&material("m", "type = \"glass\"\nior = 1.5")),
            move |s, t| scaled(COLOR, through(s, t)),
        )
        .mistake("a missing squared index of refraction, on one side", move |s, t| scaled(COLOR, through(s, t) / 2.25))
        .mistake("one passage alone, (1 − R)²", |s, t| scaled(COLOR, (1.0 - formulas::dielectric(cosine(s, t), 1.5)).powi(2))),
        Test::of_formula(
            [
                "reflection/tinted-plate",
                "A plate of glass that absorbs, by Beer's law along the refracted way.",
                "Beer's law between Fresnel's reflections",
            ],
            slab(&format!(
                "[[medium]]\nname = \"tint\"\nabsorption = {SIGMA:?}\n{}",
                material("m", "type = \"glass\"\nior = 1.5\ninterior = \"tint\"")
            )),
            move |s, t| std::array::from_fn(|i| COLOR[i] * colored(SIGMA[i], s, t)),
        )
        .mistake("absorption along the normal, not along the way", move |s, t| {
            std::array::from_fn(|i| COLOR[i] * through(s, t) * (-SIGMA[i]).exp())
        })
        .mistake("no absorption", move |s, t| scaled(COLOR, through(s, t))),
    ]
}

/// Directions at a point of the frontal film: to the camera and to the light.
fn frame(s: f64, t: f64) -> ([f64; 3], [f64; 3]) {
    let [x, y] = on_plane(s, t);
    (formulas::normalized([-x, -y, 4.0]), formulas::normalized(DIRECTION.map(|axis| -axis)))
}

fn rough() -> Vec<Test> {
    let sun = light("directional", &format!("direction = {DIRECTION:?}\nirradiance = {COLOR:?}"));
    let under_sun = |keys: &str| frontal(&format!("{}{SCREEN}{sun}", material("m", keys)));
    let reflected = |f: [f64; 3], wi: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| COLOR[i] * f[i] * wi[2]) };
    const METAL: [f64; 3] = [0.9, 0.6, 0.3];
    let metal = move |alpha: f64| {
        move |s: f64, t: f64| {
            let (wo, wi) = frame(s, t);
            let (f, cosine) = formulas::ggx_reflection(wo, wi, alpha);
            reflected(METAL.map(|channel| f * formulas::schlick(cosine, channel)), wi)
        }
    };
    let power = move |exponent: f64, factor: f64| {
        move |s: f64, t: f64| {
            let (wo, wi) = frame(s, t);
            let mirrored = [-wo[0], -wo[1], wo[2]];
            let f = factor * formulas::dot(mirrored, wi).max(0.0).powf(exponent);
            reflected([0.8 * f; 3], wi)
        }
    };
    let pbr = move |is_metal: bool, roughness: f64| {
        move |s: f64, t: f64| {
            let (wo, wi) = frame(s, t);
            reflected(formulas::gltf(wo, wi, METAL, is_metal, roughness), wi)
        }
    };
    let lobe = 32.0 / (2.0 * PI);
    let grazed_sun = light("directional", &format!("direction = [0, -0.8, -0.6]\nirradiance = {COLOR:?}"));
    let oren_nayar = move |sigma: f64| {
        move |s: f64, t: f64| {
            let wo = grazing_direction(s, t).map(|axis| -axis);
            let wi = [0.0, 0.8, 0.6];
            let f = 0.5 * formulas::oren_nayar_qualitative(wo, wi, sigma);
            reflected([f; 3], wi)
        }
    };
    let flat_paper = scaled(COLOR, FRAC_1_PI * 0.6 * 0.8 / formulas::vector_length([-0.5, -0.3, 0.8]));
    vec![
        Test::of_formula(
            [
                "reflection/ggx-metal",
                "A rough metal of GGX facets of width 0.5, with height-correlated masking and Schlick's Fresnel term.",
                "Walter et al. 2007; Heitz 2014; Schlick 1994",
            ],
            under_sun("type = \"conductor\"\nreflectance = [0.9, 0.6, 0.3]\nalpha = 0.5"),
            metal(0.5),
        )
        .mistake("a width that is taken for a roughness, and squared", metal(0.25))
        .mistake("a width that is taken for the square of one", metal(0.5f64.sqrt())),
        Test::of_formula(
            ["reflection/gltf-metal", "glTF's metal of roughness 0.6.", "glTF 2.0, appendix B.3"],
            under_sun("type = \"principled\"\nbase_color = [0.9, 0.6, 0.3]\nmetallic = 1\nroughness = 0.6"),
            pbr(true, 0.6),
        )
        .mistake("a roughness that is not squared", pbr(true, 0.6f64.sqrt()))
        .mistake("a dielectric in place of a metal", pbr(false, 0.6)),
        Test::of_formula(
            ["reflection/gltf-dielectric", "glTF's dielectric of roughness 0.6.", "glTF 2.0, appendix B.3"],
            under_sun("type = \"principled\"\nbase_color = [0.9, 0.6, 0.3]\nmetallic = 0\nroughness = 0.6"),
            pbr(false, 0.6),
        )
        .mistake("a roughness that is not squared", pbr(false, 0.6f64.sqrt()))
        .mistake("a metal in place of a dielectric", pbr(true, 0.6)),
        Test::of_formula(
            [
                "reflection/cosine-power",
                "A cosine-power lobe about the mirror direction: ρ·(n + 2)/(2π)·cosⁿ α, n = 30.",
                "`glossy` of the scene file; Lafortune and Willems 1994",
            ],
            under_sun("type = \"glossy\"\nreflectance = 0.8\nexponent = 30"),
            power(30.0, lobe),
        )
        .mistake("a lobe with n + 1 in place of n + 2", power(30.0, 31.0 / (2.0 * PI)))
        .mistake("a lobe of half the exponent", power(15.0, 17.0 / (2.0 * PI))),
        Test::of_formula(
            [
                "reflection/oren-nayar",
                "Oren and Nayar's simpler model, σ = 0.5, seen at grazing angles.",
                "Oren and Nayar 1994, section 4.4",
            ],
            grazing(&format!(
                "{}{grazed_sun}",
                material("m", "type = \"oren_nayar\"\nreflectance = 0.5\nroughness = 0.5\nmodel = \"qualitative\"")
            )),
            oren_nayar(0.5),
        )
        .mistake("Lambert's law", oren_nayar(0.0)),
        Test::of_constant(
            [
                "reflection/paper",
                "Light that comes through a sheet of transmittance 0.6.",
                "f = τ/π; KHR_materials_diffuse_transmission",
            ],
            frontal(&format!(
                "{}{SCREEN}{}",
                material("m", "type = \"diffuse_transmission\"\nreflectance = 0.2\ntransmittance = 0.6"),
                light("directional", &format!("direction = [-0.5, -0.3, 0.8]\nirradiance = {COLOR:?}"))
            )),
            flat_paper,
        )
        .mistake("the reflectance in place of the transmittance", move |_, _| scaled(flat_paper, 1.0 / 3.0))
        .mistake("a sheet that lets nothing through", |_, _| [0.0; 3]),
    ]
}

/// A sphere in a sky of radiance 1.
fn furnace([name, about, decides]: [&'static str; 3], keys: &str, left: f64) -> Test {
    let scene = frontal(&format!(
        "{}{}{}",
        material("m", keys),
        shape("sphere", "m", "center = [0, 0, 0]\nradius = 0.7"),
        light("environment", "radiance = 1")
    ));
    let value = |left: f64| {
        // The outline, seen from a distance of 4.
        let outline = 4.0 * (0.7f64 / 4.0).asin().tan();
        move |s: f64, t: f64| {
            let [x, y] = on_plane(s, t);
            [if x.hypot(y) < outline { left } else { 1.0 }; 3]
        }
    };
    let test = Test::of_formula([name, about, decides], scene, value(left));
    let test = if left == 1.0 { test } else { test.with_edges() };
    test.mistake("a twentieth of the light that is lost at the surface", value(0.95 * left))
        .mistake("a surface that makes a twentieth of light", value(1.05 * left))
}

fn furnaces() -> Vec<Test> {
    const WHITE: &str = "In an even sky a body that absorbs nothing cannot be seen.";
    const LAW: &str = "Conservation of energy: white furnace";
    vec![
        furnace(["reflection/furnace-white", WHITE, LAW], "type = \"diffuse\"\nreflectance = 1", 1.0),
        furnace(
            ["reflection/furnace-grey", "In an even sky a diffuse body shows its reflectance.", LAW],
            "type = \"diffuse\"\nreflectance = 0.5",
            0.5,
        ),
        furnace(["reflection/furnace-mirror", WHITE, LAW], "type = \"mirror\"", 1.0),
        furnace(["reflection/furnace-glass", WHITE, LAW], "type = \"glass\"\nior = 1.5", 1.0),
        furnace(["reflection/furnace-thin-glass", WHITE, LAW], "type = \"glass\"\nior = 1.5\nthin = true", 1.0),
        furnace(
            ["reflection/furnace-paper", WHITE, LAW],
            "type = \"diffuse_transmission\"\nreflectance = 0.4\ntransmittance = 0.6",
            1.0,
        ),
        furnace(
            [
                "reflection/furnace-plastic",
                "A white base below a smooth dielectric absorbs nothing, if reflections within are counted.",
                LAW,
            ],
            "type = \"plastic\"\nreflectance = 1",
            1.0,
        ),
    ]
}
