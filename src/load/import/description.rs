//! A scene file in the making.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::keys::{FileReference, Keys, Value, list};
use super::outline::{corners, outline};
use super::place_file::{PLACE_NUMBERS, PlaceFormat, place_rows, write_places};
use super::placed::{matrix_of, matrix_value};
use crate::load::error::SceneError;
use crate::load::files::Files;
use crate::load::place::Origin;
use crate::scene::{ImportReport, Mesh};

/// A scene in the terms of scene files, and what it names that has no file of its own.
#[derive(Debug, Default)]
pub struct Description {
    /// `[film]`
    pub film: Keys,
    /// `[render]`
    pub render: Keys,
    /// `[camera]`; None: the scene has none, and is framed.
    pub camera: Option<Entry>,
    pub textures: Vec<Entry>,
    pub materials: Vec<Entry>,
    pub shapes: Vec<Entry>,
    /// Meshes that are stored once, and where they stand.
    pub groups: Vec<GroupOfShapes>,
    pub instances: Vec<Entry>,
    pub lights: Vec<Entry>,
    /// What takes shapes and the camera along at frames.
    pub nodes: Vec<Entry>,
    /// Meshes and pictures, by [`FileReference::Held`].
    pub held: Vec<(String, HeldContent)>,
    /// Of meshes that are bent, by the places of their files among `held`: what they are without a frame.
    pub bent: HashMap<usize, Arc<Mesh>>,
    /// Radiance up to which a surface glows and lights no scene.
    pub(super) glow: f64,
    /// Materials that are others for some meshes, by their names, and those others.
    pub material_variants: HashMap<String, String>,
    pub report: ImportReport,
    /// Unreadable things for which a stand-in was found, in words; whoever is strict refuses them.
    pub substitutes: Vec<String>,
    pub(super) group_names: Names,
    pub(super) material_names: Names,
    pub(super) texture_names: Names,
    pub(super) node_names: Names,
}

/// Something that a file would hold.
#[derive(Debug, Clone)]
pub enum HeldContent {
    Mesh(Arc<Mesh>),
    /// A picture file as it was embedded.
    Bytes(Arc<[u8]>),
}

/// A table of a scene file and what it was made from.
#[derive(Debug, Clone, Default)]
pub struct Entry {
    pub place: Origin,
    pub keys: Keys,
}

/// `[[group]]`
#[derive(Debug, Clone, Default)]
pub struct GroupOfShapes {
    pub name: String,
    pub place: Origin,
    /// `[[group.shape]]`
    pub shapes: Vec<Entry>,
}

/// Places up to which an instance has them in the scene file itself.
const MOST_WRITTEN_PLACES: usize = 16;
/// Points of instances that are looked at one by one to frame a scene; of more, the corners of boxes.
const MOST_POINTS: usize = 1 << 23;

impl Description {
    /// Warnings of stand-ins for things that cannot be read.
    ///
    /// # Errors
    /// The first of them, where that is not allowed.
    pub fn warnings(&self, name: &str, strict: bool) -> Result<Vec<String>, SceneError> {
        match self.substitutes.first() {
            Some(first) if strict => {
                Err(SceneError::in_file(name, first.clone()).with_help("without --strict, something stands for what is missing"))
            }
            _ => Ok(self.substitutes.iter().map(|what| format!("{name}: {what}")).collect()),
        }
    }

    /// An empty one, whose surfaces glow up to a radiance and light nothing.
    pub fn with_glow(glow: f64) -> Self {
        Self { glow, ..Self::default() }
    }

    /// Adds shapes of meshes as a group that stands in all of these places.
    pub fn add_instances(&mut self, name: &str, place: &Origin, shapes: Vec<Entry>, places: &[DAffine3]) {
        let name = self.group_names.free(name);
        self.groups.push(GroupOfShapes { name: name.clone(), place: place.clone(), shapes });
        let keys = Keys::new().with("group", name.as_str());
        let keys = match places {
            [only] => keys.with_some("transform", matrix_value(only)),
            few if few.len() <= MOST_WRITTEN_PLACES => keys.with("places", list(few.iter().map(|map| list(place_rows(map))))),
            many => {
                let file = format!("{:04}-{}.f64", self.held.len(), file_name(&name));
                let file = self.hold(file, HeldContent::Bytes(write_places(many).into()));
                keys.with("file", file)
            }
        };
        self.instances.push(Entry { place: place.clone(), keys });
    }

    /// True where a material of this name, or a part of it, gives light.
    pub fn gives_light(&self, name: &str) -> bool {
        let find = |name: &str| self.materials.iter().find(|entry| entry.keys.text("name") == Some(name));
        shines(name, &find, &|_| true)
    }

