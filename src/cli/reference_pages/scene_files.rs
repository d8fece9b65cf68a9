//! `docs/scene-format.md`, made from the JSON Schema of scene files.

use std::fmt::Write;

use serde_json::{Map, Value};

/// A scene that shows every kind of table.
pub const EXAMPLE: &str = r#"[film]
size   = [512, 512]
filter = { type = "gaussian" }

[render]
spp = 256

[camera]
position = [0, 1, 6.8]
look_at  = [0, 1, 0]
vfov     = 19.5

[[texture]]
name = "tiles"
type = "checker"
a    = 0.8
b    = [0.1, 0.1, 0.3]

[[material]]
name        = "floor"
type        = "diffuse"
reflectance = { texture = "tiles" }

[[material]]
name = "ball"
type = "conductor"
preset = "gold"
roughness = 0.3

[[material]]
name     = "lamp"
type     = "emissive"
radiance = [17, 12, 4]

[[shape]]
type     = "rectangle"
corner   = [-2, 0, -2]
edge_u   = [0, 0, 4]
edge_v   = [4, 0, 0]
material = "floor"

[[shape]]
type      = "sphere"
center    = [0, 0, 0]
radius    = 1
material  = "ball"
transform = [{ scale = 0.5 }, { translate = [0, 0.5, 0] }]   # applied in this order

[[shape]]
type     = "disk"
center   = [0, 3, 0]
normal   = [0, -1, 0]
radius   = 0.5
material = "lamp"

[[light]]
type     = "environment"
radiance = 0.1
"#;

/// Rules that hold for all of a scene file and that no key states.
const CONVENTIONS: &str = "\
Scenes are [TOML](https://toml.io). An unknown key, a missing file, a wrong type, a number out of range and an unknown name are errors \
that name file, line, key and the valid choices; nothing is ignored silently. `gpt check SCENE` checks a scene without rendering it. Editors \
complete and check scene files with [scenes/scene.schema.json](../scenes/scene.schema.json), which `gpt check --schema` prints.

- Coordinates are right-handed, and +Y is up unless the camera says otherwise.
- A colour is `[r, g, b]`, linear Rec.709, or one number for a grey. A texture stands for one as `{ texture = \"name\" }`.
- Every surface reflects on both sides. Its front is where the normal points: outward for spheres and boxes, `edge_u × edge_v` for rectangles, \
where vertices run counter-clockwise for triangles.
- Paths of files are relative to the scene file.
- `version = 1`, above all tables, names the version of the format, which may be left out. A file of a newer version is refused.
";

/// The line above keys that are there to compare strategies.
const STUDY: &str = "**Study**: settings that are there to compare strategies ([figures.md](figures.md)).";

/// The whole page; `remake` is the command that makes it.
pub fn page(schema: &Value, remake: &str) -> String {
    let mut page = Page { schema, text: String::new(), sections: Vec::new() };
    let _ = write!(
        page.text,
        "<!-- Made by `{remake}`: change crates/gpt-scene/src/load/file/syntax and crates/gpt-scene/src/scene/settings, not this page. -->\n\n"
    );
    let _ = write!(page.text, "# Scene files\n\n{}\n\n{CONVENTIONS}\n```toml\n{EXAMPLE}```\n", description(schema));
    for (name, table) in entries(schema, "properties").filter(|(_, table)| table["type"] != "integer") {
        match table.get("items") {
            Some(entry) => page.table(&format!("`[[{name}]]`"), entry),
            None => page.table(&format!("`[{name}]`"), table),
        }
    }
    page.text
}

struct Page<'s> {
    schema: &'s Value,
    text: String,
    /// Types of values that are tables of their own and are still to be described.
    sections: Vec<&'s str>,
}

