//! The efficiency of the ways of sampling lights: `cargo bench --bench lights [-- spheres|many|portals]`.
//!
//! Error: mean square over pixels and channels against a long render, averaged over seeds. Cost: seconds for the same samples, the ways in
//! turn so that all meet the machine in the same state, as ratios pair by pair. Error times cost is what is left at equal time. Prints the
//! tables of docs/strategies.md.

use std::sync::Arc;
use std::time::Instant;

use glam::{DVec3, Vec3};
use gpt::choice::Choice;
use gpt::gpu::{Device, GpuRenderer};
use gpt::load;
use gpt::plan::PlanOptions;
use gpt::renderer::{DeviceChoice, RenderError, RenderRequest, Renderer, Silent};
use gpt::scene::{ColorInput, Emission, Geometry, LightSampling, Material, MaterialKind, Mesh, Scene, Shape, Transform};

const SIDE: u32 = 96;
const SPP: u32 = 64;
const SEEDS: u32 = 4;
const REFERENCE_SPP: u32 = 4096;
/// Rounds of a cost's measurement after one that is thrown away.
const ROUNDS: usize = 7;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|other| other == name);
    let device = Device::open(&DeviceChoice::Gpu)?;
    if is_wanted("spheres") {
        println!(
            "| light | strategy | mean square error | time, ratio to cone (median, range) | error at equal time, ratio to cone |"
        );
        println!("| --- | --- | --- | --- | --- |");
        for (name, center, radius) in [
            ("small and far", [0.5, 6.0, 1.0], 0.3),
            ("large and near", [0.5, 2.6, 1.0], 0.9),
            ("touching the floor", [1.2, 0.5, 1.0], 0.5),
        ] {
            let scenes = [LightSampling::Cone, LightSampling::Visible, LightSampling::Area].map(|strategy| {
                let mut scene = load(&sphere_light(center, radius));
                scene.render.light_sampling = strategy;
                (strategy.name().to_owned(), scene)
            });
            compare(&device, name, &scenes)?;
        }
    }
    if is_wanted("portals") {
        println!("| room | way | mean square error | time, ratio to the first (median, range) | error at equal time, ratio |");
        println!("| --- | --- | --- | --- | --- |");
        for (name, light) in [("sky", SKY), ("constant", "[[light]]\ntype = \"environment\"\nradiance = 1\n")] {
            let scenes =
                [("no portal", false), ("portal", true)].map(|(way, portal)| (way.to_owned(), load(&room(light, portal))));
            compare(&device, name, &scenes)?;
        }
    }
    if is_wanted("many") {
        many(&device)?;
    }
    Ok(())
}

fn load(text: &str) -> Scene {
    let mut scene = load::load_toml_str(text, "lights", std::path::Path::new("")).unwrap_or_else(|error| panic!("{error}"));
    scene.film.size = [SIDE; 2];
    scene.render.spp = SPP;
    scene
}

const FLOOR: &str = "[camera]\nposition = [0, 2.5, 7]\nlook_at = [0, 0.6, 0]\nvfov = 40\n\
    [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.7\n\
    [[material]]\nname = \"gone\"\ntype = \"pass\"\n\
    [[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 10\n\
    [[shape]]\ntype = \"rectangle\"\nmaterial = \"white\"\ncorner = [-6, 0, 6]\nedge_u = [12, 0, 0]\nedge_v = [0, 0, -12]\n\
    [[shape]]\ntype = \"sphere\"\nmaterial = \"white\"\ncenter = [-0.6, 0.7, 0]\nradius = 0.7\n[render]\nmax_depth = 3\n";

/// A ball on a floor, with its soft shadow.
fn sphere_light([x, y, z]: [f64; 3], radius: f64) -> String {
    format!("{FLOOR}[[shape]]\ntype = \"sphere\"\nmaterial = \"lamp\"\ncenter = [{x}, {y}, {z}]\nradius = {radius}\n")
}

const SKY: &str = "[[light]]\ntype = \"sky\"\nzenith = [0.4, 0.7, 1.6]\nhorizon = [1.5, 1.4, 1.2]\nground = [0.2, 0.2, 0.15]\n";

/// A closed room with one window.
fn room(light: &str, portal: bool) -> String {
    let wall = |corner: &str, u: &str, v: &str| {
        format!("[[shape]]\ntype = \"rectangle\"\nmaterial = \"white\"\ncorner = {corner}\nedge_u = {u}\nedge_v = {v}\n")
    };
    let walls = [
        wall("[-6, 0, -6]", "[12, 0, 0]", "[0, 4, 0]"),
        wall("[-6, 0, 8]", "[12, 0, 0]", "[0, 4, 0]"),
        wall("[6, 0, -6]", "[0, 0, 14]", "[0, 4, 0]"),
        wall("[-6, 4, -6]", "[12, 0, 0]", "[0, 0, 14]"),
        wall("[-6, 0, -6]", "[0, 0, 5]", "[0, 4, 0]"),
        wall("[-6, 0, 1]", "[0, 0, 7]", "[0, 4, 0]"),
        wall("[-6, 0, -1]", "[0, 0, 2]", "[0, 1, 0]"),
        wall("[-6, 2.5, -1]", "[0, 0, 2]", "[0, 1.5, 0]"),
        wall("[-6, 0, 6]", "[12, 0, 0]", "[0, 0, 2]"),
    ]
    .concat();
    let window = "[[shape]]\ntype = \"rectangle\"\nmaterial = \"gone\"\nportal = true\n\
                  corner = [-6, 1, -1]\nedge_u = [0, 0, 2]\nedge_v = [0, 1.5, 0]\n";
    format!("{FLOOR}{walls}{}{light}", if portal { window } else { "" })
}

