//! A scene file in the making.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use crate::load::error::SceneError;
use crate::load::file::instance::{GroupEntry, InstanceEntry};
use crate::load::file::light_link::ReceiverName;
use crate::load::file::material::MaterialEntry;
use crate::load::file::reference::FileOr;
use crate::load::file::shape::{ShapeEntry, TransformEntry, box_around};
use crate::load::file::syntax::SceneFile;
use crate::load::file::value::Located;
use crate::load::place::Place;
use crate::scene::{ImportReport, Mesh};

/// An imported scene as the entries of a scene file.
#[derive(Debug, Default)]
pub struct Description {
    /// Without a camera where the imported file has none.
    pub file: SceneFile,
    /// Meshes without deformation of those that are deformed, by their addresses.
    deformed: HashMap<usize, Arc<Mesh>>,
    /// Emitters up to this radiance do not count as lights of the scene.
    least_radiance: f64,
    /// Materials that are others for some meshes, by their names, and those others.
    pub material_variants: HashMap<String, String>,
    pub report: ImportReport,
    /// Unreadable things for which a stand-in was found, in words; whoever is strict refuses them.
    pub substitutes: Vec<String>,
    group_names: Names,
    material_names: Names,
    texture_names: Names,
    medium_names: Names,
    node_names: Names,
}

/// Points of instances that are looked at one by one to frame a scene; of more, the corners of boxes.
const MOST_POINTS: usize = 1 << 23;

/// Triangles that copies beyond the first have together where storing a mesh once is worth its while. A ray pays for the way into an instance.
const FEWEST_SAVED_TRIANGLES: u64 = 1000;

/// True where a mesh with so many copies is better stored once.
pub fn pays_as_instances(copies: usize, triangles: u64) -> bool {
    copies > 1 && (copies as u64 - 1).saturating_mul(triangles) >= FEWEST_SAVED_TRIANGLES
}

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

    /// An empty one, in which emitters up to a radiance do not count as lights.
    pub fn with_least_radiance(least_radiance: f64) -> Self {
        Self { least_radiance, ..Self::default() }
    }

    /// Adds shapes of meshes as a group that stands in all of these places.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn add_instances(
        &mut self,
        name: &str,
        place: &Place,
        shape: Vec<Located<ShapeEntry>>,
        maps: &[DAffine3],
    ) -> Result<(), String> {
        let name = self.group_names.free(name);
        let (transform, file) = match maps {
            [only] => (TransformEntry::of_map(only, place)?, None),
            many => (None, Some(place.at(FileOr::InMemory(many.into())))),
        };
        let group = place.at(name.clone());
        let keys =
            InstanceEntry { group, transform, places: None, file, material: None, motion: None, pivot: None, receiver: None };
        self.file.group.push(GroupEntry { name: place.at(name), shape, instance: Vec::new() });
        self.file.instance.push(place.at(keys));
        Ok(())
    }

    /// True where a material of this name, or a part of it, gives light.
    pub fn gives_light(&self, name: &str) -> bool {
        let find = |name: &str| self.file.material.iter().find(|entry| entry.name() == name);
        emits(name, &find, None)
    }

    /// Notes what a mesh that is deformed is without a frame.
    pub fn add_deformed(&mut self, mesh: &Arc<Mesh>, rest: Mesh) {
        self.deformed.insert(Arc::as_ptr(mesh) as usize, Arc::new(rest));
    }

    /// Puts every shape and instance into a group of receivers.
    pub fn set_receiver(&mut self, receiver: &Located<ReceiverName>) {
        self.file.shape.iter_mut().for_each(|shape| *shape.value.common_mut().receiver = Some(receiver.clone()));
        self.file.instance.iter_mut().for_each(|instance| instance.value.receiver = Some(receiver.clone()));
    }

    /// A light, or a material of a shape that gives light enough.
    pub fn has_light(&self) -> bool {
        // Instances give none.
        let used: HashSet<&str> = self.file.shape.iter().filter_map(|shape| material_of(&shape.value)).collect();
        let named: HashMap<&str, &MaterialEntry> = self.file.material.iter().map(|entry| (entry.name(), entry)).collect();
        let is_emitter = |name: &&str| emits(name, &|name| named.get(name).copied(), Some(self.least_radiance));
        !self.file.light.is_empty() || used.iter().any(is_emitter)
    }

    /// Points in the world around what is shown: the vertices of all meshes that faces use, or, without meshes, points around the other shapes.
    pub fn points(&self) -> Vec<DVec3> {
        let points = self.points_of_meshes();
        if !points.is_empty() {
            return points;
        }
        let placed = |shape: &Located<ShapeEntry>| {
            let map = map_of(shape.value.common().transform);
            shape.value.outline().into_iter().map(move |point| map.transform_point3(point))
        };
        self.file.shape.iter().flat_map(placed).collect()
    }

    fn points_of_meshes(&self) -> Vec<DVec3> {
        let mut points = Vec::new();
        for shape in &self.file.shape {
            points.extend(self.points_of_shape(&shape.value));
        }
        for Located { value: instance, .. } in &self.file.instance {
            let group = self.file.group.iter().find(|group| group.name.value == instance.group.value);
            let shapes = group.iter().flat_map(|group| &group.shape);
            let mut own: Vec<DVec3> = shapes.flat_map(|shape| self.points_of_shape(&shape.value)).collect();
            let places = places_of(instance);
            if own.len().saturating_mul(places.len()) > MOST_POINTS {
                own = box_around(&own);
            }
            points.extend(places.iter().flat_map(|place| own.iter().map(move |point| place.transform_point3(*point))));
        }
        points
    }

    /// The vertices of a mesh that faces use, as its transform places them.
    fn points_of_shape(&self, shape: &ShapeEntry) -> Vec<DVec3> {
        let Some(mesh) = mesh_of(shape) else { return Vec::new() };
        let mesh = self.deformed.get(&(Arc::as_ptr(mesh) as usize)).unwrap_or(mesh);
        let map = map_of(shape.common().transform);
        let mut used = vec![false; mesh.positions.len()];
        mesh.faces.iter().flatten().for_each(|&index| used[index as usize] = true);
        let placed = mesh.positions.iter().zip(used).filter(|(_, used)| *used);
        placed.map(|(position, _)| map.transform_point3(position.as_dvec3())).collect()
    }

    /// The lower and upper corner of a box around a shape as its transform places it; None of what is infinite or comes from a file.
    pub fn bounds_of(&self, shape: &ShapeEntry) -> Option<[DVec3; 2]> {
        let map = map_of(shape.common().transform);
        let points = match mesh_of(shape) {
            Some(_) => self.points_of_shape(shape),
            None => shape.outline().into_iter().map(|point| map.transform_point3(point)).collect(),
        };
        let low = points.iter().copied().reduce(DVec3::min)?;
        Some([low, points.into_iter().fold(low, DVec3::max)])
    }

    /// A name for a material that no other has, as near to the wanted one as can be.
    pub fn free_material_name(&mut self, wanted: &str) -> String {
        self.material_names.free(wanted)
    }

    /// A name for a group that no other has.
    pub fn free_group_name(&mut self, wanted: &str) -> String {
        self.group_names.free(wanted)
    }

    /// A name for a medium that no other has.
    pub fn free_medium_name(&mut self, wanted: &str) -> String {
        self.medium_names.free(wanted)
    }

    /// A name for a node that no other has.
    pub fn free_node_name(&mut self, wanted: &str) -> String {
        self.node_names.free(wanted)
    }

    /// A name for a texture that no other has.
    pub fn free_texture_name(&mut self, wanted: &str) -> String {
        self.texture_names.free(wanted)
    }
}

