//! Ways to run that only rearrange the work: every one gives the same picture, bit for bit.

#[path = "common/device.rs"]
mod device;
#[path = "common/pixel_bits.rs"]
mod pixel_bits;

use std::path::Path;

use device::DEVICE;
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::packed::hierarchy::HierarchyKind;
use gpt::plan::{FilmStorage, GeometryPlacement, PlanOptions, StageMode};
use gpt::scene::Scene;
use pixel_bits::pixel_bits;

/// Spheres, a mesh and an environment, of a size that no number of lanes divides.
fn scene(spp: u32) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/knot-plastic.toml");
    let mut scene = load::load(Some(&path.display().to_string())).expect("a shipped scene");
    scene.film.size = [37, 29];
    scene.render.spp = spp;
    scene
}

/// Means of all pixels as bits, after several passes.
fn picture(scene: &Scene, options: &PlanOptions) -> Option<Vec<[u32; 3]>> {
    Some(pixel_bits(DEVICE.as_ref()?, scene, options, 3..3 + scene.render.spp).0)
}

#[test]
fn lanes_that_share_a_pixel_change_nothing() {
    for spp in [1, 4, 5, 8, 21, 40] {
        let mut scene = scene(spp);
        for (film, geometry) in [(None, GeometryPlacement::Hierarchy), (Some(FilmStorage::Buffer), GeometryPlacement::Hierarchy)]
        {
            let sharing = |share| PlanOptions { share_pixels: Some(share), film, geometry: Some(geometry), ..Default::default() };
            let [alone, together] = [false, true].map(|share| picture(&scene, &sharing(share)));
            let (Some(alone), Some(together)) = (alone, together) else { return };
            assert_eq!(alone.len(), 37 * 29);
            assert!(alone == together, "{spp} samples, film {film:?}");
            // The comparison sees other samples.
            scene.render.seed += 1;
            assert!(picture(&scene, &sharing(true)).as_ref() != Some(&alone));
        }
    }
}

/// Otherwise the test above would compare a way with itself.
#[test]
fn lanes_share_pixels_where_they_are_told_to() {
    let Some(device) = DEVICE.as_ref() else { return };
    let of = |share| {
        let options = PlanOptions { share_pixels: share, ..Default::default() };
        GpuRenderer::on(device, &scene(1), &options).expect("the scene fits").plan().lanes
    };
    let possible = if device.limits.software { device.limits.subgroup_size } else { None };
    assert_eq!([of(None), of(Some(true)), of(Some(false))], [possible, possible, None]);
}

/// A packet's rays meet what each of them would meet alone: the nearest hit is the nearest, whoever else is on the way. Lanes without a
/// ray are among them at every path's end, and where a subgroup has more lanes than the pass samples.
#[test]
fn rays_in_packets_meet_what_they_meet_alone() {
    let mut moving = load::load(Some("motion-blur")).expect("it is built in");
    moving.film.size = [32, 24];
    let mut spheres = load::load(Some("spheres")).expect("it is built in");
    spheres.film.size = [48, 27];
    for (name, mut scene) in [("knot", scene(0)), ("moving", moving), ("spheres", spheres)] {
        for spp in [3, 8, 19] {
            scene.render.spp = spp;
            let way = |packets, largest_chunk| PlanOptions {
                geometry: Some(GeometryPlacement::Hierarchy),
                packets: Some(packets),
                largest_chunk,
                ..Default::default()
            };
            let [alone, together] = [false, true].map(|packets| picture(&scene, &way(packets, None)));
            let (Some(alone), Some(together)) = (alone, together) else { return };
            assert!(alone == together, "{name}, {spp} samples");
            // From arrays in several chunks as well, where they are large enough to cut.
            assert!(picture(&scene, &way(true, Some(1 << 18))).as_ref() == Some(&alone), "{name}, {spp} samples, chunks");
            // The comparison sees other samples.
            scene.render.seed += 1;
            assert!(picture(&scene, &way(true, None)).as_ref() != Some(&alone));
        }
    }
}

