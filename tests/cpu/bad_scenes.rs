//! Scenes that are wrong: each is one error that names the file, the line, the key and what would be right.

use std::path::Path;
use std::sync::LazyLock;

use crate::common::files::{TRIANGLE, folder_with, png_bytes};
use crate::common::sphere::grey_sphere;
use gpt::load;
use gpt::load::SceneError;
use gpt::scene::settings::SETTINGS;

/// A scene that is right, to put mistakes into.
static GOOD: LazyLock<String> =
    LazyLock::new(|| grey_sphere("[film]\nsize = [4, 4]\n[render]\nspp = 1", "type = \"environment\"\nradiance = 1"));

fn error_of(text: &str) -> SceneError {
    match load::load_toml_str(text, "test.toml", std::path::Path::new("")) {
        Ok(_) => panic!("no complaint about\n{text}"),
        Err(error) => error,
    }
}

/// The error's text and help, for the good scene with one piece of text replaced.
fn complaint(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from} is not in the good scene");
    show(&error_of(&GOOD.replacen(from, to, 1)))
}

fn show(error: &SceneError) -> String {
    match error.help_text() {
        Some(help) => format!("{error} [{help}]"),
        None => error.to_string(),
    }
}

#[test]
fn the_good_scene_is_good() {
    assert!(load::load_toml_str(&GOOD, "test.toml", std::path::Path::new("")).is_ok());
}

/// The types that the schema has for these entries, in its order.
fn types_of(entries: &str) -> String {
    let schema: serde_json::Value = serde_json::from_str(load::json_schema()).expect("the schema is JSON");
    let choices = schema["$defs"][entries]["oneOf"].as_array().cloned().unwrap_or_default();
    let names = choices.iter().filter_map(|choice| choice["properties"]["type"]["const"].as_str());
    names.collect::<Vec<_>>().join(", ")
}

