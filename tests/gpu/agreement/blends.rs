//! Every blend, each of its weights, and volumes: the device's paths against the reference's.

use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::scene::{BlendMode, BlendWeight, Estimator, MaterialKind, Scene};

use super::materials::{grid, of_cell, stage};
use super::test_grid::TestGrid;
use super::{DEVICE, assert_agrees, compare};
use crate::common::effort::in_full;

fn blend(first: &str, second: &str, weight: &str) -> String {
    format!("type = \"blend\"\nmaterials = [\"{first}\", \"{second}\"]\nweight = {weight}")
}

const BLEND_WEIGHTS: &[(&str, &str)] = &[
    ("constant", "{ type = \"constant\", value = 0.3 }"),
    ("facing", "{ type = \"facing\", power = 0.4 }"),
    ("schlick", "{ type = \"fresnel\", ior = 1.6 }"),
    ("exact fresnel", "{ type = \"fresnel\", ior = 1.6, exact = true }"),
    ("up", "{ type = \"up\", axis = [0.3, 1, 0.2], power = 1.5 }"),
    ("texture", "{ type = \"texture\", texture = \"clouds\" }"),
    ("reverse", "{ type = \"reverse\", of = { type = \"facing\", power = 2 } }"),
    ("threshold", "{ type = \"threshold\", tau = 0.6, of = { type = \"facing\" } }"),
    (
        "threshold of reverse, reversed",
        "{ type = \"reverse\", of = { type = \"threshold\", tau = 0.4, of = { type = \"reverse\", of = { type = \"facing\" } } } }",
    ),
    (
        "threshold of threshold",
        "{ type = \"threshold\", tau = 0.5, of = { type = \"reverse\", of = { type = \"threshold\", tau = 0.6, of = { type = \"facing\" } } } }",
    ),
];

/// Pairs of every kind, nested blends, emission inside and beside blends, and what lets rays pass.
fn blends() -> Vec<(String, String)> {
    let inner = |name: &str, body: &str| format!("\n[[material]]\nname = \"{name}\"\n{body}\n");
    let half = "{ type = \"constant\", value = 0.5 }";
    let facing = "{ type = \"facing\", power = 0.7 }";
    let nested = blend("b", "c", facing)
        + &inner("b", &blend("white", "gold", "{ type = \"texture\", texture = \"cells\" }"))
        + &inner("c", &(blend("mirror", "d", half) + "\nemission = [0.3, 0.1, 0.2]"))
        + &inner("d", &blend("red", "glow", "{ type = \"threshold\", tau = 0.5, of = { type = \"facing\" } }"));
    let glass = "type = \"rough_glass\"\nroughness = 0.5";
    let blends = [
        ("smooth and smooth", blend("red", "gold", facing)),
        ("smooth and delta", blend("gold", "mirror", half)),
        ("transmission", blend("red", "g", facing) + &inner("g", glass)),
        ("nested", nested),
        ("emission", blend("glow", "white", facing)),
        ("emission from both sides", blend("glow-both", "mirror", "{ type = \"texture\", texture = \"checks\" }")),
        ("textured emission", "type = \"emissive\"\nradiance = { texture = \"cells\" }".to_owned()),
        ("emission beside", blend("red", "white", half) + "\nemission = { texture = \"cells\" }\nemission_two_sided = true"),
        (
            "black from behind",
            blend("front", "mirror", half)
                + &inner("front", "type = \"plastic\"\nreflectance = [0.7, 0.3, 0.1]\ntwo_sided = false"),
        ),
        ("black from behind as a whole", blend("red", "gold", facing) + "\ntwo_sided = false"),
        (
            "plastic and principled",
            blend("p", "q", facing)
                + &inner("p", "type = \"plastic\"\nreflectance = 0.6")
                + &inner("q", "type = \"principled\"\nroughness = 0.5\nmetallic = 0.5"),
        ),
        ("volume in a blend", blend("red", "v", facing) + &inner("v", AMBER)),
        ("volume with holes", blend("v", "gone", half) + &inner("v", AMBER)),
        ("pass", blend("red", "gone", half)),
        (
            "pass through a mask",
            blend("gone", "gold", "{ type = \"threshold\", tau = 0.5, of = { type = \"texture\", texture = \"clouds\" } }"),
        ),
    ];
    blends.map(|(name, material)| (name.to_owned(), material)).into()
}

/// Every weight and every kind of blend, on one grid.
fn grid_of_blends() -> (Vec<(String, String)>, TestGrid) {
    let weights = BLEND_WEIGHTS.iter().map(|(name, weight)| ((*name).to_owned(), blend("red", "mirror", weight)));
    let materials: Vec<_> = weights.chain(blends()).collect();
    let grid = grid(6, &materials);
    (materials, grid)
}

