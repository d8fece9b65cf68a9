//! Renders that break off and go on: the picture is, bit for bit, the one of a render that did not.

use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use crate::common::device::{DEVICE, with_limits};
use crate::common::effort::in_full;
use gpt::cpu::ReferenceRenderer;
use gpt::gpu::{Device, GpuRenderer};
use gpt::output::Provenance;
use gpt::plan::{PlanOptions, StageMode};
use gpt::render::checkpoint::{Checkpoint, Identity, path_beside};
use gpt::render::intervals::interval_goal;
use gpt::render::progressive::{self, Goal, Stop, render_kept};
use gpt::renderer::{Observer, Renderer, Silent};
use gpt::scene::Scene;
use gpt::{Band, load};

/// Stops after so many passes.
struct StopsAfter {
    passes: u32,
    seen: AtomicU32,
}

impl Observer for StopsAfter {
    fn progress(&self, _done: u64, _total: u64) {
        self.seen.fetch_add(1, Ordering::Relaxed);
    }

    fn stop_requested(&self) -> bool {
        self.seen.load(Ordering::Relaxed) >= self.passes
    }
}

/// Stops once so many bands are finished.
struct StopsAtBands {
    bands: u32,
    finished: AtomicU32,
}

impl Observer for StopsAtBands {
    fn progress(&self, _done: u64, _total: u64) {}

    fn stop_requested(&self) -> bool {
        self.finished.load(Ordering::Relaxed) >= self.bands
    }
}

fn cornell(size: [u32; 2]) -> Scene {
    let mut scene = load::load(Some("cornell")).expect("it is built in");
    scene.film.size = size;
    scene
}

fn goal(spp: u32) -> Goal {
    Goal { samples: 0..spp, region: None, deadline: None, target_error: None, adaptive: false, interval: None }
}

fn identity(scene: &Scene, seed: u32) -> Identity {
    let provenance = Provenance {
        scene: scene.name.clone(),
        scene_hash: gpt::scene::digest(scene),
        settings: gpt::RenderSettings { seed, ..scene.render.clone() },
        filter: scene.film.filter,
        first_sample: 0,
        target_error: None,
        adaptive: false,
        interval: None,
        device: String::new(),
    };
    Identity::new(&provenance, scene.film.size, None, true)
}

/// Rows in their places: what comes again later is the same rows, further on.
fn collect(scene: &Scene, bands: Vec<Band>) -> Vec<[u32; 3]> {
    let [width, height] = scene.film.size.map(|side| side as usize);
    let mut pixels = vec![[0; 3]; width * height];
    for band in bands {
        let start = band.first_row as usize * width;
        pixels[start..start + band.mean.len()]
            .copy_from_slice(&band.mean.iter().map(|mean| mean.map(f32::to_bits)).collect::<Vec<_>>());
    }
    pixels
}

type Make<'a> = &'a dyn Fn() -> Box<dyn Renderer>;

