//! From XML to plugins: defaults, includes, aliases and references resolved, names of old versions brought up to date.

use std::cell::Cell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use glam::DAffine3;
use roxmltree::{Document, Node};

use super::number::parse_number;
use super::plugin::{Child, Plugin, Property, PropertyValue, Spectrum, Within, error_at};
use super::{colour, transform};
use crate::load::encoding;
use crate::load::error::{SceneError, show};
use crate::load::files::{Files, MOST_SCENE_BYTES};
use crate::load::import::{ImportReport, Place};

/// Most files that include each other.
const DEEPEST_INCLUDE: usize = 16;
/// Most files in all.
const MOST_INCLUDES: usize = 1000;
/// Most elements within each other. Scenes have about ten.
const DEEPEST: usize = 100;

/// Elements that are plugins.
const PLUGINS: [&str; 17] = [
    "scene",
    "integrator",
    "sampler",
    "film",
    "rfilter",
    "sensor",
    "camera",
    "emitter",
    "luminaire",
    "shape",
    "subsurface",
    "medium",
    "volume",
    "phase",
    "bsdf",
    "texture",
    "spectrum",
];

/// Files, parameters and plugins so far.
pub struct Reader<'a> {
    files: &'a Files,
    /// Folders in which files are looked for, the scene's first.
    pub folders: Vec<PathBuf>,
    /// What `$key` stands for.
    parameters: HashMap<String, String>,
    /// Parameters of the command line, and whether the file asked for them.
    given: Vec<(String, Cell<bool>)>,
    by_id: HashMap<String, Rc<Plugin>>,
    pub report: ImportReport,
    included: usize,
}

/// What the elements of one file have in common.
#[derive(Clone, Copy)]
struct Source<'d> {
    name: &'d str,
    /// Where the lines end, in bytes: to count them for each element takes the square of the file's length.
    line_ends: &'d [usize],
}

impl Source<'_> {
    fn place(&self, node: Node) -> Place {
        let line = self.line_ends.partition_point(|end| *end < node.range().start) + 1;
        Place { file: self.name.to_owned(), line: Some(line), key: String::new() }
    }
}

impl<'a> Reader<'a> {
    pub fn new(files: &'a Files, folder: PathBuf, definitions: &[(String, String)]) -> Self {
        Self {
            files,
            folders: vec![folder],
            parameters: definitions.iter().cloned().collect(),
            given: definitions.iter().map(|(key, _)| (key.clone(), Cell::new(false))).collect(),
            by_id: HashMap::new(),
            report: ImportReport::default(),
            included: 0,
        }
    }

    /// Reads a scene file and all that it includes.
    pub fn scene(&mut self, path: &Path) -> Result<Rc<Plugin>, SceneError> {
        let scene = self.file(path, 0)?;
        match self.given.iter().find(|(_, asked)| !asked.get()) {
            None => Ok(Rc::new(scene)),
            Some((key, _)) => Err(SceneError::in_file(show(path), format!("nothing in the scene is called ${key}"))
                .with_help("-D gives a value to a parameter that the file names as $key or declares by <default name=\"key\">")),
        }
    }

