//! The efficiency of samplers and filters: `cargo bench --bench strategies [-- samplers|filters|cost]`.
//!
//! Error: mean square over pixels and channels against a long render of the same filter, averaged over seeds; and the same relative to
//! the square of the reference. Cost: samples per second,
//! samplers in turn so that all meet the machine in the same state, as ratios to `halton` pair by pair. Prints the tables of
//! docs/strategies.md.

use std::time::Instant;

use gpt::choice::Choice;
use gpt::gpu::{Device, GpuRenderer};
use gpt::load;
use gpt::plan::PlanOptions;
use gpt::renderer::{DeviceChoice, RenderError, RenderRequest, Renderer, Silent};
use gpt::scene::{Filter, FilterKind, PixelSampler, SamplerKind, Scene};

const SIDE: u32 = 128;
const SPP: [u32; 3] = [16, 64, 256];
const SEEDS: u32 = 4;
const REFERENCE_SPP: u32 = 4096;
/// Rounds of the cost's measurement after one that is thrown away.
const ROUNDS: usize = 7;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|other| other == name);
    let device = Device::open(&DeviceChoice::Gpu)?;
    let mut scene = load::load(Some("cornell"))?;
    scene.film.size = [SIDE; 2];
    if is_wanted("samplers") {
        samplers(&device, &scene)?;
    }
    if is_wanted("filters") {
        filters(&device, &scene)?;
    }
    if is_wanted("cost") {
        cost(&device, &scene)?;
    }
    Ok(())
}

fn render(device: &Device, scene: &Scene) -> Result<Vec<[f32; 3]>, RenderError> {
    let mut renderer = GpuRenderer::on(device, scene, &PlanOptions::default())?;
    let mut pixels = Vec::new();
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..scene.render.spp };
    renderer.render(&request, &Silent, &mut |band| {
        pixels.extend(band.mean);
        Ok(())
    })?;
    Ok(pixels)
}

fn reference(device: &Device, scene: &Scene) -> Result<Vec<[f32; 3]>, RenderError> {
    let mut scene = scene.clone();
    scene.render.spp = REFERENCE_SPP;
    scene.render.seed = 0x5eed;
    render(device, &scene)
}

/// Over pixels and channels, averaged over the seeds.
struct Errors {
    mean_square: f64,
    /// Each square divided by that of the reference, plus 0.01, so that bright pixels do not decide alone.
    relative: f64,
}

fn error(device: &Device, scene: &Scene, reference: &[[f32; 3]]) -> Result<Errors, RenderError> {
    let mut errors = Errors { mean_square: 0.0, relative: 0.0 };
    for seed in 0..SEEDS {
        let mut scene = scene.clone();
        scene.render.seed = seed;
        let pixels = render(device, &scene)?;
        let share = 1.0 / (f64::from(SEEDS) * 3.0 * pixels.len() as f64);
        for (&a, &b) in pixels.iter().flatten().zip(reference.iter().flatten()) {
            let square = f64::from(a - b).powi(2);
            errors.mean_square += share * square;
            errors.relative += share * square / (f64::from(b).powi(2) + 0.01);
        }
    }
    Ok(errors)
}

fn samplers(device: &Device, scene: &Scene) -> Result<(), RenderError> {
    let reference = reference(device, scene)?;
    println!("| sampler | {} |", SPP.map(|spp| format!("{spp} spp")).join(" | "));
    println!("| --- |{}", " --- |".repeat(SPP.len()));
    let row = |name: String, sampler, pixel_sampler| {
        let mut errors = Vec::new();
        for spp in SPP {
            let mut scene = scene.clone();
            scene.render.spp = spp;
            scene.render.sampler = sampler;
            scene.render.pixel_sampler = pixel_sampler;
            let error = error(device, &scene, &reference)?;
            errors.push(format!("{:.2e}, {:.2e}", error.mean_square, error.relative));
        }
        println!("| {name} | {} |", errors.join(" | "));
        Ok::<(), RenderError>(())
    };
    for sampler in SamplerKind::ALL {
        row(sampler.name().to_owned(), sampler, PixelSampler::SameAsPath)?;
    }
    for sampler in SamplerKind::ALL.into_iter().filter(|sampler| *sampler != SamplerKind::Halton) {
        let name = format!("halton, pixel {}", sampler.name());
        row(name, SamplerKind::Halton, PixelSampler::Other(sampler))?;
    }
    row("halton, pixel none".to_owned(), SamplerKind::Halton, PixelSampler::Centre)
}

fn filters(device: &Device, scene: &Scene) -> Result<(), RenderError> {
    let filters =
        [(FilterKind::Box, 0.5), (FilterKind::Tent, 1.0), (FilterKind::Gaussian, 1.5), (FilterKind::BlackmanHarris, 2.0)];
    println!("| filter | 64 spp |\n| --- | --- |");
    for (kind, radius) in filters {
        let mut scene = scene.clone();
        scene.film.filter = Filter { kind, radius };
        scene.render.spp = 64;
        let error = error(device, &scene, &reference(device, &scene)?)?;
        println!("| {} | {:.2e}, {:.2e} |", scene.film.filter, error.mean_square, error.relative);
    }
    Ok(())
}

fn cost(device: &Device, scene: &Scene) -> Result<(), RenderError> {
    let mut renderers = Vec::new();
    for sampler in SamplerKind::ALL {
        let mut scene = scene.clone();
        scene.film.size = [512; 2];
        scene.render.max_depth = 8;
        scene.render.sampler = sampler;
        renderers.push((sampler, GpuRenderer::on(device, &scene, &PlanOptions::default())?));
    }
    let mut rates = vec![Vec::new(); renderers.len()];
    for round in 0..=ROUNDS {
        for (index, (_, renderer)) in renderers.iter_mut().enumerate() {
            let start = Instant::now();
            let request = RenderRequest { rows: 0..512, samples: 0..16 };
            let report = renderer.render(&request, &Silent, &mut |_| Ok(()))?;
            if round > 0 {
                rates[index].push(report.samples as f64 / start.elapsed().as_secs_f64() / 1e6);
            }
        }
    }
    let halton = SamplerKind::ALL.iter().position(|kind| *kind == SamplerKind::Halton).unwrap_or(0);
    println!("| sampler | Msample/s (median) | ratio to halton, pair by pair (median, range) |\n| --- | --- | --- |");
    for (index, (sampler, _)) in renderers.iter().enumerate() {
        let ratios = sorted(rates[index].iter().zip(&rates[halton]).map(|(a, b)| a / b));
        let median = sorted(rates[index].iter().copied())[ROUNDS / 2];
        let (low, high) = (ratios[0], ratios[ROUNDS - 1]);
        println!("| {} | {median:.2} | {:.3} ({low:.3}–{high:.3}) |", sampler.name(), ratios[ROUNDS / 2]);
    }
    Ok(())
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}
