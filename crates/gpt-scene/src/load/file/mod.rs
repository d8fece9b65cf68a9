//! Scene files: from TOML text to a [`Scene`](crate::scene::Scene).
//!
//! `document` reads the text into the types of `syntax`, which know every key and range; `resolve` looks up names and reads the
//! files that are named. Each complains about the place where the mistake is written.

mod calibration;
mod camera_examples;
pub(super) mod colour;
mod document;
mod emissive_instances;
pub(super) mod import;
pub(super) mod instance;
pub(super) mod keyframes;
pub(super) mod light;
mod light_group;
pub mod light_link;
pub(super) mod material;
pub mod medium;
pub(super) mod meter;
mod nested;
pub(super) mod node;
mod place_file;
mod reader;
pub(super) mod reference;
mod resolve;
mod resolver;
mod schema;
pub(super) mod shape;
mod suggestion;
pub(super) mod syntax;
pub(super) mod value;
pub(crate) mod volume;
pub(crate) mod writer;

pub use camera_examples::{CAMERA_EXAMPLES, CameraExample};
pub(crate) use document::FORMAT_VERSION;
pub(super) use document::{Document, stem};
pub(crate) use light::write_light;
pub use light::{examples as light_examples, examples_of as light_examples_of, strength_key};
pub(crate) use light_group::write_light_group;
pub(crate) use light_link::{write_link, write_receiver};
pub use material::{EXAMPLE_PARTS, example_materials, examples as material_examples};
pub(crate) use material::{metal_symbol, write_kind};
pub(crate) use medium::write as write_medium;
pub(crate) use meter::write as write_meter;
pub(crate) use place_file::{place_rows, write_places};
pub(super) use resolve::{resolve, resolve_model, resolve_transform};
pub use schema::{json_schema, make_json_schema};
pub use shape::examples as shape_examples;
pub(crate) use shape::write_geometry;
pub(super) use suggestion::{did_you_mean, did_you_mean_name};
