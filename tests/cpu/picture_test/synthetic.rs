//! False alarms come at the stated rate, and changes of the stated size are found, on synthetic renders: noise whose law is known, light tails
//! and heavy ones.

use gpt::compare::Moments;
use gpt::film::Band;
use gpt::output::Image;
use gpt::picture_test::TestSettings;
use gpt::picture_test::bless::bless;
use gpt::picture_test::golden::Golden;
use gpt::picture_test::judge::{Judgement, judge, screen};
use gpt::picture_test::replications::Replications;
use gpt::renderer::sink::Sink;
use gpt::renderer::{Batch, Observer, RenderError, RenderReport, Renderer, Silent};

use crate::statistics::random::SplitMix64;

const WIDTH: u32 = 32;
const HEIGHT: u32 = 24;

/// Renders noise about a picture that is known.
struct Synthetic {
    /// Standard deviation of a sample over its mean.
    noise: f64,
    /// One render in so many adds a bright sample to a pixel; 0: none does.
    fireflies: f64,
    /// Factor of the pixels from this column on.
    change: (u32, f64),
}

impl Synthetic {
    const SOUND: Self = Self { noise: 0.5, fireflies: 0.0, change: (0, 1.0) };

    fn truth(&self, x: u32, y: u32) -> f64 {
        let factor = if x >= self.change.0 { self.change.1 } else { 1.0 };
        factor * (0.2 + 0.01 * f64::from(x + y))
    }
}

impl Renderer for Synthetic {
    fn device(&self) -> &str {
        "synthetic"
    }

    fn holds_whole_film(&self) -> bool {
        true
    }

    fn set_samples_per_pixel(&mut self, _spp: u32) {}

    fn with_scene(
        self: Box<Self>,
        _scene: &gpt::Scene,
        _change: gpt::renderer::Change,
    ) -> Result<Box<dyn Renderer>, RenderError> {
        Ok(self)
    }

    fn render_into(
        &mut self,
        batch: &Batch<'_>,
        _observer: &dyn Observer,
        sink: &mut dyn Sink,
    ) -> Result<RenderReport, RenderError> {
        let rows = batch.request.rows.clone();
        let samples = batch.request.samples.len() as f64;
        let mut random = SplitMix64::new(u64::from(batch.seed.unwrap_or(0)) << 20);
        let mut mean = Vec::new();
        for y in 0..HEIGHT {
            for x in 0..WIDTH {
                let truth = self.truth(x, y);
                let bright = if random.uniform() < self.fireflies { 300.0 / samples } else { 0.0 };
                let pixel =
                    std::array::from_fn(|_| (truth * (1.0 + bright + self.noise * random.normal() / samples.sqrt())) as f32);
                if rows.contains(&y) {
                    mean.push(pixel);
                }
            }
        }
        let band = Band {
            first_row: rows.start,
            width: WIDTH,
            rows: rows.len() as u32,
            samples: samples as u32,
            mean,
            ..Band::default()
        };
        sink.band(band).map_err(RenderError::Output)?;
        Ok(RenderReport::default())
    }
}

fn settings(change: f64, false_alarms: f64) -> TestSettings {
    TestSettings { change, false_alarms, ..TestSettings::default() }
}

fn golden(renderer: &mut Synthetic, seed: u32, settings: &TestSettings) -> Golden {
    bless(renderer, [WIDTH, HEIGHT], ("", seed), settings, &Silent).expect("it renders").golden
}

fn test(renderer: &mut Synthetic, golden: &Golden, seed: u32, settings: &TestSettings) -> Judgement {
    judge(renderer, golden, seed, settings, &Silent).expect("it renders")
}

/// True if a count may come from so many trials of this probability: within four standard deviations.
fn is_likely(count: u32, trials: u32, probability: f64) -> bool {
    let expected = probability * f64::from(trials);
    (f64::from(count) - expected).abs() <= 4.0 * (expected * (1.0 - probability)).sqrt()
}

/// The first look rejects as often as it says, golden picture and render both anew each time; the second clears nearly all of that.
#[test]
#[ignore = "slow"]
fn equal_scenes_are_told_apart_no_more_often_than_stated() {
    let (runs, settings) = (200, settings(0.2, 0.1));
    let (mut suspected, mut found) = (0, 0);
    for run in 0..runs {
        let golden = golden(&mut Synthetic { ..Synthetic::SOUND }, run, &settings);
        let judged = test(&mut Synthetic { ..Synthetic::SOUND }, &golden, run, &settings);
        suspected += u32::from(judged.suspects > 0);
        found += u32::from(!judged.differences.is_empty());
    }
    assert!(is_likely(suspected, runs, 0.1), "the first look rejected {suspected} of {runs}");
    assert!(f64::from(found) <= 0.1 * f64::from(runs) * 0.6, "{found} of {runs} were found to differ");
}

