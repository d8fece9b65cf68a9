//! Rays that start on a surface: none may meet it again where it is convex, and none may pass what touches it.

use std::fmt::Write as _;

use gpt::scene::Scene;

use super::support::{Effort, Finding, judge, render, scene};

pub fn findings(effort: Effort) -> Vec<Finding> {
    let mut findings = Vec::new();
    let units = effort.pick(vec![1e-6, 1e6], vec![1e-6, 1e-3, 1.0, 1e3, 1e6]);
    for &unit in &units {
        findings.extend(convex(unit));
        findings.extend(grazed(unit));
        findings.extend(clear_glass(unit));
    }
    for radius in effort.pick(vec![1e5], vec![1e-5, 1.0, 1e2, 1e3, 1e4, 1e5]) {
        findings.extend(contact(radius));
    }
    findings
}

/// Shapes that bulge outward, turned and moved so that no coordinate is round, in units of `unit`.
fn shapes(unit: f64) -> [(&'static str, String); 6] {
    let mut octahedron = String::new();
    for (x, y, z) in [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)] {
        let _ = write!(octahedron, "[{x}, {y}, {z}], ");
    }
    let faces = "[[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]";
    let placed = |geometry: &str| {
        format!(
            "[[shape]]\n{geometry}\nmaterial = \"white\"\ntransform = [{{ rotate = [1, 2, 3], degrees = 37 }}, {{ scale = {unit:e} }}, \
             {{ translate = [{:e}, {:e}, {:e}] }}]\n",
            0.37 * unit,
            -0.53 * unit,
            0.71 * unit
        )
    };
    [
        ("rectangle", placed("type = \"rectangle\"\ncorner = [-1, -1, 0]\nedge_u = [2, 0, 0]\nedge_v = [0, 2, 0]")),
        ("disk", placed("type = \"disk\"\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1")),
        ("plane", placed("type = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]")),
        ("box", placed("type = \"box\"\nmin = [-0.7, -0.7, -0.7]\nmax = [0.7, 0.7, 0.7]")),
        ("sphere", placed("type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1")),
        ("octahedron", placed(&format!("type = \"mesh\"\npositions = [{octahedron}]\nfaces = {faces}"))),
    ]
}

fn settings(unit: f64, depth: u32) -> String {
    format!(
        "[film]\nsize = [64, 64]\n[render]\nspp = 4\nmax_depth = {depth}\nestimator = \"bsdf\"\n\
         [camera]\nposition = [{:e}, {:e}, {:e}]\nlook_at = [{:e}, {:e}, {:e}]\nvfov = 50\n\
         [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.5\n",
        1.3 * unit,
        0.9 * unit,
        3.1 * unit,
        0.37 * unit,
        -0.53 * unit,
        0.71 * unit
    )
}

/// A convex body of albedo 1/2 under an environment of 1 is 1/2: every path that is anything else met the surface it left.
fn convex(unit: f64) -> Vec<Finding> {
    let case = |(name, shape): (&str, String)| {
        let scene = scene(&format!("{}{shape}[[light]]\ntype = \"environment\"\nradiance = 1\n", settings(unit, 8)));
        Some(seen_in_white(format!("{name} of {unit:e} in an environment of 1"), &render(&scene)?))
    };
    shapes(unit).into_iter().filter_map(case).collect()
}

/// Each of a pixel's four samples is 1/2 where it meets the body and 1 where it passes it by.
pub fn seen_in_white(case: String, pixels: &[f64]) -> Finding {
    let wrong = |value: &&f64| (8.0 * **value - (8.0 * **value).round()).abs() > 1e-4 || !(0.49..=1.01).contains(*value);
    spotless(case, pixels.iter().filter(wrong).count(), pixels.len())
}

#[allow(dead_code, reason = "the bench shows it nothing wrong")]
/// A rectangle with a speck above it, which takes light away from some paths.
pub fn with_speck() -> Scene {
    let [(_, rectangle), ..] = shapes(1.0);
    let speck = "[[shape]]\ntype = \"sphere\"\ncenter = [0.5, -0.3, 1]\nradius = 0.05\nmaterial = \"white\"\n";
    scene(&format!("{}{rectangle}{speck}[[light]]\ntype = \"environment\"\nradiance = 1\n", settings(1.0, 8)))
}

