//! Arrays that one binding cannot hold: cut into chunks, they give the same picture, bit for bit.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use crate::common::device::DEVICE;
use crate::common::effort::in_full;
use crate::common::pixel_bits::pixel_bits;
use glam::Vec3;
use gpt::gpu::Device;
use gpt::load;
use gpt::packed::PackedScene;
use gpt::plan::{Chunks, DeviceLimits, Plan, PlanError, PlanOptions, StageMode};
use gpt::scene::{Geometry, Scene};

/// Quads along each side of the grid.
const SIDE: usize = 24;
/// Bytes of a chunk in these tests: 187 primitives or nodes, 140 triangles' attributes. Smaller ones take the driver's compiler long.
const CHUNK: u64 = 9_000;

/// A wavy grid seen from above, every triangle of which is wider than a pixel; over a part of it a small one that moves, smooth and
/// textured.
fn grid() -> Scene {
    let mut text = String::from(
        r#"
[film]
size = [48, 48]
[render]
spp = 4
max_depth = 3
[camera]
position = [0, 9, 0]
look_at = [0, 0, 0]
up = [0, 0, -1]
projection = "orthographic"
height = 2
shutter = [0, 1]
[[texture]]
name = "squares"
type = "checker"
a = [0.9, 0.3, 0.2]
b = [0.2, 0.5, 0.9]
scale = [7, 5]
[[material]]
name = "squares"
type = "diffuse"
reflectance = { texture = "squares" }
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.5
[[light]]
type = "environment"
radiance = [1, 1.5, 2]
"#,
    );
    let moving = "smooth = true\nmotion = [{ translate = [0.5, 0.1, 0.2] }]";
    for (side, width, height, material, keys) in [(SIDE, 2.0, 0.0, "grey", ""), (12, 0.7, 0.4, "squares", moving)] {
        let corners: Vec<(f64, f64)> = (0..=side)
            .flat_map(|row| (0..=side).map(move |column| (column as f64 / side as f64, row as f64 / side as f64)))
            .collect();
        let position = |&(u, v): &(f64, f64)| [width * (u - 0.5), height + 0.05 * (9.0 * u + 7.0 * v).sin(), width * (v - 0.5)];
        let positions: Vec<[f64; 3]> = corners.iter().map(position).collect();
        let uvs: Vec<[f64; 2]> = corners.iter().map(|&(u, v)| [u, v]).collect();
        let faces: Vec<[usize; 3]> = (0..side * side)
            .map(|quad| quad / side * (side + 1) + quad % side)
            .flat_map(|a| [[a, a + side + 1, a + 1], [a + 1, a + side + 1, a + side + 2]])
            .collect();
        let _ = write!(
            text,
            "[[shape]]\ntype = \"mesh\"\nmaterial = \"{material}\"\n{keys}\n\
             positions = {positions:?}\nuvs = {uvs:?}\nfaces = {faces:?}\n"
        );
    }
    load::load_toml_str(&text, "grid", Path::new(".")).expect("the scene is valid")
}

fn options(stages: StageMode) -> PlanOptions {
    PlanOptions { stages: Some(stages), ..PlanOptions::default() }
}

/// The device as if one binding held no more of an array than a chunk.
fn small_bindings(device: &Device) -> Device {
    let mut device = device.clone();
    device.limits.max_array = CHUNK;
    device
}

/// Means of all pixels as bits, and the plan.
fn picture(device: &Device, scene: &Scene, options: &PlanOptions) -> (Vec<[u32; 3]>, Plan) {
    pixel_bits(device, scene, options, 0..scene.render.spp)
}

/// Chunks of primitives, nodes and attributes.
fn counts(plan: &Plan) -> Vec<u32> {
    plan.chunks.iter().map(|array| array.count).collect()
}

#[test]
fn arrays_in_chunks_give_the_same_picture() {
    let Some(device) = DEVICE.as_ref() else { return };
    let scene = grid();
    let wavefront = in_full("arrays in chunks by the wavefront").then_some(StageMode::Wavefront);
    for stages in [StageMode::Fused].into_iter().chain(wavefront) {
        let (whole, plan) = picture(device, &scene, &options(stages));
        assert!(plan.chunks.iter().all(Chunks::is_whole) && !plan.to_string().contains("in chunks"), "{plan}");
        let (cut, plan) = picture(&small_bindings(device), &scene, &options(stages));
        assert!(counts(&plan).iter().zip([7, 2, 3]).all(|(&count, least)| count >= least), "{plan}");
        assert!(plan.to_string().contains("in chunks      primitives in "), "{plan}");
        assert!(whole == cut, "{stages:?}");
    }
}