/// Bright samples that one render in some meets and the golden picture did not: the first look cannot know, the second does.
#[test]
fn rare_bright_samples_are_cleared_by_the_second_look() {
    let (runs, settings) = (100, settings(0.2, 0.01));
    let noisy = || Synthetic { fireflies: 2e-4, ..Synthetic::SOUND };
    let (mut suspected, mut found) = (0, 0);
    for run in 0..runs {
        let golden = golden(&mut noisy(), run, &settings);
        let judged = test(&mut noisy(), &golden, run, &settings);
        suspected += u32::from(judged.suspects > 0);
        found += u32::from(!judged.differences.is_empty());
    }
    assert!(suspected > 3, "the test has something to clear: {suspected}");
    assert!(found <= 2, "{found} of {runs} were found to differ");
}

/// A change of the stated size, of a few tiles, is found as often as is stated.
#[test]
fn changes_of_the_stated_size_are_found_with_the_stated_power() {
    let settings = TestSettings { power: 0.9, ..settings(0.05, 0.01) };
    let (runs, mut found) = (60, 0);
    for run in 0..runs {
        let golden = golden(&mut Synthetic { ..Synthetic::SOUND }, run, &settings);
        // The last column of tiles, three of them: each is found with a probability of nearly 0.9 or more.
        let mut changed = Synthetic { change: (24, 1.05), ..Synthetic::SOUND };
        found += u32::from(!test(&mut changed, &golden, run, &settings).differences.is_empty());
    }
    assert!(found >= 57, "{found} of {runs} were found");
    // The control: a tenth of it is not.
    let golden = golden(&mut Synthetic { ..Synthetic::SOUND }, 1, &settings);
    let mut hardly = Synthetic { change: (24, 1.005), ..Synthetic::SOUND };
    assert!(test(&mut hardly, &golden, 1, &settings).differences.is_empty());
}

/// More noise at the same mean is no difference, though the golden picture knows only its own.
#[test]
fn more_noise_is_no_difference() {
    let settings = settings(0.1, 0.01);
    let golden = golden(&mut Synthetic { ..Synthetic::SOUND }, 5, &settings);
    let judged = test(&mut Synthetic { noise: 1.5, ..Synthetic::SOUND }, &golden, 5, &settings);
    assert!(judged.suspects > 0 && judged.differences.is_empty(), "{} suspects", judged.suspects);
}

/// A render's pixels that are not numbers, and those that have no noise.
#[test]
fn nothing_undefined_passes_and_rounding_does() {
    let mut still = Synthetic { noise: 0.0, ..Synthetic::SOUND };
    let golden = golden(&mut still, 0, &settings(0.01, 0.01));
    let level = settings(0.01, 0.01);
    let agrees = |image: &Image| screen(&golden, image, 4, &level).expect("one size").agrees();
    assert!(agrees(&golden.mean));
    let scaled = |factor: f32| {
        let pixels = golden.mean.pixels.iter().map(|pixel| pixel.map(|value| value * factor)).collect();
        Image { width: WIDTH, height: HEIGHT, pixels }
    };
    assert!(agrees(&scaled(1.00001)) && !agrees(&scaled(1.001)));
    let mut broken = golden.mean.clone();
    broken.pixels[100][1] = f32::NAN;
    assert!(!agrees(&broken));
}

/// A golden picture comes back from its file, and a picture without variances is refused with advice.
#[test]
fn golden_pictures_come_back_from_their_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.exr");
    let mut renders = Replications::new(3, 0..2, 4);
    for value in [1.0, 2.0, 4.0] {
        renders.add(&[[value, 0.5, 0.0]; 6]);
    }
    let scene = gpt::Scene::default();
    let provenance = gpt::Renderer::provenance_of(&scene, &gpt::RenderOptions::default(), "a device");
    let golden = Golden::of(&renders, 0.125, provenance.scene_hash.clone());
    golden.write(&path, provenance).expect("it is written");
    let back = Golden::read(&path).expect("it is read");
    assert_eq!((&back.mean, &back.variances, back.samples), (&golden.mean, &golden.variances, 12));
    assert_eq!((back.replications, back.flip_of_noise, back.scene_hash), (Some(3), Some(0.125), golden.scene_hash));
    let plain = folder.path().join("plain.exr");
    exr::prelude::write_rgb_file(&plain, 2, 2, |_, _| (0.0f32, 0.0f32, 0.0f32)).expect("it is written");
    let refused = Golden::read(&plain).expect_err("it says nothing of its noise").to_string();
    assert!(refused.contains("Variance.R") && refused.contains("--bless"), "{refused}");
}

/// The noise that a golden picture tells is the noise that there is.
#[test]
fn variances_are_those_of_samples() {
    let golden = golden(&mut Synthetic { ..Synthetic::SOUND }, 3, &settings(0.05, 0.01));
    let relative: Moments = golden
        .variances
        .iter()
        .zip(&golden.mean.pixels)
        .map(|(variance, mean)| f64::from(variance[0]) / f64::from(mean[0]).powi(2))
        .collect();
    assert!((relative.mean() - 0.25).abs() < 6.0 * relative.standard_error(), "{}", relative.mean());
}
