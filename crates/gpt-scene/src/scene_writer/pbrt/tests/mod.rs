//! Scenes of pbrt are read strictly, and some of their numbers are what they should be.

mod parser;

use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, DVec4};
use tempfile::tempdir;

use self::parser::{Statement, check_scene, parse};
use super::as_pbrt;
use crate::load::file::{example_materials, light_examples, material_examples, shape_examples};
use crate::load::{builtin_names, load, load_toml_str};
use crate::scene::camera::model::CameraModel;
use crate::scene::{Equirectangular, GridsOfMedium, ImportReport, MediumGrids, Projection, Scene, ViewPlace, Volume, VoxelGrid};
use crate::scene_writer::WrittenScene;

const HEAD: &str =
    "[film]\nsize = [40, 20]\n[render]\nspp = 7\nmax_depth = 5\n[camera]\nposition = [0, 1, 4]\nlook_at = [0, 1, 0]\nvfov = 40\n";
const RED: &str = "[[material]]\nname = \"red\"\ntype = \"diffuse\"\nreflectance = [0.6, 0.1, 0.1]\n";
const SPHERE: &str = "[[shape]]\ntype = \"sphere\"\ncenter = [0, 1, 0]\nradius = 2\nmaterial = \"probe\"\n";
const POINT: &str = "[[light]]\ntype = \"point\"\nposition = [1, 3, 2]\nintensity = [9, 8, 7]\n";

fn scene(tables: &str) -> Scene {
    load_toml_str(&format!("{HEAD}{tables}"), "test.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}\n{tables}"))
}

/// The statements of the written scene, whose files are all there, and what was reported.
fn written(scene: &Scene) -> (Vec<Statement>, ImportReport, WrittenScene) {
    let folder = tempdir().unwrap();
    let target = folder.path().join("out.pbrt");
    let made = as_pbrt(scene, "test", &target);
    let text = String::from_utf8(made.content.clone()).unwrap();
    let statements = parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    check_scene(&statements).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let folder = std::fs::canonicalize(folder.path()).unwrap();
    for statement in statements.iter().filter(|statement| statement.name != "Film") {
        for file in ["filename", "normalmap"].into_iter().filter_map(|name| statement.text_of(name)) {
            let path = folder.join(file);
            assert!(path.is_file() || made.files.iter().any(|(known, _)| *known == path), "no {file}");
        }
    }
    (statements, made.report.clone(), made)
}

fn find<'s>(statements: &'s [Statement], name: &str, first: &str) -> &'s Statement {
    let is_it = |statement: &&Statement| statement.name == name && statement.texts.first().is_none_or(|text| text == first);
    statements.iter().find(is_it).unwrap_or_else(|| panic!("no {name} {first}"))
}

fn reported(report: &ImportReport) -> Vec<String> {
    report.dropped.iter().chain(&report.approximated).map(|item| item.what.clone()).collect()
}

#[test]
fn every_example_and_every_built_in_scene_is_well_formed() {
    for name in builtin_names() {
        written(&load(Some(name)).unwrap());
    }
    for (name, keys) in material_examples() {
        let text = format!("{}[[material]]\nname = \"probe\"\n{keys}{SPHERE}{POINT}", example_materials());
        let read = load_toml_str(&format!("{HEAD}{text}"), "test.toml", Path::new(""));
        written(&read.unwrap_or_else(|error| panic!("{name}: {error}")));
    }
    for (_, keys) in shape_examples() {
        written(&scene(&format!("{RED}{keys}material = \"red\"\n{POINT}")));
    }
    for (_, keys) in light_examples().filter(|(_, keys)| !keys.contains("map.exr")) {
        written(&scene(&keys));
    }
}

