//! Errors of picture files.

use std::io;
use std::path::PathBuf;

/// Why a picture could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("{}: the folder {} does not exist", path.display(), folder.display())]
    NoFolder { path: PathBuf, folder: PathBuf },
    #[error("{}: {what}", path.display())]
    BadTarget { path: PathBuf, what: &'static str },
    /// The file was read by this process.
    #[error("{} is a file that is read, and would be overwritten: name another output", path.display())]
    Input { path: PathBuf },
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    /// The fault of its place, and where the whole file is instead.
    #[error("{error}; what was to go there is kept in {}", place.display())]
    Kept { error: Box<OutputError>, place: PathBuf },
    #[error("cannot write {}: {what}", path.display())]
    Encode { path: PathBuf, what: String },
}
