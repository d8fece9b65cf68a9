//! Scenes as a file with others beside it, in whatever format.

use std::fs;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::atomic_file::AtomicFile;
use crate::file_log::FileLog;
use crate::output_error::OutputError;
use crate::scene::ImportReport;

/// A scene as the content of a file, and the files that it names beside those on disk.
#[derive(Debug)]
pub struct WrittenScene {
    /// The file itself: text, or the bytes of binary glTF.
    pub content: Vec<u8>,
    /// Paths of the files beside it, with their contents.
    pub files: Vec<(PathBuf, Vec<u8>)>,
    /// Differences between what is written and the scene.
    pub report: ImportReport,
}

impl WrittenScene {
    /// Writes the files and, last of all, the file that names them; the paths of all that were written.
    ///
    /// # Errors
    /// Files that cannot be written, and those that `read` names: an output never replaces an input.
    pub fn write(self, path: &Path, read: &FileLog) -> Result<Vec<PathBuf>, OutputError> {
        let all = || self.files.iter().map(|(path, _)| path.as_path()).chain([path]);
        if let Some(path) = all().find(|path| read.has(path)).map(Path::to_owned) {
            return Err(OutputError::Input { path });
        }
        let write = |(path, content): (PathBuf, Vec<u8>)| {
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder).map_err(|source| OutputError::Write { path: folder.to_owned(), source })?;
            }
            AtomicFile::write(&path, &content).map(|()| path)
        };
        // Side by side: a disk takes some time to say that a file is safe, however small it is.
        let mut written = self.files.into_par_iter().map(write).collect::<Result<Vec<_>, _>>()?;
        AtomicFile::write(path, &self.content)?;
        written.push(path.to_owned());
        Ok(written)
    }
}
