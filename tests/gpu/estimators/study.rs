//! Settings that are there to compare strategies change what is noisy, and no mean; but for those that change the picture.

use super::{LEVEL, Way, all_ways, by_device, by_reference, worst_pair};
use gpt::compare::sidak;
use gpt::scene::Estimator;

/// Dull balls of either cosine-power material on a floor, seen at grazing angles too, under two lamps and a sky.
const SCENE: &str = r#"
render = { spp = 24, max_depth = 5 }
film = { size = [16, 16] }
camera = { position = [0, 0.7, 4], look_at = [0, 0.6, 0], vfov = 35 }
material = [
  { name = "floor", type = "glossy", reflectance = 0.6, exponent = 8 },
  { name = "left", type = "phong", diffuse = [0.4, 0.3, 0.1], specular = 0.4, exponent = 20 },
  { name = "right", type = "glossy", reflectance = [0.3, 0.7, 0.5], exponent = 3 },
  { name = "lamp", type = "emissive", radiance = 5, two_sided = true },
]
shape = [
  { type = "rectangle", corner = [-3, 0, 3], edge_u = [6, 0, 0], edge_v = [0, 0, -6], material = "floor" },
  { type = "sphere", center = [-0.7, 0.6, 0], radius = 0.6, material = "left" },
  { type = "sphere", center = [0.7, 0.6, 0], radius = 0.6, material = "right" },
  { type = "rectangle", corner = [-0.8, 2.2, -0.8], edge_u = [1.6, 0, 0], edge_v = [0, 0, 1.6], material = "lamp" },
]
light = [
  { type = "point", position = [1.5, 1.5, 2], intensity = 1 },
  { type = "environment", radiance = [0.2, 0.25, 0.3] },
]
"#;

fn with(settings: &str) -> String {
    SCENE.replace("max_depth = 5", &format!("max_depth = 5, {settings}"))
}

/// A mean that several settings are to share, found in every way by each of them.
fn ways(settings: &[&str], first_seed: u32) -> Vec<Way> {
    let numbered = (0..).zip(settings);
    let of = |(index, setting): (u32, &&str)| {
        let mut ways = all_ways(&with(setting), first_seed + 100 * index);
        // Paths alone never find the point light, nor are they weighed.
        ways.retain(|way| !way.name.starts_with("Bsdf"));
        ways.iter_mut().for_each(|way| way.name += &format!(", {setting}"));
        ways
    };
    numbered.flat_map(of).collect()
}

#[test]
#[ignore = "slow"]
fn what_is_studied_changes_no_mean() {
    let flipped = "phong_horizon = \"flipped\"";
    for (number, settings) in [
        vec![
            "heuristic = \"maximum\"",
            "heuristic = \"cutoff\"",
            "heuristic_exponent = 0.7",
            "phong_sampling = \"hemisphere\"",
            "sampler = \"hammersley\"",
            "sampler = \"lcg\"",
        ],
        vec![flipped, &format!("{flipped}, phong_sampling = \"hemisphere\", hemisphere = \"uniform\"")],
        vec!["phong_cosine = \"dropped\"", "phong_cosine = \"dropped\", phong_sampling = \"hemisphere\""],
    ]
    .into_iter()
    .enumerate()
    {
        let ways = ways(&settings, 1000 * number as u32);
        let (p, pair) = worst_pair(&ways);
        println!("{pair}");
        assert!(p >= sidak(LEVEL, ways.len() * (ways.len() - 1) / 2), "{pair}");
    }
}

/// The control: what is flipped, and what has lost its cosine, is another picture.
#[test]
fn what_changes_the_picture_is_noticed() {
    for (seed, change) in (10..).zip(["phong_horizon = \"flipped\"", "phong_cosine = \"dropped\""]) {
        let plain = by_reference(SCENE, Estimator::Mis, seed);
        let changed = by_device(&with(change), Estimator::Mis, seed + 20, None)
            .unwrap_or_else(|| by_reference(&with(change), Estimator::Mis, seed + 20));
        let (p, pair) = worst_pair(&[plain, changed]);
        assert!(p < LEVEL / 100.0, "{change}: {pair}");
    }
}
