//! Groups and instances in scene files: what they mean, what is refused, and what they take.

use std::path::Path;

use glam::DVec3;
use gpt::bench::scenes::{self, TREE_TRIANGLES};
use gpt::load::{self, SceneError};
use gpt::packed::PackedScene;
use gpt::packed::hierarchy::Traversal;
use gpt::plan::{DeviceLimits, Plan, PlanOptions, RayQueryLimits, TraversalChoice};
use gpt::scene::{Scene, SceneSummary};
use gpt::{DeviceChoice, Render, RenderOptions};

use crate::common::files::folder_with;

const GOOD: &str = r#"
[camera]
position = [0, 1, 6]
look_at = [0, 1, 0]
vfov = 40
[[texture]]
name = "checks"
type = "checker"
a = 0.2
b = 0.8
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.5
[[material]]
name = "checked"
type = "diffuse"
reflectance = { texture = "checks" }
[[material]]
name = "lamp"
type = "emissive"
radiance = 5
[[group]]
name = "tree"
[[group.shape]]
type = "mesh"
positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
faces = [[0, 1, 2]]
material = "white"
[[instance]]
group = "tree"
places = [[1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 1, 6], [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]]
transform = [{ scale = 2 }]
[[light]]
type = "environment"
radiance = 1
"#;

fn read(text: &str) -> Result<Scene, SceneError> {
    load::load_toml_str(text, "test.toml", Path::new(""))
}

fn complaint(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    let error = read(&GOOD.replacen(from, to, 1)).err().unwrap_or_else(|| panic!("no complaint about {to}"));
    format!("{error} [{}]", error.help_text().unwrap_or_default())
}

#[test]
fn places_come_before_the_transform() {
    let scene = read(GOOD).expect("it is right");
    let corners: Vec<DVec3> = scene.instances[0].maps().map(|map| map.transform_point3(DVec3::X)).collect();
    assert_eq!(corners, [DVec3::new(10.0, 10.0, 12.0), DVec3::new(-2.0, 0.0, 0.0)]);
    let summary = SceneSummary::of(&scene);
    assert_eq!((summary.groups, summary.group_triangles, summary.instances), (1, 1, 2));
    assert!(summary.to_string().contains("2 of 1 groups with 1 triangles"));
    let unseen = read(&GOOD.replace("group = \"tree\"\nplaces", "group = \"other\"\nplaces").replace(
        "[[instance]]",
        "[[group]]\nname = \"other\"\n[[group.shape]]\ntype = \"mesh\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\nmaterial = \"white\"\n[[instance]]",
    ));
    assert!(
        unseen.expect("it is right").warnings.iter().any(|warning| warning.contains("no [[instance]] names the group `tree`"))
    );
}

#[test]
fn mistakes_are_named_with_their_place() {
    let rows = [
        (
            "group = \"tree\"",
            "group = \"three\"",
            "test.toml:31:9: instance[0].group: there is no group named `three` [did you mean `tree`",
        ),
        ("group = \"tree\"\n", "", "missing"),
        ("places = [[1, 0, 0, 4,", "places = [[1, 0, 0,", "array"),
        ("places = [[1, 0, 0, 4,", "places = [[1e19, 0, 0, 4,", "expected a number of magnitude at most 1e18"),
        ("[-1, 0, 0, 0, 0, 1,", "[0, 0, 0, 0, 0, 1,", "number 1, counted from 0, flattens it"),
        ("transform = [{ scale = 2 }]", "transform = [{ scale = 0 }]", "flattens the shape"),
        ("transform = [{ scale = 2 }]", "material = \"checked\"", "needs uv coordinates"),
        ("transform = [{ scale = 2 }]", "material = \"gold\"", "there is no material named `gold`"),
        ("transform = [{ scale = 2 }]", "file = \"a.f32\"", "either `places` or `file`"),
        ("transform = [{ scale = 2 }]", "motion = [{ scale = -1 }]", "shrinks"),
        ("transform = [{ scale = 2 }]", "portal = true", "unknown key `portal`"),
        (
            "material = \"white\"\n[[instance",
            "material = \"white\"\nmotion = [{ scale = 2 }]\n[[instance",
            "a mesh of a group has no motion",
        ),
        ("faces = [[0, 1, 2]]", "faces = [[0, 1, 3]]", "group[0].shape[0].faces[0]: the face uses position 3"),
        (
            "type = \"mesh\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]",
            "type = \"sphere\"\ncenter = 0\nradius = 1",
            "center",
        ),
        (
            "type = \"mesh\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]",
            "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1",
            "a group consists of meshes, and this is a sphere",
        ),
        (
            "[[group]]\nname = \"tree\"",
            "[[group]]\nname = \"tree\"\nshape = []\n[[group]]\nname = \"tree\"",
            "a second group is named `tree`",
        ),
        (
            "[[group]]\nname = \"tree\"",
            "[[group]]\nname = \"bush\"\nshape = []\n[[group]]\nname = \"tree\"",
            "the group `bush` has no shapes",
        ),
    ];
    for (from, to, expected) in rows {
        let found = complaint(from, to);
        assert!(found.contains(expected), "{to}: {found}");
    }
}

