//! Every camera's paths are the same on both devices.

use gpt::load;
use gpt::plan::{PlanOptions, StageMode};
use gpt::scene::Scene;

use super::assert_agrees;
use super::strategies::compare_unequal;
use crate::common::effort::in_full;

/// Some shapes around the origin under a bright sky, seen from among them.
fn scene(keys: &str, size: [u32; 2], more: &str) -> Scene {
    let text = format!(
        "[film]\nsize = [{}, {}]\nfilter = {{ type = \"tent\", radius = 1 }}\n[render]\nspp = 8\nmax_depth = 3\nseed = 3\n\
         [camera]\nposition = [0.2, 0.3, 4.5]\nlook_at = [0, 0.2, 0]\nup = [0.1, 1, 0]\n{keys}{more}\
         [[material]]\nname = \"red\"\ntype = \"diffuse\"\nreflectance = [0.7, 0.2, 0.1]\n\
         [[material]]\nname = \"floor\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
         [[shape]]\ntype = \"plane\"\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\nmaterial = \"floor\"\n\
         [[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"red\"\n\
         [[shape]]\ntype = \"box\"\nmin = [2, -1, 5]\nmax = [3, 1, 7]\nmaterial = \"red\"\n\
         [[light]]\ntype = \"sky\"\nzenith = [0.3, 0.5, 1]\nhorizon = [1, 0.9, 0.8]\nground = [0.3, 0.25, 0.2]\n",
        size[0], size[1]
    );
    load::load_toml_str(&text, "test.toml", std::path::Path::new("")).unwrap_or_else(|error| panic!("{error}: {keys}"))
}

#[test]
fn every_camera_agrees() {
    let everywhere = in_full("each camera by either way to run");
    for (index, example) in load::file::CAMERA_EXAMPLES.iter().enumerate() {
        let scene = scene(example.keys, example.size, "");
        for (turn, stages) in [StageMode::Fused, StageMode::Wavefront].into_iter().enumerate() {
            if everywhere || turn == usize::from(index % 4 == 1) {
                assert_agrees(example.name, &scene, &PlanOptions { stages: Some(stages), ..PlanOptions::default() });
            }
        }
    }
}

/// Cameras that turn while the shutter is open.
#[test]
fn every_camera_that_moves_agrees() {
    let turns = "keyframes = [{ frame = 0, look_at = [0, 0.2, 0] }, { frame = 1, look_at = [1.5, 0, 0.5] }]\n";
    let everywhere = in_full("each camera in motion");
    let few = ["omnidirectional stereo", "pair of perspectives", "distorted perspective through a lens", "polynomial fisheye"];
    for example in load::file::CAMERA_EXAMPLES.iter().filter(|example| everywhere || few.contains(&example.name)) {
        let scene = scene(example.keys, example.size, turns).at_frame(0.0).expect("its first frame");
        assert!(!scene.exposure.is_empty());
        assert_agrees(&format!("{}, turning", example.name), &scene, &PlanOptions::default());
    }
}

/// A camera that differs a little is noticed.
#[test]
fn another_model_is_noticed() {
    for (ours, theirs) in [
        ("radial = [-0.2, 0.1]", "radial = [-0.21, 0.1]"),
        ("radial = [-0.2, 0.1]", "radial = [-0.2, 0.1]\ntangential = [0.003, 0]"),
    ] {
        let of = |radial: &str| scene(&format!("projection = \"brown_conrady\"\nfocal = [38, 38]\n{radial}\n"), [40, 30], "");
        let Some(verdict) = compare_unequal(&of(ours), &of(theirs)) else { return };
        assert!(!verdict.agrees && verdict.matching_share() < 0.9, "{verdict:#?}");
    }
}