/// Light that grazes the surface at a twentieth of a degree lights all of it.
fn grazed(unit: f64) -> Vec<Finding> {
    let elevation = 0.05_f64.to_radians();
    let rotation = glam::DQuat::from_axis_angle(glam::DVec3::new(1.0, 2.0, 3.0).normalize(), 37f64.to_radians());
    let travels = rotation * glam::DVec3::new(elevation.cos(), 0.0, -elevation.sin());
    let truth = 0.5 / std::f64::consts::PI * elevation.sin();
    shapes(unit)
        .into_iter()
        .take(3)
        .filter_map(|(name, shape)| {
            let text = settings(unit, 2).replace("\"bsdf\"", "\"mis\"");
            let scene = scene(&format!(
                "{text}{shape}[[light]]\ntype = \"directional\"\ndirection = [{:?}, {:?}, {:?}]\nirradiance = 1\n",
                travels.x, travels.y, travels.z
            ));
            let pixels = render(&scene)?;
            let inside = |value: &&f64| **value > 0.0;
            // A pixel at the border holds samples that pass the shape by, so it may be any quarter of the truth.
            let wrong = |value: &f64| {
                let quarters = 4.0 * value / truth;
                (quarters - quarters.round()).abs() > 2e-3 * quarters.max(1.0)
            };
            let partly = pixels.iter().filter(inside).filter(|value| **value < 0.9 * truth).count();
            let spots = pixels.iter().filter(inside).filter(|value| wrong(value)).count();
            let border = 4 * 64;
            Some(
                spotless(format!("{name} of {unit:e}, grazed by light at 0.05°"), spots, pixels.iter().filter(inside).count())
                    .require(partly <= border, || format!("{partly} pixels are partly dark, more than a border can be")),
            )
        })
        .collect()
}

fn spotless(case: String, spots: usize, pixels: usize) -> Finding {
    Finding::new(case)
        .with("pixels", pixels)
        .with("wrong pixels", spots)
        .require(spots == 0, || format!("{spots} of {pixels} pixels are dark or bright spots"))
        .require(pixels > 500, || format!("only {pixels} pixels see the shape"))
}

/// Glass without tint in an environment of 1 is 1, whatever way the light takes.
fn clear_glass(unit: f64) -> Vec<Finding> {
    shapes(unit)
        .into_iter()
        .skip(3)
        .filter_map(|(name, shape)| {
            let text = settings(unit, 0).replace("type = \"diffuse\"\nreflectance = 0.5", "type = \"glass\"\nior = 1.5");
            let scene = scene(&format!("{text}{shape}[[light]]\ntype = \"environment\"\nradiance = 1\n"));
            let pixels = render(&scene)?;
            let largest = pixels.iter().map(|value| (value - 1.0).abs()).fold(0.0, f64::max);
            // Roulette leaves paths of weight 1 alone for 64 edges and then ends one in a thousand, which makes the others brighter.
            Some(
                Finding::new(format!("{name} of glass, {unit:e}"))
                    .with("pixels", pixels.len())
                    .with("largest error", format!("{largest:.1e}"))
                    .require(largest < 2e-3, || format!("a pixel is off by {largest:e}")),
            )
        })
        .collect()
}

/// The contact of a sphere with the floor, seen from a tenth of its radius away: the shadow starts there.
fn contact(radius: f64) -> Option<Finding> {
    let scene = scene(&format!(
        "[film]\nsize = [48, 48]\n[render]\nspp = 8\nmax_depth = 3\n\
         [camera]\nposition = [{0:e}, {1:e}, {0:e}]\nlook_at = [0, 0, 0]\nvfov = 30\n\
         [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
         [[shape]]\ntype = \"rectangle\"\ncorner = [-{2:e}, 0, {2:e}]\nedge_u = [{3:e}, 0, 0]\nedge_v = [0, 0, -{3:e}]\nmaterial = \"white\"\n\
         [[shape]]\ntype = \"sphere\"\ncenter = [0, {4:e}, 0]\nradius = {4:e}\nmaterial = \"white\"\n\
         [[light]]\ntype = \"sky\"\nzenith = 1\nhorizon = 0.5\nground = 0\n\
         [[light]]\ntype = \"directional\"\ndirection = [-0.7, -0.7, 0.1]\nirradiance = 2\n",
        0.1 * radius,
        0.002 * radius,
        4.0 * radius,
        8.0 * radius,
        radius,
    ));
    judge(format!("contact of a sphere of radius {radius:e} with a floor"), &scene, &scene)
}