/// Instances that give light are shapes, of the group's material or of their own, at any depth: what is written by hand shows the same.
#[test]
fn instances_that_give_light_stand_one_by_one() {
    let picture = |scene: &Scene| {
        let options =
            RenderOptions { device: DeviceChoice::Cpu, size: Some([16, 12]), samples: Some(4), ..RenderOptions::default() };
        let image = scene.render(&options).unwrap_or_else(|error| panic!("{error}"));
        image.pixels().iter().map(|pixel| pixel.map(f32::to_bits)).collect::<Vec<_>>()
    };
    let floor = "[[shape]]\ntype = \"rectangle\"\ncorner = [-9, -1, 9]\nedge_u = [18, 0, 0]\nedge_v = [0, 0, -18]\nmaterial = \"white\"\n";
    let by_hand = ["[1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 1, 6, 0, 0, 0, 1]", "[-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"].map(|place| {
        format!(
            "[[shape]]\ntype = \"mesh\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\nmaterial = \"lamp\"\n\
             transform = [{{ matrix = {place} }}, {{ scale = 2 }}]\n"
        )
    });
    let (before, after) = GOOD.split_once("[[group]]").expect("it has one");
    let light = after.split_once("[[light]]").expect("it has one").1.replace("radiance = 1", "radiance = 0.1");
    let hand = read(&format!("{before}{floor}{}[[light]]{light}", by_hand.concat())).expect("it is right");
    let dim = GOOD.replace("radiance = 1", "radiance = 0.1").replace("[[group]]", &format!("{floor}[[group]]"));
    let own = dim.replace("material = \"white\"\n[[instance", "material = \"lamp\"\n[[instance");
    let given = dim.replace("transform = [{ scale = 2 }]", "transform = [{ scale = 2 }]\nmaterial = \"lamp\"");
    let held =
        own.replace("[[instance]]\ngroup = \"tree\"", "[[group]]\nname = \"around\"\n[[group.instance]]\ngroup = \"tree\"");
    let held = held.replace("[[light]]", "[[instance]]\ngroup = \"around\"\n[[light]]");
    for text in [&own, &given, &held] {
        let scene = read(text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((scene.instances.len(), scene.shapes.len()), (0, 3));
        assert!(picture(&scene) == picture(&hand), "{text}");
    }
    // The control: what is of white gives none.
    let dark = read(&dim).expect("it is right");
    assert!(dark.instances.len() == 1 && picture(&dark) != picture(&hand));
}

/// Lamps that move are where the same instances are that give no light, at all times; so are those of turned and mirrored meshes, about a pivot.
#[test]
fn instances_that_give_light_move_as_others_do() {
    let turned = "material = \"white\"\ntransform = [{ scale = [-1, 2, 1] }, { translate = [3, 0, 1] }]\n[[instance";
    let motion = "motion = [{ scale = [1, 3, 1] }, { rotate = [1, 2, 0], degrees = 70 }, { translate = [1, 0, 2] }]";
    for pivot in ["", "\npivot = [5, 1, -2]"] {
        let text = GOOD
            .replace("material = \"white\"\n[[instance", turned)
            .replace("transform = [{ scale = 2 }]", &format!("transform = [{{ scale = 2 }}]\n{motion}{pivot}"));
        let dark = read(&text).unwrap_or_else(|error| panic!("{error}"));
        let lit =
            read(&text.replace(motion, &format!("{motion}\nmaterial = \"lamp\""))).unwrap_or_else(|error| panic!("{error}"));
        assert!(lit.instances.is_empty() && lit.shapes.len() == 2 && dark.shapes.is_empty());
        let (instances, mesh) = (&dark.instances[0], &dark.groups[0].shapes[0]);
        let steps = instances.motion.as_ref().expect("it moves");
        for (map, shape) in instances.maps().zip(&lit.shapes) {
            let fronts: Vec<[u32; 3]> = mesh.world_faces();
            for time in [0.0, 0.3, 1.0] {
                let moved = steps.at(time, instances.origin_of_motion(&map)) * map;
                let of_lamp = shape.moved_by(time).expect("it moves");
                for (expected, found) in mesh.world_positions().into_iter().zip(shape.world_positions()) {
                    let (expected, found) =
                        (moved.transform_point3(expected.as_dvec3()), of_lamp.transform_point3(found.as_dvec3()));
                    assert!((expected - found).length() < 1e-4, "{time}: {expected} and {found}");
                }
            }
            let mirrored = map.matrix3.determinant() < 0.0;
            let faces = fronts.iter().map(|&[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] });
            assert_eq!(shape.world_faces(), faces.collect::<Vec<_>>());
        }
    }
}

