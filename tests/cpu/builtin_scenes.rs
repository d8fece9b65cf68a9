//! The built-in scenes use everything that kernels have code for, so that `gpt verify` without a scene sees all of it. No device is needed.

use std::collections::BTreeSet;

use crate::common::light_groups::{in_groups, lit_by};
use crate::common::scenes::{ELSEWHERE, ENOUGH};
use gpt::film::KernelLayer;
use gpt::learn::{Effort, settle};
use gpt::load;
use gpt::packed::PackedScene;
use gpt::packed::hierarchy::Traversal;
use gpt::plan::{DeviceLimits, GeometryPlacement, Plan, PlanOptions, RayQueryLimits, StageMode, TraversalChoice};
use gpt::reference::layer::layer_scene;
use gpt::scene::{
    DistanceSampling, Estimator, Guiding, LayerModel, MaterialKind, Meter, MeterKind, MisHeuristic, PhongCosine, PhongHorizon,
    PhongSampling, PixelSampler, SamplerKind, Scene,
};
use gpt::shader::switches::SWITCHES;

/// Switches that depend on the device or on what a render is asked for, whatever the scene.
const OF_DEVICES: [&str; 31] = [
    "ATTRIBUTE_CHUNKS",
    "CLAMP",
    "FILM_TEXTURE",
    "INSTANCE_CHUNKS",
    "LAYER_ALBEDO",
    "LAYER_DEPTH",
    "LAYER_DIRECT",
    "LAYER_EMISSION",
    "LAYER_INDIRECT",
    "LAYER_MOTION",
    "LAYER_NORMAL",
    "LAYER_OBJECT_POSITION",
    "LAYER_OF_FIRST_SURFACE",
    "LAYER_OF_LIGHT",
    "LAYER_OF_SURFACES",
    "LAYER_POSITION",
    "LAYER_SQUARES",
    "LAYER_UV",
    "NODE_CHUNKS",
    "OBJECT_MAPS",
    "OUTSIDE_UNSEEN",
    "PACKETS",
    "PIXEL_LIST",
    "PRIMITIVE_CHUNKS",
    "RAY_QUERY",
    "SUBGROUP_QUEUES",
    "TAKEN_PIXELS",
    "TEXEL_CHUNKS",
    "UNIFORM_NODES",
    "UNIFORM_PRIMITIVES",
    "UNIFORM_TABLES",
];

/// Switches of settings that no built-in scene has, and of layers by Weidlich and Wilkie's model: `tests/gpu/agreement` has scenes of them, in
/// `media.rs`, `strategies.rs` and `layers.rs`.
const OF_SETTINGS: [&str; 11] = [
    "BY_ANGLE",
    "BY_DISTANCE",
    "ESTIMATOR_CHOOSE",
    "HEURISTIC_CUTOFF",
    "HEURISTIC_EXPONENT",
    "LAYERS_STRAIGHT_THROUGH",
    "LCG",
    "PHONG_BY_HEMISPHERE",
    "PHONG_FLIPPED",
    "PHONG_WITHOUT_COSINE",
    "PIXEL_LCG",
];

/// Switches of cameras whose picture is not flat, or is not one: a scene has one camera.
const OF_CAMERAS: [&str; 13] = [
    "BLIND_PIXELS",
    "BROWN_CONRADY",
    "CAMERA_INWARD",
    "CAMERA_MODEL",
    "CAMERA_TILES",
    "CUBE_MAP",
    "CYLINDRICAL",
    "DEPTH_BY_DISTANCE",
    "EQUIRECTANGULAR",
    "FISHEYE",
    "KANNALA_BRANDT",
    "STEREO",
    "TURNING_EYES",
];

/// A built-in scene with every example of a camera, and as a meter on a sphere sees it.
fn with_cameras() -> Vec<Scene> {
    let text = load::builtin_text("spheres").expect("it is built in");
    let of_example = |example: &load::file::CameraExample| {
        let [width, height] = example.size;
        let size = format!("size = [{width}, {height}]");
        let text = text.replace("size = [640, 360]", &size).replace("vfov     = 32\n", example.keys);
        load::load_toml_str(&text, "spheres.toml", std::path::Path::new("")).expect(example.name)
    };
    let on_sphere = MeterKind::IrradianceOfSphere { center: glam::DVec3::ZERO, radius: 0.5 };
    let meter = Meter { name: "ball".to_owned(), kind: on_sphere, medium: None };
    let measured = load::load(Some("spheres")).expect("it is built in").seen_by(&meter);
    load::file::CAMERA_EXAMPLES.iter().map(of_example).chain([measured]).collect()
}

