//! Light samples, paths alone, both together, and one of both by chance estimate one integral, so their means are one, on either device. A device that agrees with the
//! reference shares its mistakes; a way of sampling does not share those of another.

mod media;
mod scenes;
mod study;

use std::path::Path;

use crate::common::device::DEVICE;
use crate::common::effort::in_full;
use gpt::compare::{Moments, hypothesis, sidak};
use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::plan::{Fault, PlanOptions};
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::{Estimator, Scene};
use scenes::Features;

/// Pictures whose random numbers are independent: their means are nearly normal.
const PICTURES: u32 = 16;

/// The mean of green over the picture, of each of [`PICTURES`].
fn means(renderer: &mut dyn Renderer, scene: &Scene) -> Moments {
    let (spp, [width, height]) = (scene.render.spp, scene.film.size);
    (0..PICTURES)
        .map(|number| {
            let mut sum = 0.0;
            let request = RenderRequest { rows: 0..height, samples: number * spp..(number + 1) * spp };
            let report = renderer.render(&request, &Silent, &mut |band| {
                sum += band.mean.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>();
                Ok(())
            });
            report.expect("it renders");
            sum / f64::from(width * height)
        })
        .collect()
}

/// A way to the mean of a picture, by its estimator, its device and random numbers of its own.
struct Way {
    name: String,
    found: Moments,
}

fn load(text: &str) -> Scene {
    load::load_toml_str(text, "features", Path::new(".")).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn by_reference(text: &str, estimator: Estimator, seed: u32) -> Way {
    let mut scene = load(text);
    (scene.render.estimator, scene.render.seed) = (estimator, seed);
    let mut renderer = ReferenceRenderer::new(&scene).expect("it is supported");
    Way { name: format!("{estimator:?} on the CPU"), found: means(&mut renderer, &scene) }
}

/// None without a device.
fn by_device(text: &str, estimator: Estimator, seed: u32, fault: Option<Fault>) -> Option<Way> {
    let device = DEVICE.as_ref()?;
    let mut scene = load(text);
    (scene.render.estimator, scene.render.seed) = (estimator, seed);
    let options = PlanOptions { fault, ..PlanOptions::default() };
    let mut renderer = GpuRenderer::on(device, &scene, &options).expect("the scene fits");
    Some(Way { name: format!("{estimator:?} on the device"), found: means(&mut renderer, &scene) })
}

/// Every estimator on every device, by numbers of its own from `first_seed` on.
fn all_ways(text: &str, first_seed: u32) -> Vec<Way> {
    let numbered = (first_seed + 1..).zip([Estimator::Bsdf, Estimator::Nee, Estimator::Mis, Estimator::Choose]);
    let both = |(seed, estimator)| [Some(by_reference(text, estimator, seed)), by_device(text, estimator, seed + 10, None)];
    numbered.flat_map(both).flatten().collect()
}

/// The pair of ways whose means are least likely to be one, and the probability of that; of many pairs, it is as many times as likely.
fn worst_pair(ways: &[Way]) -> (f64, String) {
    let pairs = (0..ways.len()).flat_map(|index| ways[..index].iter().map(move |other| (&ways[index], other)));
    let judged = pairs.map(|(way, other)| (hypothesis::welch_t_test(&way.found, &other.found).p_value, way, other));
    let (p, way, other) = judged.min_by(|a, b| a.0.total_cmp(&b.0)).expect("there are two ways at least");
    let mean = |way: &Way| format!("{}: {:.6} ± {:.6}", way.name, way.found.mean(), way.found.standard_error());
    (p, format!("{}, {}: p = {p:.1e}", mean(way), mean(other)))
}

/// Scenes of one test together reject what is true with this probability.
const LEVEL: f64 = 1e-3;

/// Pairs among eight ways.
const PAIRS: usize = 28;

/// Renders each scene in every way, and returns those whose means differ.
fn disagreements(scenes: &[(String, Features)]) -> Vec<String> {
    let level = sidak(LEVEL, PAIRS * scenes.len());
    let mut found = Vec::new();
    for (name, features) in scenes {
        let (p, pair) = worst_pair(&all_ways(&features.scene(), 0));
        println!("{name}: {pair}");
        if p < level {
            found.push(format!("{name}: {pair}\n{}", features.scene()));
        }
    }
    found
}

#[test]
#[ignore = "slow"]
fn estimators_agree_where_they_once_did_not() {
    let scenes = scenes::remembered().map(|(name, features)| (name.to_owned(), features));
    let found = disagreements(&scenes);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
#[ignore = "slow"]
fn estimators_agree_on_stacks_of_layers() {
    let scenes: Vec<_> = scenes::stacks().map(|(name, features)| (name.to_owned(), features)).collect();
    let found = disagreements(&scenes);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
#[ignore = "slow"]
fn estimators_agree_on_features_at_random() {
    let count = if in_full("estimators on 60 scenes at random instead of 3") { 60 } else { 3 };
    let scenes: Vec<_> = (0..count).map(|number| (format!("scene {number}"), Features::at_random(number))).collect();
    let found = disagreements(&scenes);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Emission that a path finds from a vertex, and light that is sampled there, count where the lamp and the vertex's object are linked.
#[test]
#[ignore = "slow"]
fn estimators_agree_where_lamps_are_linked() {
    let everything = in_full("estimators in 15 scenes of light links instead of 5");
    let taken = |(number, scene): (usize, _)| (everything || number % 3 == 0).then_some(scene);
    let scenes: Vec<_> = scenes::linked().enumerate().filter_map(taken).collect();
    let found = disagreements(&scenes);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// The control: paths alone in the scene without links, as of an estimator that asks no link of what paths find, are noticed beside light samples with them.
#[test]
fn an_estimator_that_forgets_links_is_noticed() {
    for (seed, (name, features)) in (1..).zip(scenes::linked()) {
        let text = features.scene();
        let unlinked = Features { links: scenes::Links { lamp: "", glow: "", ..features.links }, ..features }.scene();
        let ways = [by_reference(&text, Estimator::Nee, seed), by_reference(&unlinked, Estimator::Bsdf, seed + 100)];
        let (p, pair) = worst_pair(&ways);
        assert!(p < sidak(LEVEL, PAIRS), "{name}: {pair}");
    }
}

/// The control: weights of light samples and paths that do not add up to 1, and a floor that reflects a twentieth more for one of the estimators, are
/// noticed.
#[test]
fn estimators_that_differ_are_noticed() {
    let (_, features) = scenes::remembered()[0];
    let text = features.scene();
    let paths_alone = by_reference(&text, Estimator::Bsdf, 1);
    let brighter = by_reference(&text.replace("reflectance = 0.6 }", "reflectance = 0.63 }"), Estimator::Mis, 2);
    let level = sidak(LEVEL, PAIRS * scenes::remembered().len());
    let (p, pair) = worst_pair(&[paths_alone, brighter]);
    assert!(p < level, "{pair}");
    let Some(wrong) = by_device(&text, Estimator::Mis, 3, Some(Fault::Mis)) else { return };
    let (p, pair) = worst_pair(&[by_reference(&text, Estimator::Bsdf, 1), wrong]);
    assert!(p < level, "{pair}");
}
