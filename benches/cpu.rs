//! The work of the CPU before and beside the device: `cargo bench --bench cpu`.
//!
//! Reading scene files and models, packing a scene, building the hierarchy, drawing random numbers, following reference paths.

use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

use gpt::bench::scenes;
use gpt::binary_tree::parts::KeptTrees;
use gpt::choice::Choice;
use gpt::cpu::ReferenceRenderer;
use gpt::load;
use gpt::packed::{PackedScene, hierarchy::Traversal, tree, world};
use gpt::sampling::{Dimension, PathSampler, Sampling, SequencePoint, VertexDimension};
use gpt::scene::{RenderSettings, SamplerKind};

/// Triangles of the scenes that are packed.
const TRIANGLES: [u32; 3] = [1_000, 10_000, 100_000];
/// Measurements of each, and how long one of them takes at least.
const MEASUREMENTS: usize = 15;
const AT_LEAST: Duration = Duration::from_millis(50);

fn main() {
    println!("| what | median | lowest | highest |");
    println!("| --- | --- | --- | --- |");
    parse();
    pack();
    sample();
    trace();
}

/// Prints what a call takes, of so many calls at once that the clock is exact.
fn measure<T>(what: &str, mut call: impl FnMut() -> T) {
    let mut time = |calls: u32| {
        let start = Instant::now();
        (0..calls).for_each(|_| drop(black_box(call())));
        start.elapsed()
    };
    let mut calls = 1;
    while time(calls) < AT_LEAST && calls < 1 << 30 {
        calls *= 2;
    }
    let mut times: Vec<f64> = (0..MEASUREMENTS).map(|_| time(calls).as_secs_f64() / f64::from(calls)).collect();
    times.sort_by(f64::total_cmp);
    let shown = |seconds: f64| match seconds {
        seconds if seconds >= 1e-3 => format!("{:.3} ms", 1e3 * seconds),
        seconds if seconds >= 1e-6 => format!("{:.3} µs", 1e6 * seconds),
        seconds => format!("{:.3} ns", 1e9 * seconds),
    };
    let [median, lowest, highest] = [MEASUREMENTS / 2, 0, MEASUREMENTS - 1].map(|rank| shown(times[rank]));
    println!("| {what} | {median} | {lowest} | {highest} |");
}

fn parse() {
    let text = load::builtin_text("cornell").unwrap_or_default();
    measure("parse cornell.toml", || load::load_toml_str(text, "cornell", Path::new("")));
    // The scene file and the model that it names, both part of the program.
    measure("parse teapot.obj", || load::load(Some("teapot-plastic")));
}

fn pack() {
    for triangles in TRIANGLES {
        let Ok(scene) = scenes::hills(triangles) else { continue };
        measure(&format!("flatten {triangles} triangles"), || PackedScene::new(&scene));
        let geometry = world::collect(&scene);
        measure(&format!("hierarchy of {triangles} triangles"), || {
            tree::build(&geometry, Traversal::Bvh, &mut KeptTrees::default())
        });
    }
}

fn sample() {
    for sampler in SamplerKind::ALL {
        let sampling = Sampling::from(&RenderSettings { sampler, ..RenderSettings::default() });
        let mut index = 0_u32;
        measure(&format!("sequence point, {}", sampler.name()), || {
            index = index.wrapping_add(1) & 0xffff;
            SequencePoint::new(&sampling, black_box(index))
        });
        let point = SequencePoint::new(&sampling, 77);
        let path = PathSampler::new(&sampling, 1234, &point);
        measure(&format!("number of a path, {}", sampler.name()), || {
            path.uniform(black_box(Dimension::vertex(1, VertexDimension::BsdfU)))
        });
    }
}

fn trace() {
    for name in ["cornell", "veach-mis"] {
        let Ok(scene) = load::load(Some(name)) else { continue };
        let Ok(renderer) = ReferenceRenderer::new(&scene) else { continue };
        let [width, height] = scene.film.size;
        let mut index = 0_u32;
        measure(&format!("reference path, {name}"), || {
            index = index.wrapping_add(97);
            renderer.radiance_of_sample(index % width, (index / width) % height, 3)
        });
    }
}