/// The switches that scenes compile in on a device.
fn compiled_in(scenes: &[Scene], limits: &DeviceLimits, options: &PlanOptions) -> BTreeSet<&'static str> {
    let traversal = if options.asks_for_ray_queries() { Traversal::RayQuery } else { Traversal::Bvh };
    let of_scene = |scene: &Scene| {
        let mut packed = PackedScene::for_traversal(scene, traversal).expect("it packs");
        if scene.render.guiding == Guiding::On {
            let guide = settle(scene, Effort::default()).expect("the reference renders it").guide;
            packed.guide = guide.map_or_else(Vec::new, |guide| guide.words().to_vec());
        }
        // Ray queries do not see what moves.
        Plan::new(scene, &packed, limits, options).map_or_else(|_| BTreeSet::new(), |plan| plan.switches.enabled)
    };
    scenes.iter().flat_map(of_scene).collect()
}

/// A scene with cosine-power lobes, and every setting that is there to compare strategies.
fn studied() -> [Scene; 2] {
    let mut scenes = [(); 2].map(|()| load::load(Some("stage")).expect("it is built in"));
    for scene in &mut scenes {
        scene.render.estimator = Estimator::Choose;
        scene.render.phong_cosine = PhongCosine::Dropped;
        scene.render.phong_sampling = PhongSampling::Hemisphere;
        scene.render.phong_horizon = PhongHorizon::Flipped;
    }
    let [first, second] = &mut scenes;
    (first.render.heuristic, first.render.sampler) = (MisHeuristic::Cutoff, SamplerKind::Congruential);
    second.render.heuristic_exponent = 3.0;
    second.render.pixel_sampler = PixelSampler::Other(SamplerKind::Congruential);
    scenes
}

#[test]
#[ignore = "slow"]
fn built_in_scenes_use_every_switch() {
    let built_in: Vec<Scene> = load::builtin_names().map(|name| load::load(Some(name)).expect("it is built in")).collect();
    let hardware = DeviceLimits::default();
    let in_frames: Vec<Scene> = built_in
        .iter()
        .filter(|scene| !scene.animation.is_empty())
        .map(|scene| scene.at_frame(0.0).expect("its first frame"))
        .collect();
    let mut scenes = compiled_in(&built_in, &hardware, &PlanOptions::default());
    scenes.extend(compiled_in(&in_frames, &hardware, &PlanOptions::default()));
    let every = SWITCHES.iter().filter(|switch| !switch.debug).map(|switch| switch.name);
    let is_elsewhere = |name: &&str| OF_DEVICES.contains(name) || OF_SETTINGS.contains(name) || OF_CAMERAS.contains(name);
    let missing: Vec<_> = every.clone().filter(|name| !scenes.contains(name) && !is_elsewhere(name)).collect();
    assert!(missing.is_empty(), "no built-in scene uses {missing:?}");

    let software =
        DeviceLimits { software: true, threads: 4, subgroup_size: Some(8), read_write_rgba32float: true, ..hardware.clone() };
    let with_subgroups = DeviceLimits { subgroups: true, ..hardware.clone() };
    let with_ray_queries = DeviceLimits { ray_queries: Some(RayQueryLimits { max_primitives: 1 << 24 }), ..hardware.clone() };
    let small_bindings = DeviceLimits { max_array: 64 << 10, max_storage_buffers: 100, ..hardware.clone() };
    let tiny_bindings = DeviceLimits { max_array: 8 << 10, ..small_bindings.clone() };
    let by_query = PlanOptions { traversal: TraversalChoice::RayQuery, ..PlanOptions::default() };
    let of_some_pixels = PlanOptions { pixel_list: true, ..PlanOptions::default() };
    let mut anywhere = scenes;
    anywhere.extend(compiled_in(&with_cameras(), &hardware, &PlanOptions::default()));
    for (limits, options) in [
        (software, PlanOptions::default()),
        (with_subgroups, of_some_pixels),
        (with_ray_queries, by_query),
        (small_bindings, PlanOptions::default()),
        (tiny_bindings, PlanOptions::default()),
    ] {
        anywhere.extend(compiled_in(&built_in, &limits, &options));
    }
    for layer in KernelLayer::ALL {
        let ready = layer_scene(&built_in[0], layer).into_owned();
        anywhere.extend(compiled_in(&[ready], &hardware, &PlanOptions { layer: Some(layer), ..PlanOptions::default() }));
    }
    let mut clamped = built_in[0].clone();
    clamped.render.clamp = 1.0;
    anywhere.extend(compiled_in(&[clamped], &hardware, &PlanOptions::default()));
    // In the light of one of two groups, that from outside is not seen.
    let grouped = in_groups(load::load(Some("terrace")).expect("it is built in"));
    let of_groups = ["odd", "even"].map(|group| lit_by(&grouped, group));
    anywhere.extend(compiled_in(&of_groups, &hardware, &PlanOptions::default()));
    for distance_sampling in [DistanceSampling::Distance, DistanceSampling::Equiangular] {
        let mut mist = load::load(Some("mist")).expect("it is built in");
        mist.render.distance_sampling = distance_sampling;
        anywhere.extend(compiled_in(&[mist], &hardware, &PlanOptions::default()));
    }
    let mut straight = load::load(Some("paints")).expect("it is built in");
    for material in &mut straight.materials {
        if let MaterialKind::Layered(stack) = &mut material.kind {
            stack.model = LayerModel::Straight;
        }
    }
    anywhere.extend(compiled_in(&[straight], &hardware, &PlanOptions::default()));
    anywhere.extend(compiled_in(&studied(), &hardware, &PlanOptions::default()));
    let missing: Vec<_> = every.filter(|name| !anywhere.contains(name)).collect();
    assert!(missing.is_empty(), "no built-in scene uses {missing:?} on any of these devices");
}

