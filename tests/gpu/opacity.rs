//! Surfaces that are there in part: light goes straight through the rest, and shadow rays find what is behind.

use std::path::Path;

use crate::common::device::DEVICE;
use crate::common::effort::in_full;
use crate::common::picture::render;
use gpt::compare::{Moments, hypothesis};
use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::plan::{Fault, PlanOptions, StageMode, TraversalChoice};
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::{BlendMode, Estimator, SamplerKind, Scene};
use gpt::verify;

fn load(text: &str) -> Scene {
    load::load_toml_str(text, "opacity", Path::new(".")).unwrap_or_else(|error| panic!("{error}"))
}

/// Every way in which kernels trace shadow rays.
fn ways() -> Vec<(&'static str, PlanOptions)> {
    let way = |traversal, stages| PlanOptions { traversal, stages: Some(stages), ..PlanOptions::default() };
    vec![
        ("constants, fused", way(TraversalChoice::Auto, StageMode::Fused)),
        ("constants, wavefront", way(TraversalChoice::Auto, StageMode::Wavefront)),
        ("hierarchy, fused", way(TraversalChoice::Bvh, StageMode::Fused)),
        ("hierarchy, wavefront", way(TraversalChoice::Bvh, StageMode::Wavefront)),
    ]
}

/// A point of a floor below a point light, and translucent surfaces between them; the camera looks from below the translucent surfaces.
const SHEETS: &str = r#"
[film]
size = [2, 2]
[render]
spp = 2
max_depth = 2
[camera]
position = [3, 0.9, 0]
look_at = [0, 0, 0]
vfov = 0.001
[[texture]]
name = "squares"
type = "checker"
a = [0, 0.8, 0]
b = [0, 0.3, 0]
scale = [2, 1]
[[material]]
name = "floor"
type = "diffuse"
reflectance = 0.5
[[material]]
name = "veil"
type = "diffuse"
reflectance = 0.9
opacity = 0.4
[[material]]
name = "squares"
type = "mirror"
opacity = { texture = "squares", channel = "g", factor = 0.5 }
[[material]]
name = "cut"
type = "mirror"
opacity = { texture = "squares", channel = "g", cutoff = 0.5 }
[[material]]
name = "gone"
type = "pass"
[[material]]
name = "half"
type = "blend"
materials = ["veil", "gone"]
weight = { type = "constant", value = 0.5 }
[[shape]]
type = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
material = "floor"
[[light]]
type = "point"
position = [0, 4, 0]
intensity = [1, 2, 4]
"#;

/// A sheet through (0, height, 0), which it meets at the texture coordinates (0.5 ± 0.2, 0.5).
fn sheet(material: &str, height: f64, left: bool) -> String {
    let corner = if left { -1.4 } else { -0.6 };
    format!(
        "[[shape]]\ntype = \"rectangle\"\nmaterial = \"{material}\"\ncorner = [{corner}, {height}, -1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, 2]\n"
    )
}

/// Green of the floor's point.
fn green(pixels: &[[f32; 3]]) -> f64 {
    f64::from(pixels[0][1])
}

