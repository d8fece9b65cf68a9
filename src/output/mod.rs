//! Picture files: bands of pixels go in row by row, whole files come out, and other people's files are read back.
//!
//! Writers hold a few bands at a time, never the picture, so that memory does not grow with its size.

mod channels;
mod developed;
mod display;
mod exr_file;
mod finished;
mod format;
mod hdr_file;
mod jpeg_file;
mod layers;
mod picture;
mod png_file;
mod provenance;
mod read;
mod rows;
mod spec;
mod temporary;

pub use crate::file_identity::{FileIdentity, folder_of, follow_links};
pub use channels::Channels;
pub use display::{Developer, Display, Exposure, Meter, ToneCurve, srgb_byte};
pub use exr_file::part_channels;
pub use finished::is_finished_picture;
pub use format::{PICTURE_ENDINGS, PictureFormat};
pub use gpt_scene::atomic_file::{AtomicFile, check_target, remove_left_over, remove_unfinished};
pub use gpt_scene::output_error::OutputError;
pub use layers::{HIGH, LOW, LayerChannel, LayerPicture, LayerSource, SAMPLE_COUNT, sample_variance};
pub use picture::{PictureFile, STDOUT};
pub use provenance::{CONFIDENCE_KEY, CROP_KEY, LAYERS_KEY, LIGHT_GROUPS_KEY, PICTURE_HIGH_KEY, PICTURE_LOW_KEY, Provenance};
pub use read::{Image, PictureKind, ReadError, ReadPicture, cut, read_image, read_picture, read_undamaged_picture};
pub use spec::{ExrCompression, ExrForm, ExrOptions, PartSpec, PictureSpec};
