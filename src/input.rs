//! Files that are read: regular ones, of bounded size.
//!
//! A pipe, a device or a socket may never end, or never begin. Each is refused before it is opened. A file whose file system is gone ends in an
//! error ([`crate::patience`]).

use std::collections::{BTreeMap, HashMap};
use std::fs::{self, File};
use std::io::{self, BufRead, ErrorKind, Read, Seek};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use crate::file_identity::FileIdentity;
use crate::patience::{self, PatientFile};

/// A regular file that is being read.
pub type InputFile = PatientFile<File>;

/// What is read from any place in it.
pub trait Seekable: BufRead + Seek {}

impl<T: BufRead + Seek> Seekable for T {}

/// A file or what stands for one. Decoders of pictures are large, and compiled for each type that they read from: this is the one.
pub type AnyFile = Box<dyn Seekable + Send>;

/// Opens a regular file, which from now on is one that the program must not write.
///
/// # Errors
/// As [`File::open`], where the path leads to anything else, which the error names, and where its file system does not answer.
pub fn open(path: &Path) -> io::Result<InputFile> {
    let before = stamp_now(path);
    match open_own(path) {
        Ok(file) => {
            remember(path, before.or(Some(Stamp::default())));
            Ok(file)
        }
        Err(error) => {
            if error.kind() == ErrorKind::NotFound {
                remember(path, None);
            }
            Err(error)
        }
    }
}

/// Opens a regular file that the program may write as well.
///
/// # Errors
/// As [`open`].
pub fn open_own(path: &Path) -> io::Result<InputFile> {
    let path = path.to_owned();
    let (file, length) = patience::within(move || {
        let kind = fs::metadata(&path)?.file_type();
        if !kind.is_file() {
            return Err(io::Error::new(ErrorKind::InvalidInput, format!("it is {}, not a regular file", name(kind))));
        }
        let file = File::open(&path)?;
        let length = file.metadata()?.len();
        Ok((file, length))
    })?;
    Ok(PatientFile::new(file, length))
}

/// As [`open_own`], for a decoder.
///
/// # Errors
/// As [`open`].
pub fn open_to_decode(path: &Path) -> io::Result<AnyFile> {
    Ok(Box::new(open_own(path)?))
}

/// Whether there is a regular file. One whose file system does not answer counts: whoever opens it learns why it cannot be read.
pub fn is_file(path: &Path) -> bool {
    let path = path.to_owned();
    patience::within(move || Ok(path.is_file())).unwrap_or(true)
}

/// Whether there is anything of this name; as [`is_file`].
pub fn exists(path: &Path) -> bool {
    let path = path.to_owned();
    patience::within(move || Ok(path.exists())).unwrap_or(true)
}

/// The path with links followed.
///
/// # Errors
/// As [`fs::canonicalize`], and where its file system does not answer.
pub fn canonical(path: &Path) -> io::Result<PathBuf> {
    let path = path.to_owned();
    patience::within(move || fs::canonicalize(path))
}

/// What tells one content of a file from another: when it was written, its length, and on Unix which file it is.
type Stamp = (Option<SystemTime>, u64, u64);

fn stamp(metadata: &fs::Metadata) -> Stamp {
    #[cfg(unix)]
    let file = std::os::unix::fs::MetadataExt::ino(metadata);
    #[cfg(not(unix))]
    let file = 0;
    (metadata.modified().ok(), metadata.len(), file)
}

/// Of a file that is there.
fn stamp_now(path: &Path) -> Option<Stamp> {
    let path = path.to_owned();
    patience::within(move || fs::metadata(path)).ok().map(|metadata| stamp(&metadata))
}

/// Files that were opened so far, links followed, each as it was then. What a program reads it must not write. Of those that were not there, None.
static OPENED: Mutex<BTreeMap<PathBuf, Option<Stamp>>> = Mutex::new(BTreeMap::new());

fn opened() -> MutexGuard<'static, BTreeMap<PathBuf, Option<Stamp>>> {
    OPENED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The names by which files were opened.
static NAMES: LazyLock<Mutex<HashMap<FileIdentity, PathBuf>>> = LazyLock::new(Mutex::default);

fn names() -> MutexGuard<'static, HashMap<FileIdentity, PathBuf>> {
    NAMES.lock().unwrap_or_else(PoisonError::into_inner)
}

fn remember(path: &Path, stamp: Option<Stamp>) {
    // What is not there has no real path; it has one once it is.
    if let Ok(real) = canonical(path).or_else(|_| std::path::absolute(path)) {
        if stamp.is_some() {
            names().insert(FileIdentity::of(&real), real.clone());
        }
        opened().insert(real, stamp);
    }
}

/// Whether this file was opened by [`open`], by whatever name.
pub fn was_opened(path: &Path) -> bool {
    let Ok(real) = canonical(path) else { return false };
    if matches!(opened().get(&real), Some(Some(_))) {
        return true;
    }
    // A hard link. The system gives numbers of files that are gone to new ones.
    let identity = FileIdentity::of(&real);
    let other = names().get(&identity).cloned();
    other.is_some_and(|other| FileIdentity::of(&other) == identity)
}

/// True once files that were read are kept from being written.
static IS_PROTECTING: AtomicBool = AtomicBool::new(false);

/// From now on, no file is written that was read: for a program that does one thing and ends. A library's process reads what it wrote, and writes it
/// again.
pub fn protect_inputs() {
    IS_PROTECTING.store(true, Ordering::Relaxed);
}

/// True where this file must not be written.
pub fn is_protected(path: &Path) -> bool {
    IS_PROTECTING.load(Ordering::Relaxed) && was_opened(path)
}

