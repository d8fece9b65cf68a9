//! The marks this project set itself, measured: `cargo bench --bench marks [-- SCENE…]`.
//!
//! For each scene the GPU and the CPU reference render in turn, so that both meet the machine in the same state, and the ratio is taken
//! pair by pair. Prints medians with their spread, as a table for docs/performance.md. Times start at the first finished pixel and leave out
//! loading; set-up is its own column.

use std::path::Path;
use std::time::Instant;

use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::plan::{PlanOptions, StageMode};
use gpt::renderer::{DeviceChoice, RenderReport, RenderRequest, Renderer, Silent};
use gpt::scene::Scene;

/// Pairs measured after one that is thrown away.
const PAIRS: usize = 5;
/// Samples per pixel of one GPU measurement, and of one CPU measurement: about equal times.
const GPU_SPP: u32 = 16;
const CPU_SPP: u32 = 2;

fn main() {
    let mut names: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    if names.is_empty() {
        names = ["cornell", "spheres", "veach-mis"].map(str::to_owned).to_vec();
        let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models/ogre.obj");
        if Path::new(model).exists() {
            names.push(concat!(env!("CARGO_MANIFEST_DIR"), "/benches/scenes/ogre.toml").to_owned());
        } else {
            println!("ogre: left out, {model} is absent");
        }
    }
    println!("| scene | stages | set-up s | first sample s | GPU Msample/s | GPU Mray/s | CPU reference Msample/s | GPU / CPU |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for name in names {
        match load::load(Some(&name)) {
            Ok(mut scene) => {
                scene.render.max_depth = 8;
                measure(&scene);
            }
            Err(error) => println!("{name}: {error}"),
        }
    }
}

fn measure(scene: &Scene) {
    for stages in [StageMode::Fused, StageMode::Wavefront] {
        let start = Instant::now();
        let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
        let mut gpu = match GpuRenderer::new(scene, &DeviceChoice::Gpu, &options) {
            Ok(gpu) => gpu,
            Err(error) => return println!("{}: {error}", scene.name),
        };
        let set_up = start.elapsed().as_secs_f64();
        render(&mut gpu, scene, 1);
        let first_sample = start.elapsed().as_secs_f64();
        let mut cpu = match ReferenceRenderer::new(scene) {
            Ok(cpu) => cpu,
            Err(error) => return println!("{}: {error}", scene.name),
        };
        render(&mut cpu, scene, 1);
        let pairs: Vec<[RenderReport; 2]> =
            (0..PAIRS).map(|_| [render(&mut gpu, scene, GPU_SPP), render(&mut cpu, scene, CPU_SPP)]).collect();
        let rate = |report: &RenderReport| report.samples as f64 / report.render_seconds * 1e-6;
        let samples = spread(pairs.iter().map(|[gpu, _]| rate(gpu)));
        let rays = spread(pairs.iter().map(|[gpu, _]| gpu.rays as f64 / gpu.render_seconds * 1e-6));
        let reference = spread(pairs.iter().map(|[_, cpu]| rate(cpu)));
        let ratio = spread(pairs.iter().map(|[gpu, cpu]| rate(gpu) / rate(cpu)));
        let chosen = if stages == chosen_stages(scene) { ", chosen" } else { "" };
        println!(
            "| {} | {stages:?}{chosen} | {set_up:.2} | {first_sample:.2} | {samples} | {rays} | {reference} | {ratio} |",
            scene.name
        );
    }
}

fn chosen_stages(scene: &Scene) -> StageMode {
    GpuRenderer::new(scene, &DeviceChoice::Gpu, &PlanOptions::default()).map_or(StageMode::Fused, |gpu| gpu.plan().stages)
}

fn render(renderer: &mut dyn Renderer, scene: &Scene, spp: u32) -> RenderReport {
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..spp };
    renderer.render(&request, &Silent, &mut |_| Ok(())).unwrap_or_else(|error| {
        eprintln!("{}: {error}", scene.name);
        std::process::exit(1)
    })
}

/// Median, and least to largest.
fn spread(values: impl Iterator<Item = f64>) -> String {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    format!("{:.2} ({:.2}–{:.2})", values[values.len() / 2], values[0], values[values.len() - 1])
}
