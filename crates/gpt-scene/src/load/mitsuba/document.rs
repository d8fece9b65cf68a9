//! From XML to plugins: includes, aliases and references resolved.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use roxmltree::{Document, Node, ParsingOptions};

use super::limits::{MOST_SHAPES, too_many_shapes};
use super::nesting::check_depth;
use super::parameters::Parameters;
use super::plugin::{Plugin, Within, error_at};
use super::references::{Draft, NestedPlugin, References, Target};
use super::versions::{modern_kind, modern_name, old_texture_coordinates};
use crate::load::encoding;
use crate::load::error::{SceneError, show};
use crate::load::files::{Files, MOST_SCENE_BYTES};
use crate::load::import::ImportReport;
use crate::load::memory;
use crate::load::place::Origin;

/// Most files that include each other.
const DEEPEST_INCLUDE: usize = 16;
/// Most files in all.
const MOST_INCLUDES: usize = 1000;
/// Bytes that a plugin or a property takes once it is read, and how many of them there are before it is asked whether there is memory for them: files
/// that are included over and over have more than their bytes say.
const ELEMENT_BYTES: u64 = 1 << 10;
const MANY_ELEMENTS: u64 = 1 << 20;

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
    pub files: &'a Files,
    /// Folders in which files are looked for, the scene's first.
    pub folders: Vec<PathBuf>,
    parameters: Parameters,
    references: References,
    pub report: ImportReport,
    /// The scene is written for a version before 2.
    pub is_of_old: bool,
    included: usize,
    elements: u64,
    shapes: usize,
}

/// Data that the elements of one file share.
#[derive(Clone, Copy)]
pub struct Source<'d> {
    name: &'d str,
    /// Ends of the lines, in bytes: counting them for each element takes the square of the file's length.
    line_ends: &'d [usize],
}

impl Source<'_> {
    pub fn place(&self, node: Node) -> Origin {
        let line = self.line_ends.partition_point(|end| *end < node.range().start) + 1;
        Origin { file: self.name.to_owned(), line: Some(line), key: String::new() }
    }
}

impl<'a> Reader<'a> {
    pub fn new(files: &'a Files, folder: PathBuf, definitions: &[(String, String)]) -> Self {
        Self {
            files,
            folders: vec![folder],
            parameters: Parameters::new(definitions),
            references: References::default(),
            report: ImportReport::default(),
            is_of_old: false,
            included: 0,
            elements: 0,
            shapes: 0,
        }
    }

    /// Reads a scene file and all that it includes.
    pub fn scene(&mut self, path: &Path) -> Result<Rc<Plugin>, SceneError> {
        let scene = self.file(path, 0)?;
        match self.parameters.unknown() {
            None => std::mem::take(&mut self.references).resolve(scene),
            Some(key) => Err(SceneError::in_file(show(path), format!("nothing in the scene is called ${key}"))
                .with_help("-D gives a value to a parameter that the file names as $key or declares by <default name=\"key\">")),
        }
    }

