//! Changes of a scene's text, in both forms that its lists may have.

use serde_json::{Value as Json, json};
use toml_edit::DocumentMut;

use super::changes::{Change, apply};
use super::values::item_to_json;

const TABLES: &str = r#"# A room.
[film]
size = [4, 4]

# The first one.
[[material]]
name = "clay" # earthen
type = "diffuse"
reflectance = [0.8, 0.20, 0.05] # red

[[shape]]
type = "sphere"
material = "clay"

# The second one.
[[material]]
name = "coat"
type = "blend"
materials = ["clay", "gold"]
[material.weight]
type = "reverse" # turned
of = { type = "fresnel", ior = 1.5 }

[[material]]
name = "gold"
type = "conductor"
preset = "gold"
# The end.
"#;

const INLINE: &str = r#"material = [
  # The first one.
  { name = "clay", type = "diffuse", reflectance = 0.5 }, # earthen
  { name = "gold", type = "conductor", preset = "gold" },
]
shape = [{ type = "sphere", material = "clay" }]
"#;

fn changed_by(text: &str, changes: Json) -> String {
    let mut document: DocumentMut = text.parse().expect("it is TOML");
    let changes: Vec<Change> = serde_json::from_value(changes).expect("they are changes");
    for change in &changes {
        apply(&mut document, change).unwrap_or_else(|error| panic!("{change:?}: {error}"));
    }
    let text = document.to_string();
    let again: DocumentMut = text.parse().unwrap_or_else(|error| panic!("{error}\n{text}"));
    for (key, item) in document.iter() {
        assert_eq!(again.get(key).map(item_to_json), Some(item_to_json(item)), "{text}");
    }
    text
}

fn is_refused(text: &str, change: Json) -> bool {
    let mut document: DocumentMut = text.parse().expect("it is TOML");
    let change: Change = serde_json::from_value(change).expect("it is a change");
    apply(&mut document, &change).is_err()
}

fn model(text: &str) -> Json {
    item_to_json(text.parse::<DocumentMut>().expect("it is TOML").as_item())
}

#[test]
fn a_value_is_set_where_it_stands_and_comments_stay() {
    let set = |at: Json, value: Json| changed_by(TABLES, json!([{ "do": "set", "at": at, "value": value }]));
    assert_eq!(
        set(json!(["material", 0, "reflectance"]), json!([0.8, 0.2, 1])),
        TABLES.replace("[0.8, 0.20, 0.05] # red", "[0.8, 0.20, 1.0] # red")
    );
    assert_eq!(set(json!(["material", 0, "reflectance", 0]), json!(0.25)), TABLES.replace("[0.8,", "[0.25,"));
    assert_eq!(set(json!(["material", 0, "reflectance"]), json!(1)), TABLES.replace("[0.8, 0.20, 0.05] # red", "1 # red"));
    assert_eq!(set(json!(["material", 1, "weight", "of", "ior"]), json!(2)), TABLES.replace("ior = 1.5", "ior = 2.0"));
    assert_eq!(
        set(json!(["material", 1, "weight"]), json!({ "type": "facing", "power": 3 })),
        TABLES.replace("\"reverse\" # turned\nof = { type = \"fresnel\", ior = 1.5 }", "\"facing\" # turned\npower = 3")
    );
    let inline = changed_by(INLINE, json!([{ "do": "set", "at": ["material", 0, "reflectance"], "value": [1, 0.5, 0] }]));
    assert_eq!(inline, INLINE.replace("reflectance = 0.5 }", "reflectance = [1, 0.5, 0] }"));
    assert_eq!(set(json!(["material", 0, "reflectance"]), json!([0.8, 0.2, 0.05])), TABLES, "nothing changes");
}

