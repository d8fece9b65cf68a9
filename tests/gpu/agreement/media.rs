//! Media that scatter, path by path.

use super::assert_agrees;
use gpt::load::load_toml_str;
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::scene::{DistanceSampling, Estimator, Scene};
use std::path::Path;

const CAMERA: &str = "version = 1\nfilm = { size = [40, 40] }\nrender = { spp = 8, max_depth = 8 }\n";

/// The camera within fog, among lights of all kinds.
const FOG: &str = r#"
[camera]
position = [0, 1, 4]
look_at = [0, 1, 0]
vfov = 45
medium = "fog"
[[medium]]
name = "fog"
absorption = 0.02
scattering = [0.1, 0.15, 0.2]
emission = [0.01, 0.005, 0]
phase = { type = "henyey_greenstein", g = 0.3 }
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.6
[[material]]
name = "glowing"
type = "emissive"
radiance = 3
[[shape]]
type = "box"
min = [-3, -1, -3]
max = [3, 0, 3]
material = "grey"
[[shape]]
type = "sphere"
center = [0.8, 0.5, 0]
radius = 0.5
material = "grey"
[[shape]]
type = "sphere"
center = [-1.2, 1.3, 0.5]
radius = 0.2
material = "glowing"
[[shape]]
type = "rectangle"
corner = [0, 2, -1]
edge_u = [1, 0, 0]
edge_v = [0, 0, 1]
material = "glowing"
[[light]]
type = "point"
position = [-0.5, 1.8, 0]
intensity = 2
[[light]]
type = "spot"
position = [1.5, 2.5, 1]
direction = [-1, -2.5, -1]
angle = 20
intensity = 10
"#;

/// Bodies behind null surfaces and behind glass, one within another, under a sky.
const BODIES: &str = r#"
[camera]
position = [0, 1, 4]
look_at = [0, 0.7, 0]
vfov = 45
[[medium]]
name = "smoke"
absorption = [0.1, 0.3, 0.5]
scattering = [1, 1.5, 2]
phase = { type = "blend", phases = [{ type = "rayleigh" }, { type = "henyey_greenstein", g = 0.7 }], weights = [1, 2] }
[[medium]]
name = "ember"
absorption = 2
emission = [3, 1, 0.2]
[[medium]]
name = "milk"
albedo = [0.99, 0.95, 0.9]
mean_free_path = [0.1, 0.2, 0.3]
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.6
[[material]]
name = "edge"
type = "pass"
interior = "smoke"
[[material]]
name = "ember"
type = "pass"
interior = "ember"
[[material]]
name = "milk"
type = "rough_glass"
ior = 1.33
roughness = 0.3
interior = "milk"
[[material]]
name = "lamp"
type = "emissive"
radiance = 8
[[shape]]
type = "box"
min = [-3, -1, -3]
max = [3, 0, 3]
material = "grey"
[[shape]]
type = "sphere"
center = [0.9, 0.51, 0]
radius = 0.5
material = "milk"
[[shape]]
type = "box"
min = [-1.3, 0.1, -0.7]
max = [0.1, 1.5, 0.7]
material = "edge"
[[shape]]
type = "sphere"
center = [-0.6, 0.8, 0]
radius = 0.4
material = "ember"
[[shape]]
type = "mesh"
positions = [[0, 1.6, 0], [1, 1.6, 0], [0.5, 1.6, 0.9], [0.5, 2.4, 0.3]]
faces = [[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 3]]
material = "edge"
[[shape]]
type = "sphere"
center = [0, 2.9, 0.5]
radius = 0.3
material = "lamp"
[[light]]
type = "environment"
radiance = [0.1, 0.15, 0.2]
"#;

