//! `gpt test` with renders: equal scenes agree as often as is stated, and planted changes are found.

mod synthetic;

use gpt::Scene;
use gpt::cpu::ReferenceRenderer;
use gpt::picture_test::TestSettings;
use gpt::picture_test::bless::bless;
use gpt::picture_test::golden::Golden;
use gpt::picture_test::judge::{Judgement, judge};
use gpt::renderer::Silent;
use statrs::distribution::{Binomial, DiscreteCDF};

use crate::common::effort::in_full;

/// The Cornell box in so many pixels.
fn cornell(size: [u32; 2]) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell.toml");
    let text = std::fs::read_to_string(path).expect("the built-in scene");
    let sized = text.replace("size = [512, 512]", &format!("size = [{}, {}]", size[0], size[1]));
    assert_ne!(sized, text);
    sized
}

fn scene(text: &str) -> Scene {
    Scene::from_toml(text).expect("a valid scene")
}

fn make_golden(scene: &Scene, seed: u32, settings: &TestSettings) -> Golden {
    let mut renderer = ReferenceRenderer::new(scene).expect("a scene that can be rendered");
    bless(&mut renderer, scene.film.size, ("", seed), settings, &Silent).expect("it renders").golden
}

fn test(scene: &Scene, golden: &Golden, seed: u32, settings: &TestSettings) -> Judgement {
    let mut renderer = ReferenceRenderer::new(scene).expect("a scene that can be rendered");
    judge(&mut renderer, golden, seed, settings, &Silent).expect("it renders")
}

/// Probability of so many successes or more.
fn at_least(count: u64, trials: u64, probability: f64) -> f64 {
    let binomial = Binomial::new(probability, trials).expect("a probability");
    if count == 0 { 1.0 } else { binomial.sf(count - 1) }
}

/// A thousand runs of a scene against itself in the long form, golden picture and render anew each time: no more differences are found than the
/// stated rate explains (binomial test, level 10⁻³). The first look alone would not keep the rate, since samples of a room have heavy tails.
#[test]
#[ignore = "slow"]
fn a_scene_agrees_with_itself_as_often_as_is_stated() {
    let runs = if in_full("a thousand runs of a scene against itself; 12 are made") { 1000 } else { 12 };
    let settings = TestSettings { change: 0.5, false_alarms: 0.05, ..TestSettings::default() };
    let scene = scene(&cornell([16, 16]));
    let (mut suspected, mut found) = (0, 0);
    for run in 0..runs {
        let golden = make_golden(&scene, run, &settings);
        let judged = test(&scene, &golden, run, &settings);
        suspected += u64::from(judged.suspects > 0);
        found += u64::from(!judged.differences.is_empty());
    }
    let chance = at_least(found, u64::from(runs), settings.false_alarms);
    assert!(chance > 1e-3, "{found} of {runs} runs found a difference, {suspected} were suspicious at first: p = {chance:.1e}");
    println!("{found} of {runs} runs found a difference, {suspected} were suspicious at first");
}

/// Ten changes that a person may make by mistake. Each is found by a render of 32 samples per pixel, most far below the change that is asked for.
#[test]
#[ignore = "slow"]
fn each_of_ten_planted_changes_is_found() {
    let settings = TestSettings { change: 0.25, ..TestSettings::default() };
    let sound = cornell([16, 16]);
    let golden = make_golden(&scene(&sound), 0, &settings);
    let same = test(&scene(&sound), &golden, 0, &settings);
    assert!(same.differences.is_empty(), "the control: {:?}", same.differences.first());
    let changes = [
        ("the light is brighter", "radiance = [17, 12, 4]", "radiance = [20, 14, 4.7]"),
        ("the light has another colour", "radiance = [17, 12, 4]", "radiance = [17, 12, 4.8]"),
        ("the light is smaller", "edge_u   = [130, 0, 0]", "edge_u   = [105, 0, 0]"),
        ("paths are shorter", "max_depth = 8", "max_depth = 3"),
        ("a wall is darker", "reflectance = [0.63, 0.065, 0.05]", "reflectance = [0.45, 0.045, 0.035]"),
        ("walls are white by mistake", "reflectance = [0.14, 0.45, 0.091]", "reflectance = [0.725, 0.71, 0.68]"),
        ("everything reflects a little more", "reflectance = [0.725, 0.71, 0.68]", "reflectance = [0.8, 0.785, 0.75]"),
        (
            "the camera has moved",
            "position = [278, 273, -800]\nlook_at  = [278, 273, -799]",
            "position = [320, 273, -800]\nlook_at  = [320, 273, -799]",
        ),
        ("the view is wider", "vfov     = 39.3077", "vfov     = 43"),
        (
            "a block is lower",
            "[423, 330, 247], [265, 330, 296], [314, 330, 456], [472, 330, 406]",
            "[423, 120, 247], [265, 120, 296], [314, 120, 456], [472, 120, 406]",
        ),
    ];
    for (what, from, to) in changes {
        let changed = sound.replace(from, to);
        assert_ne!(changed, sound, "{what}");
        let judged = test(&scene(&changed), &golden, 0, &settings);
        assert!(!judged.differences.is_empty(), "{what}: not found, {} suspects", judged.suspects);
    }
}