#[test]
fn a_key_is_added_at_the_end_and_left_out_again() {
    for (text, end, added) in [
        (TABLES, "0.05] # red\n", "0.05] # red\ntwo_sided = true\n"),
        (INLINE, "reflectance = 0.5 }", "reflectance = 0.5, two_sided = true }"),
    ] {
        let at = json!(["material", 0, "two_sided"]);
        let set = changed_by(text, json!([{ "do": "set", "at": at, "value": true }]));
        assert_eq!(set, text.replace(end, added));
        assert_eq!(changed_by(&set, json!([{ "do": "unset", "at": at }])), text);
    }
    let lines = "material = [\n    {\n        name = \"a\",\n        type = \"mirror\"\n    },\n]\n";
    let set = changed_by(lines, json!([{ "do": "set", "at": ["material", 0, "reflectance"], "value": 0.5 }]));
    assert_eq!(model(&set)["material"][0]["reflectance"], 0.5);
    assert!(set.contains("\n        reflectance = 0.5"), "{set}");
}

#[test]
fn entries_are_added_removed_and_moved() {
    let mirror = json!({ "name": "m", "type": "mirror", "reflectance": { "texture": "t" } });
    let words = "name = \"m\"\ntype = \"mirror\"\nreflectance = { texture = \"t\" }\n";
    let added = changed_by(TABLES, json!([{ "do": "insert", "at": ["material", 1], "value": mirror }]));
    assert_eq!(added, TABLES.replace("0.05] # red\n", &format!("0.05] # red\n\n[[material]]\n{words}")));
    assert_eq!(changed_by(&added, json!([{ "do": "unset", "at": ["material", 1] }])), TABLES);
    let last = changed_by(TABLES, json!([{ "do": "insert", "at": ["material", 3], "value": mirror }]));
    assert_eq!(model(&last)["material"][3]["name"], "m");
    let first = changed_by(TABLES, json!([{ "do": "insert", "at": ["material", 0], "value": mirror }]));
    assert_eq!(model(&first)["material"][0]["name"], "m");
    let none = changed_by("[film]\nsize = [4, 4]\n", json!([{ "do": "insert", "at": ["material", 0], "value": mirror }]));
    assert_eq!(none, format!("[film]\nsize = [4, 4]\n\n[[material]]\n{words}"));

    let moved = changed_by(TABLES, json!([{ "do": "move", "at": ["material", 0], "to": 1 }]));
    let names =
        |text: &str| model(text)["material"].as_array().expect("a list").iter().map(|m| m["name"].clone()).collect::<Vec<_>>();
    assert_eq!(names(&moved), ["coat", "clay", "gold"]);
    for kept in ["# The first one.\n[[material]]\nname = \"clay\" # earthen", "# The second one.\n[[material]]\nname = \"coat\""]
    {
        assert!(moved.contains(kept), "{moved}");
    }
    assert!(moved.find("[[shape]]") > moved.find("coat\"\ntype"), "the shape stays between them: {moved}");
    assert_eq!(model(&moved)["material"][0]["weight"]["type"], "reverse");
    assert_eq!(changed_by(&moved, json!([{ "do": "move", "at": ["material", 1], "to": 0 }])), TABLES);

    let inline = changed_by(INLINE, json!([{ "do": "insert", "at": ["material", 2], "value": mirror }]));
    let line = "  { name = \"m\", type = \"mirror\", reflectance = { texture = \"t\" } },\n";
    assert_eq!(inline, INLINE.replace("\"gold\" },\n", &format!("\"gold\" }},\n{line}")));
    assert_eq!(changed_by(&inline, json!([{ "do": "unset", "at": ["material", 2] }])), INLINE);
    let moved = changed_by(INLINE, json!([{ "do": "move", "at": ["material", 0], "to": 1 }]));
    assert_eq!(names(&moved), ["gold", "clay"]);
    assert!(moved.contains("# The first one.\n  { name = \"clay\""), "{moved}");
    let swapped = changed_by(TABLES, json!([{ "do": "move", "at": ["material", 1, "materials", 1], "to": 0 }]));
    assert_eq!(swapped, TABLES.replace("[\"clay\", \"gold\"]", "[\"gold\", \"clay\"]"));
}