    /// Where an instance stands.
    fn places_of(&self, instance: &Entry) -> Vec<DAffine3> {
        let all = instance.keys.get("transform").and_then(matrix_of).unwrap_or(DAffine3::IDENTITY);
        let numbers: Vec<f64> = match (instance.keys.get("places"), instance.keys.get("file")) {
            (Some(Value::List(places)), _) => {
                let rows = places.iter().flat_map(|place| if let Value::List(row) = place { &row[..] } else { &[] });
                rows.filter_map(|number| if let Value::Number(number) = number { Some(*number) } else { None }).collect()
            }
            (_, Some(Value::File(FileReference::Held(index)))) => match self.held.get(*index) {
                Some((_, HeldContent::Bytes(bytes))) => PlaceFormat::Double.numbers(bytes).unwrap_or_default(),
                _ => Vec::new(),
            },
            _ => return vec![all],
        };
        let (rows, _) = numbers.as_chunks::<PLACE_NUMBERS>();
        let place = |row: &[f64; PLACE_NUMBERS]| {
            let column = |index: usize| DVec3::new(row[index], row[4 + index], row[8 + index]);
            DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
        };
        rows.iter().map(|row| all * place(row)).collect()
    }

    /// Keeps a mesh that shapes then name.
    pub fn hold_mesh(&mut self, name: &str, mesh: Mesh) -> FileReference {
        let name = format!("{:04}-{}.ply", self.held.len(), file_name(name));
        self.hold(name, HeldContent::Mesh(Arc::new(mesh)))
    }

    /// Keeps a mesh that is bent, and what it is without a frame.
    pub fn hold_bent_mesh(&mut self, name: &str, base: Arc<Mesh>, rest: Mesh) -> FileReference {
        self.bent.insert(self.held.len(), Arc::new(rest));
        let name = format!("{:04}-{}.ply", self.held.len(), file_name(name));
        self.hold(name, HeldContent::Mesh(base))
    }

    /// Keeps a picture or another file; `ending` says its format.
    pub fn hold_bytes(&mut self, name: &str, ending: &str, bytes: Vec<u8>) -> FileReference {
        let name = format!("{:04}-{}.{ending}", self.held.len(), file_name(name));
        self.hold(name, HeldContent::Bytes(bytes.into()))
    }

    fn hold(&mut self, name: String, content: HeldContent) -> FileReference {
        self.held.push((name, content));
        FileReference::Held(self.held.len() - 1)
    }

    /// Where a file is found while the scene is read.
    pub fn held_path(&self, file: &FileReference) -> PathBuf {
        match file {
            FileReference::Disk(path) => path.clone(),
            FileReference::Held(index) => Path::new("held:").join(self.held.get(*index).map_or("", |(name, _)| name)),
        }
    }

    /// Lets what is held be found, as a scene file in the folder names it.
    pub fn hold_in(&self, files: &mut Files, folder: &Path) {
        for (index, (_, content)) in self.held.iter().enumerate() {
            let path = folder.join(self.held_path(&FileReference::Held(index)));
            match content {
                HeldContent::Mesh(mesh) => files.hold_mesh(path, mesh.clone()),
                HeldContent::Bytes(bytes) => files.hold_bytes(path, bytes.clone()),
            }
        }
    }

    pub fn mesh(&self, file: &FileReference) -> Option<&Arc<Mesh>> {
        match file {
            FileReference::Held(index) => match &self.held.get(*index)?.1 {
                HeldContent::Mesh(mesh) => Some(mesh),
                HeldContent::Bytes(_) => None,
            },
            FileReference::Disk(_) => None,
        }
    }

    /// A light, or a material of a shape that gives more light than a glow.
    pub fn has_light(&self) -> bool {
        let is_enough = |value: &Value| brightest(value) > self.glow;
        // Instances give none.
        let used: HashSet<&str> = self.shapes.iter().filter_map(|shape| shape.keys.text("material")).collect();
        let named: HashMap<&str, &Entry> =
            self.materials.iter().filter_map(|entry| Some((entry.keys.text("name")?, entry))).collect();
        let lamps: HashSet<&str> =
            used.into_iter().filter(|name| shines(name, &|name| named.get(name).copied(), &is_enough)).collect();
        let is_lamp = |shape: &Entry| shape.keys.text("material").is_some_and(|name| lamps.contains(name));
        !self.lights.is_empty() || self.shapes.iter().any(is_lamp)
    }

    /// Points in the world around what is shown: the vertices of all meshes that faces use, or, without meshes, points around the other shapes.
    pub fn points(&self) -> Vec<DVec3> {
        let points = self.points_of_meshes();
        if !points.is_empty() {
            return points;
        }
        let placed = |shape: &Entry| {
            let map = transform_of(shape);
            outline(&shape.keys).into_iter().map(move |point| map.transform_point3(point))
        };
        self.shapes.iter().flat_map(placed).collect()
    }

