//! Files that appear whole or not at all: written under a temporary name in the target's folder, then renamed.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tempfile::{Builder, NamedTempFile};

use super::error::OutputError;

/// Temporary files that exist now; a process that ends without unwinding removes them by [`remove_unfinished`].
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A file that is not there yet. Dropped without [`AtomicFile::commit`], it leaves nothing behind.
#[derive(Debug)]
pub struct AtomicFile {
    temporary: Option<NamedTempFile>,
    temporary_path: PathBuf,
    /// As the caller named it, for messages.
    named: PathBuf,
    /// Where the file goes: `named` with symbolic links followed, so that a link stays one.
    target: PathBuf,
}

impl AtomicFile {
    /// Opens the temporary file beside `path`.
    ///
    /// # Errors
    /// A folder that is missing or that must not be written to, and a target that is no ordinary file.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        check_target(path)?;
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let temporary = temporary_beside(&target).map_err(|source| OutputError::Write { path: path.to_owned(), source })?;
        let temporary_path = temporary.path().to_owned();
        unfinished().push(temporary_path.clone());
        Ok(Self { temporary: Some(temporary), temporary_path, named: path.to_owned(), target })
    }

    /// The path as it was asked for.
    pub fn path(&self) -> &Path {
        &self.named
    }

    /// A handle to write through; all handles share one position.
    pub fn handle(&self) -> Result<File, OutputError> {
        let temporary = self.temporary.as_ref().ok_or_else(|| io::Error::other("the file is closed"));
        temporary.and_then(|temporary| temporary.as_file().try_clone()).map_err(|source| self.failure(source))
    }

    /// Puts the file in its place, over an older one of that name.
    ///
    /// # Errors
    /// Whatever the system says to flushing and renaming; then the older file is still there.
    pub fn commit(mut self) -> Result<(), OutputError> {
        let temporary = self.temporary.take().ok_or_else(|| self.failure(io::Error::other("the file is closed")))?;
        temporary.as_file().sync_all().map_err(|source| self.failure(source))?;
        temporary.persist(&self.target).map_err(|error| self.failure(error.error))?;
        Ok(())
    }

    /// Writes `bytes` as the whole file at `path`.
    ///
    /// # Errors
    /// As [`AtomicFile::create`] and [`AtomicFile::commit`].
    pub fn write(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
        let file = Self::create(path)?;
        file.handle()?.write_all(bytes).map_err(|source| file.failure(source))?;
        file.commit()
    }

    fn failure(&self, source: io::Error) -> OutputError {
        OutputError::Write { path: self.named.clone(), source }
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        unfinished().retain(|path| *path != self.temporary_path);
    }
}

/// Whether a file could be put at `path`: its folder exists and nothing but an ordinary file is in its place. Asked before a
/// render, so that hours of work do not end at a mistyped folder.
///
/// # Errors
/// [`OutputError::NoFolder`] and [`OutputError::BadTarget`].
pub fn check_target(path: &Path) -> Result<(), OutputError> {
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(OutputError::NoFolder { path: path.to_owned(), folder: folder.to_owned() });
    }
    match fs::metadata(path) {
        Ok(existing) if existing.is_dir() => Err(OutputError::BadTarget { path: path.to_owned(), what: "this is a folder" }),
        Ok(existing) if !existing.is_file() => Err(OutputError::BadTarget {
            path: path.to_owned(),
            what: "this is not an ordinary file, and renaming would replace it",
        }),
        _ => Ok(()),
    }
}

/// Removes the temporary files of every [`AtomicFile`] that is open. For use right before the process ends at once.
pub fn remove_unfinished() {
    for path in unfinished().drain(..) {
        // Nothing is left to be done about a file that cannot be removed.
        let _ = fs::remove_file(path);
    }
}

fn unfinished() -> std::sync::MutexGuard<'static, Vec<PathBuf>> {
    // The list is whole whatever panicked while holding it.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

fn temporary_beside(target: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".gpt-").suffix(".part");
    // Temporary files are private to their owner by default; a picture has the permissions that any new file has.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder_of(target))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(folder: &Path) -> Vec<String> {
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn nothing_is_seen_before_the_commit_and_nothing_is_left_without_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.exr");
        fs::write(&path, "old").unwrap();

        let abandoned = AtomicFile::create(&path).unwrap();
        abandoned.handle().unwrap().write_all(b"half of the ne").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(entries(folder.path()).len(), 2, "the temporary file lies beside its target");
        drop(abandoned);
        assert_eq!(entries(folder.path()), ["picture.exr"]);
        assert_eq!(fs::read(&path).unwrap(), b"old");

        AtomicFile::write(&path, b"new").unwrap();
        assert_eq!(entries(folder.path()), ["picture.exr"]);
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn targets_that_cannot_be_are_named() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(AtomicFile::create(&folder.path().join("no/where.exr")), Err(OutputError::NoFolder { .. })));
        assert!(matches!(AtomicFile::create(folder.path()), Err(OutputError::BadTarget { .. })));
        assert!(check_target(&folder.path().join("a.exr")).is_ok());
        assert!(check_target(Path::new("just-a-name.exr")).is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_permissions_are_ordinary() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (real, link) = (folder.path().join("real.png"), folder.path().join("link.png"));
        fs::write(&real, "old").unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        AtomicFile::write(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&real).unwrap(), b"new");

        let ordinary = folder.path().join("ordinary");
        fs::write(&ordinary, "").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&real), mode(&ordinary));
    }
}
