//! Ray queries find what a hierarchy of ours finds, and are refused where they cannot.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;

use crate::common::pixel_bits::pixel_bits;
use crate::common::ray_queries::{RAY_QUERY_DEVICE, by_ray_queries};
use gpt::gpu::{Device, GpuRenderer};
use gpt::load;
use gpt::load::load_toml_str;
use gpt::packed::PackedScene;
use gpt::packed::hierarchy::Traversal;
use gpt::plan::limits::RayQueryLimits;
use gpt::plan::{BUILD_HAS_RAY_QUERIES, DeviceLimits, Plan, PlanError, PlanOptions, RayQueryDefault, StageMode, TraversalChoice};
use gpt::renderer::{DeviceChoice, RenderError};
use gpt::scene::Scene;

/// A shipped scene as small as tests want it.
fn small(name: &str, size: [u32; 2], spp: u32) -> Scene {
    let mut scene = load::load(Some(name)).expect("a shipped scene");
    scene.film.size = size;
    scene.render.spp = spp;
    scene
}

/// A mesh with normals under an environment.
fn knot() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/knot-plastic.toml");
    small(&path.display().to_string(), [37, 29], 6)
}

/// Triangles, rectangles, spheres and disks, too many to stay outside of a hierarchy, on a plane, which always does. One lamp is a mesh, so
/// that shadow rays end at triangles.
fn everything() -> Scene {
    let mut text = String::from(
        "[film]\nsize = [48, 36]\n[render]\nspp = 6\nmax_depth = 6\n[camera]\nposition = [0, 1.5, 6]\nlook_at = [0, 0.4, 0]\nvfov = 40\n\
         [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.6\n[[material]]\nname = \"glass\"\ntype = \"glass\"\nior = 1.5\n\
         [[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 4\n[[light]]\ntype = \"sky\"\nzenith = 1\nhorizon = 0.5\nground = 0.2\n\
         [[shape]]\ntype = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"white\"\n\
         [[shape]]\ntype = \"mesh\"\npositions = [[-1, 3, -1], [-1, 3, 1], [1, 3.2, 0]]\nfaces = [[0, 2, 1]]\nmaterial = \"lamp\"\n\
         [[shape]]\ntype = \"mesh\"\npositions = [[-2, 0, -1], [2, 0, -1], [0, 2, -1.3], [0.4, 0.1, 1]]\n\
         faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2]]\nmaterial = \"white\"\n",
    );
    for index in 0..7 {
        let x = 0.6 * f64::from(index) - 1.8;
        let _ = write!(
            text,
            "[[shape]]\ntype = \"sphere\"\ncenter = [{x}, 0.3, 1.2]\nradius = 0.25\nmaterial = \"glass\"\n\
             [[shape]]\ntype = \"disk\"\ncenter = [{x}, 0.7, 0.9]\nnormal = [0.2, 1, 0.3]\nradius = 0.25\nmaterial = \"white\"\n\
             [[shape]]\ntype = \"rectangle\"\ncorner = [{x}, 0, 0.4]\nedge_u = [0.3, 0, 0]\nedge_v = [0, 0.5, {x}]\nmaterial = \"white\"\n"
        );
    }
    load_toml_str(&text, "everything", Path::new("")).expect("the scene is valid")
}

fn by_nodes() -> PlanOptions {
    PlanOptions { traversal: TraversalChoice::Bvh, ..PlanOptions::default() }
}

/// Means of all pixels as bits.
fn picture(device: &Device, scene: &Scene, options: &PlanOptions) -> Vec<[u32; 3]> {
    pixel_bits(device, scene, options, 0..scene.render.spp).0
}

