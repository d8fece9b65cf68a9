//! The JSON Schema and the program agree on which scene files are right. Random changes of right files are judged by both.
//!
//! A schema cannot know names, nor how values relate to each other (a shape without area). Such refusals are listed here, and only those: what
//! one file alone, key by key, makes wrong is wrong for both. `GPT_FUZZ_CASES` says how many files are judged.

use std::collections::BTreeMap;
use std::path::Path;

use gpt::load;
use jsonschema::Validator;
use serde_json::{Map, Value, json};

use crate::common::effort::in_full;
use crate::statistics::random::SplitMix64;

/// Parts of messages about names and relations. JSON has no whole numbers apart from others, so random files have no 1.0 in the place of a 1.
const RELATIONS: &[&str] = &[
    "there is no node named",
    "keyframes stand in the order",
    "cameras state",
    "there is no texture named",
    "there is no material named",
    "is named `",
    "cannot have length 0",
    "looks at the point",
    "diffuse + specular is at most",
    "the motion leaves the range of numbers",
    "along the viewing direction",
    "expected a whole number",
    "has no area",
    "no faces with an area",
    "the face uses position",
    "` for ",
    "needs uv coordinates",
    "nothing in the scene gives light",
    "contains itself",
    "this is the second",
    " in the texture `",
    "below its `min`",
    "can only be scaled",
    "holds directions, not colours",
    "is multiplied by another texture itself",
    "cannot be products",
    "cannot be read",
    "there is no file",
    "is at most `angle`",
    "flattens the shape",
    "pixels on a side",
    "the last row of a matrix",
    "never end",
    "a portal cannot",
    "a plane cannot",
    "an infinite plane",
    "the shutter closes before it opens",
    "while the shutter is open",
    "on the way to shutter times",
    "there is no group named",
    "a group consists of meshes",
    "a mesh of a group",
    "instances that give light do not move",
    "flattens it",
    "must rise",
    "a fisheye that is",
    "no place of its picture",
    "divided evenly",
    "are squares",
    "no plane to be in focus",
    "reaches farther than",
];

/// Every table with every key somewhere, and nothing that needs a file.
const EVERYTHING: &str = r##"
[film]
size = [64, 32]
filter = { type = "gaussian", radius = 1.5 }
[render]
spp = 16
max_depth = 8
sampler = "halton"
estimator = "mis"
heuristic = "balance"
roulette_depth = 5
[camera]
position = [0, 1, 6]
look_at = [0, 1, 0]
up = [0, 1, 0]
vfov = 40
aperture = { shape = "polygon", radius = 0.05, blades = 5, rotation = 10 }
focus_distance = 6
shutter = [0, 1]
keyframes = [{ frame = 0, position = [0, 1, 6], focus_distance = 6 }, { time = 2, look_at = [0, 2, 0], up = [0, 1, 0], vfov = 30 }]
interpolation = "smooth"
node = "arm"
[animation]
fps = 25
[[node]]
name = "arm"
transform = [{ translate = [0, 1, 0] }]
keyframes = [{ frame = 1, rotate = [0, 1, 0], degrees = 0 }, { frame = 17, rotate = [0, 1, 0], degrees = 90, translate = [0, 2, 0] }]
interpolation = "step"
[[node]]
name = "hand"
parent = "arm"
[[texture]]
name = "checks"
type = "checker"
a = 0.2
b = [0.1, 0.5, 0.9]
scale = [4, 2]
second_uvs = true
[[texture]]
name = "clouds"
type = "perlin"
scale = 3
octaves = 4
a = 0
b = 1
seed = 5
[[texture]]
name = "cells"
type = "worley"
scale = 2
a = 0
b = 1
seed = 1
times = "clouds"
[[material]]
name = "plain"
type = "diffuse"
reflectance = { texture = "checks", factor = [0.5, 1, 0.25] }
emission = { kelvin = 3000, factor = 0.5 }
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.5
[[material]]
name = "lamp"
type = "emissive"
radiance = "#ffccaa"
two_sided = true
[[material]]
name = "half"
type = "blend"
materials = ["plain", "lamp"]
weight = { type = "threshold", tau = 0.5, of = { type = "reverse", of = { type = "texture", texture = "clouds" } } }
[[shape]]
type = "sphere"
center = [0, 1, 0]
radius = 0.5
material = "half"
transform = [{ scale = 0.5 }, { rotate = [0, 1, 0], degrees = 30 }, { translate = [0, 1, 0] }]
motion = [{ translate = [0.2, 0, 0] }]
[[shape]]
type = "mesh"
positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
faces = [[0, 1, 2]]
uvs = [[0, 0], [1, 0], [0, 1]]
second_uvs = [[0, 1], [1, 0], [0, 0]]
normals = [[0, 0, 1], [0, 0, 1], [0, 0, 1]]
material = "plain"
smooth = false
[[shape]]
type = "rectangle"
corner = [0, 0, 0]
edge_u = [1, 0, 0]
edge_v = [0, 0, 1]
material = "lamp"
transform = { matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }
portal = false
[[shape]]
type = "disk"
center = [0, 3, 0]
normal = [0, -1, 0]
radius = 1
material = "lamp"
[[shape]]
type = "box"
min = [2, 0, 0]
max = [3, 1, 1]
material = "plain"
keyframes = [{ frame = 0, scale = 1 }, { frame = 0.5, scale = [1, 2, 1] }]
interpolation = "linear"
node = "hand"
[[group]]
name = "tree"
[[group.shape]]
type = "mesh"
positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
faces = [[0, 1, 2]]
uvs = [[0, 0], [1, 0], [0, 1]]
material = "grey"
transform = [{ scale = 0.5 }]
[[group]]
name = "wood"
[[group.instance]]
group = "tree"
places = [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]]
transform = [{ translate = [0, 1, 0] }]
material = "grey"
[[instance]]
group = "wood"
[[instance]]
group = "tree"
places = [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0], [-1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 0]]
transform = [{ translate = [0, 1, 0] }]
material = "grey"
motion = [{ rotate = [0, 1, 0], degrees = 20 }]
pivot = [0, 1, 0]
[[light]]
type = "environment"
radiance = 0.3
scale = 2
rotate = 30
[[light]]
type = "point"
position = [0, 3, 0]
intensity = 4
[[light]]
type = "spot"
position = [0, 3, 0]
direction = [0, -1, 0]
intensity = [1, 2, 3]
angle = 30
falloff = 5
[[light]]
type = "directional"
direction = [0, -1, 0]
irradiance = 1
"##;