/// The controls of all tests here: what the reader refuses.
#[test]
fn mistakes_are_found() {
    let (statements, _, made) = written(&scene(&format!("{RED}{}{POINT}", SPHERE.replace("probe", "red"))));
    let text = String::from_utf8(made.content).unwrap();
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}\n{text}");
        let changed = parse(&text.replacen(from, to, 1)).and_then(|statements| check_scene(&statements));
        changed.err().unwrap_or_else(|| panic!("{to} is accepted"))
    };
    for (from, to, why) in [
        ("\"float radius\"", "\"float radios\"", "has no radios"),
        ("\"float radius\"", "\"integer radius\"", "is no integer"),
        ("\"rgb I\" [ 9 8 7 ]", "\"rgb I\" [ 9 8 ]", "2 values"),
        ("NamedMaterial \"red\"\n", "NamedMaterial \"rad\"\n", "no material rad"),
        ("AttributeEnd", "", "without an end"),
        ("WorldBegin", "", "before the world"),
        ("Shape \"sphere\"", "Sphere \"sphere\"", "no directive"),
        ("[ 0.6 0.1 0.1 ]", "[ 1.6 0.1 0.1 ]", "beyond 0 to 1"),
        ("[ 0.6 0.1 0.1 ]", "[ NaN 0.1 0.1 ]", "no number"),
    ] {
        let error = refused(from, to);
        assert!(error.contains(why), "{to}: {error}");
    }
    assert!(check_scene(&statements).is_ok());
}

#[test]
fn settings_are_those_of_the_scene() {
    let (statements, report, _) = written(&scene(&format!("{RED}{}{POINT}", SPHERE.replace("probe", "red"))));
    assert_eq!(reported(&report), Vec::<String>::new());
    assert_eq!(find(&statements, "Integrator", "path").numbers_of("maxdepth"), [4.0]);
    assert_eq!(find(&statements, "Film", "rgb").numbers_of("xresolution"), [40.0]);
    assert_eq!(find(&statements, "Film", "rgb").numbers_of("yresolution"), [20.0]);
    let camera = find(&statements, "Camera", "perspective");
    assert_eq!((camera.numbers_of("fov"), camera.numbers_of("screenwindow")), (vec![40.0], vec![-2.0, 2.0, -1.0, 1.0]));
    // +X of the camera there, as pbrt makes it of the eye, the target and what is above: it is the picture's right.
    assert_eq!(find(&statements, "Scale", "").numbers, [-1.0, 1.0, 1.0]);
    let numbers = &find(&statements, "LookAt", "").numbers;
    let [eye, target, up] = [0, 3, 6].map(|at| DVec3::from_slice(&numbers[at..at + 3]));
    let right = -up.cross((target - eye).normalize()).normalize();
    assert!(right.distance(DVec3::X) < 1e-12, "{right}");
    // The control: a mirrored picture is not mirrored once more.
    let mut mirrored = scene(&format!("{RED}{POINT}"));
    mirrored.camera.stretch = -1.5;
    mirrored.camera.shift = [0.25, 0.5];
    let (statements, ..) = written(&mirrored);
    assert_eq!(find(&statements, "Scale", "").numbers, [1.0, 1.0, 1.0]);
    let window = find(&statements, "Camera", "perspective").numbers_of("screenwindow");
    assert_eq!(window, [-1.5 - 3.0, -1.5 + 3.0, 0.0, 2.0]);
}

/// pbrt-v4's spherical camera (cameras.cpp) looks along (sin θ cos φ, cos θ, sin θ sin φ), φ = 2πu, θ = πv, in the space that Rotate and LookAt lead to.
#[test]
fn panoramas_look_where_they_do_here() {
    let mut scene = scene(&format!("{RED}{POINT}"));
    scene.camera.look_at = DVec3::new(1.0, 0.5, -2.0);
    let model = Equirectangular::default();
    scene.camera.projection = Projection::Equirectangular(model);
    let (statements, report, _) = written(&scene);
    assert_eq!(reported(&report), Vec::<String>::new());
    assert_eq!(find(&statements, "Camera", "spherical").text_of("mapping"), Some("equirectangular"));
    let [degrees, axis @ ..] = &find(&statements, "Rotate", "").numbers[..] else { panic!("four numbers") };
    assert_eq!(axis, [0.0, 1.0, 0.0]);
    let numbers = &find(&statements, "LookAt", "").numbers;
    let [eye, target, up] = [0, 3, 6].map(|at| DVec3::from_slice(&numbers[at..at + 3]));
    let forward = (target - eye).normalize();
    let side = up.cross(forward).normalize();
    let of_world = DMat3::from_cols(side, forward.cross(side), forward).transpose();
    // Points go from the world to the camera: first LookAt, then Rotate.
    let to_camera = |degrees: f64| DMat3::from_rotation_y(degrees.to_radians()) * of_world;
    let [right, above, backward] = scene.camera.frame();
    let off = |degrees: f64| {
        let places = [[0.5, 0.5], [0.3, 0.2], [0.9, 0.7], [0.05, 0.4]].map(DVec2::from_array);
        let differences = places.map(|at| {
            let (phi, theta) = (std::f64::consts::TAU * at.x, std::f64::consts::PI * at.y);
            let theirs = DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
            let here = model.direction(&ViewPlace { tile: 0, at, size: DVec2::ONE }).expect("all is seen");
            (to_camera(degrees).transpose() * theirs).distance(right * here.x + above * here.y + backward * here.z)
        });
        differences.into_iter().fold(0.0, f64::max)
    };
    assert!(off(*degrees) < 1e-9, "{}", off(*degrees));
    assert!(off(-degrees) > 1.0 && off(0.0) > 1.0, "the control");
}