/// The device's hits are tested again by our arithmetic, so they are the same to the last bit. Only where
/// rays meet two primitives at the same distance, or an edge that the device counts to the other triangle, a
/// path may differ: these scenes have next to none.
#[test]
#[ignore = "slow"]
fn they_make_the_picture_of_our_hierarchy() {
    let Some(device) = RAY_QUERY_DEVICE.as_ref() else { return };
    let scenes = [
        ("knot", knot()),
        ("spheres", small("spheres", [48, 27], 8)),
        ("cornell", small("cornell", [32, 32], 6)),
        ("everything", everything()),
    ];
    for (name, mut scene) in scenes {
        for (stages, checked_shaders) in [(StageMode::Fused, false), (StageMode::Wavefront, false), (StageMode::Fused, true)] {
            let asked = PlanOptions { stages: Some(stages), checked_shaders, ..by_ray_queries() };
            let ours = PlanOptions { traversal: TraversalChoice::Bvh, ..asked.clone() };
            let [asked, expected] = [&asked, &ours].map(|options| picture(device, &scene, options));
            let different = |other: &[[u32; 3]]| expected.iter().zip(other).filter(|(a, b)| a != b).count();
            println!("{name}, {stages:?}: {} of {} pixels differ", different(&asked), expected.len());
            assert_eq!(different(&asked), 0, "{name}, {stages:?}");
        }
        // The comparison sees other samples, and a scene without its last shape.
        let original = picture(device, &scene, &by_ray_queries());
        scene.render.seed += 1;
        assert!(picture(device, &scene, &by_ray_queries()) != original, "{name}");
        scene.render.seed -= 1;
        scene.shapes.pop();
        if !scene.shapes.is_empty() {
            assert!(picture(device, &scene, &by_ray_queries()) != original, "{name}");
        }
    }
}

/// Otherwise the test above would compare a way with itself.
#[test]
fn they_are_used_where_they_were_asked_for_and_only_there() {
    let Some(device) = RAY_QUERY_DEVICE.as_ref() else { return };
    let way = |options: &PlanOptions| {
        let renderer = GpuRenderer::on(device, &everything(), options).expect("the scene fits");
        let plan = renderer.plan();
        (plan.traversal_in_use(), plan.switches.enabled.contains("RAY_QUERY"), plan.switches.enabled.contains("BVH"))
    };
    assert_eq!(way(&by_ray_queries()), (Some(Traversal::RayQuery), true, false));
    assert_eq!(way(&by_nodes()), (Some(Traversal::Bvh), false, true));
    assert_eq!(way(&PlanOptions::default()).0, None);
}

/// A device whose ray queries were verified uses them unasked, for the same picture; what they cannot see is found by nodes.
#[test]
fn verified_they_are_used_unasked() {
    let Some(device) = RAY_QUERY_DEVICE.as_ref() else { return };
    let mut verified = device.clone();
    verified.limits.ray_query_default = RayQueryDefault::Verified;
    let options = PlanOptions::default();
    let used = |device: &Device, scene: &Scene| {
        GpuRenderer::on(device, scene, &options).expect("the scene fits").plan().traversal_in_use()
    };
    assert_eq!(used(&verified, &knot()), Some(Traversal::RayQuery));
    assert!(picture(&verified, &knot(), &options) == picture(device, &knot(), &by_nodes()));
    // Found out before the scene is packed, and after.
    assert_eq!(used(&verified, &small("motion-blur", [16, 12], 1)), Some(Traversal::Bvh));
    verified.limits.ray_queries = Some(RayQueryLimits { max_primitives: 100 });
    assert_eq!(used(&verified, &knot()), Some(Traversal::Bvh));
    // The control: nobody verified this one.
    assert_eq!(used(device, &knot()), Some(Traversal::Bvh));
}

/// A shadow ray meets each shape at its nearest point, and must not come back to it.
#[test]
#[ignore = "slow"]
fn shadow_rays_go_on_behind_translucent_surfaces_of_every_shape() {
    let Some(device) = RAY_QUERY_DEVICE.as_ref() else { return };
    let mut scene = small("arbour", [32, 20], 2);
    let expected = picture(device, &scene, &by_nodes());
    assert!(picture(device, &scene, &by_ray_queries()) == expected);
    scene.render.seed += 1;
    assert!(picture(device, &scene, &by_ray_queries()) != expected, "the control: other samples");
}

