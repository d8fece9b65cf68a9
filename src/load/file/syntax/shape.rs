//! `[[shape]]`

use std::borrow::Cow;
use std::fmt;

use glam::DVec3;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::load::file::value::{Any, Checked, Located, Number, Positive, Rgb, Vector, any_of};

/// A shape's own keys and those that every shape has.
macro_rules! shapes {
    ($($(#[$doc:meta])* $variant:ident($name:ident) { $($(#[$field_doc:meta])* $field:ident : $type:ty),* $(,)? })*) => {
        /// A surface.
        #[derive(Debug, Deserialize, JsonSchema)]
        #[serde(rename_all = "snake_case")]
        #[schemars(tag = "type")]
        pub enum ShapeEntry { $($variant($name)),* }

        $(
            $(#[$doc])*
            #[derive(Debug, Deserialize, JsonSchema)]
            #[serde(deny_unknown_fields, expecting = "a table")]
            pub struct $name {
                $($(#[$field_doc])* pub $field: $type,)*
                /// A `[[material]]`'s name. A mesh file may leave it out to use its own materials.
                pub material: Option<Located<String>>,
                /// Steps applied in this order, or a matrix.
                pub transform: Option<Located<TransformEntry>>,
                /// Steps of `scale`, `rotate` and `translate` reached at shutter time 1; at time 0 the shape rests. They apply in
                /// this order after `transform`, along the world's axes and about the shape's own origin, where `transform` puts its
                /// (0, 0, 0). Each is interpolated by itself: rotations turn evenly about their axis.
                pub motion: Option<Located<TransformEntry>>,
                /// Sample the directions through this shape for the environment's light as if the shape were a light: a window. Its
                /// material is of type `pass`; a surface that emits is sampled as a light in any case.
                #[serde(default)]
                pub portal: bool,
            }
        )*

        impl ShapeEntry {
            pub fn common(&self) -> CommonShape<'_> {
                match self {
                    $(Self::$variant(shape) => CommonShape {
                        material: shape.material.as_ref(),
                        transform: shape.transform.as_ref(),
                        motion: shape.motion.as_ref(),
                        portal: shape.portal,
                    },)*
                }
            }
        }
    };
}

/// The keys every shape has.
pub struct CommonShape<'a> {
    pub material: Option<&'a Located<String>>,
    pub transform: Option<&'a Located<TransformEntry>>,
    pub motion: Option<&'a Located<TransformEntry>>,
    pub portal: bool,
}

shapes! {
    /// Triangles, from a file or written here.
    Mesh(MeshShape) {
        /// Path of an OBJ file, relative to the scene file.
        file: Option<Located<String>>,
        positions: Option<Vec<Located<Vector>>>,
        /// Three indices into `positions` each, counted from 0, counter-clockwise seen from the front.
        faces: Option<Vec<Located<[u32; 3]>>>,
        /// One per position.
        uvs: Option<Located<Vec<[Number; 2]>>>,
        /// One per position.
        normals: Option<Located<Vec<Located<Vector>>>>,
        /// Interpolate normals over the faces; when left out, true if there are normals.
        smooth: Option<bool>,
    }
    /// The normal points outward.
    Sphere(SphereShape) { center: Vector, radius: Checked<Positive> }
    /// A parallelogram; its front is where edge_u × edge_v points.
    Rectangle(RectangleShape) { corner: Vector, edge_u: Located<Vector>, edge_v: Located<Vector> }
    /// A flat disk.
    Disk(DiskShape) { center: Vector, normal: Located<Vector>, radius: Checked<Positive> }
    /// Axis-aligned before its transform; at most one edge has no length.
    Box(BoxShape) { min: Vector, max: Located<Vector> }
    /// Infinite.
    Plane(PlaneShape) { point: Vector, normal: Located<Vector> }
}

/// Steps applied in their order, or one matrix.
#[derive(Debug)]
pub enum TransformEntry {
    Steps(Vec<Located<StepEntry>>),
    Single(Box<StepEntry>),
}

/// One step: exactly one of `scale`, `rotate`, `translate`, `matrix`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table with one of the keys `scale`, `rotate`, `translate` and `matrix`")]
#[schemars(extend("oneOf" = [
    { "required": ["scale"] }, { "required": ["rotate", "degrees"] }, { "required": ["translate"] }, { "required": ["matrix"] }
]))]
pub struct StepEntry {
    /// One factor or one per axis; not 0.
    pub scale: Option<Located<ScaleEntry>>,
    /// The axis of a rotation by `degrees`.
    pub rotate: Option<Located<Vector>>,
    /// Counter-clockwise seen from the axis' tip.
    pub degrees: Option<Located<Number>>,
    pub translate: Option<Vector>,
    /// 16 numbers, row by row; the last row is 0 0 0 1.
    pub matrix: Option<Located<[Number; 16]>>,
}

/// One factor or one per axis.
#[derive(Debug)]
pub struct ScaleEntry(pub DVec3);

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

impl<'de> Deserialize<'de> for ScaleEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Rgb::<Any>::deserialize_as(deserializer, "one factor or one per axis").map(ScaleEntry)
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

impl JsonSchema for ScaleEntry {
    fn schema_name() -> Cow<'static, str> {
        "Scale".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        any_of(vec![generator.subschema_for::<Number>(), generator.subschema_for::<Vector>()])
    }
}
