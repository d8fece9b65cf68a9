//! `transform` and `motion`

use std::borrow::Cow;
use std::fmt;

use glam::{DAffine3, DMat3, DVec3};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::load::error::SceneError;
use crate::load::file::colour::any_of;
use crate::load::file::keyframes::ScaleEntry;
use crate::load::file::place_file::{PLACE_NUMBERS, place_rows};
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Exactly, Located, Number, Vector, vector};
use crate::load::place::Place;
use crate::scene::{Motion, MotionStep, Shape, Transform, TransformStep, is_singular};

/// Steps applied in their order, or one matrix.
#[derive(Debug, Clone)]
pub enum TransformEntry {
    Steps(Vec<Located<StepEntry>>),
    Single(Box<StepEntry>),
}

/// One step: exactly one of `scale`, `rotate`, `translate`, `matrix`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table with one of the keys `scale`, `rotate`, `translate` and `matrix`")]
#[schemars(extend("oneOf" = [
    { "required": ["scale"] }, { "required": ["rotate", "degrees"] }, { "required": ["translate"] }, { "required": ["matrix"] }
], "dependentRequired" = { "degrees": ["rotate"] }))]
pub struct StepEntry {
    /// One factor or one per axis; not 0.
    pub scale: Option<Located<ScaleEntry>>,
    /// The axis of a rotation by `degrees`.
    pub rotate: Option<Located<Vector>>,
    /// Counter-clockwise seen from the axis' tip.
    pub degrees: Option<Located<Number>>,
    pub translate: Option<Vector>,
    /// 16 numbers, row by row; the last row is 0 0 0 1.
    pub matrix: Option<Located<Exactly<Number, 16>>>,
}

impl TransformEntry {
    /// The matrix of a map; None of the identity.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn of_map(map: &DAffine3, place: &Place) -> Result<Option<Located<Self>>, String> {
        if *map == DAffine3::IDENTITY {
            return Ok(None);
        }
        let mut numbers = [0.0; 16];
        numbers[..PLACE_NUMBERS].copy_from_slice(&place_rows(map));
        numbers[15] = 1.0;
        let matrix = Some(place.at(Exactly::of(numbers)?));
        let step = StepEntry { scale: None, rotate: None, degrees: None, translate: None, matrix };
        Ok(Some(place.at(Self::Single(Box::new(step)))))
    }

    /// The map of what [`Self::of_map`] made; None of steps.
    pub fn map(&self) -> Option<DAffine3> {
        match self {
            Self::Single(step) => step.matrix.as_ref().map(|matrix| affine(&matrix.value)),
            Self::Steps(_) => None,
        }
    }
}

/// The map of a matrix whose numbers are row by row.
fn affine(rows: &Exactly<Number, 16>) -> DAffine3 {
    let column = |index: usize| DVec3::new(rows[index].0, rows[4 + index].0, rows[8 + index].0);
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}

impl<'de> Deserialize<'de> for TransformEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct StepsVisitor;
        impl<'de> Visitor<'de> for StepsVisitor {
            type Value = TransformEntry;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("an array of steps such as { translate = [0, 1, 0] }, or { matrix = [16 numbers] }")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(seq)).map(TransformEntry::Steps)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                Deserialize::deserialize(MapAccessDeserializer::new(map)).map(TransformEntry::Single)
            }
        }
        deserializer.deserialize_any(StepsVisitor)
    }
}

impl JsonSchema for TransformEntry {
    fn schema_name() -> Cow<'static, str> {
        "Transform".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        any_of(vec![generator.subschema_for::<Vec<StepEntry>>(), generator.subschema_for::<StepEntry>()])
    }
}