/// Clouds and fire as grids say: blended and not, one of them within the other, around them one that has no end.
const CLOUDS: &str = r#"
[camera]
position = [0, 1, 4]
look_at = [0, 0.7, 0]
vfov = 45
medium = "haze"
[[medium]]
name = "haze"
scattering = [0.05, 0.06, 0.08]
density = { resolution = [1, 2, 1], values = [1, 0.8, 0.5, 0.2, 0.2, 0.3], bounds = [[-1, -1, -1], [1, 3, 1]], outside = "border" }
[[medium]]
name = "cloud"
mean_free_path = [0.3, 0.25, 0.2]
phase = { type = "henyey_greenstein", g = 0.6 }
density = { resolution = [5, 4, 3], values = [0.12, 2.89, 0.72, 2.11, 0.77, 2.47, 1.79, 0.88, 0.53, 2.16, 0.21, 0.69, 1.68, 2.56, 1.84, 0.84, 2.75, 0.61, 0.05, 0.81, 1.34, 0.18, 0.53, 1.11, 1.72, 0.39, 1.09, 2.67, 2.94, 1.97, 2.07, 1.75, 0.42, 0.11, 0.05, 2.73, 2.1, 2.89, 0.06, 1.91, 1.45, 2.19, 0.96, 3.0, 0.23, 1.64, 2.21, 2.7, 2.21, 2.11, 2.38, 2.75, 1.06, 2.06, 2.7, 2.61, 1.25, 2.37, 2.59, 1.72], bounds = [[-1.3, 0, -0.6], [0.5, 1.5, 0.6]], transform = [{ rotate = [0, 1, 0], degrees = 20 }] }
albedo_grid = { resolution = [3, 2, 2], values = [0.21, 0.39, 0.85, 0.64, 0.1, 0.99, 0.21, 0.26, 0.77, 0.33, 0.3, 0.07, 0.09, 0.58, 0.24, 0.6, 0.37, 0.45, 0.96, 0.48, 0.57, 0.87, 0.18, 0.15, 0.91, 0.82, 0.25, 0.19, 0.74, 0.94, 0.2, 0.95, 0.88, 0.6, 0.42, 0.1], bounds = [[-1.3, 0, -0.6], [0.5, 1.5, 0.6]], filter = "nearest", outside = "border" }
[[medium]]
name = "fire"
absorption = [0.5, 1, 1.5]
emission = 4
density = { resolution = [2, 2, 2], values = [1, 2, 0, 3, 1, 1, 0.5, 2], bounds = [[0.4, 0.1, -0.5], [1.4, 1.1, 0.5]], filter = "nearest" }
temperature = { resolution = [2, 2, 2], values = [1862, 1256, 1757, 1822, 501, 1899, 2783, 2499], bounds = [[0.4, 0.1, -0.5], [1.4, 1.1, 0.5]] }
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.6
[[material]]
name = "cloud"
type = "pass"
interior = "cloud"
[[material]]
name = "fire"
type = "pass"
interior = "fire"
[[shape]]
type = "box"
min = [-3, -1, -3]
max = [3, 0, 3]
material = "grey"
[[shape]]
type = "sphere"
center = [-0.4, 0.8, 0]
radius = 0.8
material = "cloud"
[[shape]]
type = "sphere"
center = [0.8, 0.7, 0]
radius = 0.6
material = "fire"
[[light]]
type = "point"
position = [1, 2.5, 1.5]
intensity = 8
[[light]]
type = "environment"
radiance = [0.2, 0.25, 0.3]
"#;

fn scene(text: &str) -> Scene {
    load_toml_str(&format!("{CAMERA}{text}"), "media", Path::new("")).expect("a scene")
}

fn ways() -> [(&'static str, PlanOptions); 4] {
    let of = |traversal, stages| PlanOptions { traversal, stages: Some(stages), ..PlanOptions::default() };
    [
        ("fused", of(TraversalChoice::default(), StageMode::Fused)),
        ("wavefront", of(TraversalChoice::default(), StageMode::Wavefront)),
        ("hierarchy, fused", of(TraversalChoice::Bvh, StageMode::Fused)),
        ("hierarchy, wavefront", of(TraversalChoice::Bvh, StageMode::Wavefront)),
    ]
}

#[test]
#[ignore = "slow"]
fn media_agree_in_every_way_to_run() {
    for (name, text) in [("fog", FOG), ("bodies", BODIES), ("clouds", CLOUDS)] {
        for (way, options) in ways() {
            assert_agrees(&format!("{name}, {way}"), &scene(text), &options);
        }
    }
}

#[test]
fn every_way_to_draw_places_agrees() {
    for sampling in [DistanceSampling::Distance, DistanceSampling::Equiangular] {
        for estimator in [Estimator::Nee, Estimator::Bsdf] {
            let mut scene = scene(FOG);
            scene.render.distance_sampling = sampling;
            scene.render.estimator = estimator;
            assert_agrees(&format!("{sampling:?} {estimator:?}"), &scene, &PlanOptions::default());
        }
    }
}

/// Several light samples at a place, which the wavefront keeps side by side.
#[test]
#[ignore = "slow"]
fn several_light_samples_agree() {
    for (way, options) in ways() {
        let mut scene = scene(BODIES);
        scene.render.light_samples = 3.into();
        assert_agrees(&format!("three light samples, {way}"), &scene, &options);
    }
}