/// Renders in pieces, each by a renderer of its own that goes on from the last one's checkpoint; the picture and the number of pieces.
fn in_pieces(scene: &Scene, goal: &Goal, makers: &[Make<'_>], folder: &Path) -> (Vec<[u32; 3]>, u32) {
    let path = path_beside(&folder.join("a.exr"));
    for piece in 0..10_000 {
        let mut renderer = makers[piece as usize % makers.len()]();
        let interval = Duration::from_millis(if piece % 2 == 0 { 1 } else { 100_000 });
        let mut checkpoint =
            Checkpoint::new(path.clone(), identity(scene, 0), "a device", interval, Instant::now()).expect("a place");
        let found = checkpoint.find(scene.film.size).expect("it is of this render");
        assert_eq!(found.is_some(), piece > 0);
        // Each takes longer than the one before: there are not too many of them.
        // A sample of some pixels alone is no state of a render with intervals.
        let least = if goal.interval.is_some() { 8 } else { 1 };
        let observer = StopsAfter { passes: least << piece.min(20), seen: AtomicU32::new(0) };
        let mut bands = Vec::new();
        let mut on_band = |band| {
            bands.push(band);
            Ok(())
        };
        let (size, seed) = (scene.film.size, scene.render.seed);
        let outcome =
            render_kept(renderer.as_mut(), size, seed, goal, &observer, Some(&mut checkpoint), &mut on_band).expect("it renders");
        if outcome.stop != Stop::Interrupted {
            checkpoint.remove();
            assert_eq!(std::fs::read_dir(folder).expect("the folder").count(), 0, "nothing is left");
            return (collect(scene, bands), piece + 1);
        }
        assert!(checkpoint.finish().expect("it is written"));
    }
    panic!("it never ends");
}

fn gpu(device: Option<&Device>, scene: &Scene, options: &PlanOptions) -> Option<Box<dyn Renderer>> {
    Some(Box::new(GpuRenderer::on(device?, scene, options).expect("the scene fits")))
}

fn cpu(scene: &Scene) -> Box<dyn Renderer> {
    Box::new(ReferenceRenderer::new(scene).expect("the reference renders it"))
}

/// With a film too small for the picture.
fn cpu_in_bands(scene: &Scene) -> Box<dyn Renderer> {
    Box::new(ReferenceRenderer::new(scene).expect("the reference renders it").with_film_pixels(64))
}

fn whole(scene: &Scene, goal: &Goal, make: Make<'_>) -> Vec<[u32; 3]> {
    let mut bands = Vec::new();
    let mut on_band = |band| {
        bands.push(band);
        Ok(())
    };
    progressive::render(make().as_mut(), scene.film.size, scene.render.seed, goal, &Silent, &mut on_band).expect("it renders");
    collect(scene, bands)
}

/// On every way in which a device sums, whole films and films in bands, and whatever ends the render.
#[test]
#[ignore = "slow"]
fn a_render_in_pieces_is_the_render_in_one_piece() {
    let scene = cornell([40, 30]);
    let in_buffers = with_limits(|limits| limits.read_write_rgba32float = false);
    let in_bands = with_limits(|limits| limits.film_pixels = 40 * 8);
    let small_passes = with_limits(|limits| limits.max_workgroups = 3);
    let options = |stages| PlanOptions { stages: Some(stages), pixel_list: true, ..PlanOptions::default() };
    let (fused, wavefront) = (options(StageMode::Fused), options(StageMode::Wavefront));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let goals = [
        goal(40),
        Goal { adaptive: true, ..goal(32) },
        Goal { target_error: Some(1e-9), ..goal(48) },
        Goal { target_error: Some(1e-9), adaptive: true, ..goal(96) },
        Goal { interval: Some(interval_goal(&scene, &gpt::IntervalOptions { layers: true, ..Default::default() })), ..goal(40) },
    ];
    let on_scene = |scene: &Scene, device: &'static str, goal: &Goal, make: Make<'_>| {
        let expected = whole(scene, goal, make);
        let (found, pieces) = in_pieces(scene, goal, &[make], folder.path());
        assert!(pieces > 1, "{device}, {goal:?}: only {pieces} pieces");
        assert!(found == expected, "{device}, {goal:?}");
    };
    let on = |device: &'static str, goal: &Goal, make: Make<'_>| on_scene(&scene, device, goal, make);
    // Bands of the CPU have 64 rows.
    let tall = cornell([8, 150]);
    let everywhere = in_full("renders in pieces for every goal on every device");
    for (index, goal) in goals.iter().enumerate() {
        on("cpu", goal, &|| cpu(&scene));
        on_scene(&tall, "cpu in bands", goal, &|| cpu_in_bands(&tall));
        let ways = [
            ("fused", DEVICE.as_ref(), &fused),
            ("wavefront", DEVICE.as_ref(), &wavefront),
            ("film in buffers", in_buffers.as_ref(), &wavefront),
            ("bands", in_bands.as_ref(), &fused),
            ("passes of parts of the film", small_passes.as_ref(), &fused),
        ];
        // In the short form one or two for each goal, and all for the four together.
        for (_, (name, device, options)) in ways.into_iter().enumerate().filter(|(other, _)| everywhere || other % 4 == index) {
            if device.is_some() {
                on(name, goal, &|| gpu(device, &scene, options).expect("a device"));
            }
        }
    }
    // The control: one sample less is another picture.
    assert!(whole(&scene, &goal(40), &|| cpu(&scene)) != whole(&scene, &goal(39), &|| cpu(&scene)));
}

/// Devices may take turns: their samples agree to rounding, so the picture does.
#[test]
fn another_device_goes_on() {
    let Some(device) = DEVICE.as_ref() else { return };
    let scene = cornell([40, 30]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let in_bands = with_limits(|limits| limits.film_pixels = 40 * 8);
    for goal in [goal(40), Goal { adaptive: true, ..goal(32) }] {
        let options = PlanOptions { pixel_list: true, ..PlanOptions::default() };
        let on_gpu = || gpu(Some(device), &scene, &options).expect("a device");
        let on_bands = || gpu(in_bands.as_ref(), &scene, &options).expect("a device");
        let on_cpu = || cpu(&scene);
        let expected = whole(&scene, &goal, &on_cpu);
        let (found, pieces) = in_pieces(&scene, &goal, &[&on_gpu, &on_cpu, &on_bands], folder.path());
        // Two pieces are two devices. How many more there are depends on how much is in a pass.
        assert!(pieces > 1, "{pieces}");
        let far = |[a, b]: [&[u32; 3]; 2]| {
            a.iter().zip(b).any(|(a, b)| (f32::from_bits(*a) - f32::from_bits(*b)).abs() > 1e-3 * (f32::from_bits(*b) + 0.01))
        };
        let different = found.iter().zip(&expected).filter(|(a, b)| far([a, b])).count();
        assert!(different <= 12, "{different} of 1200 pixels, {goal:?}");
        // The control.
        let other = Goal { samples: 100..140, ..goal.clone() };
        let others = whole(&scene, &other, &on_cpu);
        assert!(others.iter().zip(&expected).filter(|(a, b)| far([a, b])).count() > 300);
    }
}

/// A band that one device finished of a picture is kept by another, which adds those that it finishes.
#[test]
fn bands_that_several_devices_finish_are_all_kept() {
    let (Some(device), Some(in_bands)) = (DEVICE.as_ref(), with_limits(|limits| limits.film_pixels = 40 * 8)) else { return };
    let scene = cornell([40, 30]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = path_beside(&folder.path().join("a.exr"));
    let options = PlanOptions::default();
    let goal = goal(100);
    let (size, seed) = (scene.film.size, scene.render.seed);
    let mut picture = Vec::new();
    for piece in 0.. {
        // The first begins in bands of 8 rows; the others could hold the whole film.
        let mut renderer = gpu(Some(if piece == 0 { &in_bands } else { device }), &scene, &options).expect("a device");
        let mut checkpoint =
            Checkpoint::new(path.clone(), identity(&scene, 0), "a device", Duration::ZERO, Instant::now()).expect("a place");
        checkpoint.find(size).expect("it is of this render");
        let observer = StopsAtBands { bands: piece + 1, finished: AtomicU32::new(0) };
        let mut bands = Vec::new();
        let mut on_band = |band: Band| {
            let is_finished =
                band.samples == 100 && band.counts.as_ref().is_none_or(|counts| counts.iter().all(|&count| count == 100));
            observer.finished.fetch_add(u32::from(is_finished), Ordering::Relaxed);
            bands.push(band);
            Ok(())
        };
        let outcome = render_kept(renderer.as_mut(), size, seed, &goal, &observer, Some(&mut checkpoint), &mut on_band)
            .expect("it renders");
        checkpoint.finish().expect("it is written");
        if outcome.stop != Stop::Interrupted {
            picture = collect(&scene, bands);
            break;
        }
    }
    assert!(picture == whole(&scene, &goal, &|| gpu(Some(device), &scene, &options).expect("a device")));
}

/// Nobody goes on from the state of another render.
#[test]
fn the_state_of_another_render_is_refused() {
    let scene = cornell([16, 12]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = path_beside(&folder.path().join("a.exr"));
    let open =
        |identity| Checkpoint::new(path.clone(), identity, "a device", Duration::from_secs(60), Instant::now()).expect("a place");
    let mut checkpoint = open(identity(&scene, 0));
    assert!(checkpoint.find([16, 12]).expect("there is none").is_none());
    let observer = StopsAfter { passes: 2, seen: AtomicU32::new(0) };
    let (size, seed) = (scene.film.size, scene.render.seed);
    let mut renderer = cpu(&scene);
    let goal = goal(1_000_000);
    render_kept(renderer.as_mut(), size, seed, &goal, &observer, Some(&mut checkpoint), &mut |_| Ok(())).expect("it renders");
    assert!(checkpoint.finish().expect("it is written"));
    let said = |identity| open(identity).find([16, 12]).map_err(|error| error.to_string());
    assert!(matches!(said(identity(&scene, 0)), Ok(Some((device, samples))) if device == "a device" && samples > 0));
    assert!(said(identity(&scene, 1)).is_err_and(|said| said.contains("--seed 0, and this render has --seed 1")));
    let mut moved = scene.clone();
    moved.camera.position.x += 0.5;
    assert!(said(identity(&moved, 0)).is_err_and(|said| said.contains("another scene")));
}
