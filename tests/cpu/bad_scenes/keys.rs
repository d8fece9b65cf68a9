//! Keys, types and names that there are not, and values of another type.

use gpt::load;
use gpt::scene::settings::SETTINGS;

use super::{GOOD, check, complaint, error_of};

/// The types that the schema has for these entries, in its order.
fn types_of(entries: &str) -> String {
    let schema: serde_json::Value = serde_json::from_str(load::json_schema()).expect("the schema is JSON");
    let choices = schema["$defs"][entries]["oneOf"].as_array().cloned().unwrap_or_default();
    let names = choices.iter().filter_map(|choice| choice["properties"]["type"]["const"].as_str());
    names.collect::<Vec<_>>().join(", ")
}

#[test]
fn unknown_keys_types_and_names_are_answered_with_the_valid_choices() {
    let [materials, shapes] = [types_of("MaterialEntry"), types_of("ShapeEntry")];
    let of_materials = format!(
        "test.toml:12:8: material[0].type: `diffusse` is not a valid choice [did you mean `diffuse`? valid choices: {materials}]"
    );
    let of_shapes = format!("test.toml:14:1: shape[0]: the key `type` is missing [valid choices: {shapes}]");
    assert!(materials.starts_with("diffuse, mirror, ") && shapes.starts_with("mesh, sphere, "), "{materials}; {shapes}");
    check(&[
        ("[film]", "[film", "test.toml:2:6: unclosed table, expected `]`"),
        (
            "reflectance = 0.5",
            "reflectence = 0.5",
            "test.toml:13:1: material[0].reflectence: unknown key `reflectence` [did you mean `reflectance`? valid choices: name, \
             reflectance, normal_map, normal_scale, bump_map, bump_scale, normal_shadowing, normal_mirroring, emission, emission_two_sided, opacity, interior, light_group, lights_only, lights_all_but, keyframes, interpolation, two_sided]",
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
    ]);
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

#[test]
fn values_of_another_type_are_told_from_what_is_expected() {
    check(&[
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
            "test.toml:5:13: render.estimator: invalid type: integer `3`, expected one of mis, nee, bsdf, choose",
        ),
        ("spp = 1", "seed = [1]", "test.toml:5:8: render.seed: invalid type: array, expected a whole number of at least 0"),
        (
            "[film]\nsize = [4, 4]\n[render]\nspp = 1",
            "render = 3",
            "test.toml:2:10: render: invalid type: integer `3`, expected a table",
        ),
    ]);
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
