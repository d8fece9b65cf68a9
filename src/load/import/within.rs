//! A description as part of another scene.

use glam::{DAffine3, DVec3};

use super::description::{Description, Entry, HeldContent};
use super::keys::{Keys, Value};
use super::placed::{matrix_of, matrix_value};

/// Keys whose values are names of materials, textures, nodes or groups.
const REFERENCES: [&str; 9] =
    ["group", "material", "materials", "node", "anisotropy_direction", "normal_map", "coat_normal_map", "bump_map", "texture"];

/// Marks the name of a material of the scene around, which stays as it is.
const OURS: char = '\u{1}';

impl Description {
    /// Moves all of it.
    pub fn place(&mut self, map: &DAffine3) {
        for shape in self.shapes.iter_mut().chain(&mut self.instances) {
            let own = shape.keys.get("transform").and_then(matrix_of).unwrap_or(DAffine3::IDENTITY);
            if let Some(matrix) = matrix_value(&(*map * own)) {
                shape.keys.set("transform", matrix);
            } else {
                shape.keys.0.retain(|(key, _)| *key != "transform");
            }
        }
        self.place_nodes(map);
        let camera = self.camera.iter_mut();
        for entry in self.lights.iter_mut().chain(camera) {
            for (key, value) in &mut entry.keys.0 {
                let Some(vector) = vector(value) else { continue };
                match *key {
                    "position" | "look_at" => *value = map.transform_point3(vector).into(),
                    "direction" | "up" => *value = (map.matrix3 * vector).normalize_or(vector).into(),
                    _ => {}
                }
            }
            if entry.keys.text("type") == Some("environment")
                && let Some(turn) = turn_about_y(map)
                && let Some(Value::Number(degrees)) = entry.keys.get("rotate")
            {
                let degrees = degrees + turn;
                entry.keys.set("rotate", degrees);
            }
        }
        let is_map = |light: &Entry| light.keys.get("file").is_some();
        if turn_about_y(map).is_none() && self.lights.iter().any(is_map) {
            let place = self.lights.iter().find(|light| is_map(light)).map(|light| light.place.to_string());
            let instead = "it stands upright as before";
            self.report.approximate("environment map of a scene that is turned over", place.unwrap_or_default(), instead);
        }
    }

    /// Puts the nodes into one that stands where all is moved to: what they take along is moved already.
    fn place_nodes(&mut self, map: &DAffine3) {
        let Some(matrix) = matrix_value(map).filter(|_| !self.nodes.is_empty()) else { return };
        let name = self.free_node_name("(placed)");
        for node in self.nodes.iter_mut().filter(|node| node.keys.get("parent").is_none()) {
            node.keys.set("parent", name.as_str());
        }
        let keys = Keys::new().with("name", name).with("transform", matrix);
        self.nodes.push(Entry { keys, ..Entry::default() });
    }

    /// A scene has one environment: keeps its own only where that is `open`, and says whether it still is.
    pub fn keep_environment(&mut self, open: bool) -> bool {
        let is_environment = |light: &Entry| matches!(light.keys.text("type"), Some("environment" | "sky"));
        let Some(first) = self.lights.iter().position(is_environment) else { return open };
        let mut place = 0;
        let mut left_out = Vec::new();
        self.lights.retain(|light| {
            let keeps = !is_environment(light) || open && place == first;
            if !keeps {
                left_out.push(light.place.to_string());
            }
            place += 1;
            keeps
        });
        for place in left_out {
            self.report.drop("environment of an imported file", place, "the scene has another one");
        }
        false
    }

    /// Lets shapes and blends have a material of the scene around in place of one of its own. Whether it has that one.
    pub fn replace_material(&mut self, theirs: &str, ours: &str) -> bool {
        let before = self.materials.len();
        self.materials.retain(|entry| entry.keys.text("name") != Some(theirs));
        let replaced = format!("{OURS}{ours}");
        let variants = &self.material_variants;
        let of_groups = self.groups.iter_mut().flat_map(|group| &mut group.shapes);
        for entry in self.shapes.iter_mut().chain(of_groups).chain(&mut self.materials) {
            let is_theirs = |name: &str| name == theirs || variants.get(name).is_some_and(|of| of == theirs);
            rename(&mut entry.keys, &["material", "materials"], &|name| {
                if is_theirs(name) { replaced.clone() } else { name.to_owned() }
            });
        }
        self.materials.len() < before
    }

    /// Puts `prefix` before all names, so that they are not those of the scene around.
    pub fn prefix_names(&mut self, prefix: &str, held: impl Fn(usize) -> String) {
        let renamed = |name: &str| match name.strip_prefix(OURS) {
            Some(ours) => ours.to_owned(),
            None => format!("{prefix}{name}"),
        };
        for entry in self.textures.iter_mut().chain(&mut self.materials) {
            rename(&mut entry.keys, &["name"], &renamed);
        }
        for entry in &mut self.textures {
            rename(&mut entry.keys, &["times"], &renamed);
        }
        self.groups.iter_mut().for_each(|group| group.name = renamed(&group.name));
        let of_groups = self.groups.iter_mut().flat_map(|group| &mut group.shapes);
        for entry in self.materials.iter_mut().chain(&mut self.shapes).chain(of_groups).chain(&mut self.instances) {
            rename(&mut entry.keys, &REFERENCES, &renamed);
        }
        for node in &mut self.nodes {
            rename(&mut node.keys, &["name", "parent"], &renamed);
        }
        for entry in self.camera.iter_mut().chain(&mut self.lights) {
            rename(&mut entry.keys, &["node"], &renamed);
        }
        for (index, (name, content)) in self.held.iter_mut().enumerate() {
            let ending = match content {
                HeldContent::Mesh(_) => "ply",
                HeldContent::Bytes(_) => name.rsplit('.').next().unwrap_or_default(),
            };
            *name = format!("{}.{ending}", held(index));
        }
    }
}

/// Renames what these keys name, at any depth.
fn rename(keys: &mut Keys, of: &[&str], renamed: &dyn Fn(&str) -> String) {
    for (key, value) in &mut keys.0 {
        match value {
            Value::Text(name) if of.contains(key) => *name = renamed(name),
            Value::List(names) if of.contains(key) => {
                for name in names {
                    if let Value::Text(name) = name {
                        *name = renamed(name);
                    }
                }
            }
            Value::List(tables) if of != ["name"] => {
                for table in tables {
                    if let Value::Table(keys) = table {
                        rename(keys, of, renamed);
                    }
                }
            }
            // The name of a table within is no name of an entry.
            Value::Table(keys) if of != ["name"] => rename(keys, of, renamed),
            _ => {}
        }
    }
}

fn vector(value: &Value) -> Option<DVec3> {
    let Value::List(numbers) = value else { return None };
    match numbers[..] {
        [Value::Number(x), Value::Number(y), Value::Number(z)] => Some(DVec3::new(x, y, z)),
        _ => None,
    }
}

/// Degrees about +Y, where the map leaves that upright.
fn turn_about_y(map: &DAffine3) -> Option<f64> {
    let (x, y) = (map.matrix3.x_axis.normalize_or_zero(), map.matrix3.y_axis.normalize_or_zero());
    let upright = (y - DVec3::Y).length() < 1e-9 && map.matrix3.determinant() > 0.0;
    upright.then(|| (-x.z).atan2(x.x).to_degrees())
}