/// Far from the middle, our distance to a translucent surface and the device's differ by more than the step behind it. A shadow ray must neither meet the translucent surface for
/// ever nor count it twice.
#[test]
fn translucent_surfaces_far_from_the_middle_are_passed_once() {
    if RAY_QUERY_DEVICE.is_none() {
        return;
    }
    let scene = |opacity: f64| {
        let mut text = format!(
            "[film]\nsize = [24, 24]\n[render]\nspp = 4\nmax_depth = 2\n[camera]\nposition = [1001.2, 0.1, 0]\nlook_at = [1000, 0, 0]\nvfov = 50\n\
             [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.6\n[[material]]\nname = \"veil\"\ntype = \"diffuse\"\n\
             reflectance = 0.5\nopacity = {opacity}\n[[light]]\ntype = \"point\"\nposition = [1009, 0.2, 0.1]\nintensity = 80\n\
             [[shape]]\ntype = \"sphere\"\ncenter = [-1000, 0, 0]\nradius = 1\nmaterial = \"white\"\n\
             [[shape]]\ntype = \"rectangle\"\ncorner = [1000, -2, 2]\nedge_u = [0, 0, -4]\nedge_v = [0, 4, 0]\nmaterial = \"white\"\n"
        );
        // Nearly along the rays.
        for index in 0..40 {
            let (height, slope) = (0.045 * f64::from(index) - 0.9, 0.05 - 0.1 * f64::from(index % 4));
            let _ = write!(
                text,
                "[[shape]]\ntype = \"mesh\"\npositions = [[1001.5, {height}, 2], [1001.5, {height}, -2], [1008.5, {}, 0.1]]\n\
                 faces = [[0, 1, 2]]\nmaterial = \"veil\"\n",
                height + 7.0 * slope
            );
        }
        load_toml_str(&text, "translucent surfaces", Path::new("")).expect("the scene is valid")
    };
    // A hang is a lost device.
    let hasty = PlanOptions { device_timeout: Some(Duration::from_secs(60)), ..by_ray_queries() };
    let device = Device::open_for(&DeviceChoice::Gpu, &hasty).expect("it was opened before");
    let mean = |scene: &Scene, options: &PlanOptions| {
        let picture = picture(&device, scene, options);
        picture.iter().map(|pixel| f64::from(f32::from_bits(pixel[0]))).sum::<f64>() / picture.len() as f64
    };
    for opacity in [0.0, 0.05] {
        let [asked, ours] = [by_ray_queries(), by_nodes()].map(|options| mean(&scene(opacity), &options));
        println!("opacity {opacity}: {asked} by ray queries, {ours} by nodes");
        assert!((asked / ours - 1.0).abs() < 1e-3, "opacity {opacity}: {asked} by ray queries, {ours} by nodes");
        // The control: one translucent surface in twenty counted twice would show.
        let thicker = mean(&scene(opacity + 0.0025), &by_ray_queries());
        assert!((thicker / ours - 1.0).abs() > 1e-2, "opacity {opacity}: {thicker}");
    }
    device.leave_if_lost();
}

/// Planes are constants; a structure without anything in it is not built.
#[test]
fn a_scene_with_nothing_to_ask_for_asks_nothing() {
    let text = "[camera]\nposition = [0, 1, 6]\nlook_at = [0, 0, 0]\nvfov = 40\n[[material]]\nname = \"white\"\ntype = \"diffuse\"\n\
                reflectance = 0.6\n[[shape]]\ntype = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"white\"\n\
                [[light]]\ntype = \"environment\"\nradiance = 1\n";
    let scene = load_toml_str(text, "plane", Path::new("")).expect("the scene is valid");
    let plan = plan(&scene, &with_ray_queries(1 << 24)).expect("it fits");
    assert_eq!(plan.traversal_in_use(), None);
}

