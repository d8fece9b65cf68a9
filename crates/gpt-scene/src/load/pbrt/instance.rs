//! Objects, and the places where they stand.

use std::collections::BTreeMap;

use super::converter::{Converter, is_flat};
use super::directives::unknown;
use super::shape::{Surface, at_place};
use super::world::{InstanceRecord, ObjectRecord};
use crate::load::error::SceneError;
use crate::load::file::instance::{GroupEntry, InstanceEntry};
use crate::load::file::reference::FileOr;
use crate::load::file::shape::ShapeEntry;
use crate::load::import::{mesh_of, pays_as_instances};

/// From so many copies of an object on, its round shapes are triangles, so that it can be stored once.
const MANY_COPIES: usize = 100;

impl Converter<'_> {
    /// Adds all instances, objects in the order in which they were written.
    pub fn instances(&mut self) -> Result<(), SceneError> {
        let world = self.world.clone();
        let mut of_objects: BTreeMap<usize, Vec<&InstanceRecord>> = BTreeMap::new();
        for instance in &world.instances {
            let number = world.object_numbers.get(&instance.name);
            let number = number.ok_or_else(|| unknown("object", &instance.name, &instance.spot, world.object_numbers.keys()))?;
            if is_flat(&instance.maps) {
                return Err(instance.spot.error("the transform flattens the object or leaves the range of numbers"));
            }
            of_objects.entry(*number).or_default().push(instance);
        }
        for (number, instances) in of_objects {
            self.object(&world.objects[number], &instances)?;
        }
        Ok(())
    }

    fn object(&mut self, object: &ObjectRecord, instances: &[&InstanceRecord]) -> Result<(), SceneError> {
        let as_mesh = instances.len() >= MANY_COPIES;
        let before = self.triangles;
        let mut surfaces = Vec::new();
        for record in &object.shapes {
            if record.maps[0] != record.maps[1] {
                let instead = "it rests where its transform begins";
                self.approximate(&record.entity.spot, "motion of a shape within an object", instead);
            }
            surfaces.extend(self.surface(record, true, as_mesh)?.map(|surface| (surface, &record.entity)));
        }
        if surfaces.is_empty() {
            return Ok(());
        }
        let faces = |(surface, _): &(Surface, _)| mesh_of(&surface.entry).map_or(0, |mesh| mesh.faces.len() as u64);
        let triangles: u64 = surfaces.iter().map(faces).sum();
        let only_meshes = surfaces.iter().all(|(surface, _)| matches!(surface.entry, ShapeEntry::Mesh(_)));
        if !only_meshes || !pays_as_instances(instances.len(), triangles) {
            self.triangles = before;
            for instance in instances {
                self.counted(&instance.spot, triangles)?;
                for (surface, entity) in &surfaces {
                    let maps = instance.maps.map(|map| map * surface.maps[0]);
                    self.add_surface(surface, &maps, entity)?;
                }
            }
            return Ok(());
        }
        let shapes = surfaces.iter().map(|(surface, entity)| at_place(self, surface, entity)).collect::<Result<Vec<_>, _>>()?;
        self.group(object, shapes, instances)
    }

    /// Stores an object once, and lets it stand where its instances are.
    fn group(
        &mut self,
        object: &ObjectRecord,
        shape: Vec<crate::load::file::value::Located<ShapeEntry>>,
        instances: &[&InstanceRecord],
    ) -> Result<(), SceneError> {
        let place = object.spot.place();
        let name = self.scene.free_group_name(&object.name);
        let group = GroupEntry { name: place.at(name.clone()), shape, instance: Vec::new() };
        self.scene.file.group.push(group);
        let (at_rest, moving): (Vec<&InstanceRecord>, Vec<&InstanceRecord>) =
            instances.iter().partition(|instance| instance.maps[0] == instance.maps[1]);
        let keys = |place: &crate::load::place::Place| InstanceEntry {
            group: place.at(name.clone()),
            transform: None,
            places: None,
            file: None,
            material: None,
            motion: None,
            pivot: None,
            receiver: None,
        };
        if !at_rest.is_empty() {
            let maps: Vec<_> = at_rest.iter().map(|instance| instance.maps[0]).collect();
            let file = Some(place.at(FileOr::InMemory(maps.into())));
            self.scene.file.instance.push(place.at(InstanceEntry { file, ..keys(&place) }));
        }
        for instance in moving {
            let place = instance.spot.place();
            let transform = self.transform(&instance.maps[0], &instance.spot)?;
            let motion = self.motion(&instance.maps, &instance.spot)?;
            self.scene.file.instance.push(place.at(InstanceEntry { transform, motion, ..keys(&place) }));
        }
        Ok(())
    }
}