    fn points_of_meshes(&self) -> Vec<DVec3> {
        let mut points = Vec::new();
        for shape in &self.shapes {
            points.extend(self.points_of_shape(shape));
        }
        for instance in &self.instances {
            let group = self.groups.iter().find(|group| Some(group.name.as_str()) == instance.keys.text("group"));
            let mut own: Vec<DVec3> =
                group.iter().flat_map(|group| &group.shapes).flat_map(|shape| self.points_of_shape(shape)).collect();
            let places = self.places_of(instance);
            if own.len().saturating_mul(places.len()) > MOST_POINTS {
                own = corners(&own);
            }
            points.extend(places.iter().flat_map(|place| own.iter().map(move |point| place.transform_point3(*point))));
        }
        points
    }

    /// The vertices of a mesh that faces use, as its transform places them.
    fn points_of_shape(&self, shape: &Entry) -> Vec<DVec3> {
        let Some(Value::File(file)) = shape.keys.get("file") else { return Vec::new() };
        let bent = if let FileReference::Held(index) = file { self.bent.get(index) } else { None };
        let Some(mesh) = bent.or_else(|| self.mesh(file)) else { return Vec::new() };
        let map = transform_of(shape);
        let mut used = vec![false; mesh.positions.len()];
        mesh.faces.iter().flatten().for_each(|&index| used[index as usize] = true);
        let placed = mesh.positions.iter().zip(used).filter(|(_, used)| *used);
        placed.map(|(position, _)| map.transform_point3(position.as_dvec3())).collect()
    }

    /// Adds a shape with a material of its own.
    pub fn add_surface(&mut self, name: &str, material: Keys, shape: Keys) {
        let name = self.free_material_name(name);
        let mut named = Keys::new().with("name", name.as_str());
        named.0.extend(material.0);
        self.materials.push(Entry { keys: named, ..Entry::default() });
        self.shapes.push(Entry { keys: shape.with("material", name), ..Entry::default() });
    }

    /// A name for a material that no other has, as near to the wanted one as can be.
    pub fn free_material_name(&mut self, wanted: &str) -> String {
        self.material_names.free(wanted)
    }

    /// The same for a node.
    pub fn free_node_name(&mut self, wanted: &str) -> String {
        self.node_names.free(wanted)
    }

    /// The same for a texture.
    pub fn free_texture_name(&mut self, wanted: &str) -> String {
        self.texture_names.free(wanted)
    }
}

/// True where a material, or a part of it, gives enough light. Parts that many blends share are looked at once.
fn shines<'e>(name: &str, find: &dyn Fn(&str) -> Option<&'e Entry>, is_enough: &dyn Fn(&Value) -> bool) -> bool {
    let mut seen = HashSet::new();
    let mut to_visit: Vec<&Entry> = find(name).into_iter().collect();
    while let Some(entry) = to_visit.pop() {
        if !entry.keys.text("name").is_some_and(|name| seen.insert(name)) {
            continue;
        }
        if ["emission", "radiance"].iter().any(|key| entry.keys.get(key).is_some_and(is_enough)) {
            return true;
        }
        let parts = if let Some(Value::List(parts)) = entry.keys.get("materials") { &parts[..] } else { &[] };
        to_visit.extend(parts.iter().filter_map(|part| if let Value::Text(part) = part { find(part) } else { None }));
    }
    false
}

fn transform_of(shape: &Entry) -> DAffine3 {
    shape.keys.get("transform").and_then(matrix_of).unwrap_or(DAffine3::IDENTITY)
}

/// The most that a colour can be, where textures are at most white.
fn brightest(colour: &Value) -> f64 {
    match colour {
        Value::Number(number) => *number,
        Value::Integer(number) => *number as f64,
        Value::List(channels) => channels.iter().map(brightest).fold(0.0, f64::max),
        Value::Table(texture) => texture.get("factor").map_or(1.0, brightest),
        Value::Flag(_) | Value::Text(_) | Value::File(_) => 1.0,
    }
}

/// Names that are taken.
#[derive(Debug, Default)]
pub(super) struct Names {
    taken: HashSet<String>,
    /// How often each was wanted, so that many of a kind take no longer than few.
    wanted: HashMap<String, usize>,
}

impl Names {
    fn free(&mut self, wanted: &str) -> String {
        let wanted = if wanted.is_empty() { "unnamed" } else { wanted };
        let count = self.wanted.entry(wanted.to_owned()).or_default();
        loop {
            *count += 1;
            let name = if *count == 1 { wanted.to_owned() } else { format!("{wanted} ({count})") };
            if self.taken.insert(name.clone()) {
                return name;
            }
        }
    }
}

/// A name as part of a file's name.
fn file_name(name: &str) -> String {
    let plain = |character: char| if character.is_ascii_alphanumeric() || "-_".contains(character) { character } else { '_' };
    name.chars().take(40).map(plain).collect()
}
