//! Files that appear whole or not at all: written under a temporary name in the target's folder, then renamed.
//!
//! A temporary file is locked as long as its process lives. One that is not was left by a process that was killed; [`remove_left_over`] removes it.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use crate::file_identity::{folder_of, follow_links};
use crate::output_error::OutputError;

const PREFIX: &str = ".gpt-";
const SUFFIX: &str = ".part";

/// A file that is not there yet. Dropped without [`AtomicFile::commit`], it leaves nothing behind.
#[derive(Debug)]
pub struct AtomicFile {
    temporary: Option<NamedTempFile>,
    /// The path as the caller named it, for messages.
    named: PathBuf,
    /// The place of the finished file: `named` with symbolic links followed, so that a link stays one.
    target: PathBuf,
}

impl AtomicFile {
    /// Opens the temporary file beside `path`.
    ///
    /// # Errors
    /// A folder that is missing or that must not be written to, and a target that is no ordinary file.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        check_target(path)?;
        let failure = |source| OutputError::Write { path: path.to_owned(), source };
        let target = follow_links(path).map_err(failure)?;
        let temporary = temporary_beside(&target).map_err(failure)?;
        Ok(Self { temporary: Some(temporary), named: path.to_owned(), target })
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

    /// The place of the finished file, links followed.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Puts the file in its place, over an older one of that name.
    ///
    /// # Errors
    /// Whatever the system says to flushing and renaming; then the older file is still there.
    pub fn commit(self) -> Result<(), OutputError> {
        let target = self.target.clone();
        self.commit_as(&target)
    }

    /// Does the work of [`AtomicFile::commit`] under another name in the same folder.
    ///
    /// # Errors
    /// The errors of [`AtomicFile::commit`].
    pub fn commit_as(mut self, target: &Path) -> Result<(), OutputError> {
        self.put(target)
    }

    /// Does the work of [`AtomicFile::commit_as`] for what took long to make: where it cannot be put there, it goes to another name in the folder, or else into the
    /// system's folder of temporary files.
    ///
    /// # Errors
    /// The errors of [`AtomicFile::commit`]; [`OutputError::Kept`] where it is kept elsewhere.
    pub fn commit_or_keep(mut self, target: &Path) -> Result<(), OutputError> {
        self.put(target).map_err(|error| match self.keep(target) {
            Some(place) => OutputError::Kept { error: Box::new(error), place },
            None => error,
        })
    }

    fn put(&mut self, target: &Path) -> Result<(), OutputError> {
        let temporary = self.temporary.take().ok_or_else(|| self.failure(io::Error::other("the file is closed")))?;
        let put = match temporary.as_file().sync_all() {
            Ok(()) => temporary.persist(target).map_err(|error| (error.error, error.file)),
            Err(error) => Err((error, temporary)),
        };
        match put {
            Ok(_) => flush_folder(folder_of(target)).map_err(|source| self.failure(source)),
            Err((source, temporary)) => {
                self.temporary = Some(temporary);
                Err(self.failure(source))
            }
        }
    }

    /// Puts the file anywhere else: beside its place, or where temporary files are. None: nowhere.
    fn keep(&mut self, target: &Path) -> Option<PathBuf> {
        let mut temporary = self.temporary.take()?;
        for place in names_beside(target, "kept").take(MOST_BESIDE).filter(|place| !place.exists()) {
            match temporary.persist_noclobber(&place) {
                Ok(_) => return Some(place),
                Err(error) => temporary = error.file,
            }
            // Other names do not help where the folder takes none.
            if !place.exists() {
                break;
            }
        }
        let suffix = format!(".{}", target.extension().unwrap_or_default().to_string_lossy());
        let mut elsewhere = Builder::new().prefix("gpt-kept-").suffix(&suffix).tempfile().ok()?;
        temporary.as_file_mut().rewind().ok()?;
        io::copy(temporary.as_file_mut(), &mut elsewhere).ok()?;
        elsewhere.as_file().sync_all().ok()?;
        elsewhere.keep().ok().map(|(_, place)| place)
    }

    /// Writes `bytes` as the whole file at `path`.
    ///
    /// # Errors
    /// The errors of [`AtomicFile::create`] and [`AtomicFile::commit`].
    pub fn write(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
        let file = Self::create(path)?;
        file.handle()?.write_all(bytes).map_err(|source| file.failure(source))?;
        file.commit()
    }

    fn failure(&self, source: io::Error) -> OutputError {
        OutputError::Write { path: self.named.clone(), source }
    }
}

/// How many names beside a file are tried.
pub const MOST_BESIDE: usize = 1000;

/// Names that tell a file from the one in its place: `name.WORD.ending`, and then with a number, from `name.WORD-2.ending` on.
pub fn names_beside(target: &Path, word: &str) -> impl Iterator<Item = PathBuf> {
    let [stem, ending] = [target.file_stem(), target.extension()].map(|part| part.unwrap_or_default().to_os_string());
    (1..).map(move |number| {
        let mut name = stem.clone();
        name.push(if number == 1 { format!(".{word}.") } else { format!(".{word}-{number}.") });
        name.push(&ending);
        target.with_file_name(name)
    })
}

/// Checks that a file could be put at `path`: its folder exists and nothing but an ordinary file is in its place. Asked before a render, so that
/// hours of work do not end at a mistyped folder.
///
/// # Errors
/// [`OutputError::NoFolder`] and [`OutputError::BadTarget`].
pub fn check_target(path: &Path) -> Result<(), OutputError> {
    let target = follow_links(path).map_err(|source| OutputError::Write { path: path.to_owned(), source })?;
    let folder = folder_of(&target);
    if !folder.is_dir() {
        return Err(OutputError::NoFolder { path: path.to_owned(), folder: folder.to_owned() });
    }
    match fs::metadata(&target) {
        Ok(existing) if existing.is_dir() => Err(OutputError::BadTarget { path: path.to_owned(), what: "this is a folder" }),
        Ok(existing) if !existing.is_file() => Err(OutputError::BadTarget {
            path: path.to_owned(),
            what: "this is not an ordinary file, and renaming would replace it",
        }),
        _ => Ok(()),
    }
}