    fn file(&mut self, path: &Path, depth: usize) -> Result<Plugin, SceneError> {
        let name = show(path);
        let bytes = self
            .files
            .read(path, MOST_SCENE_BYTES)
            .map_err(|error| SceneError::in_file(&name, format!("cannot be read: {error}")))?;
        let (text, _) = encoding::decode(&bytes);
        check_depth(&name, &text)?;
        let document = Document::parse(&text).map_err(|error| {
            let message = error.to_string();
            let what = message.rsplit_once(" at ").map_or(message.as_str(), |(what, _)| what).to_owned();
            SceneError::in_line(&name, error.pos().row as usize, format!("is not valid XML: {what}"))
        })?;
        let line_ends: Vec<usize> = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at).collect();
        let source = Source { name: &name, line_ends: &line_ends };
        let root = document.root_element();
        if root.tag_name().name() != "scene" && depth == 0 {
            let tag = root.tag_name().name();
            return Err(error_at(
                &source.place(root),
                format!("the file begins with <{tag}>; a Mitsuba scene begins with <scene>"),
            ));
        }
        if root.tag_name().name() == "scene" {
            return self.plugin(source, root, depth);
        }
        // An included file may be a single plugin.
        let mut around = empty_plugin("scene", source.place(root));
        self.element(source, root, &mut around, depth)?;
        Ok(around)
    }

    fn plugin(&mut self, source: Source, node: Node, depth: usize) -> Result<Plugin, SceneError> {
        let place = source.place(node);
        let mut plugin = empty_plugin(modern_kind(node.tag_name().name()), place);
        plugin.name = self.attribute(source, node, "type")?.unwrap_or_default();
        plugin.id = self.attribute(source, node, "id")?.unwrap_or_default();
        for child in node.children() {
            if child.is_element() {
                self.element(source, child, &mut plugin, depth)?;
            } else if child.is_text() && child.text().is_some_and(|text| !text.trim().is_empty()) {
                return Err(error_at(&source.place(child), "there is text outside of an element's attributes"));
            }
        }
        old_texture_coordinates(&mut plugin);
        plugin.summarize();
        if plugin.within.depth > DEEPEST {
            return Err(plugin.error(format!("plugins lie more than {DEEPEST} deep within each other, references followed")));
        }
        Ok(plugin)
    }

    /// Reads one element into the plugin around it.
    fn element(&mut self, source: Source, node: Node, around: &mut Plugin, depth: usize) -> Result<(), SceneError> {
        let tag = node.tag_name().name();
        let place = source.place(node);
        match tag {
            "default" => {
                let (name, value) = (self.needed(source, node, "name")?, self.needed(source, node, "value")?);
                for (_, asked) in self.given.iter().filter(|(key, _)| *key == name) {
                    asked.set(true);
                }
                self.parameters.entry(name).or_insert(value);
            }
            "path" => {
                let value = self.needed(source, node, "value")?;
                let folder = self.folders[0].join(value.replace('\\', "/"));
                self.folders.push(folder);
            }
            "include" => self.include(source, node, around, depth)?,
            "alias" => {
                let (id, new) = (self.needed(source, node, "id")?, self.needed(source, node, "as")?);
                let plugin = self.known(&place, &id)?;
                if self.by_id.insert(new.clone(), plugin).is_some() {
                    return Err(error_at(&place, format!("a second plugin has the id `{new}`")));
                }
            }
            "ref" => {
                let id = self.needed(source, node, "id")?;
                let plugin = self.known(&place, &id)?;
                let name = self.property_name(source, node)?;
                around.children.push(Child { name, plugin, used: Cell::new(false) });
            }
            "spectrum" | "texture" if node.attribute("type").is_none() && node.attribute("value").is_some() => {
                self.property(source, node, around)?;
            }
            "spectrum" if node.attribute("type").is_none() && node.attribute("filename").is_some() => {
                self.property(source, node, around)?;
            }
            _ if PLUGINS.contains(&tag) => {
                let name = self.property_name(source, node)?;
                let plugin = Rc::new(self.plugin(source, node, depth)?);
                if !plugin.id.is_empty() && self.by_id.insert(plugin.id.clone(), plugin.clone()).is_some() {
                    return Err(error_at(&place, format!("a second plugin has the id `{}`", plugin.id)));
                }
                around.children.push(Child { name, plugin, used: Cell::new(false) });
            }
            _ => self.property(source, node, around)?,
        }
        Ok(())
    }

    fn include(&mut self, source: Source, node: Node, around: &mut Plugin, depth: usize) -> Result<(), SceneError> {
        let place = source.place(node);
        let written = self.needed(source, node, "filename")?;
        self.included += 1;
        if depth + 1 >= DEEPEST_INCLUDE || self.included > MOST_INCLUDES {
            let message =
                format!("files include each other more than {DEEPEST_INCLUDE} deep, or more than {MOST_INCLUDES} times");
            return Err(error_at(&place, message).with_help("a file cannot include itself"));
        }
        let path = self.find(&written).ok_or_else(|| error_at(&place, format!("there is no file {written}")))?;
        let included = self.file(&path, depth + 1)?;
        around.children.extend(included.children);
        around.properties.extend(included.properties);
        Ok(())
    }

    /// A file that the scene names, in the folder of the scene or one that `<path>` adds.
    pub fn find(&self, written: &str) -> Option<PathBuf> {
        self.folders.iter().find_map(|folder| self.files.find(folder, written)).map(|found| found.path)
    }

    fn known(&self, place: &Place, id: &str) -> Result<Rc<Plugin>, SceneError> {
        self.by_id
            .get(id)
            .cloned()
            .ok_or_else(|| error_at(place, format!("there is no plugin with the id `{id}` above this line")))
    }

    fn property(&mut self, source: Source, node: Node, around: &mut Plugin) -> Result<(), SceneError> {
        let tag = node.tag_name().name();
        let place = source.place(node);
        let name = self.property_name(source, node)?;
        let number = |reader: &mut Self| -> Result<f64, SceneError> {
            let text = reader.needed(source, node, "value")?;
            parse_number(&place, &text)
        };
        let value = match tag {
            "float" | "integer" | "long" => PropertyValue::Number(number(self)?),
            "boolean" => match self.needed(source, node, "value")?.trim().to_ascii_lowercase().as_str() {
                "true" => PropertyValue::Flag(true),
                "false" => PropertyValue::Flag(false),
                other => return Err(error_at(&place, format!("expected true or false, found `{other}`"))),
            },
            "string" => PropertyValue::Text(self.needed(source, node, "value")?),
            "point" | "vector" => PropertyValue::Vector(self.vector(source, node)?),
            "rgb" | "color" => PropertyValue::Rgb(colour::parse_rgb(&place, &self.needed(source, node, "value")?)?),
            "srgb" => PropertyValue::Rgb(colour::parse_srgb(&place, &self.needed(source, node, "value")?)?),
            "spectrum" => self.spectrum(source, node)?,
            "blackbody" => {
                let kelvin = self.needed(source, node, "temperature")?;
                let kelvin = parse_number(&place, kelvin.trim_end_matches(['K', 'k']))?;
                let scale = match self.attribute(source, node, "scale")? {
                    Some(scale) => parse_number(&place, &scale)?,
                    None => 1.0,
                };
                PropertyValue::Spectrum(Spectrum::BlackBody(kelvin, scale))
            }
            "transform" => PropertyValue::Transform(self.transform(source, node)?),
            "animation" => {
                self.report.drop("animation", place.to_string(), "its first transform is taken for all times");
                let first = node.children().find(|child| child.has_tag_name("transform"));
                PropertyValue::Transform(first.map_or(Ok(DAffine3::IDENTITY), |node| self.transform(source, node))?)
            }
            _ => return Err(error_at(&place, format!("<{tag}> is no element of a Mitsuba scene"))),
        };
        if around.properties.iter().any(|property| property.name == name) {
            return Err(error_at(&place, format!("`{name}` is given twice")));
        }
        around.properties.push(Property { name, value, place, used: Cell::new(false) });
        Ok(())
    }

    fn spectrum(&mut self, source: Source, node: Node) -> Result<PropertyValue, SceneError> {
        let place = source.place(node);
        if let Some(file) = self.attribute(source, node, "filename")? {
            let path = self.find(&file).ok_or_else(|| error_at(&place, format!("there is no file {file}")))?;
            let bytes = self.files.read(&path, 1 << 24);
            let bytes = bytes.map_err(|error| error_at(&place, format!("{}: cannot be read: {error}", show(&path))))?;
            let (text, _) = encoding::decode(&bytes);
            return colour::parse_spectrum_file(&place, &text).map(PropertyValue::Spectrum);
        }
        colour::parse_spectrum(&place, &self.needed(source, node, "value")?)
    }

    fn transform(&mut self, source: Source, node: Node) -> Result<DAffine3, SceneError> {
        let mut map = DAffine3::IDENTITY;
        for step in node.children().filter(Node::is_element) {
            let place = source.place(step);
            let mut get = |name: &str| self.attribute(source, step, name);
            map = transform::step(&place, step.tag_name().name(), &mut get)? * map;
        }
        Ok(map)
    }

    fn vector(&mut self, source: Source, node: Node) -> Result<glam::DVec3, SceneError> {
        let place = source.place(node);
        let mut get = |name: &str| self.attribute(source, node, name);
        transform::vector(&place, &mut get, 0.0)
    }

    /// An attribute with parameters filled in.
    fn attribute(&mut self, source: Source, node: Node, name: &str) -> Result<Option<String>, SceneError> {
        let Some(text) = node.attribute(name) else { return Ok(None) };
        if !text.contains('$') {
            return Ok(Some(text.to_owned()));
        }
        let place = source.place(node);
        self.filled(&place, text).map(Some)
    }

    fn needed(&mut self, source: Source, node: Node, name: &str) -> Result<String, SceneError> {
        self.attribute(source, node, name)?
            .ok_or_else(|| error_at(&source.place(node), format!("<{}> needs the attribute `{name}`", node.tag_name().name())))
    }

    /// `$key` stands for the value of the longest parameter whose name follows.
    fn filled(&self, place: &Place, text: &str) -> Result<String, SceneError> {
        let mut filled = String::new();
        let mut rest = text;
        while let Some(at) = rest.find('$') {
            filled.push_str(&rest[..at]);
            rest = &rest[at + 1..];
            let fitting = self.parameters.keys().filter(|key| !key.is_empty() && rest.starts_with(key.as_str()));
            let Some(key) = fitting.max_by_key(|key| key.len()) else {
                let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                return Err(
                    error_at(place, format!("nothing says what ${name} is")).with_help(format!("give it by -D {name}=VALUE"))
                );
            };
            self.given.iter().filter(|(given, _)| given == key).for_each(|(_, asked)| asked.set(true));
            filled.push_str(&self.parameters[key]);
            rest = &rest[key.len()..];
        }
        filled.push_str(rest);
        Ok(filled)
    }

    /// The name of a property as versions from 2 on write it.
    fn property_name(&mut self, source: Source, node: Node) -> Result<String, SceneError> {
        Ok(modern_name(&self.attribute(source, node, "name")?.unwrap_or_default()))
    }
}

