//! Rectangles and triangles whose points are drawn by solid angle, on both devices.

use gpt::plan::PlanOptions;
use gpt::scene::{Estimator, LightSampling, Scene};

use super::assert_agrees;
use super::lights::{by_wavefront, compare_unequal, load};

/// Rectangles above, beside, behind and through the ground, of one side and of two, textured and turned; one is a rhomboid.
const RECTANGLES: &str = r#"
[[texture]]
name = "checks"
type = "checker"
a = [0.5, 0.2, 0.1]
b = [0.1, 0.2, 0.6]
scale = [5, 3]
[[material]]
name = "panel"
type = "emissive"
radiance = { texture = "checks" }
two_sided = true
[[shape]]
type = "rectangle"
corner = [-3, 3, -3]
edge_u = [6, 0, 0]
edge_v = [0, 0, 6]
material = "both"
[[shape]]
type = "rectangle"
corner = [2.2, -0.3, -1.5]
edge_u = [0.6, 0, 2.4]
edge_v = [-0.3, 2, 0.075]
material = "panel"
[[shape]]
type = "rectangle"
corner = [-2.5, 0.1, -2]
edge_u = [2, 0, 0]
edge_v = [0.9, 2, 0]
material = "both"
"#;

/// Triangles above, beside, behind and through the ground, alone and in meshes, of one side and of two, large and small, textured, and one that is a sliver.
const TRIANGLES: &str = r#"
[[texture]]
name = "checks"
type = "checker"
a = [0.5, 0.2, 0.1]
b = [0.1, 0.2, 0.6]
scale = [5, 3]
[[material]]
name = "panel"
type = "emissive"
radiance = { texture = "checks" }
two_sided = true
[[shape]]
type = "mesh"
positions = [[-3, 3, -3], [3, 3, -3], [3, 2.5, 3], [-3, 3, 3]]
faces = [[0, 1, 2], [0, 2, 3]]
material = "both"
[[shape]]
type = "mesh"
positions = [[2.2, -0.3, -1.5], [2.8, -0.3, 0.9], [1.9, 1.7, -1.4], [2.2, 1, 0.5]]
uvs = [[0, 0], [1, 0], [0, 1], [1, 1]]
faces = [[0, 1, 2], [1, 3, 2]]
material = "panel"
[[shape]]
type = "mesh"
positions = [[-2.5, 0.1, -2], [2.5, 0.1, -2.2], [2.5, 0.1005, -2.2], [-1.5, 1, 1], [-1.4, 1, 1], [-1.5, 1.1, 1.05]]
faces = [[0, 1, 2], [3, 4, 5]]
material = "lamp"
"#;

#[test]
fn triangles_and_rectangles_drawn_by_solid_angle_agree() {
    let shapes = TRIANGLES.find("[[shape]]").expect("there are shapes");
    let mut scene = load(&[RECTANGLES, &TRIANGLES[shapes..]]);
    scene.render.light_sampling = LightSampling::Cone;
    assert_agrees_by_solid_angle("triangles and rectangles", &scene);
    // The control: the reference draws by area.
    let mut by_area = scene.clone();
    by_area.render.light_sampling = LightSampling::Area;
    let Some(verdict) = compare_unequal(&scene, &by_area) else { return };
    assert!(verdict.matching_share() < 0.97, "{verdict:#?}");
}

#[test]
#[ignore = "long: triangles and rectangles alone"]
fn long_triangles_and_rectangles_drawn_by_solid_angle_agree_alone() {
    assert_agrees_by_solid_angle("rectangles", &load(&[RECTANGLES]));
    assert_agrees_by_solid_angle("triangles", &load(&[TRIANGLES]));
}

/// The scene's lamps are drawn by solid angle, by either estimator that draws them and by all stages.
fn assert_agrees_by_solid_angle(what: &str, scene: &Scene) {
    let mut scene = scene.clone();
    scene.render.light_sampling = LightSampling::Cone;
    assert_agrees(&format!("{what}, wavefront"), &scene, &by_wavefront());
    for estimator in [Estimator::Mis, Estimator::Nee] {
        scene.render.estimator = estimator;
        assert_agrees(&format!("{what}, {estimator:?}"), &scene, &PlanOptions::default());
    }
}
