//! The packed hierarchies: every primitive is reached, and no box cuts what is in it. No device is needed.

use std::path::Path;
use std::sync::Arc;

use crate::statistics::random::SplitMix64;
use glam::Vec3;
use gpt::load;
use gpt::packed::PackedScene;
use gpt::packed::bvh4::Child;
use gpt::packed::bvh4::Node;
use gpt::packed::grid::Box3;
use gpt::packed::shape::PrimitiveKind;
use gpt::scene::{Geometry, Mesh, Scene};

/// A mesh in front of a camera.
fn mesh(positions: Vec<Vec3>, faces: Vec<[u32; 3]>) -> Scene {
    let text = "[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\nvfov = 40\n\
                [[material]]\nname = \"grey\"\ntype = \"emissive\"\nradiance = 1\n\
                [[shape]]\ntype = \"mesh\"\nmaterial = \"grey\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n";
    let mut scene = load::load_toml_str(text, "mesh", Path::new("")).expect("the scene is valid");
    scene.shapes[0].geometry = Geometry::Mesh(Arc::new(Mesh { positions, faces, ..Mesh::default() }));
    scene
}

/// Triangles anywhere in a cube of this size around a place, most of them small.
fn soup(count: u32, size: f32, around: Vec3) -> Scene {
    let mut random = SplitMix64::new(u64::from(count));
    let mut uniform = || random.uniform() as f32;
    let positions = (0..count)
        .flat_map(|_| {
            let [place, extent] = [Vec3::new(uniform(), uniform(), uniform()), Vec3::splat(uniform().powi(8))];
            [0, 1, 2].map(|_| around + size * (place + extent * Vec3::new(uniform(), uniform(), uniform())))
        })
        .collect();
    mesh(positions, (0..count).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]).collect())
}

/// Each by a factor as large as the one before it, or all the same one: trees as deep as they get.
fn nested(count: u32, factor: f32) -> Scene {
    let corner = |index: u32, x: f32, y: f32| factor.powi(index as i32) * Vec3::new(x, y, 0.0);
    let positions = (0..count).flat_map(|index| [(1.0, 0.0), (0.0, 1.0), (-1.0, -1.0)].map(|(x, y)| corner(index, x, y)));
    mesh(positions.collect(), (0..count).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]).collect())
}

fn scenes() -> Vec<(&'static str, Scene)> {
    let builtin = |name: &'static str| (name, load::load(Some(name)).expect("it is built in"));
    vec![
        builtin("motion-blur"),
        builtin("spheres"),
        builtin("teapot-plastic"),
        ("nothing", soup(0, 1.0, Vec3::ZERO)),
        ("one triangle", soup(1, 1.0, Vec3::ZERO)),
        ("five triangles", soup(5, 1.0, Vec3::ZERO)),
        ("soup", soup(3_000, 1.0, Vec3::ZERO)),
        ("soup far away", soup(1_000, 1.0, Vec3::splat(1e5))),
        ("huge soup", soup(1_000, 1e12, Vec3::ZERO)),
        ("tiny soup", soup(1_000, 1e-12, Vec3::ZERO)),
        ("nested", nested(40, 2.0)),
        ("five hundred times the same", nested(500, 1.0)),
    ]
}

fn packed(scene: &Scene) -> PackedScene {
    PackedScene::new(scene).expect("the scene packs")
}

/// The primitives that stick out of a box on the way to them, and how often each is met.
fn walk(nodes: &[Node], packed: &PackedScene, seen: &mut [u32]) -> Vec<String> {
    let mut complaints = Vec::new();
    // Every node with what all boxes on the way to it have in common.
    let mut pending = vec![(0_usize, Box3 { low: Vec3::NEG_INFINITY, high: Vec3::INFINITY })];
    while let Some((node, outer)) = pending.pop() {
        let (children, boxes) = (nodes[node].children(), nodes[node].boxes());
        assert_eq!(children.len(), boxes.len());
        for (child, bounds) in children.into_iter().zip(boxes) {
            let common = Box3 { low: outer.low.max(bounds.low), high: outer.high.min(bounds.high) };
            let (first, count) = match child {
                Child::Inner(inner) => {
                    pending.push((inner, common));
                    continue;
                }
                Child::Leaf { first, count } => (first, count),
            };
            for index in first..first + count {
                seen[index as usize] += 1;
                let primitive = &packed.primitives[index as usize];
                let corners = [primitive.p0, primitive.p1, primitive.p2].map(Vec3::from);
                let inside = corners.iter().all(|&corner| common.contains(&Box3 { low: corner, high: corner }));
                // Moving shapes, and shapes without corners, are for pictures to judge.
                if primitive.kind() == PrimitiveKind::Triangle as u32 && !primitive.moves() && !inside {
                    complaints.push(format!("primitive {index}, {corners:?}, sticks out of {common:?}"));
                }
            }
        }
    }
    complaints
}

#[test]
fn every_primitive_is_reached_once_and_no_box_cuts_one() {
    for (name, scene) in scenes() {
        let packed = packed(&scene);
        let mut seen = vec![0; packed.hierarchy.primitive_count as usize];
        let complaints = walk(&packed.hierarchy.nodes, &packed, &mut seen);
        assert!(complaints.is_empty(), "{name}: {complaints:#?}");
        assert!(seen.iter().all(|&times| times == 1), "{name}: {seen:?}");
    }
}

/// A box that is one line too short does not pass.
#[test]
fn a_box_that_cuts_is_noticed() {
    let mut packed = packed(&soup(3_000, 1.0, Vec3::ZERO));
    packed.hierarchy.nodes.iter_mut().for_each(|node| node.high[1] -= 1);
    let mut seen = vec![0; packed.hierarchy.primitive_count as usize];
    assert!(!walk(&packed.hierarchy.nodes, &packed, &mut seen).is_empty());
}

/// A billionth more than 0 is as far from −1 as 0 is, in f32, and lies on a line of the grid: the box of a node that holds −1, a billionth and
/// 1 is as large as it has to be all the same.
#[test]
fn coordinates_that_differ_by_less_than_rounding_stay_inside() {
    let triangle = |x: f32| [Vec3::new(x, 0.0, 0.0), Vec3::new(x, 0.1, 0.0), Vec3::new(x, 0.0, 0.1)];
    let positions = [-1.0, 1e-9, 1.0].into_iter().flat_map(triangle).collect();
    let packed = packed(&mesh(positions, (0..3).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]).collect()));
    assert!(walk(&packed.hierarchy.nodes, &packed, &mut [0; 3]).is_empty());
}