impl<'s> Page<'s> {
    /// A table of the file, and then the tables that its keys take as values.
    fn table(&mut self, title: &str, table: &'s Value) {
        let _ = write!(self.text, "\n## {title}\n\n");
        let name = table["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/")).unwrap_or_default();
        self.describe(&self.schema["$defs"][name]);
        let mut described = Vec::new();
        while let Some(name) = self.sections.iter().copied().find(|name| !described.contains(name)) {
            described.push(name);
            let _ = write!(self.text, "\n### {}\n\n", title_of(name));
            self.describe(&self.schema["$defs"][name]);
        }
        self.sections.clear();
    }

    fn describe(&mut self, table: &'s Value) {
        let _ = writeln!(self.text, "{}", description(table));
        let variants: Vec<&Value> = entry_list(table, "oneOf").filter(|one| one["properties"].is_object()).collect();
        let Some(first) = variants.first() else {
            let is_study = |value: &Value| value["x-group"] == "study";
            let rows = self.rows(table, |_, value| !is_study(value));
            self.keys(&rows);
            let rows = self.rows(table, |_, value| is_study(value));
            if !rows.is_empty() {
                let _ = writeln!(self.text, "\n{STUDY}");
            }
            return self.keys(&rows);
        };
        // The key whose value chooses the variant comes first, then what all of them have.
        let tag =
            |variant: &'s Value| entries(variant, "properties").find_map(|(key, value)| Some((key, value["const"].as_str()?)));
        let shared = |key: &str, value: &Value| variants.iter().all(|variant| variant["properties"].get(key) == Some(value));
        let names: Vec<String> =
            variants.iter().filter_map(|variant| tag(variant)).map(|(_, name)| format!("`\"{name}\"`")).collect();
        let key = tag(first).map_or("type", |(key, _)| key);
        let mut rows = vec![format!("| `{key}`, required | {} | |", names.join(", "))];
        rows.extend(self.rows(first, shared));
        self.keys(&rows);
        for variant in &variants {
            let rows = self.rows(variant, |key, value| !shared(key, value) && value["const"].is_null());
            let about = description(variant);
            if rows.is_empty() && about.is_empty() {
                continue;
            }
            let colon = if about.is_empty() { "" } else { ": " };
            let name = tag(variant).map_or("", |(_, name)| name);
            let _ = writeln!(self.text, "\n**`{key} = \"{name}\"`**{colon}{about}");
            self.keys(&rows);
        }
    }

    fn keys(&mut self, rows: &[String]) {
        if !rows.is_empty() {
            let _ = writeln!(self.text, "\n| key | value | meaning |\n| --- | --- | --- |\n{}", rows.join("\n"));
        }
    }

    /// A row for each of the table's keys that is wanted.
    fn rows(&mut self, table: &'s Value, wanted: impl Fn(&str, &Value) -> bool) -> Vec<String> {
        let required: Vec<&str> = entry_list(table, "required").filter_map(Value::as_str).collect();
        let keys = entries(table, "properties").filter(|(key, value)| wanted(key, value));
        let row = |(key, value): (&str, &'s Value)| {
            let needed = if required.contains(&key) { ", required" } else { "" };
            format!("| `{key}`{needed} | {} | {} |", self.words(value), meaning(value))
        };
        keys.map(row).collect()
    }

    /// The values that are allowed, in words.
    fn words(&mut self, value: &'s Value) -> String {
        if let Some(name) = value["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/")) {
            return self.type_words(name);
        }
        if let Some(name) = value["const"].as_str() {
            return format!("`\"{name}\"`");
        }
        if let Some(names) = value["enum"].as_array() {
            return names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        }
        for (kind, separator) in [("oneOf", ", "), ("anyOf", " or ")] {
            if value[kind].is_array() {
                return entry_list(value, kind).map(|choice| self.words(choice)).collect::<Vec<_>>().join(separator);
            }
        }
        match value["type"].as_str().unwrap_or_default() {
            "array" => self.list(value),
            "boolean" => "`true` or `false`".to_owned(),
            "string" => "text".to_owned(),
            "integer" => format!("a whole number{}", range(value)),
            "number" => format!("a number{}", range(value)),
            other => other.to_owned(),
        }
    }

    /// The values that a named type allows.
    fn type_words(&mut self, name: &'s str) -> String {
        let target = &self.schema["$defs"][name];
        if name == "TextureReference" {
            "a texture".to_owned()
        } else if name.starts_with("ConstantColour") {
            match range(&target["anyOf"][1]) {
                range if range.is_empty() => "a colour".to_owned(),
                range => format!("a colour ({})", range.trim_start()),
            }
        } else if target["properties"].is_object() || target["oneOf"][0]["properties"].is_object() {
            self.sections.push(name);
            let title = title_of(name);
            format!("[{title}](#{})", title.to_lowercase())
        } else {
            self.words(target)
        }
    }

    fn list(&mut self, value: &'s Value) -> String {
        // Tables that have no name of their own are told by their keys.
        if value["items"]["properties"].is_object() {
            let keys: Vec<String> = entries(&value["items"], "properties").map(|(key, _)| format!("`{key}`")).collect();
            return format!("a list of tables of {}", keys.join(", "));
        }
        let item = self.words(&value["items"]);
        let item = item.trim_start_matches("a ");
        // A list of lists has the plural already.
        let items = if item.contains("numbers") {
            item.to_owned()
        } else {
            item.replacen("number", "numbers", 1).replacen("text", "texts", 1)
        };
        match value["maxItems"].as_u64() {
            Some(count) if value["minItems"].as_u64() == Some(count) => format!("{count} {items}"),
            Some(count) => format!("at most {count} {items}"),
            None => format!("a list of {items}{}", if value["items"]["type"] == "array" { " each" } else { "" }),
        }
    }
}

