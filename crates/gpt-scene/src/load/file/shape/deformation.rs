//! `deformation` of a mesh: morph targets and joints that bend it.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::load::deformation_file::{DeformationRows, influences_file};
use crate::load::error::{SceneError, show};
use crate::load::file::keyframes::InterpolationName;
use crate::load::file::place_file::place_rows;
use crate::load::file::reference::FileOr;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Exactly, Located, Number};
use crate::load::file::writer::{Writer, line, list, number, numbers, table, text};
use crate::load::files::MOST_SCENE_BYTES;
use crate::load::memory;
use crate::load::place::Place;
use crate::scene::Mesh;
use crate::scene::animation::{Curve, Deformation, Interpolation, Joint, Key, MorphTarget};

/// Deformation of a mesh: first morph targets, then joints.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { file = \"arm.json\", joints = [{ node = \"elbow\" }] }")]
#[schemars(rename = "Deformation")]
pub struct DeformationEntry {
    /// Path of a JSON file, relative to the scene file: `{ "influences": [[[joint, weight], …], …], "targets": [{ "positions": [[x, y, z], …],
    /// "normals": [[x, y, z], …] }, …] }`, each list in the order of the mesh's vertices. Joints are counted from 0; targets state by how much they
    /// move vertices.
    #[schemars(extend("pattern" = "\\.[jJ][sS][oO][nN]$"))]
    pub file: Located<FileOr<DeformationRows>>,
    /// Joints that move the vertices. A vertex moves to the average of its positions under its joints, by
    /// their weights.
    pub joints: Option<Located<Vec<JointEntry>>>,
    /// How much each target counts without a frame.
    pub weights: Option<Located<Vec<Number>>>,
    /// How much they count at frames.
    #[schemars(extend("minItems" = 1))]
    pub keyframes: Option<Located<Vec<Located<WeightKeyEntry>>>>,
    /// How keyframes lead from one to the next; "linear" when left out.
    pub interpolation: Option<Located<InterpolationName>>,
}

/// A joint.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { node = \"elbow\" }")]
#[schemars(rename = "Joint")]
pub struct JointEntry {
    /// A `[[node]]` that takes the joint along at frames.
    pub node: Option<Located<String>>,
    /// From the mesh as it is in its file to the mesh as it is without a frame: the 12 numbers of a matrix of 3 rows and 4 columns, row by row.
    pub matrix: Option<Located<Exactly<Number, 12>>>,
}

/// How much morph targets count at a frame.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { frame = 10, weights = [0.5] }")]
#[schemars(rename = "WeightKeyframe", extend("oneOf" = [{ "required": ["frame"] }, { "required": ["time"] }]))]
pub struct WeightKeyEntry {
    /// Number of the frame, not necessarily a whole one; or `time`.
    pub frame: Option<Number>,
    /// Seconds after the start.
    pub time: Option<Number>,
    /// One for each target.
    pub weights: Vec<Number>,
}

