//! Estimators within media, and the ways to draw places of scattering.

use super::{LEVEL, PAIRS, all_ways, by_device, by_reference, worst_pair};
use gpt::compare::sidak;
use gpt::plan::Fault;
use gpt::scene::Estimator;

/// A lamp above a floor, in fog; a ball of smoke behind a null surface, and within it a ball of coloured smoke; a ball of wax behind rough glass.
const SCENE: &str = r#"
render = { spp = 24, max_depth = 7 }
film = { size = [16, 16] }
camera = { position = [0, 1.2, 4], look_at = [0, 0.7, 0], vfov = 40, medium = "fog" }
medium = [
  { name = "fog", absorption = 0.03, scattering = [0.1, 0.12, 0.2], phase = { type = "henyey_greenstein", g = 0.4 } },
  { name = "smoke", absorption = 0.3, scattering = [1.5, 1, 0.5], phase = { type = "rayleigh" } },
  { name = "ember", absorption = [1, 2, 3], scattering = 0.5, emission = [0.6, 0.3, 0] },
  { name = "wax", albedo = [0.98, 0.9, 0.8], mean_free_path = 0.2 },
]
material = [
  { name = "grey", type = "diffuse", reflectance = 0.6 },
  { name = "smoke", type = "pass", interior = "smoke" },
  { name = "ember", type = "pass", interior = "ember" },
  { name = "wax", type = "rough_glass", ior = 1.3, roughness = 0.6, interior = "wax" },
  { name = "lamp", type = "emissive", radiance = 4, two_sided = true },
]
shape = [
  { type = "box", min = [-3, -0.3, -3], max = [3, 0, 3], material = "grey" },
  { type = "sphere", center = [-0.7, 0.7, 0], radius = 0.6, material = "smoke" },
  { type = "sphere", center = [-0.7, 0.6, 0], radius = 0.3, material = "ember" },
  { type = "sphere", center = [0.8, 0.45, 0], radius = 0.4, material = "wax" },
  { type = "rectangle", corner = [-1, 2.2, -1], edge_u = [2, 0, 0], edge_v = [0, 0, 2], material = "lamp" },
]
"#;

fn with(setting: &str) -> String {
    SCENE.replace("max_depth = 7", &format!("max_depth = 7, distance_sampling = \"{setting}\""))
}

/// Eight ways by each of three ways to draw places.
#[test]
#[ignore = "slow"]
fn estimators_agree_within_media() {
    let ways = ["mis", "distance", "equiangular"].into_iter().enumerate().flat_map(|(index, setting)| {
        let mut ways = all_ways(&with(setting), 100 * index as u32);
        ways.iter_mut().for_each(|way| way.name += &format!(", {setting}"));
        ways
    });
    let ways: Vec<_> = ways.collect();
    let (p, pair) = worst_pair(&ways);
    println!("{pair}");
    assert!(p >= sidak(LEVEL, ways.len() * (ways.len() - 1) / 2), "{pair}");
}

/// The control: wrong weights, and a fog that absorbs twice as much, are noticed.
#[test]
fn estimators_that_differ_within_media_are_noticed() {
    let level = sidak(LEVEL, PAIRS);
    let paths_alone = by_reference(SCENE, Estimator::Bsdf, 1);
    let darker = by_reference(&SCENE.replace("absorption = 0.03", "absorption = 0.06"), Estimator::Mis, 2);
    let (p, pair) = worst_pair(&[paths_alone, darker]);
    assert!(p < level, "{pair}");
    let Some(wrong) = by_device(SCENE, Estimator::Mis, 3, Some(Fault::Mis)) else { return };
    let (p, pair) = worst_pair(&[by_reference(SCENE, Estimator::Bsdf, 1), wrong]);
    assert!(p < level, "{pair}");
}
