//! The device's film: precision over many samples, samples that add up, bands that cover the picture.

use crate::common::device::{DEVICE, with_limits};
use crate::common::effort::in_full;
use gpt::cpu::ReferenceRenderer;
use gpt::film::Band;
use gpt::gpu::{Device, GpuRenderer};
use gpt::load;
use gpt::plan::{FilmStorage, PlanOptions, StageMode};
use gpt::renderer::state::{BatchState, FilmState, Tally};
use gpt::renderer::{Batch, Observer, RenderRequest, Renderer, Silent};
use gpt::scene::Scene;
use gpt::verify;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

fn render(scene: &Scene, (device, options): &Way, samples: Range<u32>) -> Option<Vec<Band>> {
    let mut renderer = GpuRenderer::on(device.as_ref()?, scene, options).expect("the scene fits");
    assert!(
        device.as_ref().is_none_or(|device| device.limits.read_write_rgba32float || renderer.plan().film == FilmStorage::Buffer)
    );
    let mut bands = Vec::new();
    let request = RenderRequest { rows: 0..scene.film.size[1], samples };
    let mut on_band = |band| {
        bands.push(band);
        Ok(())
    };
    renderer.render(&request, &Silent, &mut on_band).expect("rendering succeeds");
    Some(bands)
}

type Way = (Option<Device>, PlanOptions);

fn stages(mode: StageMode) -> PlanOptions {
    PlanOptions { stages: Some(mode), ..PlanOptions::default() }
}

fn ways() -> [Way; 3] {
    let without_textures = with_limits(|limits| limits.read_write_rgba32float = false);
    [
        (DEVICE.clone(), stages(StageMode::Fused)),
        (DEVICE.clone(), stages(StageMode::Wavefront)),
        (without_textures, stages(StageMode::Wavefront)),
    ]
}

/// A wavefront with so many paths in flight.
fn pool(paths: u32) -> Way {
    (with_limits(|limits| limits.path_capacity = paths), stages(StageMode::Wavefront))
}

/// A light that fills the view: every sample of every pixel is the same number, the hardest case for a sum in f32, because every
/// addition rounds the same way.
const LIGHT: [f64; 3] = [0.1, 1.0 / 3.0, 0.7];

fn light_in_view() -> Scene {
    let text = format!(
        "[film]\nsize = [4, 4]\n[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 40\n\
         [[material]]\nname = \"light\"\ntype = \"emissive\"\nradiance = {LIGHT:?}\n\
         [[shape]]\ntype = \"rectangle\"\ncorner = [-9, -9, 0]\nedge_u = [18, 0, 0]\nedge_v = [0, 18, 0]\nmaterial = \"light\"\n"
    );
    load::load_toml_str(&text, "light", Path::new(".")).expect("the scene is valid")
}

#[test]
#[ignore = "slow"]
fn sums_hold_their_precision_at_65536_samples() {
    const SPP: u32 = 65_536;
    let scene = light_in_view();
    let everywhere = in_full("65,536 samples on every way to sum them");
    for way in ways().into_iter().step_by(if everywhere { 1 } else { 2 }) {
        let Some(bands) = render(&scene, &way, 0..SPP) else { return };
        for pixel in &bands[0].mean {
            for (value, expected) in pixel.iter().zip(LIGHT) {
                let error = (f64::from(*value) / expected - 1.0).abs();
                assert!(error <= 1e-6, "{:?}: {value} instead of {expected}", way.1);
            }
        }
        assert_eq!(bands[0].samples, SPP);
        let luminance: f64 = LIGHT.iter().zip([0.2126, 0.7152, 0.0722]).map(|(l, weight)| l * weight).sum();
        let second = f64::from(bands[0].second_moment[0]);
        assert!((second / (luminance * luminance) - 1.0).abs() < 1e-4, "{second}");
    }
    // The control: a plain f32 sum of the same samples misses the same bound.
    let plain: f32 = std::iter::repeat_n(LIGHT[0] as f32, SPP as usize).sum();
    assert!((f64::from(plain) / f64::from(SPP) / LIGHT[0] - 1.0).abs() > 1e-6);
}

