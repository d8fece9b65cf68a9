//! How the files that a scene names are found and opened: on disk or in the program, perhaps within one folder only.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fs;
use std::io::{self, Cursor, ErrorKind};
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::builtin::embedded;
use super::error::{SceneError, show};
use super::reading::ReadingProgress;
use super::spelling::names::{folded, unquoted};
use crate::file_log::FileLog;
use crate::input::{self, AnyFile};

/// Most bytes of a scene file, where memory suffices.
pub const MOST_SCENE_BYTES: u64 = 1 << 29;
/// Most bytes of a model: some forty million triangles.
pub const MOST_MODEL_BYTES: u64 = 1 << 32;
/// Most bytes of a material library.
pub const MOST_LIBRARY_BYTES: u64 = 1 << 28;
/// Most bytes that are read for one scene, those of files that are read again counted again: for each byte of the files, and beside a first amount.
const MOST_READ: (u64, u64) = (64, 1 << 28);

/// Folders in which files may lie.
#[derive(Debug, Clone, Default)]
pub struct Files {
    /// With links followed; None: anywhere.
    root: Option<PathBuf>,
    progress: ReadingProgress,
    log: FileLog,
    account: Arc<Mutex<Account>>,
}

/// The bytes that were read so far for a scene, by all that have these files.
#[derive(Debug, Default)]
struct Account {
    /// Bytes of each file, and of all of them.
    files: HashMap<PathBuf, u64>,
    bytes: u64,
    /// Bytes that were read.
    read: u64,
}

impl Account {
    /// # Errors
    /// Files are read over and over.
    fn add(&mut self, path: &Path, bytes: u64) -> io::Result<()> {
        if self.files.insert(path.to_owned(), bytes).is_none() {
            self.bytes = self.bytes.saturating_add(bytes);
        }
        self.read = self.read.saturating_add(bytes);
        let (factor, first) = MOST_READ;
        if self.read <= self.bytes.saturating_mul(factor).saturating_add(first) {
            return Ok(());
        }
        let (read, there) = (self.read >> 20, self.bytes >> 20);
        Err(io::Error::other(format!(
            "the scene reads its files over and over: with this one it is {read} MiB, of files that have {there} MiB"
        )))
    }
}

/// A file that was looked for.
pub struct FoundFile {
    pub path: PathBuf,
    /// The file has another folder or another case than was written.
    pub is_substitute: bool,
}

impl Files {
    /// Files within a folder only, wherever links lead.
    ///
    /// # Errors
    /// A folder that is not there.
    pub fn within(root: &Path) -> Result<Self, SceneError> {
        let real = fs::canonicalize(root).and_then(|real| {
            if real.is_dir() { Ok(real) } else { Err(io::Error::new(ErrorKind::NotADirectory, "it is no folder")) }
        });
        match real {
            Ok(real) => Ok(Self { root: Some(real), ..Self::default() }),
            Err(error) => Err(SceneError::in_file(show(root), format!("cannot be the folder of all files: {error}"))),
        }
    }

    /// These files, with a report of how many are read.
    pub fn with_progress(self, progress: ReadingProgress) -> Self {
        Self { progress, ..self }
    }

    /// These files, with a log of those that are opened.
    pub fn with_log(self, log: FileLog) -> Self {
        Self { log, ..self }
    }

    /// The list of the files that were opened.
    pub fn log(&self) -> &FileLog {
        &self.log
    }

    /// Who is told how many are read.
    pub fn progress(&self) -> &ReadingProgress {
        &self.progress
    }

    /// True where anything has this name, on disk or in the program.
    pub fn exists(&self, path: &Path) -> bool {
        self.is_file(path) || path.exists()
    }

    /// True of such a regular file, on disk or in the program.
    pub fn is_file(&self, path: &Path) -> bool {
        embedded(path).is_some() || path.is_file()
    }

    /// Reads a file of at most `most` bytes.
    pub fn read(&self, path: &Path, most: u64) -> io::Result<Cow<'static, [u8]>> {
        match embedded(path) {
            Some(content) => Ok(Cow::Borrowed(content)),
            None => {
                let bytes = self.log.read(self.allowed(path)?, most)?;
                self.account().add(path, bytes.len() as u64)?;
                Ok(Cow::Owned(bytes))
            }
        }
    }

    pub fn open(&self, path: &Path) -> io::Result<AnyFile> {
        match embedded(path) {
            Some(content) => Ok(Box::new(Cursor::new(content))),
            None => {
                let file = self.log.open(self.allowed(path)?)?;
                self.account().add(path, input::length(&file)?)?;
                Ok(Box::new(file))
            }
        }
    }

    fn account(&self) -> MutexGuard<'_, Account> {
        // Its numbers are whole whoever panicked.
        self.account.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn allowed<'p>(&self, path: &'p Path) -> io::Result<&'p Path> {
        let Some(root) = &self.root else { return Ok(path) };
        if fs::canonicalize(path)?.starts_with(root) {
            return Ok(path);
        }
        let message = format!("it lies outside of {}, which --assets-root allows", show(root));
        Err(io::Error::new(ErrorKind::PermissionDenied, message))
    }

    /// Looks for a file that was written on another machine: as written, without quotes, with folders separated by backslashes, in other case or
    /// with accents taken apart, and by its name alone beside the file that names it.
    pub fn find(&self, folder: &Path, written: &str) -> Option<FoundFile> {
        if let Some(path) = self.find_exactly(folder, written) {
            return Some(FoundFile { path, is_substitute: false });
        }
        let slashed = slashed(written);
        let relative = Path::new(&slashed);
        let beside = relative.file_name().map(Path::new);
        let elsewhere = in_any_case(folder, relative).or_else(|| in_any_case(folder, beside?));
        elsewhere.filter(|path| path.is_file()).map(|path| FoundFile { path, is_substitute: true })
    }

    /// Looks for a file whose name is written as it is but for quotes and backslashes, which also escape blanks; this looks into no folder.
    pub fn find_exactly(&self, folder: &Path, written: &str) -> Option<PathBuf> {
        let escaped = || written.contains("\\ ").then(|| folder.join(written.replace("\\ ", " ")));
        let mut places = [Some(folder.join(written)), Some(folder.join(slashed(written))), escaped()].into_iter().flatten();
        places.find(|path| self.is_file(path))
    }
}