/// The picture would say little of primitives that it does not show: those on either side of every cut are
/// taken away, and the background is seen in their place.
#[test]
fn primitives_on_both_sides_of_a_cut_are_seen() {
    let Some(device) = DEVICE.as_ref() else { return };
    // At rest, so that every triangle is where the mesh has it.
    let mut scene = grid();
    scene.shapes.truncate(1);
    let (device, options) = (&small_bindings(device), options(StageMode::Fused));
    let packed = PackedScene::new(&scene).expect("the scene packs");
    let in_chunk = (CHUNK / 48) as usize;
    let cuts = (in_chunk..packed.primitives.len()).step_by(in_chunk);
    // The packed scene is relative to its centre.
    let center = scene.center().as_vec3();
    let beside: Vec<[Vec3; 3]> = cuts
        .flat_map(|first| [first - 1, first])
        .map(|index| packed.primitives[index])
        .map(|primitive| [primitive.p0, primitive.p1, primitive.p2].map(|corner| Vec3::from(corner) + center))
        .collect();
    assert!(beside.len() >= 10);
    let mut without = scene.clone();
    let Geometry::Mesh(mesh) = &mut without.shapes[0].geometry else { panic!("the grid is a mesh") };
    let mesh = Arc::make_mut(mesh);
    let positions = &mesh.positions;
    let is_beside = |face: &[u32; 3]| {
        beside.iter().any(|corners| (0..3).all(|corner| positions[face[corner] as usize].distance(corners[corner]) < 1e-5))
    };
    let before = mesh.faces.len();
    let kept: Vec<[u32; 3]> = mesh.faces.iter().copied().filter(|face| !is_beside(face)).collect();
    mesh.faces = kept;
    assert_eq!(mesh.faces.len(), before - beside.len());
    let [with, without] = [&scene, &without].map(|scene| picture(device, scene, &options).0);
    for corners in beside {
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let [column, row] = [middle.x, middle.z].map(|x| (24.0 * (x + 1.0)) as usize);
        let [with, without] = [&with, &without].map(|pixels| f32::from_bits(pixels[48 * row + column][1]));
        // The background's green is 1.5; the grid reflects at most half of that.
        assert!(without - with > 0.15, "at {column}, {row}: {with} with the triangle, {without} without");
    }
}

fn plan(limits: &DeviceLimits) -> Result<Plan, PlanError> {
    let scene = grid();
    let packed = PackedScene::new(&scene).expect("the scene packs");
    Plan::new(&scene, &packed, limits, &options(StageMode::Fused))
}

/// A device that binds no more than this takes the grid whole, in a few buffers of half its primitives, or
/// not at all.
#[test]
fn too_many_chunks_are_refused_with_both_sizes() {
    let limits = |max_storage_buffers| DeviceLimits { max_storage_buffers, max_array: CHUNK, ..DeviceLimits::default() };
    // Eight are promised: enough for what need not be cut.
    assert!(plan(&DeviceLimits::default()).is_ok());
    let needed: u32 = plan(&limits(100)).map(|plan| counts(&plan).iter().sum()).expect("they are enough");
    assert!(needed > 8);
    match plan(&limits(8)) {
        Err(PlanError::DoesNotFit(message)) => {
            let expected = "its primitives need 0.1 MiB, and the device can bind 0.0 MiB at once; in chunks of that size a stage";
            assert!(message.starts_with(expected), "{message}");
        }
        other => panic!("{other:?}"),
    }
}

/// Chunks hold whole records, all of them, and no two arrays share a binding.
#[test]
fn chunks_cover_the_array_in_whole_records() {
    use gpt::plan::chunks::{ATTRIBUTES, NODES, PRIMITIVES, TEXELS};
    let mut numbers = std::collections::BTreeSet::new();
    for array in [PRIMITIVES, NODES, ATTRIBUTES, TEXELS] {
        let record = array.record_bytes() as usize;
        for (records, limit) in [(1, record), (7, 3 * record), (9, 3 * record), (100, 3 * record + record / 2), (5, 1 << 20)] {
            let chunks = Chunks::new(array, (records * record) as u64, limit as u64);
            let ranges: Vec<_> = chunks.bindings().collect();
            assert_eq!(ranges.len() as u32, chunks.count);
            assert_eq!((ranges[0].0, ranges[0].1.start, ranges[ranges.len() - 1].1.end), (array.binding, 0, records * record));
            assert!(ranges.windows(2).all(|pair| pair[0].1.end == pair[1].1.start));
            assert!(ranges.iter().all(|(_, range)| range.len() % record == 0 && !range.is_empty() && range.len() <= limit));
        }
        numbers.extend(Chunks::new(array, 99 * record as u64, record as u64).bindings().map(|(number, _)| number));
    }
    assert_eq!(numbers.len(), 4 * 99);
    assert!(numbers.iter().all(|number| *number < 1000 && !(9..400).contains(number)));
}
