//! The packed hierarchies: every primitive is reached, and no box cuts what is in it. No device is needed.

#[path = "statistics/mod.rs"]
mod statistics;
use std::path::Path;
use std::sync::Arc;

use crate::statistics::random::SplitMix64;
use glam::Vec3;
use gpt::load;
use gpt::packed::grid::Box3;
use gpt::packed::hierarchy::{Child, HierarchyKind, Nodes};
use gpt::packed::primitive::PrimitiveKind;
use gpt::packed::{PackedScene, Unarranged};
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

fn packed(scene: &Scene, kind: HierarchyKind) -> PackedScene {
    Unarranged::new(scene).and_then(|unarranged| unarranged.arrange(kind)).expect("the scene packs")
}

/// Where primitives stick out of a box on the way to them, and how often each is met there.
fn walk(nodes: &Nodes, packed: &PackedScene, seen: &mut [u32]) -> Vec<String> {
    let mut complaints = Vec::new();
    // Every node with what all boxes on the way to it have in common.
    let mut pending = vec![(0_usize, Box3 { low: Vec3::NEG_INFINITY, high: Vec3::INFINITY })];
    while let Some((node, outer)) = pending.pop() {
        let (children, boxes) = (nodes.children(node), nodes.boxes(node));
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
                // What moves, and shapes without corners, are for pictures to judge.
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
        for kind in HierarchyKind::ALL {
            let packed = packed(&scene, kind);
            let mut seen = vec![0; packed.hierarchy.primitive_count as usize];
            let complaints = walk(&packed.hierarchy.nodes, &packed, &mut seen);
            assert!(complaints.is_empty(), "{name}, {kind}: {complaints:#?}");
            assert!(seen.iter().all(|&times| times == 1), "{name}, {kind}: {seen:?}");
        }
    }
}

/// A box that is one line too short, or half a millionth where it is of floats, does not pass.
#[test]
fn a_box_that_cuts_is_noticed() {
    for kind in HierarchyKind::ALL {
        let mut packed = packed(&soup(3_000, 1.0, Vec3::ZERO), kind);
        let mut nodes = packed.hierarchy.nodes.clone();
        match &mut nodes {
            Nodes::Bvh2(nodes) => nodes.iter_mut().for_each(|node| node.planes[1][2] *= 1.0 - 5e-7),
            Nodes::Bvh4(nodes) => nodes.iter_mut().for_each(|node| node.high[1] -= 1),
            Nodes::CwBvh(nodes) => nodes.iter_mut().for_each(|node| node.high[1][0] = node.high[1][0].saturating_sub(0x01010101)),
            Nodes::RayQuery(_) => panic!("{kind} has no nodes of ours"),
        }
        let mut seen = vec![0; packed.hierarchy.primitive_count as usize];
        packed.hierarchy.nodes = nodes;
        assert!(!walk(&packed.hierarchy.nodes, &packed, &mut seen).is_empty(), "{kind}");
    }
}

/// Why the boxes of the eight-wide form are made anew: obvhs takes differences of coordinates in f32, and a billionth more than 0 is as far
/// from −1 as 0 is, which is a line of the grid.
#[test]
fn a_box_as_obvhs_rounds_it_would_cut() {
    use obvhs::aabb::Aabb;
    use obvhs::{BvhBuildParams, cwbvh::builder::build_cwbvh};
    struct Point(f32);
    impl obvhs::Boundable for Point {
        fn aabb(&self) -> Aabb {
            Aabb::new(Vec3::splat(self.0).into(), Vec3::splat(self.0).into())
        }
    }
    let points = [-1.0, 1e-9, 1.0].map(Point);
    let wide = build_cwbvh(&points, BvhBuildParams::medium_build(), &mut std::time::Duration::default());
    let node = wide.nodes[0];
    let cut = (0..8).filter(|&child| !node.is_child_empty(child) && node.is_leaf(child)).any(|child| {
        let (first, count) = node.child_primitives(child);
        let leaf = &wide.primitive_indices[first as usize..(first + count) as usize];
        leaf.iter().any(|&index| points[index as usize].0 > node.child_aabb(child).max.x)
    });
    assert!(cut);

    let triangle = |x: f32| [Vec3::new(x, 0.0, 0.0), Vec3::new(x, 0.1, 0.0), Vec3::new(x, 0.0, 0.1)];
    let positions = points.iter().flat_map(|point| triangle(point.0)).collect();
    let packed =
        packed(&mesh(positions, (0..3).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]).collect()), HierarchyKind::CwBvh);
    assert!(walk(&packed.hierarchy.nodes, &packed, &mut [0; 3]).is_empty());
}