/// Right scene files that need no other: all tables, all materials, and built-in scenes.
fn right_files() -> Vec<Value> {
    let mut texts = vec![EVERYTHING.to_owned()];
    for (place, (_, keys)) in load::file::material_examples().enumerate() {
        let material = format!("[[material]]\nname = \"m{place}\"\n{keys}");
        texts.push(format!("{EVERYTHING}{}{material}", load::file::example_materials()));
    }
    for example in load::file::CAMERA_EXAMPLES {
        let [width, height] = example.size;
        texts.push(format!(
            "film = {{ size = [{width}, {height}] }}\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n{}[[light]]\ntype = \"environment\"\nradiance = 1\n\
             [[material]]\nname = \"m\"\ntype = \"diffuse\"\nreflectance = 0.5\n[[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\n",
            example.keys
        ));
    }
    texts.extend(["cornell", "veach-mis", "motion-blur"].into_iter().filter_map(load::builtin_text).map(str::to_owned));
    let right = |text: &String| load::load_toml_str(text, "right.toml", Path::new("")).is_ok();
    let files: Vec<Value> =
        texts.iter().filter(|text| right(text)).map(|text| toml::from_str(text).expect("it was read")).collect();
    assert!(files.len() > texts.len() / 2, "{} of {}", files.len(), texts.len());
    files
}

struct Generator {
    random: SplitMix64,
    keys: Vec<String>,
}

impl Generator {
    fn below(&mut self, count: usize) -> usize {
        (self.random.uniform() * count as f64) as usize
    }

    fn value(&mut self) -> Value {
        let values = [
            json!(-1),
            json!(0),
            json!(1),
            json!(2),
            json!(0.5),
            json!(-0.5),
            json!(3),
            json!(16),
            json!(17),
            json!(64),
            json!(65),
            json!(91.0),
            json!(179.5),
            json!(32_769),
            json!(4_294_967_295_u64),
            json!(4_294_967_296_u64),
            json!(1e18),
            json!(1.1e18),
            json!(-1e19),
            json!("plain"),
            json!("mirror"),
            json!("box"),
            json!("fisheye"),
            json!("brown_conrady"),
            json!("kannala_brandt"),
            json!(""),
            json!(true),
            json!([]),
            json!([1, 2]),
            json!([1, 2, 3]),
            json!([0.5, -1, 0.5]),
            json!([1, 2, 3, 4]),
            json!({}),
            json!({ "texture": "checks" }),
            json!({ "texture": 3 }),
            json!({ "texture": "checks", "factor": 2 }),
            json!({ "texture": "checks", "factor": [0.5, 0, 1] }),
            json!({ "kelvin": 3200 }),
            json!({ "kelvin": 900 }),
            json!({ "kelvin": 5000, "factor": 2 }),
            json!("#ff8800"),
            json!("#ff880"),
            json!({ "type": "constant", "value": 0.5 }),
            json!([{ "scale": 2 }]),
            json!({ "scale": 2, "translate": [0, 0, 1] }),
        ];
        let chosen = self.below(values.len());
        values[chosen].clone()
    }