/// Each row: what is replaced by what, and the complaint.
#[test]
fn mistakes_are_named_with_their_place_and_the_valid_choices() {
    let [materials, shapes] = [types_of("MaterialEntry"), types_of("ShapeEntry")];
    let of_materials = format!(
        "test.toml:12:8: material[0].type: `diffusse` is not a valid choice [did you mean `diffuse`? valid choices: {materials}]"
    );
    let of_shapes = format!("test.toml:14:1: shape[0]: the key `type` is missing [valid choices: {shapes}]");
    assert!(materials.starts_with("diffuse, mirror, ") && shapes.starts_with("mesh, sphere, "), "{materials}; {shapes}");
    let rows: &[(&str, &str, &str)] = &[
        // Not TOML.
        ("[film]", "[film", "test.toml:2:6: unclosed table, expected `]`"),
        // Unknown keys, types, names.
        (
            "reflectance = 0.5",
            "reflectence = 0.5",
            "test.toml:13:1: material[0].reflectence: unknown key `reflectence` [did you mean `reflectance`? valid choices: name, \
             reflectance, normal_map, normal_scale, bump_map, bump_scale, normal_shadowing, normal_mirroring, emission, emission_two_sided, opacity, two_sided]",
        ),
        ("type = \"diffuse\"", "type = \"diffusse\"", &of_materials),
        ("type = \"sphere\"", "", &of_shapes),
        (
            "material = \"grey\"",
            "material = \"gray\"",
            "test.toml:18:12: shape[0].material: there is no material named `gray` [did you mean `grey`? valid choices: grey]",
        ),
        ("material = \"grey\"", "", "test.toml:14:1: shape[0]: the key `material` is missing"),
        ("vfov = 40", "", "test.toml:8:11: camera.look_at: the camera needs the key `vfov`"),
        ("radius = 1", "", "test.toml:14:1: shape[0]: the key `radius` is missing"),
        ("spp = 1", "spp = 1\nspp = 2", "test.toml:6:1: duplicate key `spp`"),
        (
            "reflectance = 0.5",
            "reflectance = 0.5\nbump_map = \"c\"\n[[texture]]\nname = \"c\"\ntype = \"checker\"\na = 0\nb = 1",
            "test.toml:14:12: material[0].bump_map: the checker `c` rises in steps, and has no slopes for a bump map: take an image or noise",
        ),
        // Wrong types.
        ("[film]", "texture = { type = \"checker\" }\n[film]", "test.toml:2:11: texture: invalid type: table, expected an array"),
        (
            "spp = 1",
            "spp = \"many\"",
            "test.toml:5:7: render.spp: invalid type: string \"many\", expected a whole number of at least 1",
        ),
        ("spp = 1", "spp = 1.5", "test.toml:5:7: render.spp: invalid type: number `1.5`, expected a whole number of at least 1"),
        ("radius = 1", "radius = [1]", "test.toml:17:10: shape[0].radius: invalid type: array, expected a number above 0"),
        (
            "reflectance = 0.5",
            "reflectance = [0.5, 0.5]",
            "test.toml:13:15: material[0].reflectance: wrong number of values: 2, expected 3 numbers, [r, g, b]",
        ),
        (
            "position = [0, 0, 4]",
            "position = [0, 0]",
            "test.toml:7:12: camera.position: wrong number of values: 2, expected an array of length 3",
        ),
        ("[film]\nsize = [4, 4]", "film = 3", "test.toml:2:8: film: invalid type: integer `3`, expected a table"),
        ("size = [4, 4]", "filter = \"box\"", "test.toml:3:10: film.filter: expected a table with the key `type`, found string"),
        (
            "spp = 1",
            "estimator = 3",
            "test.toml:5:13: render.estimator: invalid type: integer `3`, expected one of mis, nee, bsdf",
        ),
        ("spp = 1", "seed = [1]", "test.toml:5:8: render.seed: invalid type: array, expected a whole number of at least 0"),
        (
            "[film]\nsize = [4, 4]\n[render]\nspp = 1",
            "render = 3",
            "test.toml:2:10: render: invalid type: integer `3`, expected a table",
        ),
        // Ranges.
        ("spp = 1", "spp = 0", "test.toml:5:7: render.spp: invalid value: integer `0`, expected a whole number of at least 1"),
        ("spp = 1", "spp = -1", "test.toml:5:7: render.spp: invalid value: integer `-1`, expected a whole number of at least 1"),
        (
            "spp = 1",
            "spp = 4000000000",
            "test.toml:5:7: render.spp: invalid value: integer `4000000000`, expected a whole number of at most 2147483647",
        ),
        (
            "spp = 1",
            "max_depth = -1",
            "test.toml:5:13: render.max_depth: invalid value: integer `-1`, expected a whole number of at least 0",
        ),
        (
            "spp = 1",
            "light_samples = 17",
            "test.toml:5:17: render.light_samples: invalid value: integer `17`, expected a whole number from 1 to 16",
        ),
        (
            "spp = 1",
            "light_samples_depth = 4",
            "test.toml:5:23: render.light_samples_depth: invalid value: integer `4`, expected a whole number from 1 to 3",
        ),
        (
            "size = [4, 4]",
            "size = [0, 0]",
            "test.toml:3:9: film.size[0]: invalid value: integer `0`, expected a whole number of at least 1",
        ),
        (
            "size = [4, 4]",
            "size = [100000, 1]",
            "test.toml:3:8: film.size: a picture of 100000 x 1 pixels is too large [at most 32768 pixels on a side and 268435456 in all]",
        ),
        ("radius = 1", "radius = 0", "test.toml:17:10: shape[0].radius: expected a number above 0, found 0"),
        ("radius = 1", "radius = -1", "test.toml:17:10: shape[0].radius: expected a number above 0, found -1"),
        ("radius = 1", "radius = nan", "test.toml:17:10: shape[0].radius: expected a number above 0, found NaN"),
        ("radius = 1", "radius = inf", "test.toml:17:10: shape[0].radius: expected a number above 0, found inf"),
        ("radius = 1", "radius = 1e999", "test.toml:17:10: shape[0].radius: the number is too large"),
        (
            "center = [0, 0, 0]",
            "center = [0, nan, 0]",
            "test.toml:16:14: shape[0].center[1]: expected a number of magnitude at most 1e18, found NaN",
        ),
        (
            "reflectance = 0.5",
            "reflectance = 1.5",
            "test.toml:13:15: material[0].reflectance: expected a number from 0 to 1, found 1.5",
        ),
        (
            "reflectance = 0.5",
            "reflectance = [0.5, 0.5, -0.1]",
            "test.toml:13:26: material[0].reflectance[2]: expected a number from 0 to 1, found -0.1",
        ),
        ("radiance = 1", "radiance = -1", "test.toml:21:12: light[0].radiance: expected a number from 0 to 1e18, found -1"),
        ("vfov = 40", "vfov = 180", "test.toml:9:8: camera.vfov: expected an angle from 0.001 to 179 (degrees), found 180"),
        (
            "spp = 1",
            "max_depth = 0\nroulette_depth = 0",
            "test.toml:6:18: render.roulette_depth: with max_depth = 0 and roulette_depth = 0 paths would never end [bound max_depth, \
             or let Russian roulette end paths]",
        ),
        // The film and the camera.
        (
            "size = [4, 4]",
            "filter = { type = \"tent\", radius = 0 }",
            "test.toml:3:36: film.filter.radius: expected a number from 0.5 to 16 (pixels), found 0",
        ),
        (
            "size = [4, 4]",
            "filter = { type = \"gaussian\", radius = -1 }",
            "test.toml:3:40: film.filter.radius: expected a number from 0.5 to 16 (pixels), found -1",
        ),
        (
            "spp = 1",
            "pixel_sampler = \"nothing\"",
            "test.toml:5:17: render.pixel_sampler: `nothing` is not a valid choice [valid choices: independent, stratified, quadrant, halton, sobol, none, same]",
        ),
        (
            "spp = 1",
            "blend = \"mixtur\"",
            "test.toml:5:9: render.blend: `mixtur` is not a valid choice [did you mean `mixture`? valid choices: mixture, pick]",
        ),
        ("vfov = 40", "vfov = 40\nshutter = [1, 0.5]", "test.toml:10:11: camera.shutter: the shutter closes before it opens"),
        (
            "vfov = 40",
            "vfov = 40\nfocus_distance = 0",
            "test.toml:10:18: camera.focus_distance: expected a number above 0, found 0",
        ),
        (
            "vfov = 40",
            "vfov = 40\nfocus_distance = -2",
            "test.toml:10:18: camera.focus_distance: expected a number above 0, found -2",
        ),
        (
            "vfov = 40",
            "vfov = 40\naperture = { shape = \"disk\", radius = 0.1 }",
            "test.toml:10:12: camera.aperture: an aperture needs the key `focus_distance`",
        ),
        (
            "vfov = 40",
            "vfov = 40\nfocus_distance = 1\naperture = { shape = \"disk\", radius = -0.1 }",
            "test.toml:11:39: camera.aperture.radius: expected a number from 0 to 1e18, found -0.1",
        ),
        (
            "vfov = 40",
            "vfov = 40\nfocus_distance = 1\naperture = { shape = \"polygon\", radius = 0.1, blades = 2 }",
            "test.toml:11:56: camera.aperture.blades: an aperture has 3 to 64 blades",
        ),
        (
            "vfov = 40",
            "vfov = 40\nfocus_distance = 1\naperture = { shape = \"star\", radius = 0.1 }",
            "test.toml:11:22: camera.aperture.shape: `star` is not a valid choice [valid choices: disk, square, polygon]",
        ),
        (
            "vfov = 40",
            "vfov = 40\nprojection = \"orthographic\"",
            "test.toml:9:8: camera.vfov: `vfov` belongs to projection = \"perspective\"",
        ),
        ("vfov = 40", "projection = \"orthographic\"", "test.toml:8:11: camera.look_at: the camera needs the key `height`"),
        (
            "vfov = 40",
            "projection = \"orthographic\"\nheight = 0",
            "test.toml:10:10: camera.height: expected a number above 0, found 0",
        ),
        // Geometry without meaning.
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
        // Files.
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
    ];
    let complaints: Vec<String> = rows.iter().map(|(from, to, _)| complaint(from, to)).collect();
    let expected: Vec<&str> = rows.iter().map(|(_, _, expected)| *expected).collect();
    let different = complaints.iter().zip(&expected).filter(|(found, expected)| found != *expected);
    let report: Vec<String> = different.map(|(found, expected)| format!("found    {found}\nexpected {expected}")).collect();
    assert!(report.is_empty(), "\n{}", report.join("\n"));
}