fn ways() -> [PlanOptions; 2] {
    let wavefront = PlanOptions { traversal: TraversalChoice::Bvh, stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
    [PlanOptions::default(), wavefront]
}

#[test]
fn every_blend_agrees_for_both_ways_to_blend() {
    let (_, grid) = grid_of_blends();
    for (index, mode, estimator) in
        [(0, BlendMode::Mixture, Estimator::Mis), (1, BlendMode::Pick, Estimator::Nee), (0, BlendMode::Mixture, Estimator::Bsdf)]
    {
        grid.assert_agrees(&format!("blends, {mode:?}, {estimator:?}"), &ways()[index], |scene| {
            (scene.render.blend, scene.render.estimator) = (mode, estimator);
        });
    }
}

#[test]
#[ignore = "long: each weight and each kind of blend alone"]
fn long_every_weight_and_kind_of_blend_agrees_alone() {
    for (name, weight) in BLEND_WEIGHTS {
        for mode in [BlendMode::Mixture, BlendMode::Pick] {
            let mut scene = stage(&blend("red", "mirror", weight));
            scene.render.blend = mode;
            assert_agrees(&format!("{name}, {mode:?}"), &scene, &PlanOptions::default());
        }
    }
    for (index, (name, material)) in blends().iter().enumerate() {
        for (mode, way) in [(BlendMode::Mixture, &ways()[index % 2]), (BlendMode::Pick, &ways()[(index + 1) % 2])] {
            let mut scene = stage(material);
            scene.render.blend = mode;
            scene.render.estimator = [Estimator::Mis, Estimator::Nee, Estimator::Bsdf][index % 3];
            assert_agrees(&format!("{name}, {mode:?}"), &scene, way);
        }
    }
}

/// The control of the grid: of one blend, the weight is off by a hundredth.
#[test]
fn another_blend_on_the_wall_is_noticed() {
    let (materials, grid) = grid_of_blends();
    let off = |scene: &mut Scene| {
        let blend = of_cell(scene, &materials, "constant");
        let MaterialKind::Blend { weight: BlendWeight::Constant { value }, .. } = &mut scene.materials[blend].kind else {
            panic!("it has a constant weight")
        };
        *value += 0.01;
    };
    grid.assert_notices(&[("a weight off by a hundredth", &off)]);
}

const AMBER: &str = "type = \"principled\"\nmetallic = 0\nroughness = 0.5\ntransmission = 1\nattenuation_color = [0.9, 0.5, 0.1]\nattenuation_distance = 0.6";

/// Light and what it shines on, both within a volume.
#[test]
fn a_light_within_a_volume_agrees() {
    let within = |material: &str| {
        stage(&format!(
            "{material}\n[[shape]]\ntype = \"box\"\nmin = [-1.8, -0.9, 0.8]\nmax = [1.8, 0.5, 1.9]\nmaterial = \"m\"\n\
             [[shape]]\ntype = \"sphere\"\ncenter = [-0.9, -0.2, 1.3]\nradius = 0.3\nmaterial = \"glow\"\n\
             [[shape]]\ntype = \"sphere\"\ncenter = [0.8, -0.3, 1.3]\nradius = 0.4\nmaterial = \"white\""
        ))
    };
    let wavefront = PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
    for (name, options) in [("amber", &PlanOptions::default()), ("amber, wavefront", &wavefront)] {
        assert_agrees(name, &within(AMBER), options);
    }
    // A volume a hundredth thicker is noticed.
    let (scene, off) = (within(AMBER), within(&AMBER.replace("distance = 0.6", "distance = 0.594")));
    let Some(device) = DEVICE.as_ref() else { return };
    let mut gpu = gpt::gpu::GpuRenderer::on(device, &off, &PlanOptions::default()).expect("the scene fits");
    let mut cpu = gpt::cpu::ReferenceRenderer::new(&scene).expect("the scene is supported");
    let verdict = gpt::verify::compare(&scene, &mut gpu, &mut cpu, None).expect("both render");
    assert!(!verdict.agrees, "{verdict:#?}");
}

/// Passing through a surface is no edge: what lies behind is seen even by paths of one edge.
#[test]
fn passing_does_not_use_up_the_depth() {
    let everywhere = in_full("both depths by either way to run");
    for (index, depth) in [1, 2].into_iter().enumerate() {
        let mut scene = stage(&blend("red", "gone", "{ type = \"constant\", value = 0.5 }"));
        scene.render.max_depth = depth;
        for (_, way) in ways().iter().enumerate().filter(|(other, _)| everywhere || *other == index) {
            assert_agrees(&format!("depth {depth}, {:?}", way.stages), &scene, way);
        }
    }
}

/// The comparison notices a weight that is off by 1 %.
#[test]
fn a_weight_off_by_a_hundredth_is_noticed() {
    let scene = stage(&blend("white", "mirror", "{ type = \"constant\", value = 0.5 }"));
    let off = stage(&blend("white", "mirror", "{ type = \"constant\", value = 0.51 }"));
    let Some(device) = DEVICE.as_ref() else { return };
    let mut gpu = gpt::gpu::GpuRenderer::on(device, &off, &PlanOptions::default()).expect("the scene fits");
    let mut cpu = gpt::cpu::ReferenceRenderer::new(&scene).expect("the scene is supported");
    let verdict = gpt::verify::compare(&scene, &mut gpu, &mut cpu, None).expect("both render");
    assert!(!verdict.agrees, "{verdict:#?}");
    assert!(compare(&scene, &PlanOptions::default()).is_some_and(|verdict| verdict.agrees));
}

/// Dust on what looks up and is open, halfway through its keyframes: both devices bake the same openness. A distance shorter by a tenth is noticed.
#[test]
fn dust_settles_alike() {
    let Some(device) = DEVICE.as_ref() else { return };
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/figures/dust.toml");
    let still = gpt::load::load(Some(path)).expect("the scene loads");
    let mut scene = still.at_frame(24.0).expect("it has such a frame");
    gpt::verify::shrink(&mut scene, 32);
    scene.render.spp = 4;
    assert_agrees("dust", &scene, &PlanOptions::default());
    let mut off = scene.clone();
    for material in &mut off.materials {
        if let MaterialKind::Blend { weight: BlendWeight::Open { distance, .. }, .. } = &mut material.kind {
            *distance *= 0.9;
        }
    }
    let mut gpu = gpt::gpu::GpuRenderer::on(device, &off, &PlanOptions::default()).expect("the scene fits");
    let mut cpu = gpt::cpu::ReferenceRenderer::new(&scene).expect("the scene is supported");
    let verdict = gpt::verify::compare(&scene, &mut gpu, &mut cpu, None).expect("both render");
    assert!(!verdict.agrees, "{verdict:#?}");
}
