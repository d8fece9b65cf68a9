//! States of a render in a file, so that nothing but a little time is lost where it breaks off.
//!
//! The state of a render is the film of the batch under way, with how far that is, and what earlier batches brought (`saved`). It stands in
//! one file beside the picture ([`file`]), which appears whole, replaces the last one and says what it is of (`identity`). Finished rows of
//! pictures too large for memory stand in a second one that only grows (`rows`).

mod file;
mod identity;
mod keeper;
mod rows;
pub(super) mod saved;

pub use identity::Identity;
pub use keeper::{Checkpoint, CheckpointError, DEFAULT_INTERVAL, is_kept, path_beside, path_of_layer, remove_state};