fn with_ray_queries(max_primitives: u32) -> DeviceLimits {
    DeviceLimits { ray_queries: Some(RayQueryLimits { max_primitives }), ..DeviceLimits::default() }
}

fn packed(scene: &Scene) -> PackedScene {
    PackedScene::for_traversal(scene, Traversal::RayQuery).expect("the scene packs")
}

fn plan(scene: &Scene, limits: &DeviceLimits) -> Result<Plan, PlanError> {
    Plan::new(scene, &packed(scene), limits, &by_ray_queries())
}

/// The message where ray queries are asked for and impossible.
fn refusal(scene: &Scene, limits: &DeviceLimits) -> String {
    match plan(scene, limits) {
        Err(PlanError::DoesNotFit(why)) => why,
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_they_cannot_do_is_refused_with_the_reason() {
    let instead = "; without `--traversal ray-query` it renders all the same";
    let everything = everything();
    assert!(plan(&everything, &with_ray_queries(1 << 24)).is_ok());
    let what = match BUILD_HAS_RAY_QUERIES {
        true => "the device has no ray queries, or its driver does not offer them",
        false => "this gpt is built without ray queries, which `cargo build --release --features ray-query` has",
    };
    assert_eq!(refusal(&everything, &DeviceLimits::default()), format!("{what}{instead}"));
    assert_eq!(
        refusal(&small("motion-blur", [8, 8], 1), &with_ray_queries(1 << 24)),
        format!("its shapes move, and acceleration structures hold a scene at rest{instead}")
    );
    assert_eq!(
        refusal(&everything, &with_ray_queries(11)),
        format!("it has 4 triangles and 21 other shapes, and an acceleration structure holds 3 or 11{instead}")
    );
    let narrow = DeviceLimits { max_buffer: 1 << 20, ..with_ray_queries(1 << 28) };
    assert_eq!(
        refusal(&knot(), &DeviceLimits { max_buffer: 100_000, ..narrow.clone() }),
        "an acceleration structure of its triangles is built from 0.5 MiB at once, and a buffer holds 0.1 MiB".to_owned()
            + instead
    );
    assert!(plan(&knot(), &narrow).is_ok());
}

/// A device that was opened without them has none, whatever its adapter can do.
#[test]
fn a_device_opened_without_them_has_none() {
    if RAY_QUERY_DEVICE.is_none() {
        return;
    }
    let device = Device::open(&DeviceChoice::Gpu).expect("it opened before");
    assert!(!device.device.features().contains(wgpu::Features::EXPERIMENTAL_RAY_QUERY));
    let refused = GpuRenderer::on(&device, &everything(), &by_ray_queries());
    assert!(matches!(refused, Err(RenderError::DoesNotFit(_))));
}

/// Triangles stand before what boxes stand for, each primitive once, and every box holds its shape.
#[test]
fn what_a_structure_is_built_from_is_in_order() {
    use gpt::packed::shape::PrimitiveKind;
    let packed = packed(&everything());
    let boxes = &packed.hierarchy.boxes;
    let held = &packed.primitives[..packed.hierarchy.primitive_count as usize];
    let (triangles, shapes) = held.split_at(held.len() - boxes.len());
    assert_eq!((triangles.len(), shapes.len(), packed.primitives.len()), (4, 21, 26));
    assert!(triangles.iter().all(|primitive| primitive.kind() == PrimitiveKind::Triangle as u32));
    for (shape, bounds) in shapes.iter().zip(boxes) {
        assert!(shape.kind() != PrimitiveKind::Triangle as u32);
        assert!(
            (0..3).all(|axis| bounds.low[axis] < shape.p0[axis] && shape.p0[axis] < bounds.high[axis]),
            "{shape:?} {bounds:?}"
        );
    }
    // Validation sees primitives out of order.
    let mut turned = packed.clone();
    turned.primitives.reverse();
    assert!(turned.validate().is_err());
}