/// Single precision counts to 2²⁴: a count in it stays there, while the sum goes on and the picture grows too bright. A render that begins with
/// almost as many samples ends with the light's radiance and all of its samples.
#[test]
fn samples_are_counted_beyond_the_numbers_of_single_precision() {
    const BEFORE: u32 = (1 << 24) - 2;
    const SPP: u32 = BEFORE + 64;
    let mut scene = light_in_view();
    scene.render.spp = SPP;
    let sum = LIGHT.map(|light| light * f64::from(BEFORE));
    let state = BatchState {
        rows: 0..4,
        done: BEFORE,
        iteration: 0,
        reached: 0,
        film: Arc::new(FilmState::Double { sums: vec![[sum[0], sum[1], sum[2], 0.0]; 16], samples: vec![BEFORE; 16] }),
        tally: Tally::default(),
    };
    let request = RenderRequest { rows: 0..4, samples: 0..SPP };
    let check = |what: &str, renderer: &mut dyn Renderer| {
        let mut bands = Vec::new();
        let mut on_band = |band| {
            bands.push(band);
            Ok(())
        };
        let batch = Batch { resume: Some(&state), ..Batch::of(&request) };
        renderer.render_batch(&batch, &Silent, &mut on_band).expect("it renders");
        assert_eq!(bands[0].samples, SPP, "{what}");
        for (value, expected) in bands[0].mean.iter().flat_map(|pixel| pixel.iter().zip(LIGHT)) {
            // One sample too few in the count is 6e-8 of the radiance, 62 of them are 3.7e-6.
            assert!((f64::from(*value) / expected - 1.0).abs() < 1e-6, "{what}: {value} instead of {expected}");
        }
    };
    check("cpu", &mut ReferenceRenderer::new(&scene).expect("it is supported"));
    for (device, options) in ways() {
        let Some(device) = device.as_ref() else { return };
        check(&format!("{options:?}"), &mut GpuRenderer::on(device, &scene, &options).expect("the scene fits"));
    }
}

#[test]
#[ignore = "slow"]
fn two_halves_of_the_samples_make_the_whole_picture() {
    let mut scene = load::load(Some("cornell")).expect("it is built in");
    verify::shrink(&mut scene, 32);
    for way in ways() {
        let (Some(first), Some(second), Some(whole)) =
            (render(&scene, &way, 0..128), render(&scene, &way, 128..256), render(&scene, &way, 0..256))
        else {
            return;
        };
        for ((a, b), both) in first[0].mean.iter().zip(&second[0].mean).zip(&whole[0].mean) {
            for channel in 0..3 {
                let mean = 0.5 * (f64::from(a[channel]) + f64::from(b[channel]));
                let error = (mean - f64::from(both[channel])).abs();
                assert!(error <= 1e-6 * mean, "{:?}: {mean} against {both:?}", way.1);
            }
        }
        assert_ne!(first[0].mean, second[0].mean, "the halves are different samples");
    }
}

/// The picture is the same, whether it is made in one band or in many, with passes of any size.
#[test]
#[ignore = "slow"]
fn bands_cover_the_picture_and_do_not_show() {
    let mut scene = load::load(Some("spheres")).expect("it is built in");
    scene.film.size = [1500, 1000];
    scene.render.max_depth = 3;
    let Some(bands) = render(&scene, &(DEVICE.clone(), PlanOptions::default()), 0..1) else { return };
    assert!(bands.len() > 1, "the picture is larger than a band");
    let Some(other) = render(&scene, &pool(10_007), 0..1) else { return };
    let Some(later) = render(&scene, &pool(10_007), 1..2) else { return };
    let differing = |a: &Band, b: &Band| {
        let differs = |x: f32, y: f32| (x - y).abs() > 1e-4 * x.abs().max(y.abs());
        a.mean.iter().zip(&b.mean).filter(|(a, b)| a.iter().zip(b.iter()).any(|(x, y)| differs(*x, *y))).count()
    };
    let (mut next_row, mut differing_later) = (0, 0);
    for ((band, same), later) in bands.iter().zip(&other).zip(&later) {
        assert_eq!((band.first_row, band.samples), (next_row, 1));
        next_row += band.rows;
        assert!(differing(band, same) * 1000 < band.mean.len());
        differing_later += differing(band, later);
    }
    assert_eq!(next_row, 1000);
    // The control: another sample differs in every second pixel or so, for above the horizon is one colour. A quarter is 250 times what may.
    assert!(differing_later * 4 > 1500 * 1000, "{differing_later}");
}

