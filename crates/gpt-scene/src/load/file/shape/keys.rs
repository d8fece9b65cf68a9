//! The keys that every shape has.

use glam::DVec3;

use super::transform::TransformEntry;
use crate::load::error::SceneError;
use crate::load::file::keyframes::WrittenTrack;
use crate::load::file::light_link::ReceiverName;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::Located;
use crate::load::file::writer::Writer;
use crate::load::place::Place;
use crate::math::box_corners;
use crate::scene::{MaterialId, Shape};

/// Meaning of a shape's keys.
pub trait ShapeKeys {
    /// The geometry in the scene.
    type Shape;

    /// The keys of its geometry, which tests render with materials of all kinds. Each shows itself within 1 of the origin.
    const EXAMPLES: &'static [&'static str];

    /// The geometry. Only a mesh file may bring a material, which it writes into `entry`.
    fn resolve(&self, resolver: &mut Resolver<'_>, entry: &mut Written<'_>) -> Result<Self::Shape, SceneError>;

    /// Points around it, by which a camera is placed, in its own space; none of what is infinite, or is a mesh.
    fn outline(&self) -> Vec<DVec3>;

    /// The keys that say the geometry of `shape`, which this is, and its material, a line each.
    fn write(geometry: &Self::Shape, shape: &Shape, writer: &mut Writer<'_>) -> String;
}

/// The corners of the box around points.
pub fn box_around(points: &[DVec3]) -> Vec<DVec3> {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    box_corners(low, high).to_vec()
}

/// The corners of the box around a ball.
pub fn around_ball(center: DVec3, radius: f64) -> Vec<DVec3> {
    box_around(&[center - radius, center + radius])
}

/// Declares the keys of a shape: its own and those that every shape has. `name` is what the schema calls them.
macro_rules! shape_keys {
    ($(#[$doc:meta])* $name:literal { $($(#[$field_doc:meta])* $field:ident : $type:ty),* $(,)? }) => {
        #[derive(Debug, Clone, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields, expecting = "a table")]
        #[schemars(rename = $name)]
        #[schemars(extend("dependentSchemas" = {
            "keyframes": { "not": { "required": ["motion"] } },
            "node": { "not": { "required": ["motion"] } },
            "interpolation": { "required": ["keyframes"] },
        }))]
        $(#[$doc])*
        pub struct Keys {
            $($(#[$field_doc])* pub $field: $type,)*
            /// A `[[material]]`'s name. A mesh file may leave it out to use its own materials.
            pub material: Option<$crate::load::file::value::Located<String>>,
            /// Steps applied in this order, or a matrix.
            pub transform: Option<$crate::load::file::value::Located<$crate::load::file::shape::transform::TransformEntry>>,
            /// Steps of `scale`, `rotate` and `translate` reached at shutter time 1; at time 0 the shape rests. They apply in
            /// this order after `transform`, along the world's axes and about the shape's own origin, where `transform` puts its
            /// (0, 0, 0). Each is interpolated by itself: rotations turn evenly about their axis.
            #[schemars(extend("allOf" = [{ "not": { "anyOf": [
                { "type": "object", "required": ["matrix"] },
                { "type": "array", "contains": { "type": "object", "required": ["matrix"] } },
            ] } }]))]
            pub motion: Option<$crate::load::file::value::Located<$crate::load::file::shape::transform::TransformEntry>>,
            /// Transforms at frames (`--frame`, `--frames`, `--time`), in place of `transform`, which holds
            /// without a frame.
            #[schemars(extend("minItems" = 1))]
            pub keyframes: Option<$crate::load::file::value::Located<Vec<$crate::load::file::value::Located<$crate::load::file::keyframes::TransformKeyEntry>>>>,
            /// How keyframes lead from one to the next; "linear" when left out.
            pub interpolation: Option<$crate::load::file::value::Located<$crate::load::file::keyframes::InterpolationName>>,
            /// A `[[node]]` that takes the shape along at frames.
            pub node: Option<$crate::load::file::value::Located<String>>,
            /// Sample the directions through this shape for the environment's light as if the shape were a light: a window. Its
            /// material is of type `pass`; a surface that emits is sampled as a light in any case.
            #[serde(default)]
            pub portal: bool,
            /// The group of receivers that the shape belongs to, which lamps name in `lights_only` and `lights_all_but`; "rest" when left out.
            pub receiver: Option<$crate::load::file::value::Located<$crate::load::file::light_link::ReceiverName>>,
        }

        impl Keys {
            pub fn common_mut(&mut self) -> $crate::load::file::shape::keys::CommonKeysMut<'_> {
                $crate::load::file::shape::keys::CommonKeysMut {
                    material: &mut self.material,
                    transform: &mut self.transform,
                    motion: &mut self.motion,
                    node: &mut self.node,
                    receiver: &mut self.receiver,
                }
            }

            pub fn common(&self) -> $crate::load::file::shape::keys::CommonKeys<'_> {
                $crate::load::file::shape::keys::CommonKeys {
                    material: self.material.as_ref(),
                    transform: self.transform.as_ref(),
                    motion: self.motion.as_ref(),
                    portal: self.portal,
                    receiver: self.receiver.as_ref(),
                    track: $crate::load::file::keyframes::WrittenTrack {
                        keyframes: self.keyframes.as_ref(),
                        interpolation: self.interpolation.as_ref(),
                        node: self.node.as_ref(),
                        has_motion: self.motion.is_some(),
                    },
                }
            }
        }
    };
}
pub(super) use shape_keys;

/// Makes the keys of a shape from its own, without those that every shape has.
macro_rules! plain_keys {
    ($($field:ident: $value:expr),* $(,)?) => {
        Self {
            $($field: $value,)*
            material: None,
            transform: None,
            motion: None,
            keyframes: None,
            interpolation: None,
            node: None,
            portal: false,
            receiver: None,
        }
    };
}
pub(super) use plain_keys;

/// The keys that every shape has.
pub struct CommonKeys<'a> {
    pub material: Option<&'a Located<String>>,
    pub transform: Option<&'a Located<TransformEntry>>,
    pub motion: Option<&'a Located<TransformEntry>>,
    pub portal: bool,
    pub receiver: Option<&'a Located<ReceiverName>>,
    pub track: WrittenTrack<'a>,
}

/// Keys that every shape has and importers change.
pub struct CommonKeysMut<'a> {
    pub material: &'a mut Option<Located<String>>,
    pub transform: &'a mut Option<Located<TransformEntry>>,
    pub motion: &'a mut Option<Located<TransformEntry>>,
    pub node: &'a mut Option<Located<String>>,
    pub receiver: &'a mut Option<Located<ReceiverName>>,
}

/// A shape whose geometry is about to be resolved.
pub struct Written<'a> {
    pub place: &'a Place,
    /// Place among the scene's shapes.
    pub index: usize,
    /// The one that is written, or that the geometry brings with it.
    pub material: Option<MaterialId>,
}