/// Cameras that pbrt has not are reported, and those that it has under another name are not.
#[test]
fn what_cameras_lose_is_reported() {
    let lost = |keys: &str| {
        let head = HEAD.replace("vfov = 40\n", keys);
        let scene =
            load_toml_str(&format!("{head}{RED}{POINT}"), "test.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}"));
        let (statements, report, _) = written(&scene);
        (reported(&report), find(&statements, "Film", "rgb").numbers_of("xresolution")[0])
    };
    let lens = "projection = \"brown_conrady\"\nfocal = [30, 30]\nprincipal_point = [22, 9]\n";
    assert_eq!(lost(lens), (vec![], 40.0));
    assert_eq!(lost(&format!("{lens}radial = [-0.1]\n")), (vec!["distortion of the lens".to_owned()], 40.0));
    assert_eq!(lost("projection = \"fisheye\"\nfov = 180\n"), (vec!["projection fisheye".to_owned()], 40.0));
    assert_eq!(
        lost("projection = \"equirectangular\"\nazimuth = [0, 90]\n"),
        (vec!["projection equirectangular".to_owned()], 40.0)
    );
    let stereo = "vfov = 40\nstereo = { layout = \"side_by_side\", eye_distance = 0.1 }\n";
    assert_eq!(lost(stereo), (vec!["stereo side_by_side".to_owned()], 20.0));
}

#[test]
fn lights_have_the_units_of_the_scene() {
    let lights = format!(
        "{POINT}[[light]]\ntype = \"spot\"\nposition = [0, 3, 0]\ndirection = [0, -1, 0]\nintensity = 4\nangle = 50\nfalloff = 35\n\
         [[light]]\ntype = \"directional\"\ndirection = [0, -2, 0]\nirradiance = [1, 2, 3]\n\
         [[light]]\ntype = \"environment\"\nradiance = [0.25, 0.5, 0.75]\n\
         [[material]]\nname = \"probe\"\ntype = \"emissive\"\nradiance = [5, 6, 7]\ntwo_sided = true\n{SPHERE}"
    );
    let (statements, report, _) = written(&scene(&lights));
    assert_eq!(reported(&report), Vec::<String>::new());
    assert_eq!(find(&statements, "LightSource", "point").numbers_of("I"), [9.0, 8.0, 7.0]);
    let spot = find(&statements, "LightSource", "spot");
    assert_eq!((spot.numbers_of("I"), spot.numbers_of("coneangle")), (vec![4.0; 3], vec![50.0]));
    assert_eq!((spot.numbers_of("to"), spot.numbers_of("conedeltaangle")), (vec![0.0, 2.0, 0.0], vec![15.0]));
    let distant = find(&statements, "LightSource", "distant");
    assert_eq!((distant.numbers_of("L"), distant.numbers_of("to")), (vec![1.0, 2.0, 3.0], vec![0.0, -1.0, 0.0]));
    assert_eq!(find(&statements, "LightSource", "infinite").numbers_of("L"), [0.25, 0.5, 0.75]);
    let area = find(&statements, "AreaLightSource", "diffuse");
    assert_eq!((area.numbers_of("L"), area.text_of("twosided")), (vec![5.0, 6.0, 7.0], Some("true")));
    // Nothing else scales them.
    assert!(
        statements
            .iter()
            .filter(|statement| statement.name.ends_with("LightSource"))
            .all(|light| { ["power", "scale", "illuminance"].into_iter().all(|name| light.parameter(name).is_none()) })
    );
    // The control: another curve is reported.
    let linear = lights.replace("falloff = 35\n", "falloff = 35\ncurve = \"linear\"\n");
    assert_eq!(reported(&written(&scene(&linear)).1), ["falloff of a spot light"]);
}

