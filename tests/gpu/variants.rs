//! Ways to run that only rearrange the work: every one gives the same picture, bit for bit.

use std::path::Path;

use crate::common::device::{DEVICE, with_limits};
use crate::common::effort::in_full;
use crate::common::pixel_bits::pixel_bits;
use crate::common::translucent_surfaces::translucent_surfaces;
use gpt::gpu::{Device, GpuRenderer};
use gpt::load;
use gpt::plan::{Chunks, FilmStorage, PlanOptions, StageMode, TraversalChoice};
use gpt::renderer::{Batch, RenderRequest, Renderer, Silent};
use gpt::scene::Scene;

/// Spheres, a mesh and an environment, of a size that no number of lanes divides.
fn scene(spp: u32) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/knot-plastic.toml");
    let mut scene = load::load(Some(&path.display().to_string())).expect("a shipped scene");
    scene.film.size = [37, 29];
    scene.render.spp = spp;
    scene
}

/// Means of all pixels as bits, after several passes.
fn picture(device: Option<&Device>, scene: &Scene, options: &PlanOptions) -> Option<Vec<[u32; 3]>> {
    Some(pixel_bits(device?, scene, options, 3..3 + scene.render.spp).0)
}

/// The device as one that loads lane by lane, and as one whose subgroups have no fixed size, so that every lane traces on its own.
fn together_and_alone() -> [Option<Device>; 2] {
    [with_limits(|limits| limits.gathers = false), with_limits(|limits| limits.subgroup_size = None)]
}

/// A device one of whose bindings holds less than the knot's primitives.
fn in_chunks() -> Option<Device> {
    with_limits(|limits| limits.max_array = 1 << 18)
}

fn film_in_buffers() -> Option<Device> {
    with_limits(|limits| limits.read_write_rgba32float = false)
}

fn in_hierarchy() -> PlanOptions {
    PlanOptions { traversal: TraversalChoice::Bvh, ..PlanOptions::default() }
}

/// A packet's rays meet what each of them would meet alone: the nearest hit is the nearest, whoever else is on the way. Lanes without a
/// ray are among them at every path's end, and where a subgroup has more lanes than the pass samples.
#[test]
#[ignore = "slow"]
fn rays_in_packets_meet_what_they_meet_alone() {
    let [together, alone] = together_and_alone();
    let (in_chunks, film_in_buffers) = (in_chunks(), film_in_buffers());
    let mut moving = load::load(Some("motion-blur")).expect("it is built in");
    moving.film.size = [32, 24];
    let mut spheres = load::load(Some("spheres")).expect("it is built in");
    spheres.film.size = [48, 27];
    let everywhere = in_full("packets with eight numbers of samples more, and of the built-in spheres");
    let spheres = everywhere.then_some(("spheres", spheres));
    for (name, mut scene) in [("knot", scene(0)), ("moving", moving)].into_iter().chain(spheres) {
        let numbers: &[u32] = match name {
            "knot" if everywhere => &[1, 4, 5, 8, 21, 40],
            "knot" => &[1, 5, 8, 21],
            _ if everywhere => &[3, 8, 19],
            _ => &[3, 19],
        };
        for &spp in numbers {
            scene.render.spp = spp;
            let Some(expected) = picture(alone.as_ref(), &scene, &in_hierarchy()) else { return };
            let same = |device: &Option<Device>| picture(device.as_ref(), &scene, &in_hierarchy()).as_ref() == Some(&expected);
            assert!(same(&together), "{name}, {spp} samples");
            // From arrays in several chunks as well, where they are large enough to cut.
            assert!(same(&in_chunks), "{name}, {spp} samples, chunks");
            assert!(same(&film_in_buffers), "{name}, {spp} samples, film in buffers");
            // The comparison sees other samples.
            scene.render.seed += 1;
            assert!(picture(together.as_ref(), &scene, &in_hierarchy()).as_ref() != Some(&expected));
        }
    }
}

/// Otherwise the test above would compare a way with itself.
#[test]
fn packets_are_used_where_they_can_be() {
    let [Some(together), Some(alone)] = together_and_alone() else { return };
    let plan = |device: &Device| GpuRenderer::on(device, &scene(1), &in_hierarchy()).expect("the scene fits").plan().clone();
    let possible = together.limits.subgroup_size.filter(|size| together.limits.software && *size >= 4);
    assert_eq!([plan(&together).lanes, plan(&alone).lanes], [possible, None]);
    let [in_chunks, film_in_buffers] =
        [in_chunks(), film_in_buffers()].map(|device| plan(&device.expect("it is the same device")));
    assert!(!in_chunks.chunks.iter().all(Chunks::is_whole), "{in_chunks}");
    assert_eq!(film_in_buffers.film, FilmStorage::Buffer);
}

/// Which place a path or a shadow ray has in a queue is nothing that its samples know of. Queues end within a subgroup at most edges, and
/// lanes of one leave the scene, die and miss lights at different vertices.
#[test]
#[ignore = "slow"]
fn places_taken_by_a_subgroup_at_once_change_nothing() {
    let wavefront = PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
    let alone = with_limits(|limits| limits.subgroups = false);
    let small_passes = with_limits(|limits| limits.path_capacity = 1001);
    let mut cornell = load::load(Some("cornell")).expect("it is built in");
    cornell.film.size = [41, 31];
    let mut spheres = load::load(Some("spheres")).expect("it is built in");
    spheres.film.size = [48, 27];
    let everywhere = in_full("queues of a knot and of the built-in spheres");
    let others = [("knot", scene(0)), ("spheres", spheres)].into_iter().filter(|_| everywhere);
    for (name, mut scene) in [("cornell", cornell)].into_iter().chain(others) {
        for spp in [1, 5, 24] {
            scene.render.spp = spp;
            let Some(expected) = picture(alone.as_ref(), &scene, &wavefront) else { return };
            assert!(picture(DEVICE.as_ref(), &scene, &wavefront).as_ref() == Some(&expected), "{name}, {spp} samples");
            // In passes whose last subgroup is never full.
            let small = picture(small_passes.as_ref(), &scene, &wavefront);
            assert!(small.as_ref() == Some(&expected), "{name}, {spp} samples, small passes");
            // The comparison sees other samples.
            scene.render.seed += 1;
            assert!(picture(DEVICE.as_ref(), &scene, &wavefront).as_ref() != Some(&expected));
        }
    }
}