/// Reads a file that may be written again, such as a picture that the program made. One that was read before as anything else is not.
pub fn as_own<T>(path: &Path, read: impl FnOnce() -> T) -> T {
    let was_an_input = was_opened(path);
    let done = read();
    if !was_an_input && let Ok(real) = canonical(path).or_else(|_| std::path::absolute(path)) {
        names().remove(&FileIdentity::of(&real));
        opened().remove(&real);
    }
    done
}

/// Files that are not what they were when they were opened, or when they were last [accepted](accept_changes). None where their file system does
/// not answer.
pub fn changed() -> Vec<PathBuf> {
    let files = opened().clone();
    let now = |path: &Path| fs::metadata(path).ok().map(|metadata| stamp(&metadata));
    let look = move || Ok(files.into_iter().filter(|(path, before)| now(path) != *before).map(|(path, _)| path).collect());
    patience::within(look).unwrap_or_default()
}

/// Takes all files for what they are now.
pub fn accept_changes() {
    let files = opened().clone();
    for (path, before) in files {
        // A file that was read stays one that must not be written, though it may be gone for a moment. Whatever was missing and is still wanted
        // will be looked for again.
        match before {
            Some(_) => opened().insert(path.clone(), Some(stamp_now(&path).unwrap_or_default())),
            None => opened().remove(&path),
        };
    }
}

/// Reads a regular file of at most `most` bytes.
///
/// # Errors
/// As [`open`], for a larger file, and where memory does not suffice.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    let length = file.length();
    if length > most {
        return Err(too_large(most));
    }
    read_to_end(file, length, most)
}

/// Reads what is left of a stream, at most `most` bytes; `expected` of them, as far as that is known.
///
/// # Errors
/// As [`read`].
pub fn read_to_end(stream: impl Read, expected: u64, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(usize::try_from(expected).unwrap_or(usize::MAX)).map_err(|_| ErrorKind::OutOfMemory)?;
    // Files of the kernel state no length, and others grow while they are read.
    stream.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(too_large(most)) } else { Ok(bytes) }
}

fn too_large(most: u64) -> io::Error {
    io::Error::new(ErrorKind::FileTooLarge, format!("it is larger than the {} MiB that are read of such a file", most >> 20))
}

#[cfg(unix)]
fn name(kind: fs::FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt as _;
    match kind {
        _ if kind.is_dir() => "a folder",
        _ if kind.is_fifo() => "a pipe",
        _ if kind.is_socket() => "a socket",
        _ => "a device",
    }
}

#[cfg(not(unix))]
fn name(kind: fs::FileType) -> &'static str {
    if kind.is_dir() { "a folder" } else { "a device" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regular_files_are_read_up_to_a_size() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        fs::write(&path, [7; 100]).unwrap();
        assert_eq!(read(&path, 100).unwrap(), [7; 100]);
        assert_eq!(read(&path, 99).unwrap_err().kind(), ErrorKind::FileTooLarge);
        assert_eq!(read_to_end(io::repeat(1), 0, 1 << 20).unwrap_err().kind(), ErrorKind::FileTooLarge);
        assert_eq!(read(folder.path(), 100).unwrap_err().to_string(), "it is a folder, not a regular file");
        assert_eq!(read(&folder.path().join("absent"), 100).unwrap_err().kind(), ErrorKind::NotFound);
    }

    #[test]
    fn files_that_change_are_noticed_once() {
        let folder = tempfile::tempdir().unwrap();
        let [path, missing] = ["file", "missing"].map(|name| fs::canonicalize(folder.path()).unwrap().join(name));
        let seen = |path: &Path| changed().iter().any(|changed| changed == path);
        fs::write(&path, "one").unwrap();
        assert!(read(&path, 100).is_ok() && read(&missing, 100).is_err());
        assert!(!seen(&path) && !seen(&missing));
        fs::write(&path, "three").unwrap();
        fs::write(&missing, "here").unwrap();
        assert!(seen(&path) && seen(&missing));
        assert!(was_opened(&path) && !was_opened(&missing));
        accept_changes();
        assert!(!seen(&path) && !seen(&missing) && was_opened(&path));
        fs::remove_file(&path).unwrap();
        assert!(seen(&path));
        accept_changes();
        // It is written anew; until then there is nothing to see.
        fs::write(&path, "four").unwrap();
        assert!(seen(&path) && was_opened(&path));
    }

    #[cfg(unix)]
    #[test]
    fn inputs_are_known_by_all_of_their_names() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("read"), "one").unwrap();
        fs::hard_link(at("read"), at("hard")).unwrap();
        std::os::unix::fs::symlink("read", at("soft")).unwrap();
        fs::write(at("other"), "one").unwrap();
        assert!(!was_opened(&at("read")));
        as_own(&at("read"), || read(&at("read"), 100)).unwrap();
        assert!(!was_opened(&at("read")) && !was_opened(&at("hard")));
        read(&at("read"), 100).unwrap();
        as_own(&at("read"), || read(&at("read"), 100)).unwrap();
        assert!(["read", "hard", "soft"].iter().all(|name| was_opened(&at(name))) && !was_opened(&at("other")));
        // An editor puts a new file in its place, and another file may get the old one's number.
        fs::rename(at("other"), at("read")).unwrap();
        assert!(was_opened(&at("read")) && !was_opened(&at("hard")));
    }

    #[cfg(unix)]
    #[test]
    fn what_never_ends_or_never_begins_is_refused() {
        assert_eq!(open(Path::new("/dev/zero")).unwrap_err().to_string(), "it is a device, not a regular file");
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        assert_eq!(open(&pipe).unwrap_err().to_string(), "it is a pipe, not a regular file");
    }
}