/// A point light's light is multiplied by what each surface in between lets through, whatever traces the shadow ray.
#[test]
#[ignore = "slow"]
fn translucent_surfaces_multiply_the_light_of_a_point_light() {
    // ρ/π · I/d²
    let free = 0.5 / std::f64::consts::PI * 2.0 / 16.0;
    let ball = "[[shape]]\ntype = \"sphere\"\ncenter = [0, 3, 0]\nradius = 0.5\nmaterial = \"veil\"\n".to_owned();
    let tube = |from: &str, to: &str| {
        format!("[[shape]]\ntype = \"cylinder\"\nfrom = {from}\nto = {to}\nradius = 0.4\nmaterial = \"veil\"\n")
    };
    let round = ball.clone() + &tube("[-1, 2.6, 0.1]", "[1, 1.4, 0.1]");
    let rows = [
        ("nothing", String::new(), 1.0),
        ("a translucent surface", sheet("veil", 1.0, true), 0.6),
        ("a translucent surface blended with nothing", sheet("half", 1.0, true), 0.8),
        ("two translucent surfaces", sheet("veil", 1.0, true) + &sheet("half", 2.0, false), 0.48),
        ("both sides of a ball", ball.clone(), 0.36),
        ("both walls of a tube", tube("[-1, 3, 0.2]", "[1, 3, 0.2]"), 0.36),
        ("one wall of a tube that the light is in", tube("[-1, 4, 0.2]", "[1, 4, 0.2]"), 0.6),
        ("one wall of a tube through its open end", tube("[0.02, 4.5, 0.2]", "[-0.8, 2, 0.2]"), 0.6),
        ("a tube without a wall in the way", tube("[0, 1, 0.2]", "[0, 2, 0.2]"), 1.0),
        ("a thin square", sheet("squares", 2.0, true), 0.85),
        ("a thick square", sheet("squares", 2.0, false), 0.6),
        ("a hole", sheet("cut", 2.0, true), 1.0),
        ("beside a hole", sheet("cut", 2.0, false), 0.0),
        (
            "all",
            sheet("cut", 1.5, true) + &sheet("squares", 2.0, false) + &sheet("veil", 1.0, true) + &round,
            0.6 * 0.6 * 0.36 * 0.36,
        ),
        ("an opaque sheet behind", sheet("veil", 1.0, true) + &sheet("floor", 2.0, true), 0.0),
    ];
    let everywhere = in_full("each kind of translucent surface by every way to run");
    for (what, shapes, share) in rows {
        let scene = load(&(SHEETS.to_owned() + &shapes));
        let check = |device: &str, found: f64| {
            assert!((found - share * free).abs() < 2e-6 * free, "{what}, {device}: {found} and not {}", share * free);
        };
        check("cpu", green(&render(&mut ReferenceRenderer::new(&scene).expect("it is supported"), &scene)));
        let Some(device) = DEVICE.as_ref() else { continue };
        // In the short form the device renders what has all of them, in every way, and what lets nothing through.
        let count = match what {
            "all" => 4,
            _ if everywhere => 4,
            "an opaque sheet behind" => 1,
            _ => 0,
        };
        for (way, options) in ways().into_iter().take(count) {
            check(way, green(&render(&mut GpuRenderer::on(device, &scene, &options).expect("the scene fits"), &scene)));
        }
    }
}

/// A scene behind a translucent surface is as bright as the opacity says, wherever a map bends the translucent surface's normals.
/// The translucent surface itself is black here, so every path goes through, and carries that share exactly.
#[test]
fn bent_normals_do_not_dim_what_is_behind() {
    let text = |bump: &str, reflectance: f64| {
        format!(
            r#"
film.size = [8, 6]
render = {{ spp = 16, max_depth = 3 }}
camera = {{ position = [0, 1, 4], look_at = [0, 0, -1], vfov = 40 }}
light = [{{ type = "environment", radiance = [1, 2, 4] }}]
texture = [{{ name = "hills", type = "perlin", scale = 7, a = 0, b = 1 }}]
material = [{{ name = "veil", type = "diffuse", reflectance = {reflectance}, opacity = 0.4{bump} }}]
shape = [{{ type = "rectangle", corner = [-30, 0, 30], edge_u = [60, 0, 0], edge_v = [0, 0, -60], material = "veil" }}]
"#
        )
    };
    let bump = ", bump_map = \"hills\", bump_scale = 30, normal_shadowing = true";
    let mirrored = format!("{bump}, normal_mirroring = true");
    for bump in ["", bump, &mirrored] {
        let scene = load(&text(bump, 0.0));
        let check = |device: &str, pixels: &[[f32; 3]]| {
            // The last rows see the translucent surface.
            for [r, g, b] in &pixels[32..] {
                for (value, expected) in [(r, 0.6), (g, 1.2), (b, 2.4)] {
                    assert!(
                        (f64::from(*value) - expected).abs() < 1e-5 * expected,
                        "{device}, {bump}: {value} and not {expected}"
                    );
                }
            }
        };
        check("cpu", &render(&mut ReferenceRenderer::new(&scene).expect("it is supported"), &scene));
        let Some(device) = DEVICE.as_ref() else { continue };
        check("gpu", &render(&mut GpuRenderer::on(device, &scene, &PlanOptions::default()).expect("the scene fits"), &scene));
    }
    // The control: what the rest reflects is dimmed where its normals are bent.
    let mean = |bump: &str| {
        let scene = load(&text(bump, 0.9));
        let pixels = render(&mut ReferenceRenderer::new(&scene).expect("it is supported"), &scene);
        pixels[32..].iter().map(|pixel| f64::from(pixel[1])).sum::<f64>()
    };
    assert!(mean(bump) < 0.99 * mean(&bump.replace("true", "false")), "{} {}", mean(bump), mean(&bump.replace("true", "false")));
}