/// Passes are sized by time, so their borders differ from run to run; the picture must not, nor what parts of pictures are made of. Bit for bit.
#[test]
fn the_picture_does_not_depend_on_how_samples_are_cut_into_passes() {
    let mut scene = load::load(Some("spheres")).expect("it is built in");
    verify::shrink(&mut scene, 48);
    let (Some(one), Some(other)) = (render(&scene, &pool(1 << 18), 0..50), render(&scene, &pool(1_001), 0..50)) else {
        return;
    };
    assert!(one[0].mean == other[0].mean);
    assert!(one[0].remainder == other[0].remainder && one[0].second_moment == other[0].second_moment);
    let Some(different) = render(&scene, &pool(1_001), 1..51) else { return };
    assert!(one[0].mean != different[0].mean, "other samples make another picture");
    assert!(one[0].remainder != different[0].remainder && one[0].second_moment != different[0].second_moment);
}

/// Asks to stop once it was told of progress so often, and of so many samples.
struct StopAfter {
    passes: u32,
    samples: u64,
    seen: AtomicU32,
    done: AtomicU64,
}

impl Observer for StopAfter {
    fn progress(&self, done: u64, _total: u64) {
        self.seen.fetch_add(1, Ordering::Relaxed);
        self.done.store(done, Ordering::Relaxed);
    }
    fn stop_requested(&self) -> bool {
        self.seen.load(Ordering::Relaxed) >= self.passes && self.done.load(Ordering::Relaxed) >= self.samples
    }
}

/// The picture of a render that is stopped after so many passes and a sample for each pixel.
fn interrupted(renderer: &mut dyn Renderer, scene: &Scene, samples: u32, passes: u32) -> Vec<Band> {
    let [width, height] = scene.film.size;
    stopped(renderer, scene, samples, (passes, u64::from(width) * u64::from(height)))
}

fn stopped(renderer: &mut dyn Renderer, scene: &Scene, samples: u32, (passes, done): (u32, u64)) -> Vec<Band> {
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..samples };
    let stop = StopAfter { passes, samples: done, seen: AtomicU32::new(0), done: AtomicU64::new(0) };
    let mut bands = Vec::new();
    let report = renderer.render(&request, &stop, &mut |band| {
        bands.push(band);
        Ok(())
    });
    assert!(report.expect("rendering succeeds").interrupted);
    bands
}

fn rows(bands: &[Band]) -> u32 {
    bands.iter().map(|band| band.rows).sum()
}

/// However large: samples go over all of it before a pixel gets its second one.
#[test]
#[ignore = "slow"]
fn an_interrupted_picture_is_whole() {
    let mut scene = load::load(Some("spheres")).expect("it is built in");
    scene.film.size = [1500, 1000];
    scene.render.max_depth = 2;
    for (device, options) in ways() {
        let Some(device) = device else { return };
        let mut renderer = GpuRenderer::on(&device, &scene, &options).expect("the scene fits");
        let bands = interrupted(&mut renderer, &scene, 64, 1);
        assert_eq!(rows(&bands), 1000, "{options:?}");
        assert!(bands.iter().all(|band| band.samples >= 1), "{options:?}");
    }
}

