//! Very many parts, joined in the order in which they happen to end: nothing is lost between them.

use std::sync::Arc;
use std::time::Instant;

use crate::common::effort::{announce, in_full};
use gpt::merge::{PartHeader, chunks, merge};
use gpt::output::{PartSpec, PictureFile, PictureFormat, PictureSpec};
use gpt::{DeviceChoice, RenderOptions, Renderer, Silent};
use rayon::prelude::*;

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