    /// Changes something somewhere.
    fn change(&mut self, value: &mut Value) {
        let inner = match value {
            Value::Object(table) => table.len(),
            Value::Array(items) => items.len(),
            _ => 0,
        };
        // Rather below than here: a file has many more leaves than tables.
        if inner > 0 && self.random.uniform() < 0.8 {
            let place = self.below(inner);
            match value {
                Value::Object(table) => table.values_mut().nth(place).into_iter().for_each(|value| self.change(value)),
                Value::Array(items) => self.change(&mut items[place]),
                _ => {}
            }
            return;
        }
        match value {
            Value::Object(table) if self.random.uniform() < 0.9 => self.change_table(table),
            Value::Array(items) if self.random.uniform() < 0.6 => {
                let place = self.below(items.len() + 1);
                match items.get(place).cloned() {
                    Some(item) if self.random.uniform() < 0.5 => items.push(item),
                    Some(_) => drop(items.remove(place)),
                    None => items.push(self.value()),
                }
            }
            other => *other = self.value(),
        }
    }

    fn change_table(&mut self, table: &mut Map<String, Value>) {
        let place = self.below(self.keys.len());
        let known = self.keys[place].clone();
        let own = table.keys().nth(self.below(table.len().max(1))).cloned();
        match (own, self.below(4)) {
            (Some(own), 0) => drop(table.remove(&own)),
            (Some(own), 1) => {
                let value = table.remove(&own).unwrap_or_default();
                table.insert(known, value);
            }
            (Some(_), 2) => drop(table.insert("nonsense".to_owned(), json!(1))),
            _ => drop(table.insert(known, self.value())),
        }
    }
}

/// All keys that the schema names anywhere.
fn all_keys(schema: &Value, keys: &mut Vec<String>) {
    match schema {
        Value::Object(table) => {
            if let Some(Value::Object(properties)) = table.get("properties") {
                keys.extend(properties.keys().cloned());
            }
            table.values().for_each(|value| all_keys(value, keys));
        }
        Value::Array(items) => items.iter().for_each(|item| all_keys(item, keys)),
        _ => {}
    }
}

/// The answers of the schema and of the program to a file, where they do not agree.
fn disagreement(validator: &Validator, text: &str) -> Option<String> {
    let file: Value = toml::from_str(text).expect("it was written as TOML");
    let by_schema = validator.validate(&file).map_err(|error| format!("{error} at {}", error.instance_path()));
    let by_program = load::load_toml_str(text, "random.toml", Path::new("")).map(|_| ());
    match (by_schema, by_program) {
        (Ok(()), Err(error)) if RELATIONS.iter().any(|relation| error.message().contains(relation)) => None,
        (Ok(()), Err(error)) => Some(format!("only the program refuses: {} | {error}", error.message())),
        (Err(error), Ok(())) => Some(format!("only the schema refuses: {error}")),
        _ => None,
    }
}

#[test]
fn the_schema_and_the_program_agree_on_random_files() {
    let schema: Value = serde_json::from_str(load::json_schema()).expect("the schema is JSON");
    let validator = jsonschema::validator_for(&schema).expect("the schema is one");
    let mut keys = Vec::new();
    all_keys(&schema, &mut keys);
    keys.sort();
    keys.dedup();
    let files = right_files();
    let asked = std::env::var("GPT_FUZZ_CASES").ok().and_then(|count| count.parse().ok());
    let cases = asked.unwrap_or_else(|| if in_full("100,000 random scene files instead of 500") { 100_000 } else { 500 });
    let mut generator = Generator { random: SplitMix64::new(11), keys };
    let mut found: BTreeMap<String, (usize, String)> = BTreeMap::new();
    let (mut right, mut wrong) = (0, 0);
    for _ in 0..cases {
        let mut file = files[generator.below(files.len())].clone();
        for _ in 0..1 + generator.below(2) {
            generator.change(&mut file);
        }
        let Ok(text) = toml::to_string(&file) else { continue };
        if let Some(what) = disagreement(&validator, &text) {
            let kind: String =
                what.split('|').next().unwrap_or_default().chars().filter(|letter| !letter.is_ascii_digit()).take(150).collect();
            found.entry(kind).or_insert((0, format!("{what}\n{text}"))).0 += 1;
        } else if validator.is_valid(&file) {
            right += 1;
        } else {
            wrong += 1;
        }
    }
    let list: Vec<String> = found.iter().map(|(kind, (count, _))| format!("{count} × {kind}")).collect();
    let first = found.values().next().map_or("", |(_, text)| text);
    assert!(found.is_empty(), "{}\nfor example {first}", list.join("\n"));
    // Both kinds occur, else nothing was tested.
    assert!(right > cases / 20 && wrong > cases / 20, "{right} right, {wrong} wrong");
}

/// The controls: a schema that allows too much or too little is noticed.
#[test]
fn schemas_that_do_not_agree_are_noticed() {
    let anything = jsonschema::validator_for(&json!({})).expect("a schema");
    let nothing = jsonschema::validator_for(&json!(false)).expect("a schema");
    let right = EVERYTHING;
    let wrong = EVERYTHING.replace("vfov = 40", "vfov = -1");
    assert_eq!(disagreement(&anything, right), None);
    assert!(disagreement(&nothing, right).is_some_and(|what| what.starts_with("only the schema refuses")));
    assert!(disagreement(&anything, &wrong).is_some_and(|what| what.starts_with("only the program refuses")));
    assert_eq!(disagreement(&nothing, &wrong), None);
}
