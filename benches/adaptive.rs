//! The gain of samples that follow the noise: `cargo bench --bench adaptive [-- SCENES]`, of cornell,
//! veach-mis, spheres, caustic, behind-glass, ogre-area, bunny-area; the last two need models that are not
//! part of the project.
//!
//! Equal numbers of samples are rendered with and without `--adaptive`, in turn, and with the independent
//! streams that `--target-error` needs. Error: relative mean squared error against a long render, less that
//! render's own. Time times error is what equal error costs; its ratio, pair by pair, is the table of
//! docs/performance.md.

#[path = "../tests/common/caustic.rs"]
mod caustic;

use std::time::Instant;

use caustic::CAUSTIC;
use gpt::compare::RELATIVE_EPSILON;
use gpt::gpu::{Device, GpuRenderer};
use gpt::load;
use gpt::plan::PlanOptions;
use gpt::render::progressive::{self, Goal};
use gpt::renderer::{DeviceChoice, RenderError, RenderRequest, Renderer, Silent};
use gpt::scene::Scene;
use gpt::verify;

const LONGER_SIDE: u32 = 128;
const SPP: u32 = 256;
const REFERENCE_SPP: u32 = 8192;
const SCENES: [&str; 5] = ["cornell", "veach-mis", "spheres", "caustic", "behind-glass"];
/// With two light samples at a path's first surface, which is their best.
const MODELS: [&str; 2] = ["ogre-area", "bunny-area"];
/// Pairs after one that is thrown away.
const PAIRS: u32 = 5;

/// A lit room of which most is seen calmly, and a corner of it through rough glass.
const BEHIND_GLASS: &str = "[film]\nsize = [128, 128]\n[camera]\nposition = [0, 1.5, 7]\nlook_at = [0, 1, 0]\nvfov = 40\n\
    [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.7\n\
    [[material]]\nname = \"frosted\"\ntype = \"rough_glass\"\nior = 1.5\nalpha = 0.2\n\
    [[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 20\n\
    [[shape]]\ntype = \"rectangle\"\nmaterial = \"white\"\ncorner = [-6, 0, 6]\nedge_u = [12, 0, 0]\nedge_v = [0, 0, -12]\n\
    [[shape]]\ntype = \"sphere\"\nmaterial = \"frosted\"\ncenter = [1.2, 0.8, 1]\nradius = 0.8\n\
    [[shape]]\ntype = \"sphere\"\nmaterial = \"lamp\"\ncenter = [-3, 5, -1]\nradius = 0.5\n\
    [[light]]\ntype = \"environment\"\nradiance = [0.3, 0.35, 0.4]\n[render]\nmax_depth = 8\n";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let device = Device::open(&DeviceChoice::Gpu)?;
    println!(
        "| scene | error | with --adaptive | time, ratio | equal error, ratio (median, range) | streams: equal error, ratio |"
    );
    println!("| --- | --- | --- | --- | --- | --- |");
    for name in SCENES.into_iter().chain(MODELS) {
        if wanted.is_empty() || wanted.iter().any(|other| other == name) {
            match load(name) {
                Ok(scene) => measure(&device, &scene, name)?,
                Err(error) if MODELS.contains(&name) => eprintln!("{name}: left out: {error}"),
                Err(error) => return Err(error),
            }
        }
    }
    Ok(())
}

fn load(name: &str) -> Result<Scene, Box<dyn std::error::Error>> {
    let mut scene = match name {
        "caustic" => load::load_toml_str(CAUSTIC, name, std::path::Path::new(""))?,
        "behind-glass" => load::load_toml_str(BEHIND_GLASS, name, std::path::Path::new(""))?,
        _ if MODELS.contains(&name) => {
            let file = format!("{}/benches/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            let mut scene = load::load(Some(&file))?;
            scene.render.light_samples = 2.into();
            scene
        }
        _ => load::load(Some(name))?,
    };
    verify::shrink(&mut scene, LONGER_SIDE);
    scene.render.spp = SPP;
    Ok(scene)
}

/// The three ways, and renderers made for them once.
struct Ways<'a> {
    scene: &'a Scene,
    plain: GpuRenderer,
    allocating: GpuRenderer,
    truth: Vec<[f32; 3]>,
}

