//! Shapes and models that are wrong.

use gpt::load;

use super::{check, complaint};
use crate::common::files::folder_with;

#[test]
fn transforms_and_views_without_meaning_are_refused() {
    check(&[
        (
            "look_at = [0, 0, 0]",
            "look_at = [0, 0, 4]",
            "test.toml:8:11: camera.look_at: the camera looks at the point it stands at",
        ),
        (
            "vfov = 40",
            "vfov = 40\nup = [0, 0, 1]",
            "test.toml:10:6: camera.up: `up` is zero or lies along the viewing direction, so which way is up is not known [choose an \
             `up` that is not parallel to look_at - position]",
        ),
        (
            "radius = 1",
            "radius = 1\ntransform = [{ scale = [1, 2, 1] }]",
            "test.toml:18:13: shape[0].transform: a sphere can only be scaled by the same factor along every axis [use a mesh for an \
             ellipsoid or an ellipse]",
        ),
        (
            "radius = 1",
            "radius = 1\ntransform = [{ scale = 0 }]",
            "test.toml:18:24: shape[0].transform[0].scale: a scale of 0 flattens the shape",
        ),
        (
            "radius = 1",
            "radius = 1\ntransform = [{ scale = 2, translate = [0, 0, 1] }]",
            "test.toml:18:14: shape[0].transform[0]: a step has one of `scale`, `rotate`, `translate`, `matrix`; this has 2 [write several \
             steps as several tables: they are applied in the order of the array]",
        ),
        (
            "radius = 1",
            "radius = 1\ntransform = { matrix = [1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }",
            "test.toml:18:13: shape[0].transform: the transform flattens the shape or leaves the range of numbers",
        ),
        (
            "radius = 1",
            "radius = 1\ntransform = [{ rotate = [0, 0, 0], degrees = 3 }]",
            "test.toml:18:25: shape[0].transform[0].rotate: a direction cannot have length 0",
        ),
    ]);
}

#[test]
fn files_of_meshes_that_cannot_be_read_are_named() {
    check(&[
        (
            "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1",
            "type = \"mesh\"\nfile = \"absent.obj\"",
            "test.toml:16:8: shape[0].file: there is no file absent.obj",
        ),
        (
            "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1",
            "type = \"mesh\"\nfile = \"model.stl\"",
            "test.toml:16:8: shape[0].file: a mesh file is an OBJ or a PLY file: its name ends in .obj, .ply or .ply.gz \
             [MeshLab or `assimp export MODEL model.obj` (assimp-utils) makes an OBJ file of it]",
        ),
    ]);
}

#[test]
fn shapes_without_area_are_refused() {
    let shape = "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1";
    let rows = [
        ("type = \"rectangle\"\ncorner = [0, 0, 0]\nedge_u = [1, 0, 0]\nedge_v = [2, 0, 0]", "the rectangle has no area"),
        ("type = \"disk\"\ncenter = [0, 0, 0]\nnormal = [0, 0, 0]\nradius = 1", "a direction cannot have length 0"),
        ("type = \"box\"\nmin = [0, 0, 0]\nmax = [1, -1, 1]", "the box's `max` is below its `min`"),
        ("type = \"box\"\nmin = [0, 0, 0]\nmax = [1, 0, 0]", "the box has no area"),
        (
            "type = \"mesh\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 3]]",
            "uses position 3, but there are only 3",
        ),
        (
            "type = \"mesh\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, -1]]",
            "integer `-1`, expected a whole number",
        ),
        ("type = \"mesh\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = []", "the mesh has no faces with an area"),
        (
            "type = \"mesh\"\npositions = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]\nfaces = [[0, 1, 2]]",
            "the mesh has no faces with an area",
        ),
        (
            "type = \"mesh\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\nuvs = [[0, 0]]",
            "there are 1 `uvs` for 3 positions",
        ),
        ("type = \"mesh\"", "a mesh needs the key `file`, or both `positions` and `faces`"),
    ];
    for (to, expected) in rows {
        let complaint = complaint(shape, to);
        assert!(complaint.starts_with("test.toml:1") && complaint.contains("shape[0]"), "{complaint}");
        assert!(complaint.contains(expected), "{complaint}");
    }
}

/// A fault of one statement is a warning that names its line, and an error with `--strict` (tests/cli/odd_models.rs).
#[test]
fn models_without_a_face_that_can_be_rendered_are_refused() {
    let positions = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let rows = [
        (
            "f 1 2 4",
            "none of its faces can be read: line 4: faces with a corner that is no vertex of the file are left out: `f 1 2 4`",
        ),
        ("f 1 2", "none of its faces can be read: line 4: faces of fewer than three corners"),
        ("v nan 0 0\nf 1 2 4", "none of its faces can be read: line 4: faces with a corner whose position"),
        ("", "bad.obj: there is nothing to render in the model: it has no faces"),
        ("f 1 2 2", "bad.obj: there is nothing to render in the model: none of its faces has an area"),
    ];
    for (rest, expected) in rows {
        let folder = folder_with(&[("bad.obj", format!("{positions}{rest}\n").as_bytes())]);
        let error = load::load(folder.path().join("bad.obj").to_str()).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}