/// Removes the temporary file of every [`AtomicFile`] that this process has open, right before it ends at once. Only Linux lists what a process has
/// open; elsewhere the files stay until [`remove_left_over`].
pub fn remove_unfinished() {
    let open = fs::read_dir("/proc/self/fd").into_iter().flatten().flatten();
    for path in open.filter_map(|entry| fs::read_link(entry.path()).ok()).filter(|path| is_temporary(path)) {
        // A file that cannot be removed stays.
        let _ = fs::remove_file(path);
    }
}

/// True where an [`AtomicFile`] made the file's name.
fn is_temporary(path: &Path) -> bool {
    let name = path.file_name().and_then(OsStr::to_str);
    name.is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX))
}

fn temporary_beside(target: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    // Temporary files are private to their owner by default; a picture has the permissions that any new file has.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    loop {
        let temporary = builder.tempfile_in(folder_of(target))?;
        // A file system without locks refuses, and then nothing is removed.
        let locked = temporary.as_file().lock();
        // Another process may have found it before it was locked, and taken it for left over.
        if locked.is_err() || temporary.path().exists() {
            return Ok(temporary);
        }
    }
}

/// Removes temporary files in a folder that no process has open any more. A file that cannot be removed stays.
pub fn remove_left_over(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten().filter(|entry| is_temporary(&entry.path())) {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if let Some(file) = File::open(entry.path()).ok().filter(|_| is_file)
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Makes a rename last through a loss of power: it is part of the folder.
#[cfg(unix)]
fn flush_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        // Some file systems flush no folders.
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported | io::ErrorKind::PermissionDenied
            ) =>
        {
            Ok(())
        }
        flushed => flushed,
    }
}

/// Folders are no files elsewhere.
#[cfg(not(unix))]
fn flush_folder(_folder: &Path) -> io::Result<()> {
    Ok(())
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

    /// The files of a living process stay.
    #[test]
    fn what_a_killed_process_left_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let left = folder.path().join(".gpt-a1b2c3.part");
        fs::write(&left, "half of a picture").unwrap();
        fs::write(folder.path().join(".gpt-notes"), "not a temporary file").unwrap();
        let living = AtomicFile::create(&folder.path().join("a.exr")).unwrap();
        remove_left_over(folder.path());
        assert!(!left.exists());
        AtomicFile::write(&folder.path().join("b.exr"), b"another").unwrap();
        living.handle().unwrap().write_all(b"a picture").unwrap();
        living.commit().unwrap();
        let mut left = entries(folder.path());
        left.sort();
        assert_eq!(left, [".gpt-notes", "a.exr", "b.exr"]);
    }

    /// A folder takes its name, or its folder is gone.
    #[test]
    fn what_has_no_place_any_more_is_kept_elsewhere() {
        let folder = tempfile::tempdir().unwrap();
        let below = folder.path().join("below");
        fs::create_dir(&below).unwrap();
        let written = |path: &Path| {
            let file = AtomicFile::create(path).unwrap();
            file.handle().unwrap().write_all(b"hours of work").unwrap();
            file
        };
        type Spoil = fn(&Path) -> io::Result<()>;
        let spoils: [(Spoil, bool); 2] =
            [(|path| fs::create_dir(path), true), (|path| fs::remove_dir_all(folder_of(path)), false)];
        for (name, (spoil, is_beside)) in ["a", "b"].into_iter().zip(spoils) {
            let path = below.join(name).with_extension("exr");
            let file = written(&path);
            spoil(&path).unwrap();
            let Err(OutputError::Kept { place, .. }) = file.commit_or_keep(&path) else { panic!("it is kept") };
            assert_eq!(fs::read(&place).unwrap(), b"hours of work");
            assert_eq!(place == below.join("a.kept.exr"), is_beside, "{}", place.display());
            fs::remove_file(place).unwrap();
        }
        // The control.
        let path = folder.path().join("a.exr");
        written(&path).commit_or_keep(&path).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"hours of work");
    }

    #[cfg(unix)]
    #[test]
    fn links_lead_to_the_file_that_is_meant() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("below")).unwrap();
        symlink("below/new.exr", at("dangling.exr")).unwrap();
        AtomicFile::write(&at("dangling.exr"), b"picture").unwrap();
        assert!(fs::symlink_metadata(at("dangling.exr")).unwrap().is_symlink());
        assert_eq!(fs::read(at("below/new.exr")).unwrap(), b"picture");

        symlink("nowhere/new.exr", at("lost.exr")).unwrap();
        assert!(matches!(AtomicFile::create(&at("lost.exr")), Err(OutputError::NoFolder { .. })));
        symlink("b.exr", at("a.exr")).unwrap();
        symlink("a.exr", at("b.exr")).unwrap();
        assert!(AtomicFile::create(&at("a.exr")).is_err());

        symlink("below", at("also-below")).unwrap();
        let one_file =
            ["below/x.exr", "also-below/x.exr", "also-below/../below/x.exr"].map(|name| follow_links(&at(name)).unwrap());
        assert!(one_file.iter().all(|path| *path == one_file[0]), "{one_file:?}");
        assert_ne!(one_file[0], follow_links(&at("x.exr")).unwrap());
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