#[test]
fn a_material_is_wrapped_in_a_blend_wherever_it_is_named() {
    for text in [TABLES, INLINE] {
        let wrapped = changed_by(text, json!([{ "do": "wrap", "at": ["material", 0] }]));
        let scene = model(&wrapped);
        let before = &model(text)["material"][0];
        for (index, name) in [(0, "clay 1"), (1, "clay 2")] {
            let mut part = before.clone();
            part["name"] = json!(name);
            assert_eq!(scene["material"][index], part, "{wrapped}");
        }
        let blend = json!({ "name": "clay", "type": "blend", "materials": ["clay 1", "clay 2"], "weight": { "type": "constant", "value": 0.5 } });
        assert_eq!(scene["material"][2], blend, "{wrapped}");
        assert_eq!(scene["shape"], model(text)["shape"]);
        assert!(wrapped.contains("# The first one.") && wrapped.contains("earthen"), "{wrapped}");
        assert_eq!(wrapped.matches("# The first one.").count(), 1, "{wrapped}");
    }
    // A table below the entry goes with it and its copy.
    let wrapped = model(&changed_by(TABLES, json!([{ "do": "wrap", "at": ["material", 1] }])));
    for index in [1, 2] {
        assert_eq!(wrapped["material"][index]["weight"], json!({ "type": "reverse", "of": { "type": "fresnel", "ior": 1.5 } }));
    }
    assert_eq!(wrapped["material"][4]["name"], "gold");
}

#[test]
fn a_name_is_wrapped_where_it_stands_alone() {
    let wrapped = changed_by(TABLES, json!([{ "do": "wrap", "at": ["material", 1, "materials", 0] }]));
    let scene = model(&wrapped);
    let names: Vec<_> =
        scene["material"].as_array().expect("a list").iter().map(|m| m["name"].as_str().expect("a name")).collect();
    assert_eq!(names, ["clay", "clay 1", "clay 2", "coat", "gold"], "{wrapped}");
    assert_eq!(scene["material"][2]["materials"], json!(["clay", "clay 1"]));
    assert_eq!(scene["material"][3]["materials"], json!(["clay 2", "gold"]));
    assert_eq!(scene["shape"][0]["material"], "clay", "others still name what they named");
    // The entry stands before what it names, so that nothing moves it.
    let wrapped = model(&changed_by(TABLES, json!([{ "do": "wrap", "at": ["material", 1, "materials", 1] }])));
    assert_eq!(wrapped["material"][1]["materials"], json!(["clay", "gold 2"]));
}

#[test]
fn what_is_not_there_or_not_to_be_changed_is_refused() {
    for change in [
        json!({ "do": "set", "at": ["film", "size"], "value": [1, 1] }),
        json!({ "do": "set", "at": ["material"], "value": [] }),
        json!({ "do": "set", "at": [], "value": 1 }),
        json!({ "do": "set", "at": ["material", 9, "name"], "value": "x" }),
        json!({ "do": "set", "at": ["material", 0, "name", "x"], "value": 1 }),
        json!({ "do": "set", "at": ["material", 0, "reflectance"], "value": null }),
        json!({ "do": "unset", "at": ["material", 0, "nothing"] }),
        json!({ "do": "insert", "at": ["material", 9], "value": {} }),
        json!({ "do": "insert", "at": ["material", 0], "value": 1 }),
        json!({ "do": "move", "at": ["material", 0], "to": 9 }),
        json!({ "do": "wrap", "at": ["material", 9] }),
        json!({ "do": "wrap", "at": ["material", 0, "type"] }),
    ] {
        assert!(is_refused(TABLES, change.clone()), "{change}");
    }
    assert!(!is_refused(TABLES, json!({ "do": "unset", "at": ["material", 0, "type"] })), "the control");
    assert!(serde_json::from_value::<Change>(json!({ "do": "wrap", "at": [], "to": 1 })).is_err());
}
