//! From a file, a model or a name to a [`Scene`](crate::scene::Scene).
//!
//! - [`source`]: what a person may name as the scene.
//! - [`mod@file`]: scene files in TOML; `obj`, `ply`: models, of which `model` is what they have in common, `spelling` how their texts
//!   say it, and `mends` what is wrong in them and replaced; `image_file`: textures and environment maps, and `environment_map`: what of those is
//!   no lat-long map as it stands.
//! - `mitsuba`, `pbrt`, `gltf`: scenes of other programs, which become entries of scene files by means of `import`; `import_file` tells them apart.
//! - `scene_file`: a scene file with what it imports.
//! - `lm_63`: profiles of lamps, from photometric files.
//! - `volume`: grids of media, from files of OpenVDB, NanoVDB and Mitsuba.
//! - `place`: where mistakes are reported.
//! - `framing`: camera, ground and light for a model that comes without them; `view`: what a person may say of that; `presets`: materials by name.
//! - `builtin_scenes`: scenes that are part of the program, among them `examples`, made of all examples; `builtin`: the files they name.
//! - `toml_text`: values and tables as scene files have them, for those who write some.
//! - [`error`]: what is wrong with an input file, and where.

mod access;
mod builtin;
mod builtin_scenes;
mod daylight;
mod deformation_file;
mod encoding;
mod environment_map;
pub mod error;
mod examples;
mod excerpt;
pub mod file;
mod files;
mod formats;
mod framing;
mod gltf;
mod image_file;
mod import;
mod import_file;
pub(crate) mod lm_63;
mod memory;
mod mends;
mod mitsuba;
mod model;
mod obj;
mod pbrt;
pub(crate) mod place;
mod ply;
mod polygon;
mod presets;
mod printable;
mod reading;
mod scene_file;
mod scene_methods;
pub mod source;
mod spelling;
mod toml_text;
mod view;
pub mod volume;

pub use crate::file_log::FileLog;
pub use access::LoadOptions;
pub use builtin::is_builtin;
pub use builtin_scenes::{builtin_names, builtin_text};
pub use error::SceneError;
pub use excerpt::Excerpt;
pub use file::{json_schema, make_json_schema};
pub(crate) use file::{place_rows, write_places};
pub(crate) use gltf::single_scattering_albedo;
pub use image_file::read_image;
pub use presets::preset_names;
pub use printable::printable;
pub use reading::ReadingProgress;
pub use scene_file::load_toml_str;
pub use source::{SceneSource, load, load_file_text, load_with};
pub use view::{ModelView, Up};
