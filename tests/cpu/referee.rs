//! The referee's suite: its truths are what the reference renders, and each of its tests can fail.

use std::collections::BTreeSet;
use std::path::Path;

use gpt::cpu::ReferenceRenderer;
use gpt::referee::causes::{Suspect, explained_by};
use gpt::referee::judge::{Outcome, Seeds, judge};
use gpt::referee::picture::TruthPicture;
use gpt::referee::test::{Test, Variant, VariantPicture};
use gpt::referee::truth::Truth;
use gpt::referee::{all_tests, replay, shipped};
use gpt::renderer::{Batch, RenderRequest, Renderer, Silent};

use crate::common::effort::in_full;

/// The probability that all comparisons of one test here together reject what is true.
const LEVEL: f64 = 1e-3;

/// Two renders, with random numbers of their own.
fn rendered(test: &Test, spp: u32, seed: u32) -> [Vec<[f32; 3]>; 2] {
    [seed, seed + 100].map(|seed| rendered_once(test, spp, seed))
}

fn rendered_once(test: &Test, spp: u32, seed: u32) -> Vec<[f32; 3]> {
    rendered_scene(test, &test.scene, spp, seed)
}

/// A picture by a renderer that goes on to others, with random numbers of this seed.
fn one_of_many(renderer: &mut ReferenceRenderer, [_, height]: [u32; 2], spp: u32, seed: u32) -> Vec<[f32; 3]> {
    let request = RenderRequest { rows: 0..height, samples: 0..spp };
    let batch = Batch { seed: Some(gpt::sampling::hash::mix(seed)), ..Batch::of(&request) };
    let mut pixels = Vec::new();
    let report = renderer.render_batch(&batch, &Silent, &mut |band| {
        pixels.extend(band.mean);
        Ok(())
    });
    report.expect("it renders");
    pixels
}

/// A picture of a scene in place of the test's own.
fn rendered_scene(test: &Test, text: &str, spp: u32, seed: u32) -> Vec<[f32; 3]> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut scene = replay::load_scene(test.name, text, &test.files, folder.path()).unwrap_or_else(|error| panic!("{error}"));
    (scene.render.spp, scene.render.seed) = (spp, seed);
    let mut pixels = Vec::new();
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..spp };
    let mut renderer = ReferenceRenderer::new(&scene).expect("it is supported");
    let report = renderer.render(&request, &Silent, &mut |band| {
        pixels.extend(band.mean);
        Ok(())
    });
    report.expect("it renders");
    pixels
}

/// Samples per pixel of the short and the long form.
fn samples() -> u32 {
    if in_full("pictures of the referee's suite with 256 samples instead of 16") { 256 } else { 16 }
}

