//! Scenes of the path tracer `gpt`: their plain types, what reads and checks them, and what writes them again.
//!
//! This is a part of `gpt-pathtracer`, which exports what users of the library need. Modules are public for that crate; they are not an
//! interface and change without notice.

#[doc(hidden)]
pub mod atomic_file;
#[doc(hidden)]
pub mod black_body;
#[doc(hidden)]
pub mod choice;
pub(crate) mod equal_area_square;
#[doc(hidden)]
pub mod file_identity;
#[doc(hidden)]
pub mod file_log;
#[doc(hidden)]
pub mod input;
#[doc(hidden)]
pub mod layer;
#[doc(hidden)]
pub mod light_examples;
#[doc(hidden)]
pub mod load;
#[doc(hidden)]
pub mod math;
#[doc(hidden)]
pub mod observer;
#[doc(hidden)]
pub mod output_error;
#[doc(hidden)]
pub mod picture_file;
#[doc(hidden)]
pub mod scene;
#[doc(hidden)]
pub mod scene_writer;
#[doc(hidden)]
pub mod spectrum;