#[test]
fn an_unknown_setting_is_answered_with_all_settings() {
    let names: Vec<&str> = SETTINGS.iter().map(|setting| setting.name).collect();
    let expected = format!(
        "test.toml:5:1: render.samples: unknown key `samples` [did you mean `sampler`? valid choices: {}]",
        names.join(", ")
    );
    assert_eq!(complaint("spp = 1", "samples = 1"), expected);
}

/// Lists of values would be read in the order of the keys, and a schema refuses them.
#[test]
fn lists_in_the_place_of_tables_are_refused() {
    for (table, list) in [("animation", "[24]"), ("film", "[[4, 4]]"), ("output", "[]"), ("render", "[4]")] {
        let text = GOOD.replace("[film]\nsize = [4, 4]\n[render]\nspp = 1\n", "");
        let found = error_of(&format!("{table} = {list}\n{text}")).to_string();
        assert!(found.starts_with("test.toml:1:") && found.contains("expected a table"), "{table}: {found}");
    }
    for (from, to) in [
        ("radius = 1", "radius = 1\ntransform = [[2.0]]"),
        ("radius = 1", "radius = 1\nmotion = [[[1, 1, 1]]]"),
        ("radius = 1", "radius = 1\nkeyframes = [[1, [0, 0, 0]]]"),
        ("[film]", "node = [[\"arm\"]]\n[film]"),
        ("[film]", "instance = [[\"group\"]]\n[film]"),
        ("[film]", "group = [[\"group\"]]\n[film]"),
        ("[film]", "import = [[\"a.glb\"]]\n[film]"),
    ] {
        let found = complaint(from, to);
        assert!(found.contains("expected a table"), "{to}: {found}");
    }
}