/// The mesh of a shape that an importer has made.
pub fn mesh_of(shape: &ShapeEntry) -> Option<&Arc<Mesh>> {
    let ShapeEntry::Mesh(keys) = shape else { return None };
    match keys.file.as_ref().map(|file| &file.value) {
        Some(FileOr::InMemory(mesh)) => Some(mesh),
        _ => None,
    }
}

/// The name of a shape's material.
pub fn material_of(shape: &ShapeEntry) -> Option<&str> {
    shape.common().material.map(|name| name.value.as_str())
}

/// The map of a transform that an importer has made.
pub fn map_of(transform: Option<&Located<TransformEntry>>) -> DAffine3 {
    transform.and_then(|transform| transform.value.map()).unwrap_or(DAffine3::IDENTITY)
}

/// Transforms of the instances of an entry.
fn places_of(instance: &InstanceEntry) -> Vec<DAffine3> {
    let all = map_of(instance.transform.as_ref());
    match instance.file.as_ref().map(|file| &file.value) {
        Some(FileOr::InMemory(places)) => places.iter().map(|place| all * *place).collect(),
        _ => vec![all],
    }
}

/// True where a material, or a part of it, gives light, of more than the least radiance where one is given. Parts that many blends share are
/// looked at once.
fn emits<'e>(name: &str, find: &dyn Fn(&str) -> Option<&'e MaterialEntry>, least: Option<f64>) -> bool {
    let mut seen = HashSet::new();
    let mut to_visit: Vec<&MaterialEntry> = find(name).into_iter().collect();
    while let Some(entry) = to_visit.pop() {
        if !seen.insert(entry.name()) {
            continue;
        }
        if entry.radiance().is_some_and(|radiance| least.is_none_or(|least| radiance.largest() > least)) {
            return true;
        }
        to_visit.extend(entry.parts().iter().filter_map(|part| find(&part.value)));
    }
    false
}

/// Names that are taken.
#[derive(Debug, Default)]
struct Names {
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