impl Resolver<'_> {
    pub(in crate::load::file) fn transform(&self, written: &Located<TransformEntry>) -> Result<Transform, SceneError> {
        let steps = match &written.value {
            TransformEntry::Steps(steps) => {
                steps.iter().map(|step| self.step(&step.place, &step.value)).collect::<Result<_, _>>()?
            }
            TransformEntry::Single(step) => vec![self.step(&written.place, step)?],
        };
        let transform = Transform { steps };
        let map = transform.to_affine();
        if !map.is_finite() || is_singular(map.matrix3) {
            return Err(self.error(&written.place, "the transform flattens the shape or leaves the range of numbers"));
        }
        Ok(transform)
    }

    /// None where nothing is written in the list: the shape rests.
    pub(in crate::load::file) fn motion(&self, written: &Located<TransformEntry>) -> Result<Option<Motion>, SceneError> {
        let steps: Vec<MotionStep> = match &written.value {
            TransformEntry::Steps(steps) => {
                steps.iter().map(|step| self.motion_step(&step.place, &step.value)).collect::<Result<_, _>>()?
            }
            TransformEntry::Single(step) => vec![self.motion_step(&written.place, step)?],
        };
        Ok((!steps.is_empty()).then_some(Motion::new(steps)))
    }

    fn motion_step(&self, span: &Place, written: &StepEntry) -> Result<MotionStep, SceneError> {
        match self.step(span, written)? {
            TransformStep::Scale(factors) => Ok(MotionStep::Scale(factors)),
            TransformStep::Rotate { axis, degrees } => Ok(MotionStep::Rotate { axis, degrees }),
            TransformStep::Translate(offset) => Ok(MotionStep::Translate(offset)),
            TransformStep::Matrix(_) => Err(self
                .error(span, "a motion has no matrices: what lies between one and rest is not defined")
                .with_help("write it as steps of `scale`, `rotate` and `translate`")),
        }
    }

    /// The shape with this motion written can be followed while the shutter is open. The camera has been read.
    pub(super) fn check_motion(&self, written: &Located<TransformEntry>, shape: &Shape) -> Result<(), SceneError> {
        shape.check_motion(self.scene.camera.shutter).map_err(|(step, message)| {
            let span = match (&written.value, step) {
                (TransformEntry::Steps(steps), Some(step)) => &steps[step].place,
                _ => &written.place,
            };
            self.error(span, message)
        })
    }

    fn step(&self, span: &Place, written: &StepEntry) -> Result<TransformStep, SceneError> {
        if let Some(degrees) = &written.degrees
            && written.rotate.is_none()
        {
            return Err(self.error(&degrees.place, "`degrees` belongs to `rotate`, which is missing"));
        }
        let mut steps = Vec::with_capacity(1);
        if let Some(scale) = &written.scale {
            if scale.value.0.abs().min_element() == 0.0 {
                return Err(self.error(&scale.place, "a scale of 0 flattens the shape"));
            }
            steps.push(TransformStep::Scale(scale.value.0));
        }
        if let Some(axis) = &written.rotate {
            let Some(degrees) = &written.degrees else {
                return Err(self.error(span, "`rotate` needs the key `degrees`"));
            };
            steps.push(TransformStep::Rotate { axis: self.direction(axis)?, degrees: degrees.value.0 });
        }
        if let Some(offset) = written.translate {
            steps.push(TransformStep::Translate(vector(offset)));
        }
        if let Some(matrix) = &written.matrix {
            steps.push(TransformStep::Matrix(self.matrix(matrix)?));
        }
        match steps[..] {
            [step] => Ok(step),
            _ => Err(self
                .error(span, format!("a step has one of `scale`, `rotate`, `translate`, `matrix`; this has {}", steps.len()))
                .with_help("write several steps as several tables: they are applied in the order of the array")),
        }
    }

    fn matrix(&self, written: &Located<Exactly<Number, 16>>) -> Result<DAffine3, SceneError> {
        let rows = written.value.map(|number| number.0);
        if rows[12..] != [0.0, 0.0, 0.0, 1.0] {
            return Err(self.error(&written.place, "the last row of a matrix is 0, 0, 0, 1 (numbers are row by row)"));
        }
        Ok(affine(&written.value))
    }
}