/// The scenes that `tests/gpu/agreement` compares in its short form miss no switch of the others, on the
/// devices that it runs on.
#[test]
#[ignore = "slow"]
fn a_few_built_in_scenes_use_every_switch_that_any_uses() {
    let software = DeviceLimits {
        software: true,
        threads: 4,
        subgroup_size: Some(8),
        read_write_rgba32float: true,
        ..DeviceLimits::default()
    };
    let of = |name: &str| {
        let scene = load::load(Some(name)).expect("it is built in");
        compiled_in(&[scene], &software, &PlanOptions::default())
    };
    let all: Vec<(&str, BTreeSet<_>)> = load::builtin_names().map(|name| (name, of(name))).collect();
    let every: BTreeSet<_> = all.iter().flat_map(|(_, switches)| switches).copied().collect();
    let covered_without = |left_out: &str| -> BTreeSet<_> {
        let few = all.iter().filter(|(name, _)| ENOUGH.contains(name) && *name != left_out);
        few.flat_map(|(_, switches)| switches).copied().collect()
    };
    let missing: Vec<_> = every.difference(&covered_without("")).copied().collect();
    assert_eq!(missing, ELSEWHERE, "beside the scenes of the short form");
    // The control: none of them can be left out.
    for name in ENOUGH {
        assert!(every.difference(&covered_without(name)).count() > missing.len(), "{name} adds nothing");
    }
}

/// Software devices trace whole paths, in packets wherever they load lane by lane. One scene makes them go through stages too, as hardware does.
#[test]
fn software_devices_run_the_stages_of_hardware_in_one_scene() {
    let software = DeviceLimits { software: true, subgroup_size: Some(8), ..DeviceLimits::default() };
    for (name, stages) in [("planetarium", StageMode::Wavefront), ("teapot-plastic", StageMode::Fused)] {
        let scene = load::load(Some(name)).expect("it is built in");
        let packed = PackedScene::for_traversal(&scene, Traversal::Bvh).expect("it packs");
        let plan = Plan::new(&scene, &packed, &software, &PlanOptions::default()).expect("it fits");
        assert_eq!((plan.geometry, plan.stages), (GeometryPlacement::Hierarchy, stages), "{name}");
        assert_eq!(plan.lanes.is_none(), stages == StageMode::Wavefront, "{name}");
        let gathering = DeviceLimits { gathers: true, ..software.clone() };
        let plan = Plan::new(&scene, &packed, &gathering, &PlanOptions::default()).expect("it fits");
        assert_eq!((plan.stages, plan.lanes), (stages, None), "{name} where the device gathers");
    }
}

#[test]
fn pictures_that_built_in_scenes_need_are_small() {
    let bytes: u64 = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/textures"))
        .expect("the folder")
        .map(|file| file.and_then(|file| file.metadata()).expect("a file").len())
        .sum();
    assert!(bytes < 20_000, "{bytes} bytes of textures are part of the program");
}
