//! Profiles of lights: where scene files name them, what is wrong with them, and their ways into files of other programs and back.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use gpt::load::{LoadOptions, SceneError, load_with};
use gpt::scene::{AimedProfile, Light, PointLight, Scene};
use gpt::scene_writer::ExportFormat;
use serde_json::json;

const LAMP: &str = "IESNA:LM-63-2002\n[TEST] none\nTILT=NONE\n1 -1 1 4 3 1 2 0 0 0\n1 1 10\n0 30 60 90\n0 45 90\n100 80 40 0\n100 60 30 10\n100 20 50 5\n";

const ROOM: &str = r#"
[film]
size = [4, 4]
[camera]
position = [0, 1, 5]
look_at = [0, 0, 0]
vfov = 40
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.8
[[shape]]
type = "rectangle"
corner = [-9, 0, 9]
edge_u = [18, 0, 0]
edge_v = [0, 0, -18]
material = "white"
"#;

const POINT: &str =
    "[[light]]\ntype = \"point\"\nposition = [1, 3, 2]\nintensity = [0.5, 0.4, 0.3]\nprofile = \"lamps/lamp.ies\"\n";
const SPOT: &str = "[[light]]\ntype = \"spot\"\nposition = [0, 3, 0]\ndirection = [0.1, -1, 0]\nangle = 60\nintensity = 0.5\nprofile = \"lamps/lamp.ies\"\n";

/// A folder with a scene file and, in a folder of its own, a profile.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new(lights: &str, profile: &str) -> Self {
        let folder = Self(tempfile::tempdir().expect("a folder"));
        fs::create_dir(folder.path("lamps")).expect("a folder");
        fs::write(folder.path("lamps/lamp.ies"), profile).expect("it is written");
        fs::write(folder.path("room.toml"), format!("{ROOM}{lights}")).expect("it is written");
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn load(&self, name: &str, strict: bool) -> Result<Scene, SceneError> {
        let options = LoadOptions { strict, ..LoadOptions::default() };
        load_with(Some(OsStr::new(&self.path(name))), &options)
    }

    fn valid(&self, name: &str) -> Scene {
        self.load(name, false).unwrap_or_else(|error| panic!("{error}"))
    }

    /// The scene in the format of a file's ending, read again, and what the export says.
    fn exported(&self, name: &str) -> (Scene, String) {
        let target = self.path(name);
        let format = ExportFormat::of(Path::new(name)).expect("a format");
        let written = format.write(&self.valid("room.toml"), "room", &target).unwrap_or_else(|error| panic!("{error}"));
        let said = format!("{:?}", written.report);
        for (path, content) in written.files.into_iter().chain([(target, written.content)]) {
            fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            fs::write(path, content).expect("it is written");
        }
        (self.valid(name), said)
    }
}

fn complaint(lights: &str, profile: &str) -> String {
    match Folder::new(lights, profile).load("room.toml", false) {
        Ok(_) => panic!("no complaint about\n{lights}\n{profile}"),
        Err(error) => error.to_string(),
    }
}

fn aimed(scene: &Scene) -> &AimedProfile {
    scene.lights.iter().find_map(Light::profile).expect("a light with a profile")
}

fn point(scene: &Scene) -> &PointLight {
    let found = scene.lights.iter().find_map(|light| if let Light::Point(point) = light { Some(point) } else { None });
    found.expect("a point light")
}

/// Directions over the sphere, and none on an edge of the table.
fn directions() -> impl Iterator<Item = DVec3> {
    (0..400).map(|index| {
        let height = 1.0 - (f64::from(index) + 0.37) / 200.0;
        let turn = 2.399_963 * f64::from(index);
        DVec3::new((1.0 - height * height).sqrt() * turn.cos(), height, (1.0 - height * height).sqrt() * turn.sin())
    })
}

/// Largest difference of what two lights send anywhere, as a share of the brightest.
fn difference(a: &PointLight, b: &PointLight) -> f64 {
    let [a_at, b_at] = [a, b].map(|light| {
        let aimed = light.profile.as_ref().expect("a profile");
        move |direction: DVec3| light.intensity.r() * aimed.candela(direction)
    });
    let largest = directions().map(&a_at).fold(0.0, f64::max);
    directions().map(|direction| (a_at(direction) - b_at(direction)).abs()).fold(0.0, f64::max) / largest
}

#[test]
fn a_profile_lies_beside_the_scene_file() {
    let folder = Folder::new(&format!("{POINT}{SPOT}"), LAMP);
    let scene = folder.valid("room.toml");
    let [a, b] = [0, 1].map(|index| scene.lights[index].profile().expect("it has one"));
    // Both lights share one table.
    assert!(std::sync::Arc::ptr_eq(&a.profile, &b.profile));
    assert_eq!((a.nadir, a.profile.candela_at(30.0, 45.0)), (DVec3::NEG_Y, 60.0));
    assert_eq!(b.nadir, DVec3::new(0.1, -1.0, 0.0).normalize());
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert_eq!(scene.sources.paths().collect::<Vec<_>>(), [folder.path("lamps/lamp.ies")]);
}

