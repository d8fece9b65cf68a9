//! The files that were read for a scene, or for all scenes of one command. None of them may be written, and a render that is watched begins again
//! where one changes.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use crate::file_identity::FileIdentity;
use crate::input::{self, InputFile};

/// A list of files. Copies share it.
#[derive(Debug, Clone, Default)]
pub struct FileLog {
    /// Each file by its real path, as it was when it was opened; None where there was no file of that name.
    files: Arc<Mutex<BTreeMap<PathBuf, Option<Stamp>>>>,
}

/// A content of a file: which file it is, its length, and when it was written.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Stamp {
    identity: FileIdentity,
    length: u64,
    written: Option<SystemTime>,
}

impl Stamp {
    /// The stamp of a file that is there.
    fn of(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok()?;
        Some(Self { identity: FileIdentity::of(path), length: metadata.len(), written: metadata.modified().ok() })
    }

    /// A stamp that no file has.
    fn unknown(path: &Path) -> Self {
        Self { identity: FileIdentity::Place(path.to_owned()), length: u64::MAX, written: None }
    }
}

impl FileLog {
    /// Opens a regular file, which from now on is in the list.
    ///
    /// # Errors
    /// The errors of [`input::open`].
    pub fn open(&self, path: &Path) -> io::Result<InputFile> {
        let before = Stamp::of(path);
        let opened = input::open(path);
        match &opened {
            // A file that appeared meanwhile counts as changed.
            Ok(_) => self.add(path, before.or_else(|| Some(Stamp::unknown(path)))),
            Err(error) if error.kind() == ErrorKind::NotFound => self.add(path, None),
            Err(_) => {}
        }
        opened
    }

    /// Reads a regular file of at most `most` bytes, which from now on is in the list.
    ///
    /// # Errors
    /// The errors of [`input::open`] and [`input::read`].
    pub fn read(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        input::read(self.open(path)?, most)
    }

    fn add(&self, path: &Path, stamp: Option<Stamp>) {
        // A missing file has no real path; it has one once it is there.
        if let Ok(real) = fs::canonicalize(path).or_else(|_| std::path::absolute(path)) {
            self.files().insert(real, stamp);
        }
    }

    /// True where this file was opened, by whatever name.
    pub fn has(&self, path: &Path) -> bool {
        let Ok(real) = fs::canonicalize(path) else { return false };
        let files = self.files();
        if matches!(files.get(&real), Some(Some(_))) {
            return true;
        }
        // A hard link, or a name in other case. A new file may have got the number of one that is gone.
        let identity = FileIdentity::of(&real);
        let is_it = |(path, stamp): (&PathBuf, &Option<Stamp>)| {
            stamp.as_ref().is_some_and(|stamp| stamp.identity == identity) && FileIdentity::of(path) == identity
        };
        files.iter().any(is_it)
    }

    /// Files that are not what they were when they were opened, or when they were last [accepted](Self::accept_changes).
    pub fn changed(&self) -> Vec<PathBuf> {
        let files = self.files().clone();
        files.into_iter().filter(|(path, before)| Stamp::of(path) != *before).map(|(path, _)| path).collect()
    }

    /// Takes all files for what they are now.
    pub fn accept_changes(&self) {
        let mut files = self.files();
        // A file that was read stays in the list, though it may be gone for a moment. One that was missing and is still wanted will be looked for
        // again.
        files.retain(|_, before| before.is_some());
        for (path, before) in files.iter_mut() {
            *before = Some(Stamp::of(path).unwrap_or_else(|| Stamp::unknown(path)));
        }
    }

    fn files(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Option<Stamp>>> {
        // The list is whole whoever panicked while holding it.
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_change_are_noticed_once() {
        let folder = tempfile::tempdir().unwrap();
        let [path, missing] = ["file", "missing"].map(|name| fs::canonicalize(folder.path()).unwrap().join(name));
        let log = FileLog::default();
        let seen = |path: &Path| log.changed().iter().any(|changed| changed == path);
        fs::write(&path, "one").unwrap();
        assert!(log.read(&path, 100).is_ok() && log.read(&missing, 100).is_err());
        assert!(!seen(&path) && !seen(&missing));
        fs::write(&path, "three").unwrap();
        fs::write(&missing, "here").unwrap();
        assert!(seen(&path) && seen(&missing));
        assert!(log.has(&path) && !log.has(&missing));
        log.accept_changes();
        assert!(!seen(&path) && !seen(&missing) && log.has(&path));
        fs::remove_file(&path).unwrap();
        assert!(seen(&path));
        log.accept_changes();
        // An editor writes the file anew.
        fs::write(&path, "four").unwrap();
        assert!(seen(&path) && log.has(&path));
    }

    #[cfg(unix)]
    #[test]
    fn files_are_known_by_all_of_their_names() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("read"), "one").unwrap();
        fs::hard_link(at("read"), at("hard")).unwrap();
        std::os::unix::fs::symlink("read", at("soft")).unwrap();
        fs::write(at("other"), "one").unwrap();
        let log = FileLog::default();
        assert!(!log.has(&at("read")));
        log.read(&at("read"), 100).unwrap();
        assert!(["read", "hard", "soft"].iter().all(|name| log.has(&at(name))) && !log.has(&at("other")));
        assert!(!FileLog::default().has(&at("read")), "another list");
        // An editor puts a new file in its place, and another file may get the old one's number.
        fs::rename(at("other"), at("read")).unwrap();
        assert!(log.has(&at("read")) && !log.has(&at("hard")));
    }
}