/// Pixels differ where a render ends in the middle of an iteration. Each has, bit for bit, what a render of as many samples gives it.
#[test]
#[ignore = "slow"]
fn pixels_say_how_many_samples_they_have() {
    let mut scene = load::load(Some("spheres")).expect("it is built in");
    scene.film.size = [16, 160];
    let (device, options) = pool(1_001);
    let mut renderers: Vec<Box<dyn Renderer>> = vec![Box::new(ReferenceRenderer::new(&scene).expect("it renders"))];
    if let Some(device) = device {
        renderers.push(Box::new(GpuRenderer::on(&device, &scene, &options).expect("the scene fits")));
    }
    for mut renderer in renderers {
        let whole = |renderer: &mut dyn Renderer, samples: u32| {
            let mut pixels = Vec::new();
            let request = RenderRequest { rows: 0..160, samples: 0..samples };
            let mut on_band = |band: Band| {
                assert!(band.counts.is_none(), "all pixels have as many");
                pixels.extend(band.mean);
                Ok(())
            };
            renderer.render(&request, &Silent, &mut on_band).expect("rendering succeeds");
            pixels
        };
        let of_one_sample = whole(renderer.as_mut(), 1);
        let mut uneven = 0;
        for passes in 4..12 {
            let bands = interrupted(renderer.as_mut(), &scene, 1_000_000, passes);
            assert_eq!(rows(&bands), 160);
            let Some(counts) = bands.iter().map(|band| band.counts.clone()).collect::<Option<Vec<_>>>() else { continue };
            let counts = counts.concat();
            let [fewest, most] = [counts.iter().min(), counts.iter().max()].map(|count| *count.expect("there are pixels"));
            assert!(fewest >= 1 && fewest < most, "{fewest} to {most}");
            assert_eq!(bands.iter().map(|band| band.samples).min(), Some(fewest));
            let picture: Vec<[f32; 3]> = bands.iter().flat_map(|band| band.mean.iter().copied()).collect();
            for samples in [fewest, most] {
                let expected = whole(renderer.as_mut(), samples);
                let of_as_many = (0..counts.len()).filter(|pixel| counts[*pixel] == samples);
                assert!(of_as_many.clone().all(|pixel| picture[pixel] == expected[pixel]), "{passes} passes, {samples} samples");
                // The control.
                assert!(samples == 1 || of_as_many.filter(|pixel| picture[*pixel] != of_one_sample[*pixel]).count() > 10);
            }
            uneven += 1;
        }
        assert!(uneven > 0, "on {}", renderer.device());
    }
}

/// Bands that memory makes of the film are finished one after the other, and an interrupted picture says what
/// it lacks.
#[test]
fn a_film_that_memory_cuts_is_the_same_picture() {
    let mut scene = load::load(Some("cornell")).expect("it is built in");
    scene.film.size = [96, 64];
    let small = with_limits(|limits| {
        limits.max_texture_side = 90;
        limits.max_array = 96 * 16 * 20;
    });
    let (Some(device), Some(small)) = (DEVICE.as_ref(), small) else { return };
    let mut cut = GpuRenderer::on(&small, &scene, &PlanOptions::default()).expect("the scene fits");
    assert!(!cut.holds_whole_film() && cut.plan().band_rows == 20);
    let whole = render(&scene, &(Some(device.clone()), PlanOptions::default()), 0..3).expect("there is a device");
    let bands = render(&scene, &(Some(small.clone()), PlanOptions::default()), 0..3).expect("there is a device");
    let pixels = |bands: &[Band]| bands.iter().flat_map(|band| band.mean.iter().copied()).collect::<Vec<_>>();
    assert!(pixels(&whole) == pixels(&bands));
    assert!(bands.iter().all(|band| band.counts.as_ref().is_some_and(|counts| counts.iter().all(|count| *count == 3))));
    let begun = stopped(&mut cut, &scene, 3, (1, 0));
    assert!(rows(&begun) < 64 && begun.iter().all(|band| band.counts.is_some()));
}