#[test]
fn mistakes_have_a_place() {
    for (lights, profile, said) in [
        (POINT, LAMP.replace("0 30 60 90", "0 30 x 90"), "lamp.ies:6:1: expected vertical angle 3 of 4, found `x`"),
        (POINT, LAMP.replace("4 3 1 2", "4 3 2 2"), "lamp.ies:4:1: its photometry is of type B"),
        (POINT, String::new(), "lamp.ies:1:1: there is no line `TILT=NONE`"),
        (&POINT.replace("lamp.ies", "other.ies"), LAMP.to_owned(), "light[0].profile: "),
        (
            &POINT.replace("profile", "front = [0, 1, 0]\nprofile"),
            LAMP.to_owned(),
            "light[0].front: `front` is zero or lies along",
        ),
        (&POINT.replace("profile = \"lamps/lamp.ies\"", "direction = [0, -1, 0]"), LAMP.to_owned(), "belong to `profile`"),
        (&SPOT.replace("profile = \"lamps/lamp.ies\"", "front = [0, 0, 1]"), LAMP.to_owned(), "`front` belongs to `profile`"),
        (&POINT.replace("\"lamps/lamp.ies\"", "7"), LAMP.to_owned(), "a photometric file (.ies) or {"),
        (
            &POINT.replace("\"lamps/lamp.ies\"", "{ vertical = [0, 90], candela = [[1, 2, 3]] }"),
            LAMP.to_owned(),
            "light[0].profile.candela: `candela` has a list for each horizontal angle (1), each with a number for each vertical one (2)",
        ),
        (
            &POINT.replace("\"lamps/lamp.ies\"", "{ vertical = [90, 0], candela = [[1, 2]] }"),
            LAMP.to_owned(),
            "light[0].profile.vertical: the vertical angle 0 comes behind 90",
        ),
        // All of the light goes up.
        (
            &SPOT.replace("\"lamps/lamp.ies\"", "{ vertical = [90, 180], candela = [[1, 2]] }"),
            LAMP.to_owned(),
            "its profile gives no light within 60 degrees",
        ),
    ] {
        let found = complaint(lights, &profile);
        assert!(found.contains(said), "{lights}: {found}");
    }
    // The control: as it stands, it is read.
    assert_eq!(Folder::new(POINT, LAMP).valid("room.toml").lights.len(), 1);
}

#[test]
fn what_is_not_used_of_a_file_is_said() {
    let folder = Folder::new(POINT, &LAMP.replace("TILT=NONE", "TILT=other.tlt"));
    let said = folder.valid("room.toml").warnings.join("\n");
    assert!(said.contains("lamp.ies:3:1: how its light changes with the tilt"), "{said}");
    let error = folder.load("room.toml", true).map(|_| ()).expect_err("strict");
    assert!(error.to_string().contains("tilt"), "{error}");
}

#[test]
fn a_written_scene_has_the_same_lights() {
    for (lights, named) in [
        (format!("{POINT}direction = [0.2, -1, 0.3]\nfront = [0, 0.1, 1]\n"), true),
        (format!("{SPOT}front = [0, 0, -2]\n"), true),
        (POINT.replace("\"lamps/lamp.ies\"", "{ vertical = [0, 50, 90], candela = [[3, 2, 1]] }"), false),
    ] {
        let folder = Folder::new(&lights, LAMP);
        let scene = folder.valid("room.toml");
        let target = folder.path("elsewhere.toml");
        gpt::scene_writer::save_scene(&scene, &target).unwrap_or_else(|error| panic!("{error}"));
        let text = fs::read_to_string(&target).expect("it is written");
        assert_eq!(text.contains("profile = \"lamps/lamp.ies\""), named, "{text}");
        let again = folder.valid("elsewhere.toml");
        assert_eq!(aimed(&again).profile, aimed(&scene).profile);
        let apart = aimed(&again).axes().into_iter().zip(aimed(&scene).axes()).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        assert!(apart < 1e-15, "{apart}");
    }
}

#[test]
fn gltf_keeps_a_point_with_a_profile() {
    let folder = Folder::new(&format!("{POINT}direction = [0.2, -1, 0.3]\nfront = [0, 0.1, 1]\n"), LAMP);
    let scene = folder.valid("room.toml");
    for name in ["out.gltf", "out.glb"] {
        let (again, said) = folder.exported(name);
        assert!(!said.contains("profile"), "{said}");
        assert_eq!(point(&again).position, point(&scene).position);
        assert!(point(&again).intensity.distance(point(&scene).intensity) < 1e-12);
        let off = difference(point(&again), point(&scene));
        assert!(off < 1e-9, "{name}: {off}");
    }
    // The control: turned about nadir, it differs.
    let turned = Folder::new(&format!("{POINT}direction = [0.2, -1, 0.3]\nfront = [1, 0.1, 1]\n"), LAMP).valid("room.toml");
    assert!(difference(point(&turned), point(&scene)) > 0.05);
}

