//! A farm of ten thousand nodes, simulated: how much of its time becomes samples, and that none is lost. The numbers are those of
//! docs/scaling.md. Chunks are cut and joined by the code that does it in earnest, with tiny parts.

use std::collections::BinaryHeap;
use std::sync::Arc;
use std::time::Instant;

use crate::common::effort::{announce, in_full};
use gpt::merge::{PartHeader, chunks, merge};
use gpt::output::{PartSpec, PictureFile, PictureFormat, PictureSpec};
use gpt::{DeviceChoice, RenderOptions, Renderer, Silent};
use rayon::prelude::*;

/// Hours, and events an hour.
#[derive(Clone, Copy)]
struct Farm {
    nodes: u32,
    /// Chunks for each node, and how long one takes.
    chunks_per_node: u32,
    chunk: f64,
    /// From a task's start to its first sample, and from a failure to the next start.
    start_up: f64,
    requeue: f64,
    checkpoint: f64,
    failures_per_hour: f64,
}

const SECOND: f64 = 1.0 / 3600.0;

const FARM: Farm = Farm {
    nodes: 10_000,
    chunks_per_node: 4,
    chunk: 1.0,
    start_up: 10.0 * SECOND,
    requeue: 60.0 * SECOND,
    checkpoint: 60.0 * SECOND,
    failures_per_hour: 0.02,
};

/// Numbers between 0 and 1.
struct Random(u32);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(1);
        (f64::from(gpt::sampling::hash::mix(self.0)) + 0.5) / 4_294_967_296.0
    }
}

/// Hours that a chunk takes with its failures.
fn hours_of_chunk(farm: &Farm, random: &mut Random) -> f64 {
    let (mut hours, mut left) = (0.0, farm.chunk);
    loop {
        hours += farm.start_up;
        let until_failure = -random.next().ln() / farm.failures_per_hour;
        if until_failure >= left {
            return hours + left;
        }
        // What was done since the last state is lost.
        left -= (until_failure / farm.checkpoint).floor() * farm.checkpoint;
        hours += until_failure + farm.requeue;
    }
}

/// Share of the nodes' time, until the last chunk is done, that became samples.
fn simulated_efficiency(farm: &Farm) -> f64 {
    let mut random = Random(7);
    // When each node is free, in seconds, the soonest first.
    let mut free: BinaryHeap<std::cmp::Reverse<u64>> = (0..farm.nodes).map(|_| std::cmp::Reverse(0)).collect();
    let mut end = 0;
    for _ in 0..farm.nodes * farm.chunks_per_node {
        let std::cmp::Reverse(now) = free.pop().expect("there are nodes");
        let done = now + (hours_of_chunk(farm, &mut random) / SECOND) as u64;
        end = end.max(done);
        free.push(std::cmp::Reverse(done));
    }
    farm.chunk * f64::from(farm.chunks_per_node) / (end as f64 * SECOND)
}

/// The model of docs/scaling.md, but for the wait for the last chunk.
fn modelled_efficiency(farm: &Farm) -> f64 {
    let failures = farm.failures_per_hour * farm.chunk;
    farm.chunk / (farm.chunk + farm.start_up + failures * (0.5 * farm.checkpoint + farm.requeue + farm.start_up))
}

#[test]
fn a_farm_of_ten_thousand_nodes_loses_little_time() {
    let [simulated, modelled] = [simulated_efficiency(&FARM), modelled_efficiency(&FARM)];
    announce(&format!(
        "10,000 nodes: efficiency {simulated:.4} simulated, {modelled:.4} by the model without the wait for the last chunk"
    ));
    assert!(simulated >= 0.95 && simulated <= modelled + 0.002, "{simulated} {modelled}");
    // The control: without checkpoints a failure costs half a chunk, and so do long chunks on nodes that fail often.
    let without = Farm { checkpoint: 10.0, ..FARM };
    assert!(simulated_efficiency(&without) < simulated - 0.01);
    let bad = Farm { checkpoint: 10.0, chunk: 8.0, failures_per_hour: 0.1, ..FARM };
    assert!(simulated_efficiency(&bad) < 0.7, "{}", simulated_efficiency(&bad));
}

/// As many parts as chunks, joined in the order in which they end.
#[test]
fn nothing_is_lost_between_many_parts() {
    let count = if in_full("ten thousand parts") { 10_000 } else { 200 };
    let samples = count * 2 + 1;
    let mut scene = gpt::Scene::load("cornell").expect("it is built in");
    scene.film.size = [4, 3];
    scene.render.max_depth = 3;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let render = |first_sample: u32, samples: u32| {
        let options =
            RenderOptions { device: DeviceChoice::Cpu, first_sample, samples: Some(samples), ..RenderOptions::default() };
        let mut scene = scene.clone();
        scene.render.spp = samples;
        let mut renderer = Renderer::new(&scene, &options).expect("the CPU");
        let mut bands = Vec::new();
        let mut on_band = |band| {
            bands.push(band);
            Ok(())
        };
        renderer.render(&Silent, &mut on_band).expect("it renders");
        (bands, renderer.provenance().clone())
    };
    let begun = Instant::now();
    let ranges: Vec<_> = chunks(samples, count).collect();
    let mut parts: Vec<(u32, PartHeader)> = ranges
        .into_par_iter()
        .enumerate()
        .map(|(index, range)| {
            let (bands, provenance) = render(range.start, range.len() as u32);
            let path = folder.path().join(format!("{index}.exr"));
            let part = Some(PartSpec { film: [4, 3], origin: [0, 0] });
            let spec = PictureSpec { width: 4, height: 3, provenance: Some(provenance), part, ..PictureSpec::default() };
            let mut file = PictureFile::create(&path, PictureFormat::Exr, &spec).expect("a file");
            for band in bands {
                file.write_band(&Arc::new(band)).expect("it is written");
            }
            file.finish().expect("it is in its place");
            (gpt::sampling::hash::mix(index as u32), PartHeader::read(&path).expect("a part"))
        })
        .collect();
    parts.sort_by_key(|(when, _)| *when);
    let parts: Vec<PartHeader> = parts.into_iter().map(|(_, part)| part).collect();
    let rendered = begun.elapsed().as_secs_f64();
    let merged = merge(parts.clone(), Some(samples), false).expect("they belong together");
    let merging = begun.elapsed().as_secs_f64() - rendered;
    announce(&format!("{count} parts: written in {rendered:.1} s, joined in {merging:.1} s"));
    let (whole, _) = render(0, samples);
    let found: Vec<[f32; 3]> = merged.bands().flat_map(|band| band.mean).collect();
    let pairs = found.iter().flatten().zip(whole[0].mean.iter().flatten());
    let units = pairs.map(|(a, b)| a.to_bits().abs_diff(b.to_bits())).max().expect("pixels");
    assert!(units <= 1, "{units}");
    // The control: one part less is noticed.
    let missing = merge(parts[1..].to_vec(), Some(samples), false);
    assert!(missing.is_err_and(|error| error.to_string().contains("missing")));
}
