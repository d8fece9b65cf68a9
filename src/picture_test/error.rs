//! Why a scene could not be tested.

use crate::output::{OutputError, ReadError};
use crate::renderer::RenderError;

/// Why a scene could not be tested.
#[derive(Debug, thiserror::Error)]
pub enum PictureTestError {
    #[error(transparent)]
    Render(#[from] RenderError),
    #[error(transparent)]
    Picture(#[from] ReadError),
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A sentence that names the file.
    #[error("{0}")]
    Unsuitable(String),
    /// The observer asked to stop.
    #[error("interrupted")]
    Interrupted,
}
