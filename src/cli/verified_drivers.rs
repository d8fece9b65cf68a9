//! Which devices `gpt verify --traversal ray-query` passed on, kept in the user's folder for caches.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use gpt::plan::VerifiedDrivers;
use serde::{Deserialize, Serialize};

/// A device with the version of its driver, as the program of this version found it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Entry {
    device: String,
    gpt: String,
}

impl Entry {
    /// For this version of the program, whose kernels are not those of another.
    fn of(device: &str) -> Self {
        Self { device: device.to_owned(), gpt: env!("CARGO_PKG_VERSION").to_owned() }
    }
}

/// The file; None where the system has no folder for caches.
pub fn file() -> Option<PathBuf> {
    Some(dirs::cache_dir()?.join("gpt").join("ray-queries.json"))
}

/// The drivers that were verified by this version of the program; none if the file is missing or cannot be
/// read.
pub fn known() -> VerifiedDrivers {
    let entries = file().map(|path| read(&path)).unwrap_or_default();
    VerifiedDrivers::new(entries.into_iter().filter(|entry| *entry == Entry::of(&entry.device)).map(|entry| entry.device))
}

/// Adds a device that passed, or takes out one that did not. Says whether that is a change.
///
/// # Errors
/// Errors of the file system.
pub fn keep(path: &Path, device: &str, passed: bool) -> io::Result<bool> {
    let mut entries = read(path);
    let entry = Entry::of(device);
    let before = entries.clone();
    entries.retain(|kept| *kept != entry);
    if passed {
        entries.push(entry);
    }
    if entries == before {
        return Ok(false);
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    std::fs::create_dir_all(folder)?;
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    serde_json::to_writer_pretty(&mut file, &entries)?;
    file.write_all(b"\n")?;
    file.persist(path)?;
    Ok(true)
}

/// A damaged file counts as an empty one: ray queries then have to be asked for again.
fn read(path: &Path) -> Vec<Entry> {
    std::fs::read(path).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_are_kept_once_and_taken_out_again() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("new").join("ray-queries.json");
        let devices = || read(&path).into_iter().map(|entry| entry.device).collect::<Vec<_>>();
        assert!(!keep(&path, "a", false).expect("nothing to write") && !path.exists());
        assert!(keep(&path, "a", true).expect("written") && keep(&path, "b", true).expect("written"));
        assert!(!keep(&path, "b", true).expect("nothing to write"));
        assert_eq!(devices(), ["a", "b"]);
        assert!(keep(&path, "a", false).expect("written"));
        assert_eq!(devices(), ["b"]);
        std::fs::write(&path, "[{\"device\": ").expect("a file");
        assert!(devices().is_empty() && keep(&path, "c", true).expect("written"));
        assert_eq!(devices(), ["c"]);
    }
}