/// Translucent surfaces of every kind before an area light, a round one, a map of the sky, and glossy and diffuse surfaces that see them.
const ROOM: &str = r#"
[film]
size = [32, 24]
[render]
spp = 16
max_depth = 4
[camera]
position = [0.2, 1.6, 5]
look_at = [0, 0.9, 0]
vfov = 45
[[texture]]
name = "leaves"
type = "worley"
scale = 5
a = 0
b = 1
[[texture]]
name = "squares"
type = "checker"
a = [1, 0.2, 0]
b = [0, 0.9, 0.5]
scale = [6, 4]
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.7
[[material]]
name = "shiny"
type = "conductor"
preset = "silver"
roughness = 0.4
[[material]]
name = "lamp"
type = "emissive"
radiance = [6, 5, 4]
[[material]]
name = "glowing veil"
type = "diffuse"
reflectance = [0.2, 0.6, 0.3]
opacity = 0.35
emission = [0.3, 0.5, 0.2]
emission_two_sided = true
[[material]]
name = "leaves"
type = "diffuse"
reflectance = [0.2, 0.7, 0.2]
opacity = { texture = "leaves", cutoff = 0.45 }
[[material]]
name = "lace"
type = "conductor"
preset = "copper"
roughness = 0.5
opacity = { texture = "squares", channel = "g", factor = 0.7 }
[[material]]
name = "gone"
type = "pass"
[[material]]
name = "film"
type = "blend"
materials = ["shiny", "gone"]
weight = { type = "reverse", of = { type = "fresnel", ior = 1.8 } }
[[shape]]
type = "rectangle"
corner = [-4, 0, 4]
edge_u = [8, 0, 0]
edge_v = [0, 0, -8]
material = "white"
[[shape]]
type = "sphere"
center = [-0.9, 0.6, 0]
radius = 0.6
material = "shiny"
[[shape]]
type = "sphere"
center = [0.9, 0.5, 0.4]
radius = 0.5
material = "film"
[[shape]]
type = "rectangle"
corner = [-1, 3.2, -1]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
material = "lamp"
[[shape]]
type = "sphere"
center = [2.2, 1.4, -1]
radius = 0.35
material = "lamp"
[[shape]]
type = "rectangle"
corner = [-1.8, 2.2, 1.6]
edge_u = [3.6, 0, 0]
edge_v = [0, 0.3, -3.2]
material = "leaves"
[[shape]]
type = "rectangle"
corner = [1.3, 0.2, -1.6]
edge_u = [0.2, 0, 2]
edge_v = [0, 2, 0]
material = "lace"
[[shape]]
type = "rectangle"
corner = [-2.4, 0.1, -1]
edge_u = [0.9, 0, 1.7]
edge_v = [0, 1.6, 0]
material = "glowing veil"
[[light]]
type = "sky"
zenith = [0.2, 0.3, 0.6]
horizon = 0.4
ground = 0.1
"#;

fn verdict(device: &gpt::gpu::Device, on_gpu: &Scene, scene: &Scene, options: &PlanOptions) -> verify::Verdict {
    let mut gpu = GpuRenderer::on(device, on_gpu, options).expect("the scene fits");
    let mut cpu = ReferenceRenderer::new(scene).expect("the scene is supported");
    verify::compare(scene, &mut gpu, &mut cpu, None).expect("both render")
}

#[test]
#[ignore = "slow"]
fn paths_and_shadow_rays_through_translucent_surfaces_agree() {
    let Some(device) = DEVICE.as_ref() else { return };
    let scene = load(ROOM);
    let everywhere = in_full("paths through translucent surfaces by all four ways to run");
    for (way, options) in ways().into_iter().filter(|(_, options)| everywhere || options.traversal == TraversalChoice::Auto) {
        let verdict = verdict(device, &scene, &scene, &options);
        assert!(verdict.agrees, "{way}: {verdict:#?}");
    }
    type Change = fn(&mut Scene);
    let changes: [(&str, Change); 4] = [
        ("nee", |scene| scene.render.estimator = Estimator::Nee),
        ("bsdf", |scene| scene.render.estimator = Estimator::Bsdf),
        ("pick", |scene| scene.render.blend = BlendMode::Pick),
        ("several light samples", |scene| (scene.render.light_samples, scene.render.light_samples_depth) = (3.into(), 2)),
    ];
    let everywhere = in_full("estimators through translucent surfaces by either way to run");
    for (index, (what, change)) in changes.into_iter().enumerate() {
        let mut scene = load(ROOM);
        change(&mut scene);
        for (_, (way, options)) in ways()[2..].iter().enumerate().filter(|(other, _)| everywhere || *other == index % 2) {
            let verdict = verdict(device, &scene, &scene, options);
            assert!(verdict.agrees, "{what}, {way}: {verdict:#?}");
        }
    }
    // A translucent surface that is a little thinner on one of the devices is noticed.
    let thinner = load(&ROOM.replace("opacity = 0.35", "opacity = 0.34"));
    assert!(!verdict(device, &scene, &thinner, &PlanOptions::default()).agrees);
}

