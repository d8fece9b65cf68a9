//! Every scene that can be read comes back from what is written of it.

use std::path::Path;

use tempfile::tempdir;

use super::*;
use crate::load::file::{example_materials, light_examples, material_examples, shape_examples};
use crate::load::load_toml_str;
use crate::load::{builtin_names, load};
use crate::scene::{Geometry, Mesh, digest};

const HEAD: &str = "[camera]\nposition = [0.1, 1, 4]\nlook_at = [0, 0, 0]\nvfov = 40\n";
const MATERIALS: &str = "[[material]]\nname = \"red\"\ntype = \"diffuse\"\nreflectance = [0.6, 0.1, 0.1]\n\
                         [[material]]\nname = \"mirror\"\ntype = \"mirror\"\n";
const SPHERE: &str = "[[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"probe\"\n";
const POINT_LIGHT: &str = "[[light]]\ntype = \"point\"\nposition = [1, 3, 2]\nintensity = 9\n";

/// The scene, written and read again.
fn round_trip(scene: &Scene) -> Scene {
    let folder = tempdir().unwrap();
    let path = folder.path().join("out.toml");
    save_scene(scene, &path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    load_toml_str(&text, "out.toml", folder.path()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn comes_back(scene: &Scene, what: &str) {
    let read = round_trip(scene);
    assert_eq!(digest(&read), digest(scene), "{what}");
    assert_eq!((&read.film, &read.render, &read.layers), (&scene.film, &scene.render, &scene.layers), "{what}");
}

fn scene(tables: &str) -> Scene {
    load_toml_str(&format!("{HEAD}{MATERIALS}{tables}"), "test.toml", Path::new(""))
        .unwrap_or_else(|error| panic!("{error}\n{tables}"))
}

#[test]
fn every_built_in_scene_comes_back() {
    for name in builtin_names() {
        comes_back(&load(Some(name)).unwrap(), name);
    }
}

#[test]
fn every_material_comes_back() {
    for (name, keys) in material_examples() {
        let text = format!("{HEAD}{}[[material]]\nname = \"probe\"\n{keys}{SPHERE}{POINT_LIGHT}", example_materials());
        let read = load_toml_str(&text, "test.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}\n{text}"));
        comes_back(&read, name);
    }
    let textured = "[[texture]]\nname = \"noise\"\ntype = \"perlin\"\na = 0.1\nb = [0.5, 0.25, \"0\"]\noctaves = 3\nseed = 7\nscale = 2.5\n\
                    [[texture]]\nname = \"tiles\"\ntype = \"checker\"\na = 0.1\nb = \"#808080\"\nscale = [3, 4]\n\
                    [[texture]]\nname = \"cells\"\ntype = \"worley\"\na = 0.1\nb = 0.9\n\
                    [[material]]\nname = \"rough\"\ntype = \"conductor\"\npreset = \"gold\"\nroughness = { texture = \"cells\" }\n\
                    [[material]]\nname = \"dim\"\ntype = \"diffuse\"\nreflectance = { texture = \"noise\", factor = [0.5, 0.25, 1] }\n\
                    emission = { kelvin = 3000, factor = 4 }\nemission_two_sided = true\n\
                    [[material]]\nname = \"probe\"\ntype = \"blend\"\nmaterials = [\"rough\", \"dim\"]\n\
                    weight = { type = \"threshold\", tau = 0.4, of = { type = \"reverse\", of = { type = \"texture\", texture = \"tiles\" } } }\n";
    comes_back(&scene(&format!("{}{SPHERE}{POINT_LIGHT}", textured.replace(", \"0\"]", ", 0]"))), "textures");
}

#[test]
fn every_shape_comes_back_where_it_stands_and_as_it_moves() {
    let placed = "transform = [{ rotate = [1, 2, 3], degrees = 31 }, { scale = 0.7 }, { translate = [0.1, 0, -0.3] }]\n\
                  motion = [{ rotate = [1, 1, 0], degrees = 15 }, { translate = [0.1, 0.2, 0.3] }]\n";
    for (name, keys) in shape_examples() {
        let placed = if name == "plane" { "" } else { placed };
        comes_back(&scene(&format!("{keys}material = \"red\"\n{placed}{POINT_LIGHT}")), name);
    }
    let matrix = "transform = { matrix = [1, 0.2, 0, 3, 0, 1, 0, 0, 0, 0.1, 1, 0.25, 0, 0, 0, 1] }\nportal = true\n";
    let keys = "[[shape]]\ntype = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nmaterial = \"red\"\n";
    comes_back(&scene(&format!("{keys}{matrix}{POINT_LIGHT}")), "a matrix");
}

#[test]
fn every_light_and_camera_comes_back() {
    for (name, keys) in light_examples().filter(|(_, keys)| !keys.contains("map.exr")) {
        comes_back(&scene(&keys), name);
    }
    for camera in [
        "position = [3, 2, 1]\nlook_at = [0, 0, 0]\nup = [0, 0, 1]\nprojection = \"orthographic\"\nheight = 3",
        "position = [3, 2, 1]\nlook_at = [0, 0, 0]\nvfov = 33.3\naperture = { shape = \"polygon\", radius = 0.1, blades = 7, rotation = 11 }\n\
         focus_distance = 2.5\nshutter = [0.25, 0.75]\nrolling_shutter = 0.125",
    ] {
        let text = format!(
            "[film]\nsize = [30, 20]\nfilter = {{ type = \"tent\", radius = 1.25 }}\n[render]\nspp = 7\nsampler = \"halton\"\n\
                            pixel_sampler = \"sobol\"\nmax_depth = 3\n[output]\naov = [\"albedo\", \"depth\"]\n[camera]\n{camera}\n{POINT_LIGHT}"
        );
        comes_back(&load_toml_str(&text, "test.toml", Path::new("")).unwrap(), camera);
    }
}

/// Each key by itself, some with their defaults, and none of them lost where it does not change.
#[test]
fn keyframes_of_materials_come_back() {
    let keyed = scene(&format!(
        "{}{SPHERE}{POINT_LIGHT}",
        "[[material]]\nname = \"lacquer\"\ntype = \"principled\"\nbase_color = 0.5\nroughness = 0.5\nclearcoat = 1\ninterpolation = \"smooth\"\n\
         keyframes = [{ frame = 0, roughness = 0.5, clearcoat = 0 }, { frame = 5, roughness = 0.5 },\n\
         { frame = 10, roughness = 0.9, clearcoat = 1, emission = [0, 1, 2] }, { frame = 12, emission = 0 }]\n\
         [[material]]\nname = \"probe\"\ntype = \"blend\"\nmaterials = [\"lacquer\", \"mirror\"]\nweight = { type = \"constant\", value = 1 }\n\
         keyframes = [{ frame = 0, weight = { type = \"constant\", value = 1 } }, { frame = 8, weight = { type = \"constant\", value = 0.25 } }]\n"
    ));
    let read = round_trip(&keyed);
    assert_eq!(read.animation.frames(), Some([0.0, 12.0]));
    for frame in [0.0, 2.5, 7.0, 9.5, 11.0, 13.0] {
        let [before, after] = [&keyed, &read].map(|scene| scene.at_frame(frame).expect("a frame").materials);
        for (before, after) in before.iter().zip(&after) {
            let near = before.numbers().iter().zip(after.numbers()).all(|(a, b)| (a - b).abs() < 1e-9);
            assert!(near && before.has_form_of(after), "{frame}: {before:?} {after:?}");
        }
    }
    assert!(!keyed.at_frame(2.5).expect("a frame").materials[2].looks_like(&keyed.materials[2]), "the control");
}

/// Names that are empty or the same twice, as importers may bring them, are told apart.
#[test]
fn names_need_not_be_good() {
    let mut bad = scene(&format!("[[material]]\nname = \"probe\"\ntype = \"glass\"\n{SPHERE}{POINT_LIGHT}"));
    bad.materials.iter_mut().for_each(|material| material.name.clear());
    let read = round_trip(&bad);
    assert_eq!(
        read.materials.iter().map(|material| material.name.as_str()).collect::<Vec<_>>(),
        ["material 1", "material 2", "material 3"]
    );
    assert_eq!(read.shapes[0].material, 2);
}

/// Normals, coordinates and faces of several materials, bit for bit.
#[test]
fn meshes_that_come_from_no_file_come_back() {
    let mut made = scene(&format!(
        "{}{POINT_LIGHT}",
        "[[shape]]\ntype = \"mesh\"\nfile = \"bad.obj\"\nmaterial = \"red\"\n"
            .replace("file = \"bad.obj\"", "positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]")
    ));
    let mut mesh = Mesh { smooth: true, ..Mesh::default() };
    for index in 0..60_u32 {
        let angle = f64::from(index);
        let at = glam::DVec3::new(angle.sin(), (1.3 * angle).cos(), 0.1 * angle);
        mesh.positions.push(at.as_vec3());
        mesh.normals.push(at.normalize().as_vec3());
        mesh.uvs.push(at.as_vec3().truncate() / 3.0);
    }
    mesh.faces = (0..58).map(|index| [index, index + 1, index + 2]).collect();
    mesh.face_materials = (0..58).map(|index| index % 2).collect();
    made.shapes[0].geometry = Geometry::Mesh(mesh.into());
    comes_back(&made, "a mesh");
    // Negative control: the digest sees a last bit of a normal.
    let mut other = made.clone();
    let Geometry::Mesh(mesh) = &mut other.shapes[0].geometry else { unreachable!("the shape is a mesh") };
    let normal = &mut std::sync::Arc::make_mut(mesh).normals[7].x;
    *normal = f32::from_bits(normal.to_bits() + 1);
    assert_ne!(digest(&round_trip(&other)), digest(&made));
}

/// Content of a model stays in its file, which the scene file names; the picture is the same, bit for bit.
#[test]
fn a_models_file_is_named_and_its_materials_can_be_replaced() {
    let folder = tempdir().unwrap();
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.3\nusemtl wood\nf 1 2 3\nusemtl iron\nf 2 4 3\n";
    std::fs::write(folder.path().join("a.obj"), obj).unwrap();
    std::fs::write(folder.path().join("a.mtl"), "newmtl wood\nKd 0.5 0.3 0.1\nnewmtl iron\nKd 0.2 0.2 0.2\n").unwrap();
    let text =
        format!("{HEAD}{MATERIALS}[[shape]]\ntype = \"mesh\"\nfile = \"a.obj\"\nmaterials = {{ iron = \"red\" }}\n{POINT_LIGHT}");
    let original = load_toml_str(&text, "test.toml", folder.path()).unwrap();
    let names: Vec<&str> = original.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["red", "mirror", "wood"]);

    std::fs::create_dir(folder.path().join("below")).unwrap();
    let path = folder.path().join("below/out.toml");
    assert_eq!(save_scene(&original, &path).unwrap(), std::slice::from_ref(&path), "no file beside it");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("file = \"../a.obj\"") && text.contains("materials = { \"iron\" = \"red\" }"), "{text}");
    assert!(!text.contains("wood"), "{text}");
    let read = load_toml_str(&text, "out.toml", path.parent().unwrap()).unwrap();
    assert_eq!(digest(&read), digest(&original));

    for (written, message) in [("irn = \"red\"", "no material named `irn`"), ("iron = \"rd\"", "no material named `rd`")] {
        let text =
            format!("{HEAD}{MATERIALS}[[shape]]\ntype = \"mesh\"\nfile = \"a.obj\"\nmaterials = {{ {written} }}\n{POINT_LIGHT}");
        let error = load_toml_str(&text, "test.toml", folder.path()).unwrap_err().to_string();
        assert!(error.contains(message) && error.contains("shape[0]"), "{error}");
    }
}

