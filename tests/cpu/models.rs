//! The models of the built-in scenes: closed where they are solids, faces and normals to the outside.

#[path = "../../examples/tessellate/main.rs"]
#[allow(dead_code, reason = "its main function writes the files")]
mod tessellate;

use std::collections::HashMap;

use gpt::load;
use gpt::scene::{Geometry, Mesh};

fn model(scene: &str) -> Mesh {
    let scene = load::load(Some(scene)).unwrap_or_else(|error| panic!("{error}"));
    let mut meshes = scene.shapes.iter().filter_map(|shape| match &shape.geometry {
        Geometry::Mesh(mesh) => Some((**mesh).clone()),
        _ => None,
    });
    meshes.next().unwrap_or_else(|| panic!("{} has no mesh", scene.name))
}

/// Faces with a corner whose normal points to the other side, or nearly so.
fn turned_faces(mesh: &Mesh) -> usize {
    let is_turned = |face: &&[u32; 3]| {
        let normal = mesh.face_normal(**face).unwrap_or_default();
        face.iter().any(|&corner| normal.dot(mesh.normals[corner as usize].as_dvec3()) < 0.5)
    };
    mesh.faces.iter().filter(is_turned).count()
}

/// Edges that are not shared by exactly two faces in opposite directions; corners at one place are one.
fn open_edges(mesh: &Mesh) -> usize {
    let place = |corner: u32| mesh.positions[corner as usize].to_array().map(|coordinate| (coordinate + 0.0).to_bits());
    let mut balance: HashMap<_, i32> = HashMap::new();
    for &[a, b, c] in &mesh.faces {
        for (from, to) in [(a, b), (b, c), (c, a)].map(|(from, to)| (place(from), place(to))) {
            *balance.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
        }
    }
    balance.values().filter(|&&sum| sum != 0).count()
}

/// Six times the volume that the faces enclose, positive if they face outward.
fn volume(mesh: &Mesh) -> f64 {
    let corners = |face: &[u32; 3]| face.map(|corner| mesh.positions[corner as usize].as_dvec3());
    mesh.faces.iter().map(corners).map(|[a, b, c]| a.dot(b.cross(c))).sum()
}

#[test]
fn faces_and_normals_point_outward() {
    for scene in ["teapot-plastic", "knot-plastic"] {
        let mut mesh = model(scene);
        assert_eq!(turned_faces(&mesh), 0, "{scene}");
        assert!(volume(&mesh) > 0.0, "{scene}");
        let heights = mesh.positions.iter().map(|position| position.y);
        let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), y| (low.min(y), high.max(y)));
        assert!(low == 0.0 && (high - 1.0).abs() < 0.01, "{scene} stands from {low} to {high}");
        // The check sees a face that is turned over.
        mesh.faces[7].reverse();
        assert_eq!(turned_faces(&mesh), 1, "{scene}");
    }
}

#[test]
fn the_knot_is_closed_and_the_teapot_open_where_newell_left_it() {
    let knot = model("knot-toon");
    assert_eq!(open_edges(&knot), 0);
    let mut broken = knot;
    broken.faces.pop();
    assert_eq!(open_edges(&broken), 3);
    // The inner rim, the lid's rim, both ends of handle and spout, and nowhere else.
    let (around, across) = (4 * 12, 2 * 12);
    assert_eq!(open_edges(&model("teapot-toon")), 2 * around + 4 * across);
}

/// The example makes them, so their formulas are what to change.
#[test]
fn the_models_are_what_the_tessellation_makes() {
    let made = tessellate::models();
    let shipped = [include_str!("../../scenes/models/teapot.obj"), include_str!("../../scenes/models/knot.obj")];
    for ((name, text), shipped) in made.iter().zip(shipped) {
        assert!(text == shipped, "scenes/models/{name}.obj is not what `cargo run --release --example tessellate` writes");
    }
}
