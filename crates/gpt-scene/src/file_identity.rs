//! Which file a path means, whatever it is called.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// Links that lead from one to the next, at most: as many as Linux follows.
const MOST_LINKS: usize = 40;

/// A file, by what it is and not by one of its names: two paths mean one file where these are equal.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FileIdentity {
    /// Device and number of a file that is there, so that hard links are one file, and names in other case where the file system knows none.
    Number(u64, u64),
    /// The place where it would stand, or stands on systems that number no files; links are followed.
    Place(PathBuf),
}

impl FileIdentity {
    /// The identity of the file to which a path leads, be it there or not.
    pub fn of(path: &Path) -> Self {
        if let Some(number) = fs::metadata(path).ok().and_then(|metadata| Self::number(&metadata)) {
            return number;
        }
        let place = follow_links(path).unwrap_or_else(|_| path.to_owned());
        // Names there differ by more than their case.
        let has_no_case = cfg!(any(windows, target_os = "macos"));
        Self::Place(if has_no_case { PathBuf::from(place.to_string_lossy().to_lowercase()) } else { place })
    }

    #[cfg(unix)]
    fn number(metadata: &fs::Metadata) -> Option<Self> {
        use std::os::unix::fs::MetadataExt as _;
        Some(Self::Number(metadata.dev(), metadata.ino()))
    }

    #[cfg(not(unix))]
    fn number(_metadata: &fs::Metadata) -> Option<Self> {
        None
    }
}

/// The file that is meant by a path, whether it exists or not: links are followed, the folder is the one that the system calls so. Two paths
/// that mean one file become equal.
///
/// # Errors
/// Links that lead in a circle.
pub fn follow_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(to) = fs::read_link(&path) else {
            let (folder, name) = (folder_of(&path), path.file_name());
            // A folder that is missing is reported by who looks for it.
            return Ok(match (fs::canonicalize(folder), name) {
                (Ok(folder), Some(name)) => folder.join(name),
                _ => fs::canonicalize(&path).unwrap_or(path),
            });
        };
        path = folder_of(&path).join(to);
    }
    Err(io::Error::other(format!("{} leads through too many links", path.display())))
}

/// The folder that a path's last name stands in.
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_file_is_one_by_all_of_its_names() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let of = |name: &str| FileIdentity::of(&at(name));
        fs::create_dir(at("below")).unwrap();
        fs::write(at("a"), "a").unwrap();
        fs::write(at("b"), "a").unwrap();
        assert_eq!(of("a"), of("below/../a"));
        assert_ne!(of("a"), of("b"));
        // A file that is not there yet.
        assert_eq!(of("new"), of("./below/../new"));
        assert_ne!(of("new"), of("newer"));
        #[cfg(unix)]
        {
            fs::hard_link(at("a"), at("hard")).unwrap();
            std::os::unix::fs::symlink("a", at("soft")).unwrap();
            std::os::unix::fs::symlink("new", at("dangling")).unwrap();
            assert!(of("hard") == of("a") && of("soft") == of("a") && of("dangling") == of("new"));
        }
    }
}