/// The purpose of a key, the meaning of its values, and its default.
fn meaning(value: &Value) -> String {
    let mut meaning = description(value);
    for choice in entry_list(value, "oneOf").filter(|choice| !description(choice).is_empty()) {
        let value = if choice["const"].is_null() { "A number".to_owned() } else { format!("`{}`", choice["const"]) };
        let _ = write!(meaning, "<br>{value}: {}", description(choice));
    }
    if let Some(default) = value.get("default") {
        let _ = write!(meaning, "{}`{default}` when left out.", if meaning.contains("<br>") { "<br>" } else { " " });
    }
    meaning
}

/// The range of a number; the ends that nobody comes near are left out.
fn range(value: &Value) -> String {
    let most = value["maximum"].as_f64().filter(|most| *most < f64::from(i32::MAX));
    let least = value["minimum"].as_f64().filter(|least| *least > f64::from(i32::MIN));
    match (least, value["exclusiveMinimum"].as_f64(), most) {
        (Some(least), _, Some(most)) => format!(" from {least} to {most}"),
        (Some(least), _, None) => format!(" of at least {least}"),
        (None, Some(least), Some(most)) => format!(" above {least}, at most {most}"),
        (None, Some(least), None) => format!(" above {least}"),
        (None, None, Some(most)) => format!(" of at most {most}"),
        (None, None, None) => String::new(),
    }
}

fn entry_list<'v>(value: &'v Value, key: &str) -> impl Iterator<Item = &'v Value> + use<'v> {
    value[key].as_array().into_iter().flatten()
}

fn entries<'v>(value: &'v Value, key: &str) -> impl Iterator<Item = (&'v str, &'v Value)> + use<'v> {
    let entries = value[key].as_object().into_iter().flat_map(Map::iter);
    entries.map(|(key, value)| (key.as_str(), value))
}

/// The description on one line, as a cell of a table needs it.
fn description(value: &Value) -> String {
    value["description"].as_str().unwrap_or_default().replace('\n', " ").replace('|', "\\|")
}

/// A type's name as a heading.
fn title_of(name: &str) -> &str {
    name.strip_suffix("Entry").unwrap_or(name)
}