impl Resolver<'_> {
    /// The mesh as it is without a frame; what bends it is noted for the shape in the making.
    pub(super) fn deformed(
        &mut self,
        mesh: Arc<Mesh>,
        written: Option<&Located<DeformationEntry>>,
    ) -> Result<Arc<Mesh>, SceneError> {
        let Some(Located { value: written, place: span }) = written else { return Ok(mesh) };
        let rows = self.deformation_rows(&written.file)?;
        let mut deformation = Deformation { base: mesh, ..Deformation::default() };
        for joint in written.joints.iter().flat_map(|joints| &joints.value) {
            let node = joint.node.as_ref().map(|name| self.look_up(&self.node_names, name, "node")).transpose()?;
            deformation
                .joints
                .push(Joint { node, bind: joint.matrix.as_ref().map_or(DAffine3::IDENTITY, |matrix| map(&matrix.value)) });
        }
        rows.influences.into_iter().for_each(|pairs| deformation.influences.push(pairs));
        let list = |rows: Vec<[f32; 3]>| rows.into_iter().map(Vec3::from_array).collect();
        deformation.targets = (rows.targets.into_iter())
            .map(|rows| MorphTarget { positions: list(rows.positions), normals: list(rows.normals), ..MorphTarget::default() })
            .collect();
        self.weights(written, &mut deformation.targets)?;
        deformation.check().map_err(|message| match written.file.value.path(self.folder) {
            Some(path) => SceneError::in_file(show(&path), message),
            None => self.error(&written.file.place, message),
        })?;
        let rest = deformation.at_rest();
        if let Some(vertex) = rest.positions.iter().position(|position| !position.is_finite()) {
            return Err(self.error(span, format!("vertex {vertex} of the mesh is deformed out of the range of numbers")));
        }
        self.deformation = Some(deformation);
        Ok(Arc::new(rest))
    }

    fn deformation_rows(&self, file: &Located<FileOr<DeformationRows>>) -> Result<DeformationRows, SceneError> {
        let path = match &file.value {
            FileOr::InMemory(rows) => return Ok(DeformationRows::clone(rows)),
            FileOr::Written(path) => self.folder.join(path),
            FileOr::OnDisk(path) => path.clone(),
        };
        let name = show(&path);
        // A list of an empty list is three bytes, and takes some twenty times as much.
        let most = MOST_SCENE_BYTES.min(memory::available() / 20);
        let bytes =
            self.files().read(&path, most).map_err(|error| SceneError::in_file(&name, format!("cannot be read: {error}")))?;
        serde_json::from_slice(&bytes).map_err(|error| {
            let message = error.to_string();
            let what = message.rsplit_once(" at line").map_or(message.as_str(), |(what, _)| what).to_owned();
            SceneError::in_line(&name, error.line(), format!("is no deformation: {what}"))
        })
    }

    /// How much targets count.
    fn weights(&self, written: &DeformationEntry, targets: &mut [MorphTarget]) -> Result<(), SceneError> {
        let fits = |count: usize, span: &Place| match count == targets.len() {
            true => Ok(()),
            false => Err(self.error(span, format!("there are {count} weights for {} targets", targets.len()))),
        };
        if let Some(weights) = &written.weights {
            fits(weights.value.len(), &weights.place)?;
        }
        let Some(keyframes) = &written.keyframes else {
            self.without_keyframes(written.interpolation.as_ref())?;
            set_rest(written, targets);
            return Ok(());
        };
        let frames = self.frames(keyframes, self.scene.animation.frames_per_second, |key| (key.frame, key.time))?;
        for entry in &keyframes.value {
            fits(entry.value.weights.len(), &entry.place)?;
        }
        let interpolation = written.interpolation.as_ref().map_or(Interpolation::default(), |name| name.value.into());
        for (index, target) in targets.iter_mut().enumerate() {
            let keys = keyframes.value.iter().zip(&frames);
            let keys = keys.map(|(entry, &frame)| Key { frame, value: entry.value.weights[index].0 }).collect();
            target.weight = Curve { keys, interpolation };
        }
        set_rest(written, targets);
        Ok(())
    }
}

fn set_rest(written: &DeformationEntry, targets: &mut [MorphTarget]) {
    let weights = written.weights.iter().flat_map(|weights| &weights.value);
    targets.iter_mut().zip(weights).for_each(|(target, weight)| target.rest = weight.0);
}

/// A map by the rows of its matrix.
fn map(rows: &[Number; 12]) -> DAffine3 {
    let column = |index: usize| DVec3::new(rows[index].0, rows[4 + index].0, rows[8 + index].0);
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}

/// The key that bends a mesh.
pub fn write(deformation: &Deformation, writer: &mut Writer<'_>) -> String {
    let name = format!("deformation-{}.json", writer.files.len() + 1);
    let mut keys = vec![("file", writer.files.add(&name, influences_file(deformation)))];
    let joint = |joint: &Joint| {
        let node = joint.node.map(|node| ("node", writer.nodes.quoted(node)));
        table(node.into_iter().chain([("matrix", numbers(&place_rows(&joint.bind)))]))
    };
    if !deformation.joints.is_empty() {
        keys.push(("joints", list(deformation.joints.iter().map(joint))));
    }
    if let Some(first) = deformation.targets.first() {
        let rest: Vec<f64> = deformation.targets.iter().map(|target| target.rest).collect();
        keys.push(("weights", numbers(&rest)));
        let keyframe = |(index, key): (usize, &Key<f64>)| {
            let weights: Vec<f64> = deformation.targets.iter().map(|target| target.weight.keys[index].value).collect();
            table([("frame", number(key.frame)), ("weights", numbers(&weights))])
        };
        if !first.weight.keys.is_empty() {
            keys.push(("keyframes", list(first.weight.keys.iter().enumerate().map(keyframe))));
        }
        match first.weight.interpolation {
            Interpolation::Linear => {}
            Interpolation::Smooth => keys.push(("interpolation", text("smooth"))),
            Interpolation::Step => keys.push(("interpolation", text("step"))),
        }
    }
    line("deformation", &table(keys))
}
