//! `[[group]]` and `[[instance]]`: meshes that are stored once, and the places where they stand.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::resolver::Resolver;
use super::shape::{ShapeEntry, TransformEntry};
use super::value::{Exactly, LARGEST, Located, Number};
use crate::load::error::{SceneError, show};
use crate::load::files::MOST_MODEL_BYTES;
use crate::load::import::{PLACE_NUMBERS, PlaceFormat};
use crate::scene::{Geometry, Group, Instances, Material, Transform};

/// Meshes that are stored once. They are seen where an `[[instance]]` names the group.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "Group")]
pub struct GroupEntry {
    /// What instances call it.
    #[schemars(extend("minLength" = 1))]
    name: Located<String>,
    /// Its meshes, each a `[[group.shape]]` of type `mesh` in the group's own space.
    #[schemars(extend("minItems" = 1))]
    shape: Vec<Located<ShapeEntry>>,
}

/// A group of meshes in one place, or in as many as `places` or `file` have.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "Instance", extend("not" = { "required": ["places", "file"] }))]
pub struct InstanceEntry {
    /// A `[[group]]`'s name.
    group: Located<String>,
    /// Steps applied in this order, or a matrix; after the places, where there are some.
    transform: Option<Located<TransformEntry>>,
    /// A place for each instance: the 12 numbers of a matrix of 3 rows and 4 columns, row by row.
    places: Option<Located<Vec<Located<Exactly<Number, 12>>>>>,
    /// Path of a file of such places, relative to the scene file: `.f32` and `.f64` hold numbers of that many bits, little-endian, one behind the
    /// other; `.csv` and `.txt` a line of 12 numbers for each place, between commas or blanks.
    #[schemars(extend("pattern" = "\\.([fF]32|[fF]64|[cC][sS][vV]|[tT][xX][tT])$"))]
    file: Option<Located<String>>,
    /// A `[[material]]` for all faces, in place of the group's own; faces of type `pass` stay openings.
    material: Option<Located<String>>,
    /// Steps of `scale`, `rotate` and `translate` reached at shutter time 1, along the world's axes and about where each instance has the
    /// group's (0, 0, 0).
    #[schemars(extend("allOf" = [{ "not": { "anyOf": [
        { "type": "object", "required": ["matrix"] },
        { "type": "array", "contains": { "type": "object", "required": ["matrix"] } },
    ] } }]))]
    motion: Option<Located<TransformEntry>>,
}

impl Resolver<'_> {
    pub(super) fn groups(&mut self, written: &[GroupEntry]) -> Result<HashMap<String, usize>, SceneError> {
        let names = self.register("group", written.iter().map(|entry| &entry.name))?;
        for (index, entry) in written.iter().enumerate() {
            let mut group = Group { name: entry.name.value.clone(), shapes: Vec::new() };
            for (place, written) in entry.shape.iter().enumerate() {
                let shape = self.group_shape(place, written);
                group.shapes.extend(self.note(shape).map(|mut shape| {
                    shape.label = format!("group[{index}].shape[{place}] ({})", shape.geometry.kind_name());
                    shape
                }));
            }
            if entry.shape.is_empty() {
                self.note::<()>(Err(self.error(&entry.name.span, format!("the group `{}` has no shapes", group.name))));
            }
            self.scene.groups.push(group);
        }
        Ok(names)
    }

    fn group_shape(&mut self, place: usize, written: &Located<ShapeEntry>) -> Result<crate::scene::Shape, SceneError> {
        let shape = self.checked_shape(place, written)?;
        if !matches!(shape.geometry, Geometry::Mesh(_)) {
            let message = format!("a group consists of meshes, and this is a {}", shape.geometry.kind_name());
            return Err(self.error(&written.span, message).with_help("write it as a [[shape]] for each place, or as a mesh"));
        }
        if shape.motion.is_some() || written.value.is_animated() || shape.portal {
            let message = "a mesh of a group has no motion of its own and is no portal";
            return Err(self.error(&written.span, message).with_help("an [[instance]] can have `motion`"));
        }
        Ok(shape)
    }

    pub(super) fn instances(&mut self, written: &[Located<InstanceEntry>], names: &HashMap<String, usize>) {
        let textured = self.scene.materials_that(Material::uses_texture);
        let emits = self.scene.materials_that(|material| material.emission.is_some());
        let balls = self.scene.balls();
        for (index, entry) in written.iter().enumerate() {
            let instances = self.instances_of(index, entry, names).and_then(|instances| {
                let check = self.scene.check_instances(&instances, &textured, &emits, &balls);
                check.map(|()| instances).map_err(|message| self.error(&entry.span, message))
            });
            let instances = self.note(instances);
            self.scene.instances.extend(instances);
        }
        for (index, group) in self.scene.groups.iter().enumerate() {
            if !self.scene.instances.iter().any(|instances| instances.group == index) && self.errors.is_empty() {
                let warning = format!("{}: no [[instance]] names the group `{}`: it is not seen", self.document.name, group.name);
                self.scene.warnings.push(warning);
            }
        }
    }

    fn instances_of(
        &mut self,
        index: usize,
        entry: &Located<InstanceEntry>,
        names: &HashMap<String, usize>,
    ) -> Result<Instances, SceneError> {
        let written = &entry.value;
        let group = self.look_up(names, &written.group, "group")?;
        let places = match (&written.places, &written.file) {
            (Some(places), Some(_)) => return Err(self.error(&places.span, "an instance has either `places` or `file`")),
            (Some(places), None) => places.value.iter().map(|place| affine(place.value.0.map(|number| number.0))).collect(),
            (None, Some(file)) => self.places_of_file(file)?,
            (None, None) => vec![DAffine3::IDENTITY],
        };
        let material = written.material.as_ref().map(|name| self.material_id(name)).transpose()?;
        let transform = written.transform.as_ref().map_or(Ok(Transform::default()), |transform| self.transform(transform))?;
        let motion = written.motion.as_ref().map_or(Ok(None), |motion| self.motion(motion))?;
        if let (Some(steps), Some(written)) = (&motion, &written.motion) {
            steps.check(self.scene.camera.shutter).map_err(|(_, message)| self.error(&written.span, message))?;
        }
        let label = format!("instance[{index}] of `{}`", self.scene.groups[group].name);
        Ok(Instances { label, group, places: Arc::new(places), transform, material, motion })
    }

    fn places_of_file(&self, file: &Located<String>) -> Result<Vec<DAffine3>, SceneError> {
        let path = self.path(&file.value);
        let Some(format) = PlaceFormat::of(&path) else {
            return Err(self.error(&file.span, "a file of places ends in .f32, .f64, .csv or .txt"));
        };
        let bytes = self.files().read(&path, MOST_MODEL_BYTES).map_err(|error| {
            let missing = format!("there is no file {}", show(&path));
            self.error(&file.span, if self.files().exists(&path) { format!("{}: {error}", show(&path)) } else { missing })
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

/// Of a matrix of three rows, row by row.
fn affine(rows: [f64; PLACE_NUMBERS]) -> DAffine3 {
    let column = |index: usize| DVec3::new(rows[index], rows[4 + index], rows[8 + index]);
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}