fn slashed(written: &str) -> String {
    unquoted(written).replace('\\', "/")
}

/// The path whose parts are named so but for upper and lower case, and for characters that are composed or taken apart.
fn in_any_case(folder: &Path, relative: &Path) -> Option<PathBuf> {
    let mut path = folder.to_owned();
    for part in relative.components() {
        let Component::Normal(name) = part else {
            path.push(part);
            continue;
        };
        let exact = path.join(name);
        if exact.exists() {
            path = exact;
            continue;
        }
        let wanted = folded(&name.to_string_lossy());
        let entries = fs::read_dir(if path.as_os_str().is_empty() { Path::new(".") } else { &path }).ok()?;
        let mut fitting: Vec<_> =
            entries.flatten().map(|entry| entry.file_name()).filter(|name| folded(&name.to_string_lossy()) == wanted).collect();
        // The order of a folder's entries is none.
        fitting.sort();
        path.push(fitting.first()?);
    }
    Some(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("Textures")).unwrap();
        for name in ["Textures/Wood.PNG", "stone.png", "Textures/stone.png"] {
            fs::write(folder.path().join(name), name).unwrap();
        }
        folder
    }

    #[test]
    fn files_are_found_in_other_case_and_by_their_name() {
        let folder = folder();
        let found = |written: &str| {
            let found = Files::default().find(folder.path(), written)?;
            let path = found.path.strip_prefix(folder.path()).unwrap().to_str()?.to_owned();
            Some((path, found.is_substitute))
        };
        let expect = |path: &str, is_substitute| Some((path.to_owned(), is_substitute));
        assert_eq!(found("stone.png"), expect("stone.png", false));
        assert_eq!(found("Textures\\stone.png"), expect("Textures/stone.png", false));
        assert_eq!(found("textures/wood.png"), expect("Textures/Wood.PNG", true));
        assert_eq!(found("C:\\Users\\me\\Stone.png"), expect("stone.png", true));
        assert_eq!(found("/absent/stone.png"), expect("stone.png", true));
        assert_eq!(found("\"stone.png\""), expect("stone.png", false));
        fs::write(folder.path().join("my wood.png"), "").unwrap();
        assert_eq!(found("my\\ wood.png"), expect("my wood.png", false));
        assert_eq!(found("absent.png"), None);
        assert_eq!(found(".."), None);
    }

    #[test]
    fn files_are_found_whose_accents_are_taken_apart() {
        for (on_disk, written) in [("Mo\u{308}bel.png", "Möbel.png"), ("Möbel.png", "Mo\u{308}bel.png")] {
            let folder = tempfile::tempdir().unwrap();
            fs::write(folder.path().join(on_disk), "").unwrap();
            // A file system may take both names for one.
            assert!(Files::default().find(folder.path(), written).is_some(), "{written}");
            assert!(Files::default().find(folder.path(), "Mobel.png").is_none(), "the control");
        }
    }

    #[test]
    fn nothing_outside_of_the_root_is_read() {
        let folder = folder();
        let files = Files::within(&folder.path().join("Textures")).unwrap();
        assert!(files.read(&folder.path().join("Textures/stone.png"), 100).is_ok());
        assert!(files.read(&folder.path().join("Textures/../Textures/stone.png"), 100).is_ok());
        let outside = [folder.path().join("stone.png"), folder.path().join("Textures/../stone.png"), "/etc/hostname".into()];
        for path in outside {
            let error = files.read(&path, 100).unwrap_err();
            assert!(error.to_string().contains("--assets-root"), "{}: {error}", path.display());
            assert!(files.open(&path).is_err());
        }
        assert!(Files::within(&folder.path().join("stone.png")).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_do_not_lead_out_of_the_root() {
        let folder = folder();
        let link = folder.path().join("Textures/link.png");
        std::os::unix::fs::symlink(folder.path().join("stone.png"), &link).unwrap();
        assert!(Files::default().read(&link, 100).is_ok());
        assert!(Files::within(&folder.path().join("Textures")).unwrap().read(&link, 100).is_err());
    }
}