fn empty_plugin(kind: &str, place: Place) -> Plugin {
    Plugin {
        kind: kind.to_owned(),
        name: String::new(),
        id: String::new(),
        place,
        properties: Vec::new(),
        children: Vec::new(),
        within: Within::default(),
        visited: Cell::new(false),
    }
}

/// Elements of versions before 0.5.
fn modern_kind(tag: &str) -> &str {
    match tag {
        "luminaire" => "emitter",
        "camera" => "sensor",
        other => other,
    }
}

/// `toWorld` became `to_world` in version 2, and some words changed.
fn modern_name(name: &str) -> String {
    let mut modern = String::with_capacity(name.len() + 4);
    for character in name.chars() {
        if character.is_ascii_uppercase() {
            if !modern.is_empty() && !modern.ends_with('_') {
                modern.push('_');
            }
            modern.push(character.to_ascii_lowercase());
        } else {
            modern.push(character);
        }
    }
    match modern.as_str() {
        "int_i_o_r" => "int_ior".to_owned(),
        "ext_i_o_r" => "ext_ior".to_owned(),
        "diffuse_amount" => "diffuse_reflectance".to_owned(),
        "specular_amount" => "specular_reflectance".to_owned(),
        _ => modern,
    }
}

/// `uscale` and its like, which became `to_uv` in version 2.
fn old_texture_coordinates(plugin: &mut Plugin) {
    if plugin.kind != "texture" {
        return;
    }
    let number = |name: &str| {
        plugin.properties.iter().find_map(|property| match property.value {
            PropertyValue::Number(number) if property.name == name => Some(number),
            _ => None,
        })
    };
    let both = number("uvscale");
    let found = ["uscale", "vscale", "uoffset", "voffset"].map(number);
    if both.is_none() && found.iter().all(Option::is_none) {
        return;
    }
    let [u, v, u_offset, v_offset] = found;
    let scale = glam::DVec3::new(u.or(both).unwrap_or(1.0), v.or(both).unwrap_or(1.0), 1.0);
    let offset = glam::DVec3::new(u_offset.unwrap_or(0.0), v_offset.unwrap_or(0.0), 0.0);
    plugin.properties.retain(|property| !["uscale", "vscale", "uvscale", "uoffset", "voffset"].contains(&property.name.as_str()));
    plugin.properties.push(Property {
        name: "to_uv".to_owned(),
        value: PropertyValue::Transform(DAffine3::from_translation(offset) * DAffine3::from_scale(scale)),
        place: plugin.place.clone(),
        used: Cell::new(false),
    });
}