#[test]
fn widths_of_microfacets_are_not_remapped() {
    let rough = |keys: &str| {
        let (statements, report, _) = written(&scene(&format!("[[material]]\nname = \"probe\"\n{keys}\n{SPHERE}{POINT}")));
        (find(&statements, "MakeNamedMaterial", "probe").clone(), reported(&report))
    };
    let (glass, report) = rough("type = \"rough_glass\"\nior = 1.4\nroughness = 0.5");
    assert_eq!(
        (glass.text_of("type"), glass.numbers_of("roughness"), glass.numbers_of("eta")),
        (Some("dielectric"), vec![0.25], vec![1.4])
    );
    assert_eq!((glass.text_of("remaproughness"), report.len()), (Some("false"), 0));
    let (metal, _) = rough("type = \"conductor\"\npreset = \"gold\"\nalpha_u = 0.6\nalpha_v = 0.15");
    assert_eq!((metal.text_of("eta"), metal.text_of("k")), (Some("metal-Au-eta"), Some("metal-Au-k")));
    assert_eq!((metal.numbers_of("uroughness"), metal.numbers_of("vroughness")), (vec![0.6], vec![0.15]));
    let (metal, report) =
        rough("type = \"conductor\"\neta = [0.2, 0.9, 1.1]\nk = [3.9, 2.5, 2.1]\nalpha = 0.3\ndistribution = \"beckmann\"");
    assert_eq!((metal.numbers_of("eta"), metal.numbers_of("roughness")), (vec![0.2, 0.9, 1.1], vec![0.3]));
    assert!(report.contains(&"distribution of microfacets".to_owned()), "{report:?}");
    // The control: smooth glass has no widths.
    let (smooth, report) = rough("type = \"glass\"");
    assert!(smooth.parameter("roughness").is_none() && report.is_empty());
}

#[test]
fn blends_are_mixtures_and_openings() {
    let blend = |second: &str, value: f64| {
        format!(
            "{RED}[[material]]\nname = \"other\"\ntype = \"{second}\"\n[[material]]\nname = \"probe\"\ntype = \"blend\"\n\
             materials = [\"red\", \"other\"]\nweight = {{ type = \"constant\", value = {value} }}\n{SPHERE}{POINT}"
        )
    };
    let (statements, ..) = written(&scene(&blend("glass", 0.25)));
    // The amount is that of the second.
    let mix = find(&statements, "MakeNamedMaterial", "probe");
    assert_eq!(mix.numbers_of("amount"), [0.75]);
    assert_eq!(mix.parameter("materials").unwrap().values, ["red", "other"]);
    let (statements, ..) = written(&scene(&blend("pass", 0.25)));
    assert_eq!(find(&statements, "Shape", "sphere").numbers_of("alpha"), [0.25]);
    assert_eq!(find(&statements, "NamedMaterial", "red").texts, ["red"]);
    let (statements, ..) = written(&scene(&blend("pass", 1.0)));
    assert!(find(&statements, "Shape", "sphere").parameter("alpha").is_none(), "the control");
}

/// A lamp that is there by a share gives off that share of its light, by its alpha alone.
#[test]
fn light_of_openings_is_not_halved_twice() {
    let lamp = |second: &str| {
        let tables = format!(
            "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = [5, 6, 7]\n[[material]]\nname = \"other\"\ntype = \"{second}\"\n\
             [[material]]\nname = \"probe\"\ntype = \"blend\"\nmaterials = [\"lamp\", \"other\"]\nweight = {{ type = \"constant\", value = 0.25 }}\n{SPHERE}"
        );
        let statements = written(&scene(&tables)).0;
        let alpha = find(&statements, "Shape", "sphere").numbers_of("alpha");
        (find(&statements, "AreaLightSource", "diffuse").numbers_of("L"), alpha)
    };
    assert_eq!(lamp("pass"), (vec![5.0, 6.0, 7.0], vec![0.25]));
    assert_eq!(lamp("glass"), (vec![1.25, 1.5, 1.75], Vec::new()), "the control");
}