/// Numbers that are possible one by one, and lead out of the range of numbers together.
#[test]
fn what_ends_beyond_the_range_of_numbers_is_refused() {
    let far = "it reaches farther than 1e18 units from the origin";
    let transform = "transform = [{ scale = 1e10 }, { translate = [1e17, 0, 0] }, { scale = 1e3 }]";
    let moving = "transform = { scale = 5e17 }\nmotion = [{ translate = [6e17, 0, 0] }]";
    for (keys, column) in [(transform, 13), (moving, 10)] {
        let line = 18 + keys.matches('\n').count();
        let found = complaint("radius = 1", &format!("radius = 1\n{keys}"));
        assert!(found.contains(&format!("test.toml:{line}:{column}: ")) && found.contains(far), "{keys}: {found}");
    }
    let near = GOOD.replace("radius = 1", &format!("radius = 1\n{}", transform.replace("1e17", "1e14")));
    assert!(load::load_toml_str(&near, "test.toml", std::path::Path::new("")).is_ok());
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

#[test]
fn blends_that_contain_themselves_are_refused() {
    let text = GOOD.replace(
        "type = \"diffuse\"\nreflectance = 0.5",
        "type = \"blend\"\nmaterials = [\"grey\", \"grey\"]\nweight = { type = \"constant\", value = 0.5 }",
    );
    assert!(error_of(&text).message().contains("the blend `grey` contains itself"));
}

#[test]
fn a_scene_without_light_is_refused() {
    let dark = GOOD.split("[[light]]").next().unwrap_or_default();
    let error = error_of(dark);
    assert_eq!(error.to_string(), "test.toml: nothing in the scene gives light, so the picture would be black");
    assert!(error.help_text().is_some_and(|help| help.contains("[[light]]") && help.contains("emissive")));
    // An emissive material that no shape uses lights nothing.
    let unused = format!("{dark}[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 1\n");
    assert_eq!(error_of(&unused).to_string(), error.to_string());
    assert!(load::load_toml_str(&unused.replace("material = \"grey\"", "material = \"lamp\""), "test.toml", "".as_ref()).is_ok());
}

#[test]
fn the_error_holds_the_text_and_the_place_in_it() {
    let text = GOOD.replace("radius = 1", "radius = -1");
    let error = error_of(&text);
    assert_eq!((error.file(), error.line(), error.column()), ("test.toml", Some(17), Some(10)));
    let excerpt = error.excerpt().expect("the mistake is in the text");
    let line = excerpt.text.lines().nth(17 - excerpt.first_line).expect("it is among the lines");
    assert_eq!((line, &excerpt.text[excerpt.span.clone()]), ("radius = -1", "-1"));
}

#[test]
fn sources_that_are_not_there_are_named() {
    let complaint = |name: &str| load::load(Some(name)).map(|_| ()).map_err(|error| show(&error)).unwrap_err();
    assert!(complaint("absent.toml").starts_with("absent.toml: cannot be read: No such file"));
    assert!(complaint("absent.obj").starts_with("absent.obj: cannot be read: No such file"));
    let misspelt = complaint("cornel");
    assert!(
        misspelt.contains("cornel: is no built-in scene [did you mean `cornell`? valid choices: cornell, spheres"),
        "{misspelt}"
    );
    assert!(complaint("Cargo.lock").contains("is neither a scene file nor a model"));
}

#[test]
fn bad_models_name_file_and_line() {
    let positions = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let rows = [
        ("f 1 2 4", "bad.obj:4:1: the face uses position 4, but there are only 3"),
        ("f -1 -2 -4", "bad.obj:4:1: the face uses position -4, but there are only 3"),
        ("f 0 1 2", "bad.obj:4:1: indices count from 1, or back from -1; found 0"),
        ("f 1/1 2/1 3/1", "bad.obj:4:1: the face uses uv coordinate 1, but there are only 0"),
        ("f 1 2 x", "bad.obj:4:1: `x` is not an index"),
        ("v nan 0 0\nf 1 2 3", "bad.obj:4:1: the position has the coordinate nan"),
        ("v 1 2\nf 1 2 3", "bad.obj:4:1: a position has 4 numbers, found 2"),
        ("", "bad.obj: there is nothing to render in the model: it has no faces"),
        ("f 1 2 2", "bad.obj: there is nothing to render in the model: none of its faces has an area"),
    ];
    for (rest, expected) in rows {
        let folder = folder_with(&[("bad.obj", format!("{positions}{rest}\n").as_bytes())]);
        let error = load::load(folder.path().join("bad.obj").to_str()).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn bad_textures_name_the_key() {
    let folder = folder_with(&[
        ("plain.obj", TRIANGLE.as_bytes()),
        ("uv.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"),
        ("good.png", &png_bytes([255, 0, 0])),
        ("notes.png", b"these are not pixels"),
        ("cut.png", &png_bytes([255, 0, 0])[..40]),
    ]);
    let load = |file: &str, mesh: &str| {
        let texture =
            format!("reflectance = {{ texture = \"t\" }}\n[[texture]]\nname = \"t\"\ntype = \"image\"\nfile = \"{file}\"");
        let text = GOOD
            .replace("reflectance = 0.5", &texture)
            .replace("type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1", &format!("type = \"mesh\"\nfile = \"{mesh}\""));
        load::load_toml_str(&text, "test.toml", folder.path()).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(load("good.png", "uv.obj"), Ok(()));
    let complaint = |file, mesh| load(file, mesh).err().unwrap_or_default();
    let absent = complaint("absent.png", "uv.obj");
    assert!(absent.starts_with("test.toml:17:8: texture[0].file: ") && absent.contains("cannot be read"), "{absent}");
    let notes = complaint("notes.png", "uv.obj");
    assert!(notes.starts_with("test.toml:17:8: texture[0].file: ") && notes.contains("is not a valid image"), "{notes}");
    assert!(complaint("cut.png", "uv.obj").contains("is not a valid image"));
    let without_uv = complaint("good.png", "plain.obj");
    assert!(
        without_uv.contains("shape[0].material: the material `grey` uses a texture, which needs uv coordinates"),
        "{without_uv}"
    );
}

/// A product has two textures, and their values are those of both.
#[test]
fn bad_products_of_textures_name_the_key() {
    let load = |times: [&str; 2], keys: &str| {
        let texture = |name: &str, value: &str, times: &str| {
            let times = if times.is_empty() { String::new() } else { format!("times = \"{times}\"\n") };
            format!("[[texture]]\nname = \"{name}\"\ntype = \"perlin\"\na = {value}\nb = {value}\n{times}")
        };
        let textures = texture("first", "0.5", times[0]) + &texture("second", "1.5", times[1]);
        let text = GOOD.replace("reflectance = 0.5", &format!("{keys}\n{textures}"));
        load::load_toml_str(&text, "test.toml", Path::new("")).map(|_| ()).map_err(|error| error.to_string())
    };
    let used = "reflectance = { texture = \"first\" }";
    assert_eq!(load(["second", ""], used), Ok(()));
    let bright = load(["second", ""], "reflectance = { texture = \"second\" }").err().unwrap_or_default();
    assert!(bright.contains("found 1.5 in the texture `second`"), "{bright}");
    let bright = load(["second", ""], "reflectance = { texture = \"first\", factor = 2 }").err().unwrap_or_default();
    assert!(bright.contains("found 1.5 in the texture `first` times its factor"), "{bright}");
    for times in [["first", ""], ["second", "first"]] {
        let message = load(times, used).err().unwrap_or_default();
        assert!(message.contains("which is multiplied by another texture itself"), "{message}");
    }
    let message = load(["thrid", ""], used).err().unwrap_or_default();
    assert!(message.contains("thrid"), "{message}");
    let message = load(["second", ""], "reflectance = 0.5\nbump_map = \"first\"").err().unwrap_or_default();
    assert!(message.contains("normal and bump maps cannot be products"), "{message}");
}

#[test]
fn bad_material_libraries_name_file_and_line() {
    let model = format!("mtllib a.mtl\nusemtl a\n{TRIANGLE}");
    let rows = [
        ("newmtl a\nKd 0.5 0.5\n", "a.mtl:2:1: Kd: expected 1 or 3 numbers, found 2"),
        ("newmtl a\nKd red\n", "a.mtl:2:1: Kd: expected numbers from 0 to 1e18, found `red`"),
        ("newmtl a\nKe nan 0 0\n", "a.mtl:2:1: Ke: expected numbers"),
        ("newmtl\n", "a.mtl:1:1: newmtl: the name is missing"),
        ("newmtl a\nillum glass\n", "a.mtl:2:1: illum: expected an illumination model"),
        ("newmtl a\nd 1.5\n", "a.mtl: the material `a` has d or Tr outside 0 to 1"),
        ("newmtl a\nmap_Kd -s wood.png\n", "the material `a`: map_Kd: expected a number"),
        ("newmtl a\nillum 4\nNi 100\n", "the index of refraction Ni = 100"),
    ];
    for (library, expected) in rows {
        let folder = folder_with(&[("a.obj", model.as_bytes()), ("a.mtl", library.as_bytes())]);
        let error = load::load(folder.path().join("a.obj").to_str()).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn deep_nesting_is_an_error_not_a_stack_overflow() {
    let weight = format!("weight{} = 1", ".of".repeat(200_000));
    let text = GOOD.replace("reflectance = 0.5", &weight);
    assert!(load::load_toml_str(&text, "test.toml", "".as_ref()).is_err());
    let inline = format!("weight = {}1{}", "{ of = ".repeat(100_000), " }".repeat(100_000));
    assert!(load::load_toml_str(&GOOD.replace("reflectance = 0.5", &inline), "test.toml", "".as_ref()).is_err());
}