fn truth(test: &Test) -> TruthPicture {
    test.true_picture().unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_suite_is_as_large_as_it_says_and_each_test_is_one() {
    let tests = all_tests();
    assert!(tests.len() >= 80, "{} tests", tests.len());
    let names: BTreeSet<_> = tests.iter().map(Test::file_name).collect();
    assert_eq!(names.len(), tests.len(), "two tests have one name");
    let formulas = tests.iter().filter(|test| matches!(test.truth, Truth::Formula(_))).count();
    assert!(formulas >= 70, "{formulas} formulas");
    let folder = tempfile::tempdir().expect("a temporary folder");
    for test in &tests {
        assert!(!test.about.is_empty() && test.about.ends_with('.') && !test.decides.is_empty(), "{}", test.name);
        let scene = replay::load_scene(test.name, &test.scene, &test.files, folder.path());
        let scene = scene.unwrap_or_else(|error| panic!("{}: {error}", test.name));
        assert_eq!(scene.film.size, test.size(), "{}", test.name);
        assert!(scene.warnings.is_empty(), "{}: {:?}", test.name, scene.warnings);
    }
}

/// The reference renders every truth. Mistakes that are planted into its pictures, whose noise stays, are found, and called by their names.
#[test]
#[ignore = "slow"]
fn the_reference_agrees_with_every_truth_and_planted_mistakes_are_named() {
    let tests = all_tests();
    let spp = samples();
    let (level, level_of_mistakes) = (gpt::compare::sidak(LEVEL, tests.len()), gpt::compare::sidak(0.01, tests.len()));
    let mut wrong = Vec::new();
    for test in &tests {
        let truth = truth(test);
        let pictures = rendered(test, spp, 7);
        let judged = judge(&truth, truth.width, &pictures.each_ref().map(Vec::as_slice), Seeds::Known, level);
        println!("{}: {:?}, finds {:?}", test.name, judged.outcome, judged.finds);
        if judged.outcome != Outcome::Agrees {
            wrong.push(format!("{}: {:?}", test.name, judged.difference));
        }
        let of_formula = |variant: &Variant| match &variant.picture {
            VariantPicture::Formula(formula) => {
                Some(Suspect { cause: variant.cause.to_owned(), picture: formula.picture(test.size()) })
            }
            VariantPicture::Scene(_) => None,
        };
        let suspects: Vec<Suspect> = test.variants.iter().filter_map(of_formula).collect();
        for suspect in &suspects {
            let planted = pictures.each_ref().map(|pixels| -> Vec<[f32; 3]> {
                let pixel = |index: usize, i: usize| pixels[index][i] + suspect.picture.mean[index][i] - truth.mean[index][i];
                (0..pixels.len()).map(|index| std::array::from_fn(|i| pixel(index, i))).collect()
            });
            let planted = planted.each_ref().map(Vec::as_slice);
            let judged = judge(&truth, truth.width, &planted, Seeds::Known, level_of_mistakes);
            if judged.outcome != Outcome::Differs {
                wrong.push(format!("{}: {} is not found, {:?}", test.name, suspect.cause, judged.finds));
            } else if !explained_by(&suspects, truth.width, &planted, Seeds::Known, level_of_mistakes)
                .contains(&suspect.cause.as_str())
            {
                let as_it_is = judge(&suspect.picture, truth.width, &planted, Seeds::Known, level_of_mistakes);
                wrong.push(format!("{}: {} is not named, {:?}", test.name, suspect.cause, as_it_is.difference));
            }
        }
    }
    assert!(wrong.is_empty(), "{} mistakes:\n{}", wrong.len(), wrong.join("\n"));
}

/// Scenes with a mistake planted into them render to pictures that are found to differ, and the mistake is called by its name.
#[test]
#[ignore = "slow"]
fn mistakes_in_scenes_are_found() {
    // The samples that the suite's runs have.
    let (tests, spp) = (all_tests(), 256);
    let level = gpt::compare::sidak(0.01, tests.len());
    let (mut planted, mut wrong) = (0, Vec::new());
    for test in &tests {
        let truth = truth(test);
        let with_mistakes: Vec<(&str, String)> = test
            .variants
            .iter()
            .filter_map(|variant| match &variant.picture {
                VariantPicture::Scene(scene) => Some((variant.cause, scene.clone())),
                VariantPicture::Formula(_) => None,
            })
            .collect();
        for (cause, scene) in with_mistakes {
            planted += 1;
            let folder = tempfile::tempdir().expect("a temporary folder");
            if let Err(error) = replay::load_scene(test.name, &scene, &test.files, folder.path()) {
                wrong.push(format!("{}: {cause} is no scene: {error}", test.name));
                continue;
            }
            let render = |seed| rendered_scene(test, &scene, spp, seed);
            let pictures = [render(3), render(103)];
            let pictures = pictures.each_ref().map(Vec::as_slice);
            let judged = judge(&truth, truth.width, &pictures, Seeds::Known, level);
            if judged.outcome != Outcome::Differs {
                wrong.push(format!("{}: {cause} is not found, {:?}", test.name, judged.finds));
            }
        }
    }
    println!("{planted} mistakes in scenes");
    assert!(wrong.is_empty(), "{} of {planted} mistakes:\n{}", wrong.len(), wrong.join("\n"));
}

/// Runs of the whole suite by a renderer without a mistake: of 1,000, no more have a false alarm than the level of the suite says.
#[test]
fn the_suite_raises_no_more_false_alarms_than_it_says() {
    let runs: u32 = if in_full("1,000 runs of the referee's suite without a mistake") { 1000 } else { return };
    // Enough for tests of means, whose distribution is less normal where samples are fewer.
    const SPP: u32 = 8;
    const OF_SUITE: f64 = 0.05;
    let tests = all_tests();
    let level = gpt::compare::sidak(OF_SUITE, tests.len());
    let mut alarms = vec![Vec::new(); runs as usize];
    for test in &tests {
        let truth = truth(test);
        let folder = tempfile::tempdir().expect("a temporary folder");
        let scene = replay::load_scene(test.name, &test.scene, &test.files, folder.path());
        let mut scene = scene.unwrap_or_else(|error| panic!("{error}"));
        scene.render.spp = SPP;
        let mut renderer = ReferenceRenderer::new(&scene).expect("it is supported");
        for run in 0..runs {
            let pictures = [2 * run, 2 * run + 1].map(|seed| one_of_many(&mut renderer, scene.film.size, SPP, seed));
            let judged = judge(&truth, truth.width, &pictures.each_ref().map(Vec::as_slice), Seeds::Known, level);
            if judged.outcome != Outcome::Agrees {
                alarms[run as usize].push(test.name);
            }
        }
        // A run takes an hour and more: what is known of it shows.
        let of_test = alarms.iter().filter(|names| names.contains(&test.name)).count();
        println!("{}: {of_test} of {runs}", test.name);
    }
    let alarmed = alarms.iter().filter(|names| !names.is_empty()).count();
    println!("{alarmed} of {runs} runs had a false alarm, where {OF_SUITE} of them may: {:?}", alarms.concat());
    let most = OF_SUITE * f64::from(runs) + 3.0 * (OF_SUITE * (1.0 - OF_SUITE) * f64::from(runs)).sqrt();
    assert!(alarmed as f64 <= most, "{alarmed} of {runs}: {:?}", alarms.concat());
}

/// Files of truths that no formula tells, which are made again where `GPT_BLESS` is set; the long form makes them anew and compares.
#[test]
fn shipped_truths_are_what_the_reference_renders() {
    let blesses = std::env::var_os("GPT_BLESS").is_some();
    let long = in_full("truths of the referee's suite rendered again");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/referee");
    let tests: Vec<_> = all_tests().into_iter().filter(|test| matches!(test.truth, Truth::Shipped)).collect();
    assert!(tests.len() >= 10);
    for test in &tests {
        if !blesses && !long {
            truth(test);
            continue;
        }
        let spp = if blesses { 1024 } else { 128 };
        let made = replay::by_reference(test.name, &test.scene, &test.files, spp).unwrap_or_else(|error| panic!("{error}"));
        if blesses {
            std::fs::create_dir_all(&folder).expect("a folder");
            std::fs::write(folder.join(format!("{}.truth", test.file_name())), shipped::bytes(&made)).expect("a file");
            println!("{} is made", test.name);
        } else {
            let truth = truth(test);
            let judged = judge(&truth, truth.width, &[&made.mean], Seeds::Unknown, LEVEL / tests.len() as f64);
            assert_eq!(judged.outcome, Outcome::Agrees, "{}: {judged:?}", test.name);
        }
    }
}