fn render(renderer: &mut GpuRenderer, spp: u32) -> Result<(Vec<[f32; 3]>, f64), RenderError> {
    let mut pixels = Vec::new();
    let start = Instant::now();
    renderer.render(&RenderRequest { rows: 0..SIDE, samples: 0..spp }, &Silent, &mut |band| {
        pixels.extend(band.mean);
        Ok(())
    })?;
    Ok((pixels, start.elapsed().as_secs_f64()))
}

/// Errors and times of several ways to render one scene, the first being what the others are compared with.
fn compare(device: &Device, name: &str, ways: &[(String, Scene)]) -> Result<(), RenderError> {
    let prepare = |scene: &Scene, seed: u32, spp: u32| {
        let mut scene = scene.clone();
        (scene.render.seed, scene.render.spp) = (seed, spp);
        GpuRenderer::on(device, &scene, &PlanOptions::default())
    };
    // The last way is the portal, or area sampling; the first and last may each be the better, so both take part.
    let mut reference = vec![[0.0; 3]; (SIDE * SIDE) as usize];
    for (index, (_, scene)) in ways.iter().enumerate() {
        let (pixels, _) = render(&mut prepare(scene, 0x5eed + index as u32, REFERENCE_SPP)?, REFERENCE_SPP)?;
        for (sum, pixel) in reference.iter_mut().zip(pixels) {
            (0..3).for_each(|channel| sum[channel] += f64::from(pixel[channel]) / ways.len() as f64);
        }
    }
    let mut errors = Vec::new();
    for (_, scene) in ways {
        let mut error = 0.0;
        for seed in 0..SEEDS {
            let (pixels, _) = render(&mut prepare(scene, seed, SPP)?, SPP)?;
            let squares = pixels.iter().flatten().zip(reference.iter().flatten()).map(|(&a, &b)| (f64::from(a) - b).powi(2));
            error += squares.sum::<f64>() / (3.0 * f64::from(SIDE * SIDE) * f64::from(SEEDS));
        }
        errors.push(error);
    }
    let ratios = time_ratios(&mut ways.iter().map(|(_, scene)| prepare(scene, 1, SPP)).collect::<Result<Vec<_>, _>>()?)?;
    for (index, (way, _)) in ways.iter().enumerate() {
        let [low, median, high] = ratios[index];
        println!(
            "| {name} | {way} | {:.2e} | {median:.2} ({low:.2}–{high:.2}) | {:.2} |",
            errors[index],
            errors[index] / errors[0] * median
        );
    }
    Ok(())
}

/// Time of each renderer over that of the first, pair by pair: lowest, median, highest.
fn time_ratios(renderers: &mut [GpuRenderer]) -> Result<Vec<[f64; 3]>, RenderError> {
    let mut times = vec![Vec::new(); renderers.len()];
    for round in 0..=ROUNDS {
        for (index, renderer) in renderers.iter_mut().enumerate() {
            let (_, seconds) = render(renderer, SPP)?;
            if round > 0 {
                times[index].push(seconds);
            }
        }
    }
    let ratios = times.iter().map(|own| {
        let mut ratios: Vec<f64> = own.iter().zip(&times[0]).map(|(a, b)| a / b).collect();
        ratios.sort_unstable_by(f64::total_cmp);
        [ratios[0], ratios[ROUNDS / 2], ratios[ROUNDS - 1]]
    });
    Ok(ratios.collect())
}

/// A panel of 10,000 triangles over the floor, of which two or all emit.
fn panel(emitting: usize) -> Scene {
    let mut scene = load(&format!("{FLOOR}[[light]]\ntype = \"point\"\nposition = [0, 9, 0]\nintensity = 1e-6\n"));
    let material = |name: &str, emission| Material {
        name: name.into(),
        kind: MaterialKind::Emissive,
        normal_map: None,
        emission,
        two_sided: true,
        interior: None,
    };
    let first = scene.materials.len();
    scene.materials.push(material("dark", None));
    scene.materials.push(material("bright", Some(Emission { radiance: ColorInput::grey(2.0), two_sided: false })));
    let (columns, rows) = (100_u32, 50_u32);
    let positions =
        (0..=rows).flat_map(|y| (0..=columns).map(move |x| Vec3::new(x as f32 / 25.0 - 2.0, 3.0, y as f32 / 25.0 - 1.0)));
    let faces: Vec<[u32; 3]> = (0..rows)
        .flat_map(|y| (0..columns).map(move |x| y * (columns + 1) + x))
        .flat_map(|a| [[a, a + 1, a + columns + 2], [a, a + columns + 2, a + columns + 1]])
        .collect();
    let face_materials = (0..faces.len()).map(|face| first + usize::from(face < emitting)).collect();
    let mesh = Mesh { positions: positions.collect(), faces, face_materials, ..Mesh::default() };
    scene.shapes.push(Shape {
        label: "panel".into(),
        geometry: Geometry::Mesh(Arc::new(mesh)),
        material: first,
        transform: Transform::default(),
        motion: None,
        portal: false,
        receiver: 0,
    });
    scene.camera.position = DVec3::new(0.0, 2.0, 7.0);
    scene
}

fn many(device: &Device) -> Result<(), RenderError> {
    let scenes = [2, 10_000].map(panel);
    let renderers: Result<Vec<_>, _> =
        scenes.iter().map(|scene| GpuRenderer::on(device, scene, &PlanOptions::default())).collect();
    let [low, median, high] = time_ratios(&mut renderers?)?[1];
    println!("time with 10,000 emitting triangles over that with 2, same geometry: {median:.2} ({low:.2}–{high:.2})");
    Ok(())
}