/// The map from a shape's space to the world as pbrt reads it.
fn map_of(statement: &Statement) -> DAffine3 {
    let columns: [f64; 16] = statement.numbers.clone().try_into().unwrap();
    let map = DMat4::from_cols_array(&columns);
    assert_eq!(map.row(3), DVec4::W);
    DAffine3::from_mat4(map)
}

/// Triangles face where the shape does, also behind a mirror; round shapes are not turned inside out.
#[test]
fn fronts_stay_fronts() {
    let placed = |keys: &str, transform: &str| {
        written(&scene(&format!("{RED}[[shape]]\n{keys}material = \"red\"\n{transform}\n{POINT}"))).0
    };
    let mirror = "transform = [{ scale = [-1, 1, 1] }, { translate = [0, 0, 5] }]";
    for (transform, x) in [("", 1.0), (mirror, -1.0)] {
        let statements = placed("type = \"rectangle\"\ncorner = [0, 0, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]\n", transform);
        let mesh = find(&statements, "Shape", "trianglemesh");
        let (at, indices) = (mesh.numbers_of("P"), mesh.numbers_of("indices"));
        let corner = |index: usize| DVec3::from_slice(&at[3 * indices[index] as usize..][..3]);
        let normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
        assert!(normal.z > 0.0, "{normal}");
        assert!((0..6).map(|index| corner(index).x * x).fold(0.0, f64::max) == 1.0);
    }
    let statements = placed("type = \"disk\"\ncenter = [1, 2, 3]\nnormal = [1, 1, 0]\nradius = 2\n", mirror);
    let map = map_of(find(&statements, "Transform", ""));
    assert!(map.matrix3.determinant() > 0.0 && map.translation == DVec3::new(-1.0, 2.0, 8.0));
    assert!(map.matrix3.z_axis.distance(DVec3::new(-1.0, 1.0, 0.0).normalize()) < 1e-12, "{map:?}");
    let statements = placed("type = \"cylinder\"\nfrom = [0, 0, 0]\nto = [0, 3, 0]\nradius = 0.5\n", mirror);
    let map = map_of(find(&statements, "Transform", ""));
    assert!((map.transform_point3(DVec3::Z * 3.0) - DVec3::new(0.0, 3.0, 5.0)).length() < 1e-12, "{map:?}");
    assert!(!statements.iter().any(|statement| statement.name == "ReverseOrientation"), "the control: nobody sees it");
}

/// A sphere's texture lies where it does here, by a map that mirrors it.
#[test]
fn textures_lie_on_spheres_as_they_do_here() {
    let tables = format!(
        "[[texture]]\nname = \"tiles\"\ntype = \"checker\"\na = 0.1\nb = 0.9\nscale = [3, 4]\n\
         [[material]]\nname = \"probe\"\ntype = \"diffuse\"\nreflectance = {{ texture = \"tiles\" }}\n{SPHERE}{POINT}"
    );
    let (statements, ..) = written(&scene(&tables));
    let texture = find(&statements, "Texture", "tiles");
    assert_eq!((texture.numbers_of("uscale"), texture.numbers_of("vscale")), (vec![3.0], vec![4.0]));
    let map = map_of(find(&statements, "Transform", ""));
    assert!(statements.iter().any(|statement| statement.name == "ReverseOrientation"));
    // There u is 0 along +x and a quarter along +y, and v is 1 along +z.
    let expected = DMat3::from_cols(DVec3::NEG_Z, DVec3::X, DVec3::Y);
    assert!((map.matrix3 - expected).to_cols_array().iter().all(|entry| entry.abs() < 1e-12), "{map:?}");
    // Without a texture no mirror is needed.
    let plain = written(&scene(&format!("{RED}{}{POINT}", SPHERE.replace("probe", "red")))).0;
    assert!(!plain.iter().any(|statement| statement.name == "ReverseOrientation"), "the control");
}