#[test]
fn files_of_places_are_read_and_mistakes_in_them_named() {
    let row = [1.0_f32, 0.0, 0.0, 4.0, 0.0, 1.0, 0.0, 5.0, 0.0, 0.0, 1.0, 6.0];
    let single: Vec<u8> = row.iter().flat_map(|number| number.to_le_bytes()).collect();
    let double: Vec<u8> = row.iter().flat_map(|&number| f64::from(number).to_le_bytes()).collect();
    let mut not_finite = single.clone();
    not_finite[..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let folder = folder_with(&[
        ("a.f32", &single),
        ("a.f64", &double),
        ("a.csv", b"1,0,0,4,0,1,0,5,0,0,1,6\n"),
        ("short.f32", &single[..47]),
        ("none.f32", b""),
        ("nan.f32", &not_finite),
        ("words.txt", b"1 0 0 one\n"),
        ("a.bin", &single),
    ]);
    let read = |file: &str| {
        let places = GOOD.find("places = ").expect("it has some");
        let end = places + GOOD[places..].find('\n').expect("a line ends");
        let text = format!("{}file = \"{file}\"{}", &GOOD[..places], &GOOD[end..]);
        std::fs::write(folder.path().join("scene.toml"), text).expect("it can be written");
        load::load(folder.path().join("scene.toml").to_str())
    };
    for file in ["a.f32", "a.f64", "a.csv"] {
        let scene = read(file).expect("it is right");
        assert_eq!(scene.instances[0].places[0].translation, DVec3::new(4.0, 5.0, 6.0), "{file}");
    }
    for (file, expected) in [
        ("short.f32", "no multiple of that"),
        ("none.f32", "it holds no places"),
        ("nan.f32", "found NaN in place 0"),
        ("words.txt", "line 1: `one` is no number"),
        ("a.bin", "a file of places ends in .f32, .f64, .csv or .txt"),
        ("missing.f32", "there is no file"),
    ] {
        let error = read(file).err().unwrap_or_else(|| panic!("no complaint about {file}"));
        assert!(error.to_string().contains(expected), "{file}: {error}");
    }
}

/// A wood of two trees and a leaf of its own, twice, in which the trees stand at places that are exact in binary.
const WOOD: &str = r#"
[[group]]
name = "wood"
[[group.shape]]
type = "mesh"
positions = [[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0]]
faces = [[0, 1, 2]]
material = "white"
[[group.instance]]
group = "tree"
places = [[1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 0], [0.5, 0, 0, -2, 0, 1, 0, 0, 0, 0, 1, 0]]
transform = [{ translate = [0, 0, 1] }]
[[group]]
name = "land"
[[group.instance]]
group = "wood"
transform = [{ scale = 2 }]
[[group.instance]]
group = "wood"
material = "white"
transform = [{ translate = [8, 0, 0] }]
[[instance]]
group = "land"
transform = [{ translate = [0, 4, 0] }]
"#;

/// The scene [`GOOD`] with a wood in place of the trees.
fn wood(change: impl Fn(&str) -> String) -> String {
    let trees = GOOD.find("[[instance]]").expect("it has some");
    let end = GOOD.find("[[light]]").expect("it has one");
    format!("{}{}{}", &GOOD[..trees], change(WOOD), &GOOD[end..])
}

#[test]
fn groups_within_groups_stand_where_all_of_them_put_them() {
    let scene = read(&wood(str::to_owned)).expect("it is right");
    let names: Vec<&str> = scene.groups.iter().map(|group| group.name.as_str()).collect();
    assert_eq!(names, ["tree", "wood"], "a group without meshes of its own is no group of the scene");
    assert_eq!(scene.instance_count(), 6);
    let at_origin = |of: &str, material: bool| -> Vec<[f64; 3]> {
        let entries =
            scene.instances.iter().filter(|entry| scene.groups[entry.group].name == of && entry.material.is_some() == material);
        entries.flat_map(|entry| entry.maps().map(|map| map.translation.to_array()).collect::<Vec<_>>()).collect()
    };
    assert_eq!(at_origin("wood", false), [[0.0, 4.0, 0.0]]);
    assert_eq!(at_origin("wood", true), [[8.0, 4.0, 0.0]]);
    assert_eq!(at_origin("tree", false), [[4.0, 4.0, 2.0], [-4.0, 4.0, 2.0]]);
    assert_eq!(at_origin("tree", true), [[10.0, 4.0, 1.0], [6.0, 4.0, 1.0]]);
    // Every group is seen: `tree` and `wood` by way of `land`.
    assert!(!scene.warnings.iter().any(|warning| warning.contains("not seen")), "{:?}", scene.warnings);
    let without = read(&wood(|wood| wood.replace("[[instance]]\ngroup = \"land\"", "[[instance]]\ngroup = \"tree\"")));
    let unseen = without.expect("it is right").warnings;
    assert!(
        ["wood", "land"].iter().all(|name| unseen.iter().any(|warning| warning.contains(&format!("`{name}`: it is not seen"))))
    );
    assert!(!unseen.iter().any(|warning| warning.contains("`tree`")));
}

#[test]
fn mistakes_within_groups_are_named_with_their_place() {
    let rows = [
        (
            "group = \"tree\"\nplaces",
            "group = \"wood\"\nplaces",
            "test.toml:39:9: group[1].instance[0].group: the group `wood` contains itself",
        ),
        (
            "group = \"tree\"\nplaces",
            "group = \"land\"\nplaces",
            "group[2].instance[0].group: the group `wood` contains itself: `wood` holds `land`, which holds `wood`",
        ),
        (
            "group = \"tree\"\nplaces",
            "group = \"three\"\nplaces",
            "test.toml:39:9: group[1].instance[0].group: there is no group named `three`",
        ),
        ("transform = [{ scale = 2 }]", "motion = [{ scale = 2 }]", "unknown key `motion`"),
        (
            "transform = [{ scale = 2 }]",
            "places = [[0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]]",
            "group[2].instance[0].group: the transform of number 0",
        ),
        (
            "material = \"white\"\ntransform",
            "material = \"checked\"\ntransform",
            "of `wood` within `land`: the material `checked` uses a texture",
        ),
        ("transform = [{ translate = [0, 4, 0] }]", "pivot = [0, 0, 0]", "`pivot` is what `motion` is about"),
    ];
    for (from, to, expected) in rows {
        assert!(WOOD.contains(from), "{from}");
        let error = read(&wood(|wood| wood.replacen(from, to, 1))).err().unwrap_or_else(|| panic!("no complaint about {to}"));
        assert!(error.to_string().contains(expected), "{to}: {error}");
    }
}

/// Thirty doublings are refused before any instance is made.
#[test]
fn a_billion_instances_in_thirty_lines_are_refused() {
    let doublings = |levels: usize| {
        let mut text = String::from("[[group]]\nname = \"g0\"\n[[group.instance]]\ngroup = \"tree\"\n");
        for level in 1..=levels {
            let inner = format!("[[group.instance]]\ngroup = \"g{}\"\n", level - 1);
            text += &format!("[[group]]\nname = \"g{level}\"\n{inner}{inner}transform = [{{ translate = [{level}, 0, 0] }}]\n");
        }
        wood(|_| format!("{text}[[instance]]\ngroup = \"g{levels}\"\n"))
    };
    assert_eq!(read(&doublings(8)).expect("it is right").instance_count(), 256);
    let error = read(&doublings(30)).expect_err("it is refused").to_string();
    assert!(error.contains("`g30` and what it holds make 1073741824 instances; at most 268435456 are possible"), "{error}");
    // The control: none of the places are instances where nothing names the group.
    assert!(read(&doublings(30).replace("group = \"g30\"", "group = \"g3\"")).is_ok());
}

/// A scene that is read and written again is the same scene.
#[test]
fn written_scenes_have_the_same_instances() {
    let moving = wood(|wood| format!("{wood}motion = [{{ rotate = [0, 1, 0], degrees = 20 }}]\n"));
    let scene = read(&moving).expect("it is right");
    assert!(scene.instances.iter().all(|entry| entry.pivot == Some(DVec3::new(0.0, 4.0, 0.0))));
    let folder = folder_with(&[]);
    let path = folder.path().join("written.toml");
    gpt::scene_writer::save_scene(&scene, &path).expect("it can be written");
    let again = load::load(path.to_str()).expect("it is right");
    let of = |scene: &Scene| -> Vec<(Vec<[f64; 3]>, Option<DVec3>)> {
        let maps = |entry: &gpt::scene::Instances| entry.maps().map(|map| map.translation.to_array()).collect();
        scene.instances.iter().map(|entry| (maps(entry), entry.pivot)).collect()
    };
    assert_eq!(of(&scene), of(&again));
}

/// A tree is stored once however often it stands: 96 bytes for an instance, 48 for its leaf, and its share of the nodes.
#[test]
fn memory_grows_by_instances_and_not_by_triangles() {
    let bytes = |trees: u32| {
        let scene = scenes::forest(trees).expect("it is right");
        let packed = PackedScene::new(&scene).expect("it packs");
        let plan = Plan::new(&scene, &packed, &DeviceLimits::default(), &PlanOptions::default()).expect("it fits");
        assert_eq!(packed.instances.len(), trees as usize);
        ["primitives", "hierarchy", "instances"].map(|array| plan.memory.bytes(array)).iter().sum::<u64>()
    };
    let (few, many) = (bytes(10), bytes(2_010));
    let each = (many - few) as f64 / 2_000.0;
    assert!((96.0 + 48.0..220.0).contains(&each), "{each} bytes for an instance");
    // The control: a tree by itself takes thousands of times as much.
    assert!(few > 48 * TREE_TRIANGLES as u64);
}

#[test]
fn ray_queries_are_refused_with_what_to_do() {
    let scene = read(GOOD).expect("it is right");
    let packed = PackedScene::for_traversal(&scene, Traversal::RayQuery).expect("it packs");
    let limits = DeviceLimits { ray_queries: Some(RayQueryLimits { max_primitives: 1 << 24 }), ..DeviceLimits::default() };
    let options = PlanOptions { traversal: TraversalChoice::RayQuery, ..PlanOptions::default() };
    let error = Plan::new(&scene, &packed, &limits, &options).expect_err("it is refused");
    assert!(error.to_string().contains("without `--traversal ray-query` it renders all the same"), "{error}");
}
