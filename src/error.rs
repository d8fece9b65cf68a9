//! The one error that users of the crate meet.

use std::io;
use std::path::PathBuf;

use crate::compare::SizeMismatch;
use crate::load::SceneError;
use crate::output::{OutputError, ReadError};
use crate::renderer::RenderError;

/// Why something could not be done. Each displays as one sentence.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A scene file, or a file that it names, is wrong; the error says where.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene was changed after it was loaded, and cannot be rendered as it is.
    #[error("the scene is not valid: {0}")]
    InvalidScene(String),
    /// Options are out of range, or contradict each other.
    #[error("{0}")]
    Options(String),
    /// There is no device of the kind that was asked for.
    #[error("no usable device: {0}")]
    NoDevice(String),
    /// The scene needs more than the device has. The message holds both numbers.
    #[error("the scene does not fit the device: {0}")]
    DoesNotFit(String),
    /// The device was lost while it was in use.
    #[error("the device was lost: {0}")]
    DeviceLost(String),
    /// A picture file could not be read.
    #[error("cannot read {}: {message}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The mistake, in a sentence.
        message: String,
    },
    /// A picture file could not be written. The message names the file.
    #[error("{0}")]
    Write(String),
    /// The receiver of the bands returned this error.
    #[error(transparent)]
    Receiver(io::Error),
    /// Two pictures that were to be compared have different sizes.
    #[error(transparent)]
    Sizes(#[from] SizeMismatch),
    /// A fault of this crate or of a driver.
    #[error("{0}")]
    Internal(String),
}

impl From<RenderError> for Error {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::NoDevice(message) => Self::NoDevice(message),
            RenderError::DoesNotFit(message) => Self::DoesNotFit(message),
            RenderError::InvalidScene(invalid) => Self::InvalidScene(invalid.to_string()),
            RenderError::DeviceLost(message) => Self::DeviceLost(message),
            RenderError::Internal(message) => Self::Internal(message),
            RenderError::Output(error) => Self::Receiver(error),
        }
    }
}

impl From<OutputError> for Error {
    fn from(error: OutputError) -> Self {
        Self::Write(error.to_string())
    }
}

impl From<ReadError> for Error {
    fn from(ReadError { path, what }: ReadError) -> Self {
        Self::Read { path, message: what }
    }
}