/// Otherwise the test above would compare a way with itself.
#[test]
fn subgroups_take_places_where_they_can() {
    let (Some(device), Some(without)) = (DEVICE.as_ref(), with_limits(|limits| limits.subgroups = false)) else { return };
    let of = |device: &Device, stages| {
        let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
        GpuRenderer::on(device, &scene(1), &options).expect("the scene fits").plan().subgroup_queues
    };
    let wavefront = [device, &without].map(|device| of(device, StageMode::Wavefront));
    assert_eq!(wavefront, [device.limits.subgroups, false]);
    assert!(!of(device, StageMode::Fused), "there are no queues where one kernel traces whole paths");
}

/// Means as bits of the pixels that a seventh of them are, picked over the whole film, and how many rays that took. The plan did what the
/// options ask for.
fn selected_pixels(device: &Device, scene: &Scene, stages: StageMode, traversal: TraversalChoice) -> (Vec<[u32; 3]>, u64) {
    let options = PlanOptions { stages: Some(stages), traversal, pixel_list: true, ..PlanOptions::default() };
    let mut renderer = GpuRenderer::on(device, scene, &options).expect("the scene fits");
    assert_eq!((renderer.plan().stages, renderer.plan().light_samples), (stages, scene.render.light_samples_at(1)));
    let [width, height] = scene.film.size;
    let selection: Vec<bool> = (0..width * height).map(|pixel| gpt::sampling::hash::mix(pixel).is_multiple_of(7)).collect();
    let request = RenderRequest { rows: 0..height, samples: 2..2 + scene.render.spp };
    let mut pixels = Vec::new();
    let mut on_band = |band: gpt::film::Band| {
        pixels.extend(band.mean.iter().map(|pixel| pixel.map(f32::to_bits)));
        Ok(())
    };
    let batch = Batch { selection: Some(&selection), ..Batch::of(&request) };
    let rays = renderer.render_batch(&batch, &Silent, &mut on_band).expect("it renders").rays;
    (pixels, rays)
}

/// The wavefront has all shadow rays of a path in one place of a queue, and one invocation adds them up in the order of the samples, as the
/// kernel does that traces whole paths. So pictures are the same, bit for bit, and from run to run, with translucent surfaces that rays pass through, with
/// shapes that move, and where pixels are listed.
#[test]
#[ignore = "slow"]
fn several_light_samples_are_the_same_in_every_kernel() {
    let mut moving = load::load(Some("motion-blur")).expect("it is built in");
    moving.film.size = [32, 24];
    let mut cornell = load::load(Some("cornell")).expect("it is built in");
    cornell.film.size = [41, 31];
    let queues_alone = with_limits(|limits| limits.subgroups = false);
    let small_passes = with_limits(|limits| limits.path_capacity = 1001);
    let cases = [
        ("knot", scene(5), TraversalChoice::default(), 5, 2),
        ("cornell", cornell.clone(), TraversalChoice::default(), 1, 1),
        ("cornell", cornell, TraversalChoice::default(), 16, 3),
        ("moving", moving, TraversalChoice::default(), 3, 3),
        ("translucent surfaces", translucent_surfaces(), TraversalChoice::default(), 4, 1),
        ("translucent surfaces in a hierarchy", translucent_surfaces(), TraversalChoice::Bvh, 2, 2),
    ];
    let everywhere = in_full(
        "light samples of a knot, of the Cornell box, of moving shapes and of translucent surfaces as constants in every kernel",
    );
    for (name, mut scene, traversal, count, depth) in
        cases.into_iter().filter(|(name, ..)| everywhere || *name == "translucent surfaces in a hierarchy")
    {
        (scene.render.light_samples, scene.render.light_samples_depth, scene.render.spp) = (count.into(), depth, 5);
        let what = format!("{name}, {count} light samples at {depth} surfaces");
        let way = |stages| PlanOptions { stages: Some(stages), traversal, ..PlanOptions::default() };
        let of = |device: &Option<Device>, stages| picture(device.as_ref(), &scene, &way(stages));
        let (Some(expected), Some(device)) = (of(&DEVICE, StageMode::Fused), DEVICE.as_ref()) else { return };
        for (run, limited) in [&*DEVICE, &*DEVICE, &queues_alone, &small_passes].into_iter().enumerate() {
            assert!(of(limited, StageMode::Wavefront).as_ref() == Some(&expected), "{what}, run {run}");
        }
        let [fused, wavefront] =
            [StageMode::Fused, StageMode::Wavefront].map(|stages| selected_pixels(device, &scene, stages, traversal));
        assert!(fused == wavefront, "{what}, a list of pixels; {} and {} rays", fused.1, wavefront.1);
        // The comparison sees one light sample more or less.
        scene.render.light_samples = if count == 1 { 2 } else { count - 1 }.into();
        assert!(picture(Some(device), &scene, &way(StageMode::Wavefront)).as_ref() != Some(&expected), "{what}");
    }
}