/// Elements that lie too deep within each other would take the parser's stack.
fn check_depth(name: &str, text: &str) -> Result<(), SceneError> {
    let bytes = text.as_bytes();
    let mut depth = 0_usize;
    let mut rest = 0;
    while let Some(found) = text[rest..].find('<') {
        let at = rest + found;
        let (step, skip) = match bytes.get(at + 1) {
            Some(b'!') if text[at..].starts_with("<!--") => (0, text[at..].find("-->").unwrap_or(1)),
            Some(b'/') => (-1, 2),
            Some(b'!' | b'?') | None => (0, 1),
            Some(_) => {
                let end = text[at..].find('>').unwrap_or(1);
                (if end > 0 && bytes[at + end - 1] == b'/' { 0 } else { 1 }, end.max(1))
            }
        };
        depth = depth.saturating_add_signed(step);
        if depth > DEEPEST {
            let line = text[..at].matches('\n').count() + 1;
            return Err(SceneError::in_line(name, line, format!("elements lie more than {DEEPEST} deep within each other")));
        }
        rest = at + skip;
        while !text.is_char_boundary(rest) {
            rest += 1;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_brought_up_to_date() {
        let rows = [
            ("toWorld", "to_world"),
            ("maxDepth", "max_depth"),
            ("intIOR", "int_ior"),
            ("to_uv", "to_uv"),
            ("alphaU", "alpha_u"),
        ];
        for (old, new) in rows {
            assert_eq!(modern_name(old), new);
        }
    }

    #[test]
    fn deep_files_are_refused_before_they_are_parsed() {
        let deep = format!("<scene>{}", "<a>".repeat(1_000_000));
        assert!(check_depth("a.xml", &deep).is_err());
        assert!(check_depth("a.xml", &"<a><b/></a><!-- <c> -->".repeat(1000)).is_ok());
    }
}