/// Mean radiance of pictures whose random numbers are independent.
fn means(device: &gpt::gpu::Device, scene: &Scene, options: &PlanOptions) -> Moments {
    let mut renderer = GpuRenderer::on(device, scene, options).expect("the scene fits");
    let spp = scene.render.spp;
    (0..24)
        .map(|number| {
            let mut sum = 0.0;
            let request = RenderRequest { rows: 0..scene.film.size[1], samples: number * spp..(number + 1) * spp };
            let report = renderer.render(&request, &Silent, &mut |band| {
                sum += band.mean.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>();
                Ok(())
            });
            report.expect("it renders");
            sum / f64::from(scene.film.size[0] * scene.film.size[1])
        })
        .collect()
}

/// Light samples through translucent surfaces, and the weights of both ways of finding a light behind them, leave the mean where paths without light samples
/// have it. Weights that do not add up to 1, and a mean 1 % off, are noticed.
#[test]
#[ignore = "slow"]
fn light_behind_translucent_surfaces_has_the_mean_of_paths_alone() {
    let Some(device) = DEVICE.as_ref() else { return };
    let mut scene = load(ROOM);
    (scene.render.spp, scene.render.sampler) = (64, SamplerKind::Independent);
    let of = |estimator: Estimator, fault: Option<Fault>, seed: u32| {
        let mut scene = scene.clone();
        (scene.render.estimator, scene.render.seed) = (estimator, seed);
        means(device, &scene, &PlanOptions { fault, ..PlanOptions::default() })
    };
    let paths_alone = of(Estimator::Bsdf, None, 1);
    for (number, estimator) in [Estimator::Mis, Estimator::Nee].into_iter().enumerate() {
        let sampled = of(estimator, None, 2 + number as u32);
        let held = hypothesis::welch_t_test(&sampled, &paths_alone);
        println!("{estimator:?}: {sampled:?} and {paths_alone:?}: p = {}", held.p_value);
        assert!(held.p_value > 1e-4, "{estimator:?}: {sampled:?} and {paths_alone:?}: {held:?}");
        let (off, errors) = (0.01 * sampled.mean(), sampled.standard_error().hypot(paths_alone.standard_error()));
        assert!(off > 4.5 * errors, "{off} would go unnoticed beside {errors}");
    }
    let wrong = of(Estimator::Mis, Some(Fault::Mis), 9);
    assert!(hypothesis::welch_t_test(&wrong, &paths_alone).p_value < 1e-4, "{wrong:?} and {paths_alone:?}");
}

/// Opaque scenes pay nothing for opacity: they compile none of it, and an opacity of 1 is none.
#[test]
fn opaque_scenes_compile_none_of_it() {
    use gpt::packed::PackedScene;
    use gpt::plan::{DeviceLimits, Plan};
    let plan = |text: &str| {
        let scene = load(text);
        let packed = PackedScene::new(&scene).expect("it packs");
        Plan::new(&scene, &packed, &DeviceLimits::default(), &PlanOptions::default()).expect("it fits")
    };
    let transparent = plan(&(SHEETS.to_owned() + &sheet("veil", 1.0, true)));
    assert!(transparent.switches.enabled.contains("TRANSPARENT_SHADOWS"));
    // Translucent surfaces that no surface is made of, and one of opacity 1.
    let opaque = plan(&(SHEETS.replace("opacity = 0.4", "opacity = 1") + &sheet("veil", 1.0, true)));
    let without = plan(&(SHEETS.replace("opacity = 0.4", "") + &sheet("veil", 1.0, true)));
    assert!(!opaque.switches.enabled.contains("TRANSPARENT_SHADOWS") && !opaque.switches.enabled.contains("BLENDS"));
    assert_eq!(opaque.switches, without.switches);
}
