//! `[[group]]` and `[[instance]]`: meshes that are stored once, and the places where they stand. A group may hold instances of others.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::light_link::ReceiverName;
use super::nested::{FileGroup, Groups, NestedInstance};
use super::place_file::{PLACE_NUMBERS, PlaceFormat, place_rows};
use super::reference::FileOr;
use super::resolver::Resolver;
use super::shape::{ShapeEntry, TransformEntry};
use super::value::{Exactly, LARGEST, Located, Number, Vector, vector};
use crate::load::error::{SceneError, show};
use crate::load::files::MOST_MODEL_BYTES;
use crate::scene::{Geometry, Group, Instances, Material, Transform, is_singular};

/// Meshes that are stored once, and instances of other groups. They are seen where an `[[instance]]` names the group.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "Group", extend("anyOf" = [
    { "required": ["shape"], "properties": { "shape": { "minItems": 1 } } },
    { "required": ["instance"], "properties": { "instance": { "minItems": 1 } } },
]))]
pub struct GroupEntry {
    /// Name by which instances refer to the group.
    #[schemars(extend("minLength" = 1))]
    pub name: Located<String>,
    /// Its meshes, each a `[[group.shape]]` of type `mesh` in the group's own space.
    #[serde(default)]
    pub shape: Vec<Located<ShapeEntry>>,
    /// Other groups within it, each a `[[group.instance]]`. Those may hold groups too, up to 64 within each other.
    #[serde(default)]
    pub instance: Vec<Located<NestedInstanceEntry>>,
}

/// A group within another one, at rest in that one's space.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "HeldInstance", extend("not" = { "required": ["places", "file"] }))]
pub struct NestedInstanceEntry {
    /// The name of another `[[group]]`, which does not hold this one.
    pub group: Located<String>,
    /// Steps applied in this order, or a matrix; after the places, where there are some.
    pub transform: Option<Located<TransformEntry>>,
    /// Places, as in `[[instance]]`.
    pub places: Option<Located<Vec<Located<Exactly<Number, 12>>>>>,
    /// File of places, as in `[[instance]]`.
    #[schemars(extend("pattern" = "\\.([fF]32|[fF]64|[cC][sS][vV]|[tT][xX][tT])$"))]
    pub file: Option<Located<FileOr<[DAffine3]>>>,
    /// A `[[material]]` for all faces, in place of the group's own, where the instance around names none.
    pub material: Option<Located<String>>,
}

/// A group of meshes in one place, or in as many as `places` or `file` have.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "Instance", extend("not" = { "required": ["places", "file"] }, "dependentRequired" = { "pivot": ["motion"] }))]
pub struct InstanceEntry {
    /// A `[[group]]`'s name.
    pub group: Located<String>,
    /// Steps applied in this order, or a matrix; after the places, where there are some.
    pub transform: Option<Located<TransformEntry>>,
    /// A place for each instance: the 12 numbers of a matrix of 3 rows and 4 columns, row by row.
    pub places: Option<Located<Vec<Located<Exactly<Number, 12>>>>>,
    /// Path of a file of such places, relative to the scene file: `.f32` and `.f64` hold numbers of that many bits, little-endian, one behind the
    /// other; `.csv` and `.txt` a line of 12 numbers for each place, between commas or blanks.
    #[schemars(extend("pattern" = "\\.([fF]32|[fF]64|[cC][sS][vV]|[tT][xX][tT])$"))]
    pub file: Option<Located<FileOr<[DAffine3]>>>,
    /// A `[[material]]` for all faces, in place of the group's own; faces of type `pass` stay openings. Instances of which a face emits stand in the scene
    /// one by one, as if each were written as `[[shape]]`s.
    pub material: Option<Located<String>>,
    /// Steps of `scale`, `rotate` and `translate` reached at shutter time 1, along the world's axes and about where each instance has the
    /// group's (0, 0, 0), or about `pivot`.
    #[schemars(extend("allOf" = [{ "not": { "anyOf": [
        { "type": "object", "required": ["matrix"] },
        { "type": "array", "contains": { "type": "object", "required": ["matrix"] } },
    ] } }]))]
    pub motion: Option<Located<TransformEntry>>,
    /// A point of the world, at shutter time 0, about which `motion` turns and scales all of the instances.
    pub pivot: Option<Located<Vector>>,
    /// The group of receivers that the instances belong to, which lamps name in `lights_only` and `lights_all_but`; "rest" when left out.
    pub receiver: Option<Located<ReceiverName>>,
}

/// Places of instances, as they are written.
struct WrittenPlaces<'a> {
    transform: Option<&'a Located<TransformEntry>>,
    places: Option<&'a Located<Vec<Located<Exactly<Number, 12>>>>>,
    file: Option<&'a Located<FileOr<[DAffine3]>>>,
}