    fn file(&mut self, path: &Path, depth: usize) -> Result<Draft, SceneError> {
        let name = show(path);
        let bytes = self
            .files
            .read(path, MOST_SCENE_BYTES)
            .map_err(|error| SceneError::in_file(&name, format!("cannot be read: {error}")))?;
        let (text, _) = encoding::decode(&bytes);
        check_depth(&name, &text)?;
        // Older scenes name the type of their document; entities that lead to themselves are refused by the parser.
        let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
        let document = Document::parse_with_options(&text, options).map_err(|error| {
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
            if depth == 0 {
                self.is_of_old = root.attribute("version").is_some_and(|version| version.trim().starts_with("0."));
            }
            return self.plugin(source, root, depth);
        }
        // An included file may be a single plugin.
        let mut around = Draft { plugin: empty_plugin("scene", source.place(root)), parts: Vec::new() };
        self.element(source, root, &mut around, depth)?;
        Ok(around)
    }

    fn plugin(&mut self, source: Source, node: Node, depth: usize) -> Result<Draft, SceneError> {
        let place = source.place(node);
        let mut plugin = empty_plugin(modern_kind(node.tag_name().name()), place);
        plugin.name = self.attribute(source, node, "type")?.unwrap_or_default();
        plugin.id = self.attribute(source, node, "id")?.unwrap_or_default();
        let mut draft = Draft { plugin, parts: Vec::new() };
        for child in node.children() {
            if child.is_element() {
                self.element(source, child, &mut draft, depth)?;
            } else if child.is_text() && child.text().is_some_and(|text| !text.trim().is_empty()) {
                return Err(error_at(&source.place(child), "there is text outside of an element's attributes"));
            }
        }
        old_texture_coordinates(&mut draft.plugin);
        Ok(draft)
    }

    /// Reads one element into the plugin around it.
    fn element(&mut self, source: Source, node: Node, around: &mut Draft, depth: usize) -> Result<(), SceneError> {
        let tag = node.tag_name().name();
        let place = source.place(node);
        self.elements += 1;
        let needed = self.elements * ELEMENT_BYTES;
        if self.elements.is_multiple_of(MANY_ELEMENTS) && needed > memory::available() {
            let message = format!(
                "the scene does not fit: up to here it has {} elements, included files counted, which take about {} MiB; {} MiB are free",
                self.elements,
                needed >> 20,
                memory::available() >> 20
            );
            return Err(error_at(&place, message));
        }
        self.shapes += usize::from(tag == "shape");
        if self.shapes > MOST_SHAPES {
            return Err(too_many_shapes(&place));
        }
        match tag {
            "default" => {
                let (name, value) = (self.needed(source, node, "name")?, self.needed(source, node, "value")?);
                self.parameters.declare(name, value);
            }
            "path" => {
                let value = self.needed(source, node, "value")?;
                let folder = self.folders[0].join(value.replace('\\', "/"));
                self.folders.push(folder);
            }
            "include" => self.include(source, node, around, depth)?,
            "alias" => {
                let (id, new) = (self.needed(source, node, "id")?, self.needed(source, node, "as")?);
                self.references.alias(new, id, place)?;
            }
            "ref" => {
                let id = self.needed(source, node, "id")?;
                let name = self.property_name(source, node)?;
                around.parts.push(NestedPlugin { name, target: Target::Named(id, place) });
            }
            "spectrum" | "texture" if node.attribute("type").is_none() && node.attribute("value").is_some() => {
                self.property(source, node, &mut around.plugin)?;
            }
            "spectrum" if node.attribute("type").is_none() && node.attribute("filename").is_some() => {
                self.property(source, node, &mut around.plugin)?;
            }
            _ if PLUGINS.contains(&tag) => {
                let name = self.property_name(source, node)?;
                let draft = self.plugin(source, node, depth)?;
                let target = self.references.note(draft)?;
                around.parts.push(NestedPlugin { name, target });
            }
            _ => self.property(source, node, &mut around.plugin)?,
        }
        Ok(())
    }

    fn include(&mut self, source: Source, node: Node, around: &mut Draft, depth: usize) -> Result<(), SceneError> {
        let place = source.place(node);
        let written = self.needed(source, node, "filename")?;
        self.included += 1;
        if depth + 1 >= DEEPEST_INCLUDE || self.included > MOST_INCLUDES {
            let message =
                format!("files include each other more than {DEEPEST_INCLUDE} deep, or more than {MOST_INCLUDES} times");
            return Err(error_at(&place, message).with_help("a file cannot include itself"));
        }
        let path = self.find(&written).ok_or_else(|| error_at(&place, format!("there is no file {written}")))?;
        let mut included = self.file(&path, depth + 1)?;
        // A plugin by itself takes the name that the including file gives it.
        if let (Some(name), [part]) = (self.attribute(source, node, "name")?, &mut included.parts[..]) {
            part.name = modern_name(&name);
        }
        around.parts.extend(included.parts);
        around.plugin.properties.extend(included.plugin.properties);
        Ok(())
    }

    /// A file that the scene names, in the folder of the scene or one that `<path>` adds.
    pub fn find(&self, written: &str) -> Option<PathBuf> {
        self.folders.iter().find_map(|folder| self.files.find(folder, written)).map(|found| found.path)
    }

    /// An attribute with parameters filled in.
    pub fn attribute(&self, source: Source, node: Node, name: &str) -> Result<Option<String>, SceneError> {
        let Some(text) = node.attribute(name) else { return Ok(None) };
        if !text.contains('$') {
            return Ok(Some(text.to_owned()));
        }
        self.parameters.filled(&source.place(node), text).map(Some)
    }

    pub fn needed(&self, source: Source, node: Node, name: &str) -> Result<String, SceneError> {
        self.attribute(source, node, name)?
            .ok_or_else(|| error_at(&source.place(node), format!("<{}> needs the attribute `{name}`", node.tag_name().name())))
    }

    /// The name of a property as versions from 2 on write it.
    pub fn property_name(&self, source: Source, node: Node) -> Result<String, SceneError> {
        Ok(modern_name(&self.attribute(source, node, "name")?.unwrap_or_default()))
    }
}

fn empty_plugin(kind: &str, place: Origin) -> Plugin {
    Plugin {
        kind: kind.to_owned(),
        name: String::new(),
        id: String::new(),
        place: place.into(),
        properties: Vec::new(),
        children: Vec::new(),
        within: Within::default(),
        visited: Cell::new(false),
    }
}
