//! What the CPU does before and beside the device: `cargo bench --bench cpu`.
//!
//! Reading scene files and models, packing a scene, building the hierarchy, drawing random numbers, following reference paths.

#![allow(missing_docs, reason = "the macro that gathers the benchmarks makes a public function")]

use std::hint::black_box;
use std::path::Path;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use gpt::bench::scenes;
use gpt::binary_tree::parts::KeptTrees;
use gpt::choice::Choice;
use gpt::load;
use gpt::packed::{PackedScene, hierarchy::Traversal, tree, world};
use gpt::reference::ReferenceRenderer;
use gpt::sampling::{Dimension, PathSampler, Sampling, SequencePoint, VertexDimension};
use gpt::scene::{RenderSettings, SamplerKind};

/// Triangles of the scenes that are packed.
const TRIANGLES: [u32; 3] = [1_000, 10_000, 100_000];

fn parse(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("parse");
    let text = load::builtin_text("cornell").unwrap_or_default();
    group.throughput(Throughput::Bytes(text.len() as u64));
    group.bench_function("cornell.toml", |bencher| bencher.iter(|| load::load_toml_str(text, "cornell", Path::new(""))));
    // The scene file and the model that it names, both part of the program.
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/models/teapot.obj");
    group.throughput(Throughput::Bytes(std::fs::metadata(model).map_or(0, |file| file.len())));
    group.bench_function("teapot.obj", |bencher| bencher.iter(|| load::load(Some("teapot-plastic"))));
    group.finish();
}

fn pack(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("pack");
    group.sample_size(10);
    for triangles in TRIANGLES {
        let Ok(scene) = scenes::hills(triangles) else { continue };
        group.throughput(Throughput::Elements(triangles.into()));
        group.bench_with_input(BenchmarkId::new("flatten", triangles), &scene, |bencher, scene| {
            bencher.iter(|| PackedScene::new(scene));
        });
        let geometry = world::collect(&scene);
        group.bench_with_input(BenchmarkId::new("hierarchy", triangles), &geometry, |bencher, geometry| {
            bencher.iter(|| tree::build(geometry, Traversal::Bvh, &mut KeptTrees::default()));
        });
    }
    group.finish();
}

fn sample(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("sample");
    for sampler in SamplerKind::ALL {
        let sampling = Sampling::from(&RenderSettings { sampler, ..RenderSettings::default() });
        group.throughput(Throughput::Elements(1));
        group.bench_function(BenchmarkId::new("sequence point", sampler.name()), |bencher| {
            let mut index = 0_u32;
            bencher.iter(|| {
                index = index.wrapping_add(1) & 0xffff;
                SequencePoint::new(&sampling, black_box(index))
            });
        });
        let point = SequencePoint::new(&sampling, 77);
        group.bench_function(BenchmarkId::new("number of a path", sampler.name()), |bencher| {
            let path = PathSampler::new(&sampling, 1234, &point);
            bencher.iter(|| path.uniform(black_box(Dimension::vertex(1, VertexDimension::BsdfU))));
        });
    }
    group.finish();
}

fn trace(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("reference path");
    for name in ["cornell", "veach-mis"] {
        let Ok(scene) = load::load(Some(name)) else { continue };
        let Ok(renderer) = ReferenceRenderer::new(&scene) else { continue };
        let [width, height] = scene.film.size;
        group.throughput(Throughput::Elements(1));
        group.bench_function(name, |bencher| {
            let mut index = 0_u32;
            bencher.iter(|| {
                index = index.wrapping_add(97);
                renderer.radiance_of_sample(index % width, (index / width) % height, 3)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, parse, pack, sample, trace);
criterion_main!(benches);
