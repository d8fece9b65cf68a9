//! Kernels with naga's checks of indices and loops make the same pictures, bit for bit, as those without.

use gpt::load;
use gpt::load::load_toml_str;
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::scene::Scene;
use gpt::verify;

use super::random_scenes;
use super::support::{Effort, Finding, render_band};

pub fn findings(effort: Effort) -> Vec<Finding> {
    let names: Vec<&str> = load::builtin_names().collect();
    let few = ["cornell", "motion-blur", "teapot-iridescent"];
    let built_in = names.into_iter().filter(|name| effort == Effort::Full || few.contains(name)).map(|name| {
        let mut scene = load::load(Some(name)).expect("built-in scenes load");
        verify::shrink(&mut scene, 32);
        scene.render.spp = 2;
        (name.to_owned(), scene)
    });
    let random = (1..=effort.pick(2, 20)).map(|seed| {
        let scene = load_toml_str(&random_scenes::text(seed), "random", std::path::Path::new(""));
        (format!("random scene {seed}"), scene.expect("random scenes are valid"))
    });
    built_in.chain(random).flat_map(|(name, scene)| both_ways(effort, &name, &scene)).collect()
}

/// Both modes: the plan's own choice, and the mode of real GPUs.
fn both_ways(effort: Effort, name: &str, scene: &Scene) -> Vec<Finding> {
    let wavefront = PlanOptions { traversal: TraversalChoice::Bvh, stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
    let ways = [("fused", PlanOptions::default()), ("wavefront", wavefront)];
    ways[..effort.pick(1, 2)].iter().filter_map(|(way, options)| same(format!("{name}, {way}"), scene, options)).collect()
}

fn same(case: String, scene: &Scene, options: &PlanOptions) -> Option<Finding> {
    let checked = PlanOptions { checked_shaders: true, ..options.clone() };
    let pictures = [render_band(scene, options)?.0, render_band(scene, &checked)?.0];
    let bits = |index: usize| pictures[index].mean.iter().map(|pixel| pixel.map(f32::to_bits)).collect::<Vec<_>>();
    let (plain, checked) = (bits(0), bits(1));
    let different = plain.iter().zip(&checked).filter(|(a, b)| a != b).count();
    Some(
        Finding::new(case)
            .with("pixels", plain.len())
            .with("pixels that differ", different)
            .require(different == 0, || format!("{different} pixels differ between checked and unchecked shaders")),
    )
}