/// Lights of EXT_lights_ies: where one of an untransformed node shines, its factor and colour, files beside and within, and what is wrong.
#[test]
fn gltf_lights_shine_along_their_nodes() {
    let folder = Folder::new("", LAMP);
    let data = LAMP.bytes().map(|byte| format!("%{byte:02x}")).collect::<String>();
    let load = |light: serde_json::Value, node: serde_json::Value| {
        let root = json!({
            "asset": { "version": "2.0" },
            "extensionsUsed": ["EXT_lights_ies"],
            "extensions": { "EXT_lights_ies": { "lights": [light] } },
            "nodes": [{ "translation": [1, 2, 3], "extensions": { "EXT_lights_ies": node } }, { "mesh": 0 }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
            "accessors": [{ "componentType": 5126, "type": "VEC3", "count": 3, "bufferView": 0, "min": [0, 0, 0], "max": [1, 1, 0] }],
            "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
            "buffers": [{ "byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" }],
        });
        fs::write(folder.path("a.gltf"), root.to_string()).expect("it is written");
        folder.load("a.gltf", false)
    };
    let beside = json!({ "uri": "lamps/lamp.ies" });
    let scene = load(beside.clone(), json!({ "light": 0, "multiplier": 2.0, "color": [1.0, 0.5, 0.25] })).expect("it is read");
    let light = point(&scene);
    assert_eq!((light.position, light.intensity.to_rgb()), (DVec3::new(1.0, 2.0, 3.0), [2.0, 1.0, 0.5]));
    // Nadir is -Z; horizontal angle 0 lies on the side of +X, and 90 on that of +Y.
    let aimed = light.profile.as_ref().expect("a profile");
    let towards = |horizontal: f64| DVec3::new(0.5 * horizontal.cos(), 0.5 * horizontal.sin(), -(0.75_f64.sqrt()));
    let found = [0.0, 45.0_f64.to_radians(), 90.0_f64.to_radians()].map(|turn| aimed.candela(towards(turn)).round());
    assert_eq!((aimed.candela(DVec3::NEG_Z), found), (100.0, [80.0, 60.0, 20.0]));
    let within = load(json!({ "uri": format!("data:application/x-ies-lm-63,{data}") }), json!({ "light": 0 }));
    assert_eq!(point(&within.expect("it is read")).profile.as_ref().map(|aimed| &aimed.profile), Some(&aimed.profile));
    for (light, node, said) in [
        (beside.clone(), json!({}), "it names no light"),
        (beside.clone(), json!({ "light": 3 }), "there is no EXT_lights_ies.lights[3]"),
        (beside.clone(), json!({ "light": 0, "color": "red" }), "its color is not three numbers"),
        (json!({}), json!({ "light": 0 }), "it names no file and no bufferView"),
        (json!({ "uri": "none.ies" }), json!({ "light": 0 }), "none.ies"),
        (json!({ "uri": "a.gltf" }), json!({ "light": 0 }), "no photometric file"),
    ] {
        let error = load(light, node).map(|_| ()).expect_err(said).to_string();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn pbrt_has_it_as_a_map_of_all_directions() {
    let folder = Folder::new(&format!("{POINT}direction = [0.2, -1, 0.3]\nfront = [0, 0.1, 1]\n"), LAMP);
    let scene = folder.valid("room.toml");
    let (again, said) = folder.exported("out.pbrt");
    assert!(said.contains("profile of a light"), "{said}");
    assert!(point(&again).position.distance(point(&scene).position) < 1e-12);
    // A map of 256 × 256 texels, and a table every 2 degrees of that.
    let off = difference(point(&again), point(&scene));
    assert!(off < 0.05, "{off}");
    let turned = Folder::new(&format!("{POINT}direction = [0.2, -1, 0.3]\nfront = [1, 0.1, 0]\n"), LAMP).valid("room.toml");
    assert!(difference(point(&turned), point(&scene)) > 0.2, "the control");
}

#[test]
fn where_there_are_no_profiles_lights_are_as_strong_without() {
    let power = |scene: &Scene| match scene.lights[0].delta().expect("a point").strength {
        gpt::scene::LightStrength::Power(power) => power,
        other => panic!("{other:?}"),
    };
    // Mitsuba's spots fall off by angle, as this one does.
    for (lights, name) in [
        (POINT.to_owned(), "out.xml"),
        (format!("{SPOT}falloff = 20\ncurve = \"linear\"\n"), "out.xml"),
        (format!("{SPOT}falloff = 20\ncurve = \"square\"\n"), "out.gltf"),
        (format!("{SPOT}falloff = 20\n"), "out.pbrt"),
    ] {
        let folder = Folder::new(&lights, LAMP);
        let (again, said) = folder.exported(name);
        assert!(said.contains("profile"), "{said}");
        assert!(again.lights[0].profile().is_none());
        let [before, after] = [power(&folder.valid("room.toml")), power(&again)];
        assert!((after / before - 1.0).abs() < 1e-3, "{name}: {before} and {after}");
        // The control: the intensity alone would be a hundred times too little.
        assert!(before > 5.0, "{before}");
    }
}