/// Error and seconds of one picture.
type Cost = (f64, f64);

fn measure(device: &Device, scene: &Scene, name: &str) -> Result<(), Box<dyn std::error::Error>> {
    let plain = GpuRenderer::on(device, scene, &PlanOptions::default())?;
    let allocating = GpuRenderer::on(device, scene, &PlanOptions { pixel_list: true, ..PlanOptions::default() })?;
    let mut ways = Ways { scene, plain, allocating, truth: Vec::new() };
    // Far from the samples of the pictures.
    ways.truth = ways.plain_picture(1 << 20..(1 << 20) + REFERENCE_SPP)?;
    let mut rows: Vec<[Cost; 3]> = Vec::new();
    for pair in 0..=PAIRS {
        let first = pair * SPP;
        let costs = [ways.plain(first)?, ways.goal(pair, true, None)?, ways.goal(pair, false, Some(1e-12))?];
        rows.push(costs);
    }
    rows.remove(0);
    let errors = |way: usize| median(rows.iter().map(|row| row[way].0).collect()).0;
    let own = errors(0) * f64::from(SPP) / f64::from(REFERENCE_SPP + SPP);
    let cost = |(error, seconds): Cost| (error - own) * seconds;
    let (times, ..) = median(rows.iter().map(|row| row[1].1 / row[0].1).collect());
    let (equal, least, most) = median(rows.iter().map(|row| cost(row[0]) / cost(row[1])).collect());
    let (streams, low, high) = median(rows.iter().map(|row| cost(row[0]) / cost(row[2])).collect());
    println!(
        "| {name} | {:.3e} | {:.3e} | {times:.2} | {equal:.2} ({least:.2}–{most:.2}) | {streams:.2} ({low:.2}–{high:.2}) |",
        errors(0) - own,
        errors(1) - own
    );
    Ok(())
}

impl Ways<'_> {
    fn plain_picture(&mut self, samples: std::ops::Range<u32>) -> Result<Vec<[f32; 3]>, RenderError> {
        let mut picture = Vec::new();
        let request = RenderRequest { rows: 0..self.scene.film.size[1], samples };
        self.plain.render(&request, &Silent, &mut |band| {
            picture.extend(band.mean);
            Ok(())
        })?;
        Ok(picture)
    }

    fn plain(&mut self, first: u32) -> Result<Cost, RenderError> {
        let start = Instant::now();
        let picture = self.plain_picture(first..first + SPP)?;
        Ok((self.error(&picture), start.elapsed().as_secs_f64()))
    }

    fn goal(&mut self, seed: u32, adaptive: bool, target_error: Option<f64>) -> Result<Cost, RenderError> {
        let start = Instant::now();
        let mut picture = Vec::new();
        let goal = Goal { samples: 0..SPP, region: None, deadline: None, target_error, adaptive, interval: None };
        let renderer = if adaptive { &mut self.allocating } else { &mut self.plain };
        progressive::render(renderer, self.scene.film.size, seed, &goal, &Silent, &mut |band| {
            picture.extend(band.mean);
            Ok(())
        })?;
        Ok((self.error(&picture), start.elapsed().as_secs_f64()))
    }

    /// Relative mean squared error.
    fn error(&self, picture: &[[f32; 3]]) -> f64 {
        let pairs = picture.iter().flatten().zip(self.truth.iter().flatten()).map(|(a, b)| (f64::from(*a), f64::from(*b)));
        pairs.map(|(a, b)| (a - b).powi(2) / (b * b + RELATIVE_EPSILON)).sum::<f64>() / (3 * picture.len()) as f64
    }
}

/// Median, least and largest.
fn median(mut values: Vec<f64>) -> (f64, f64, f64) {
    values.sort_by(f64::total_cmp);
    (values[values.len() / 2], values[0], values[values.len() - 1])
}