/// Otherwise the test above would compare a way with itself.
#[test]
fn packets_are_used_where_they_can_be() {
    let Some(device) = DEVICE.as_ref() else { return };
    let of = |packets, hierarchy| {
        let options = PlanOptions { packets, hierarchy, ..Default::default() };
        GpuRenderer::on(device, &scene(1), &options).expect("the scene fits").plan().packets
    };
    let possible = device.limits.software && device.limits.subgroup_size.is_some_and(|size| size >= 4);
    assert_eq!([of(None, None), of(Some(true), None), of(Some(false), None)], [possible, possible, false]);
    assert!(!of(Some(true), Some(HierarchyKind::Bvh2)), "there are no packets for binary trees");
}

/// Which place a path or a shadow ray has in a queue is nothing that its samples know of. Queues end within a subgroup at most edges, and
/// lanes of one leave the scene, die and miss lights at different vertices.
#[test]
fn places_taken_by_a_subgroup_at_once_change_nothing() {
    let mut cornell = load::load(Some("cornell")).expect("it is built in");
    cornell.film.size = [41, 31];
    let mut spheres = load::load(Some("spheres")).expect("it is built in");
    spheres.film.size = [48, 27];
    for (name, mut scene) in [("knot", scene(0)), ("cornell", cornell), ("spheres", spheres)] {
        for spp in [1, 5, 24] {
            scene.render.spp = spp;
            let way = |together, path_capacity| PlanOptions {
                stages: Some(StageMode::Wavefront),
                subgroup_queues: Some(together),
                path_capacity,
                ..Default::default()
            };
            let [alone, together] = [false, true].map(|together| picture(&scene, &way(together, None)));
            let (Some(alone), Some(together)) = (alone, together) else { return };
            assert!(alone == together, "{name}, {spp} samples");
            // In passes whose last subgroup is never full.
            assert!(picture(&scene, &way(true, Some(1001))).as_ref() == Some(&alone), "{name}, {spp} samples, small passes");
            // The comparison sees other samples.
            scene.render.seed += 1;
            assert!(picture(&scene, &way(true, None)).as_ref() != Some(&alone));
        }
    }
}

/// Otherwise the test above would compare a way with itself.
#[test]
fn subgroups_take_places_where_they_can() {
    let Some(device) = DEVICE.as_ref() else { return };
    let of = |together, stages| {
        let options = PlanOptions { subgroup_queues: together, stages: Some(stages), ..Default::default() };
        GpuRenderer::on(device, &scene(1), &options).expect("the scene fits").plan().subgroup_queues
    };
    let possible = device.limits.subgroups;
    let wavefront = [None, Some(true), Some(false)].map(|together| of(together, StageMode::Wavefront));
    assert_eq!(wavefront, [possible, possible, false]);
    assert!(!of(Some(true), StageMode::Fused), "there are no queues where one kernel traces whole paths");
}

/// A hierarchy only says what need not be tested: the nearest hit is the nearest in every form. Where two primitives are met at the same
/// distance to the last bit, the first to be tested stays, which is why edges that primitives share may show another one's material; a
/// mesh of one smooth material does not show even that.
#[test]
fn every_form_of_hierarchy_makes_the_same_picture() {
    let mut moving = load::load(Some("motion-blur")).expect("it is built in");
    moving.film.size = [32, 24];
    moving.render.spp = 6;
    let mut spheres = load::load(Some("spheres")).expect("it is built in");
    spheres.film.size = [48, 27];
    spheres.render.spp = 8;
    for (name, mut scene) in [("knot", scene(8)), ("moving", moving), ("spheres", spheres)] {
        for stages in [StageMode::Fused, StageMode::Wavefront] {
            let form = |kind| PlanOptions {
                geometry: Some(GeometryPlacement::Hierarchy),
                hierarchy: Some(kind),
                stages: Some(stages),
                ..Default::default()
            };
            let [binary, four, eight] = HierarchyKind::ALL.map(|kind| picture(&scene, &form(kind)));
            let (Some(binary), Some(four), Some(eight)) = (binary, four, eight) else { return };
            let different = |other: &[[u32; 3]]| four.iter().zip(other).filter(|(a, b)| a != b).count();
            println!("{name}, {stages:?}: {} and {} of {} pixels differ", different(&binary), different(&eight), four.len());
            assert!(four == binary && four == eight, "{name}, {stages:?}");
            // The comparison sees other samples.
            scene.render.seed += 1;
            assert!(picture(&scene, &form(HierarchyKind::CwBvh)).as_ref() != Some(&four));
        }
    }
}
