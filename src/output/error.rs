//! What can go wrong with a picture file.

use std::io;
use std::path::PathBuf;

/// Why a picture could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("{}: the folder {} does not exist", path.display(), folder.display())]
    NoFolder { path: PathBuf, folder: PathBuf },
    #[error("{}: {what}", path.display())]
    BadTarget { path: PathBuf, what: &'static str },
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot write {}: {what}", path.display())]
    Encode { path: PathBuf, what: String },
}