/// Keyframes of everything that has some, with nodes within nodes.
#[test]
fn keyframes_come_back() {
    let tables = "[animation]\nfps = 12.5\n\
        [camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvfov = 40\nshutter = [0, 0.5]\nnode = \"rig\"\ninterpolation = \"smooth\"\n\
        keyframes = [{ frame = 0, position = [0, 0, 5] }, { time = 0.8, position = [0.1, 0, 4], vfov = 30, focus_distance = 3 }]\n\
        [[node]]\nname = \"rig\"\ntransform = [{ translate = [0.1, 0, 0] }, { rotate = [1, 2, 3], degrees = 10 }]\n\
        keyframes = [{ frame = 0, rotate = [1, 2, 3], degrees = 10 }, { frame = 10, rotate = [1, 2, 3], degrees = 20, scale = 1.1 }]\n\
        [[node]]\nname = \"a \\\"node\\\"\"\nparent = \"rig\"\n\
        [[material]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
        [[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0.8\nmaterial = \"grey\"\ntransform = [{ scale = 0.9 }]\n\
        node = \"a \\\"node\\\"\"\ninterpolation = \"step\"\n\
        keyframes = [{ frame = 0, translate = [0, 0.1, 0] }, { frame = 4, translate = [0, 1, 0], scale = 0.5 }]\n\
        [[light]]\ntype = \"spot\"\nposition = [0, 3, 0]\ndirection = [0.1, -1, 0]\nintensity = 9\nangle = 50\nnode = \"rig\"\n\
        keyframes = [{ frame = 0, direction = [0.1, -1, 0.3] }, { frame = 9, position = [1, 3, 0], intensity = [1, 2, 3] }]\n\
        [[light]]\ntype = \"environment\"\nradiance = 0.5\nscale = 3\n\
        keyframes = [{ frame = 0, radiance = 0.1 }, { frame = 9, rotate = 20 }]\n";
    let scene = load_toml_str(tables, "test.toml", Path::new("")).unwrap();
    let read = round_trip(&scene);
    assert_eq!(read.animation, scene.animation);
    let at = |scene: &Scene, frame: f64| digest(&scene.at_frame(frame).unwrap());
    for frame in [0.0, 3.5, 20.0] {
        assert_eq!(at(&read, frame), at(&scene, frame), "{frame}");
    }
    // The control: frames differ.
    assert_ne!(at(&read, 3.5), at(&read, 20.0));
    // A single frame cannot be written to a file.
    assert!(save_scene(&scene.at_frame(2.0).unwrap(), Path::new("frame.toml")).is_err());
}