impl Resolver<'_> {
    pub(super) fn groups(&mut self, written: &[GroupEntry]) -> Result<(HashMap<String, usize>, Groups), SceneError> {
        let names = self.register("group", written.iter().map(|entry| &entry.name))?;
        let mut groups = Vec::with_capacity(written.len());
        for (index, entry) in written.iter().enumerate() {
            let name = entry.name.value.clone();
            if entry.shape.is_empty() && entry.instance.is_empty() {
                self.note::<()>(Err(self.error(&entry.name.place, format!("the group `{name}` has no shapes"))));
            }
            let own = self.group_shapes(index, entry);
            let mut nested = Vec::with_capacity(entry.instance.len());
            for written in &entry.instance {
                let found = self.nested_instance(&written.value, &names);
                nested.extend(self.note(found));
            }
            groups.push(FileGroup { name, own, nested });
        }
        let groups = Groups::new(groups).map_err(|(span, message)| self.error(&span, message))?;
        Ok((names, groups))
    }

    /// The scene's group of the meshes; None where there are none.
    fn group_shapes(&mut self, index: usize, entry: &GroupEntry) -> Option<usize> {
        let mut group = Group { name: entry.name.value.clone(), shapes: Vec::new() };
        for (place, written) in entry.shape.iter().enumerate() {
            let shape = self.group_shape(place, written);
            group.shapes.extend(self.note(shape).map(|mut shape| {
                shape.label = format!("group[{index}].shape[{place}] ({})", shape.geometry.kind_name());
                shape
            }));
        }
        (!group.shapes.is_empty()).then(|| {
            self.scene.groups.push(group);
            self.scene.groups.len() - 1
        })
    }

    fn nested_instance(
        &self,
        written: &NestedInstanceEntry,
        names: &HashMap<String, usize>,
    ) -> Result<NestedInstance, SceneError> {
        let group = self.look_up(names, &written.group, "group")?;
        let NestedInstanceEntry { transform, places, file, .. } = written;
        let places = WrittenPlaces { transform: transform.as_ref(), places: places.as_ref(), file: file.as_ref() };
        let (places, transform) = self.places(&places)?;
        let around = transform.to_affine();
        let maps: Vec<DAffine3> = places.into_iter().map(|place| around * place).collect();
        if let Some(place) = maps.iter().position(|map| !map.is_finite() || is_singular(map.matrix3)) {
            let message = format!("the transform of number {place}, counted from 0, flattens it or leaves the range of numbers");
            return Err(self.error(&written.group.place, message));
        }
        let material = written.material.as_ref().map(|name| self.material_id(name)).transpose()?;
        Ok(NestedInstance { group, maps, material, named_at: written.group.place.clone() })
    }

    fn group_shape(&mut self, place: usize, written: &Located<ShapeEntry>) -> Result<crate::scene::Shape, SceneError> {
        let shape = self.checked_shape(place, written);
        let is_deformed = self.deformation.take().is_some();
        let shape = shape?;
        if !matches!(shape.geometry, Geometry::Mesh(_)) {
            let message = format!("a group consists of meshes, and this is a {}", shape.geometry.kind_name());
            return Err(self.error(&written.place, message).with_help("write it as a [[shape]] for each place, or as a mesh"));
        }
        if let Some(receiver) = written.value.common().receiver {
            let message = "a mesh of a group belongs to the receivers of the instance: an [[instance]] has `receiver`";
            return Err(self.error(&receiver.place, message));
        }
        if shape.motion.is_some() || is_deformed || written.value.is_animated() || shape.portal {
            let message = "a mesh of a group has no motion of its own, is not deformed and is no portal";
            return Err(self.error(&written.place, message).with_help("an [[instance]] can have `motion`"));
        }
        Ok(shape)
    }

    pub(super) fn instances(&mut self, written: &[Located<InstanceEntry>], names: &HashMap<String, usize>, groups: &Groups) {
        let textured = self.scene.materials_that(Material::uses_texture);
        let emits = self.scene.materials_that(|material| material.emission.is_some());
        let emissive_groups = self.emissive_groups(&emits);
        let are_emissive = |part: &Instances| part.material.map_or(emissive_groups[part.group], |material| emits[material]);
        // Emitting shapes are added to the scene as shapes, so that no instance emits.
        let none_emits = vec![false; emits.len()];
        let balls = self.scene.balls();
        let mut named = vec![false; names.len()];
        let mut count = 0;
        for (index, entry) in written.iter().enumerate() {
            let instances = self.instances_of(index, entry, names, groups).and_then(|instances| {
                groups.check_count(&instances, count).map_err(|message| self.error(&entry.place, message))?;
                named[instances.group] = true;
                count += groups.count(&instances);
                let all = groups.expanded(&instances, &|id| self.scene.materials[id].is_nothing());
                let (mut kept, mut copies) = (Vec::new(), Vec::new());
                for part in all {
                    let check = self.scene.check_instances(&part, &textured, &none_emits, &balls);
                    let emissive =
                        check.and_then(|()| if are_emissive(&part) { self.emissive_copies(&part).map(Some) } else { Ok(None) });
                    let of_nested = |message: String| match part.label == instances.label {
                        true => message,
                        false => format!(
                            "of `{}` within `{}`: {message}",
                            self.scene.groups[part.group].name,
                            groups.name(instances.group)
                        ),
                    };
                    match emissive.map_err(|message| self.error(&entry.place, of_nested(message)))? {
                        Some(shapes) => copies.extend(shapes),
                        None => kept.push(part),
                    }
                }
                Ok((kept, copies))
            });
            let (instances, copies) = self.note(instances).unwrap_or_default();
            self.scene.instances.extend(instances);
            self.scene.shapes.extend(copies);
        }
        for (index, is_seen) in groups.reached_from(&named).into_iter().enumerate() {
            if !is_seen && self.errors.is_empty() {
                let warning =
                    format!("{}: no [[instance]] names the group `{}`: it is not seen", self.document.name, groups.name(index));
                self.scene.warnings.push(warning);
            }
        }
    }

    /// An entry, whose group is one of the file's.
    fn instances_of(
        &mut self,
        index: usize,
        entry: &Located<InstanceEntry>,
        names: &HashMap<String, usize>,
        groups: &Groups,
    ) -> Result<Instances, SceneError> {
        let written = &entry.value;
        let group = self.look_up(names, &written.group, "group")?;
        let InstanceEntry { transform, places, file, .. } = written;
        let places = WrittenPlaces { transform: transform.as_ref(), places: places.as_ref(), file: file.as_ref() };
        let (places, transform) = self.places(&places)?;
        let material = written.material.as_ref().map(|name| self.material_id(name)).transpose()?;
        let motion = written.motion.as_ref().map_or(Ok(None), |motion| self.motion(motion))?;
        if let (Some(steps), Some(written)) = (&motion, &written.motion) {
            steps.check(self.scene.camera.shutter).map_err(|(_, message)| self.error(&written.place, message))?;
        }
        if let (Some(pivot), None) = (&written.pivot, &written.motion) {
            return Err(self.error(&pivot.place, "`pivot` is what `motion` is about, which is missing"));
        }
        let pivot = written.pivot.as_ref().map(|pivot| vector(pivot.value));
        let label = format!("instance[{index}] of `{}`", groups.name(group));
        let receiver = self.receiver(written.receiver.as_ref())?;
        Ok(Instances { label, group, places: Arc::new(places), transform, material, motion, pivot, receiver })
    }

    /// The places, one where none are written, and what comes behind them.
    fn places(&self, written: &WrittenPlaces<'_>) -> Result<(Vec<DAffine3>, Transform), SceneError> {
        let places = match (written.places, written.file) {
            (Some(places), Some(_)) => return Err(self.error(&places.place, "an instance has either `places` or `file`")),
            (Some(places), None) => places.value.iter().map(|place| affine(place.value.0.map(|number| number.0))).collect(),
            (None, Some(file)) => self.places_of_file(file)?,
            (None, None) => vec![DAffine3::IDENTITY],
        };
        let transform = written.transform.map_or(Ok(Transform::default()), |transform| self.transform(transform))?;
        Ok((places, transform))
    }

    fn places_of_file(&self, file: &Located<FileOr<[DAffine3]>>) -> Result<Vec<DAffine3>, SceneError> {
        let path = match &file.value {
            FileOr::InMemory(places) => {
                let is_possible = |map: &DAffine3| place_rows(map).iter().all(|number| number.abs() <= LARGEST);
                let message = "a place of an instance leaves the range of numbers";
                return if places.iter().all(is_possible) { Ok(places.to_vec()) } else { Err(self.error(&file.place, message)) };
            }
            FileOr::Written(path) => self.folder.join(path),
            FileOr::OnDisk(path) => path.clone(),
        };
        let Some(format) = PlaceFormat::of(&path) else {
            return Err(self.error(&file.place, "a file of places ends in .f32, .f64, .csv or .txt"));
        };
        let bytes = self.files().read(&path, MOST_MODEL_BYTES).map_err(|error| {
            let missing = format!("there is no file {}", show(&path));
            self.error(&file.place, if self.files().exists(&path) { format!("{}: {error}", show(&path)) } else { missing })
        })?;
        let numbers = format.numbers(&bytes).map_err(|message| SceneError::in_file(show(&path), message))?;
        in_range(&path, &numbers)?;
        let (rows, _) = numbers.as_chunks::<PLACE_NUMBERS>();
        Ok(rows.iter().map(|row| affine(*row)).collect())
    }
}

fn in_range(path: &Path, numbers: &[f64]) -> Result<(), SceneError> {
    match numbers.iter().position(|number| number.is_nan() || number.abs() > LARGEST) {
        None => Ok(()),
        Some(at) => {
            let (place, number) = (at / PLACE_NUMBERS, numbers[at]);
            let message = format!("expected numbers of magnitude at most 1e18, found {number} in place {place}, counted from 0");
            Err(SceneError::in_file(show(path), message))
        }
    }
}

/// The map with this matrix of three rows, row by row.
fn affine(rows: [f64; PLACE_NUMBERS]) -> DAffine3 {
    let column = |index: usize| DVec3::new(rows[index], rows[4 + index], rows[8 + index]);
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}