#[test]
fn media_are_on_both_sides_of_their_surfaces() {
    let tables = format!(
        "medium = \"fog\"\n[[medium]]\nname = \"fog\"\nabsorption = 0.25\nscattering = 0.5\nphase = {{ type = \"henyey_greenstein\", g = 0.5 }}\n\
         [[medium]]\nname = \"milk\"\nabsorption = [0, 1, 3]\nscattering = [4, 3, 2]\n\
         [[material]]\nname = \"probe\"\ntype = \"glass\"\ninterior = \"milk\"\n{SPHERE}{POINT}"
    );
    let (statements, report, _) = written(&scene(&tables));
    assert_eq!(reported(&report), Vec::<String>::new());
    let fog = find(&statements, "MakeNamedMedium", "fog");
    assert_eq!(
        (fog.numbers_of("sigma_a"), fog.numbers_of("sigma_s"), fog.numbers_of("g")),
        (vec![0.25; 3], vec![0.5; 3], vec![0.5])
    );
    let interfaces: Vec<_> = statements
        .iter()
        .filter(|statement| statement.name == "MediumInterface")
        .map(|statement| statement.texts.join("|"))
        .collect();
    // The camera, nothing for surfaces that bound no medium, the light, and the sphere.
    assert_eq!(interfaces, ["|fog", "|", "|fog", "milk|fog"]);
    find(&statements, "Integrator", "volpath");
    let clear = tables.replace("medium = \"fog\"\n", "").replace("interior = \"milk\"\n", "");
    let (statements, ..) = written(&scene(&clear));
    assert!(!statements.iter().any(|statement| statement.name == "MediumInterface"), "the control");
}

/// A grid lies in the box of its voxels, which a transform puts where it is here.
#[test]
fn grids_lie_where_they_do_here() {
    let tables = format!(
        "[[medium]]\nname = \"milk\"\nabsorption = 1\nscattering = [4, 3, 2]\n\
         [[material]]\nname = \"probe\"\ntype = \"pass\"\ninterior = \"milk\"\n{SPHERE}{POINT}"
    );
    let mut made = scene(&tables);
    let values: Vec<f32> = (0..2 * 3 * 4).map(|index| index as f32).collect();
    let grid = Arc::new(VoxelGrid::new([2, 3, 4], 1, values.clone()).unwrap());
    let density = Volume::in_box(grid, DVec3::new(-1.0, 0.0, 1.0), DVec3::new(1.0, 6.0, 2.0));
    let grids = GridsOfMedium { density, albedo: None, emission: None };
    made.media[0].grids = Some(MediumGrids::new(grids).into());
    let (statements, report, _) = written(&made);
    assert_eq!(reported(&report), ["border of the grid of a medium"]);
    let medium = find(&statements, "MakeNamedMedium", "milk");
    assert_eq!(medium.numbers_of("density"), values.iter().map(|value| f64::from(*value)).collect::<Vec<_>>());
    assert_eq!((medium.numbers_of("sigma_s"), medium.numbers_of("p1")), (vec![4.0, 3.0, 2.0], vec![2.0, 3.0, 4.0]));
    let map = map_of(find(&statements, "Transform", ""));
    let [low, high] = [DVec3::ZERO, DVec3::new(2.0, 3.0, 4.0)].map(|at| map.transform_point3(at));
    assert!(low.distance(DVec3::new(-1.0, 0.0, 1.0)) < 1e-12 && high.distance(DVec3::new(1.0, 6.0, 2.0)) < 1e-12);
    made.media[0].grids = None;
    let (statements, ..) = written(&made);
    assert_eq!(find(&statements, "MakeNamedMedium", "milk").text_of("type"), Some("homogeneous"), "the control");
}

#[test]
fn what_is_lost_is_named() {
    let lost = |tables: &str| reported(&written(&scene(tables)).1);
    let moving = format!("{RED}{}motion = [{{ translate = [1, 0, 0] }}]\n{POINT}", SPHERE.replace("probe", "red"));
    assert_eq!(lost(&moving), ["motion"]);
    assert_eq!(lost("[[light]]\ntype = \"sky\"\nzenith = 1\nhorizon = 0.5\nground = 0.1\n"), ["light `sky`"]);
    let plane = format!("{RED}[[shape]]\ntype = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"red\"\n{POINT}");
    assert_eq!(lost(&plane), ["shape `plane`"]);
    let film = format!("[[material]]\nname = \"probe\"\ntype = \"glass\"\nthin_film_thickness = 300\n{SPHERE}{POINT}");
    assert_eq!(lost(&film), ["thin film"]);
    assert_eq!(lost(&film.replace("thin_film_thickness = 300\n", "")), Vec::<String>::new(), "the control");
}
