//! Files beside a scene file, and how it names files.

use std::collections::HashMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::load::builtin::is_builtin;
use crate::load::toml_text::text;

/// Files that are to be written beside a scene file.
pub struct SideFiles {
    /// The folder of the scene file, with links followed where it exists.
    folder: PathBuf,
    /// The folder of the files, within that.
    subfolder: String,
    files: Vec<(PathBuf, Vec<u8>)>,
    /// The paths of pictures and grids relative to the scene file's folder, by their addresses.
    shared: HashMap<usize, String>,
}

impl SideFiles {
    pub fn beside(scene_file: &Path) -> Self {
        let folder = scene_file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let stem = scene_file.file_stem().unwrap_or_default().to_string_lossy();
        let folder = fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
        Self { folder, subfolder: format!("{stem}.files"), files: Vec::new(), shared: HashMap::new() }
    }

    /// Adds a file; how the scene file names it, in quotes.
    pub fn add(&mut self, name: &str, content: Vec<u8>) -> String {
        text(&self.add_file(name, content))
    }

    /// Adds a file; its path relative to the scene file's folder.
    pub fn add_file(&mut self, name: &str, content: Vec<u8>) -> String {
        let within = format!("{}/{name}", self.subfolder);
        self.files.push((self.folder.join(&within), content));
        within
    }

    /// Adds the picture at an address, once; how the scene file names it, in quotes.
    pub fn add_picture(&mut self, address: usize, ending: &str, content: impl FnOnce() -> Vec<u8>) -> String {
        self.add_once("picture", address, ending, content)
    }

    /// Adds what is at an address, once, under the name of its kind and a number; how the scene file names it, in quotes.
    pub fn add_once(&mut self, kind: &str, address: usize, ending: &str, content: impl FnOnce() -> Vec<u8>) -> String {
        text(&self.add_file_once(kind, address, ending, content))
    }

    /// Adds what is at an address, once; its path relative to the scene file's folder.
    pub fn add_file_once(&mut self, kind: &str, address: usize, ending: &str, content: impl FnOnce() -> Vec<u8>) -> String {
        if let Some(name) = self.shared.get(&address) {
            return name.clone();
        }
        let name = self.add_file(&format!("{kind}-{}.{ending}", self.len() + 1), content());
        self.shared.insert(address, name.clone());
        name
    }

    /// The folder of the scene file.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// True of a file that is to be written.
    pub fn contains(&self, path: &Path) -> bool {
        self.files.iter().any(|(file, _)| file == path)
    }

    /// How the scene file names a file that is there, in quotes: relative to its own folder.
    pub fn name_of(&self, path: &Path) -> String {
        text(&self.path_to(path).to_string_lossy())
    }

    /// The way to a file that is there, from the scene file's folder.
    pub fn path_to(&self, path: &Path) -> PathBuf {
        let absolute = fs::canonicalize(path).or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_owned());
        relative(&absolute, &self.folder)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// Their paths and contents.
    pub fn into_files(self) -> Vec<(PathBuf, Vec<u8>)> {
        self.files
    }
}

/// True where there is such a file for others to name. Files of built-in and of imported scenes may be in
/// memory alone.
pub fn is_on_disk(path: &Path) -> bool {
    !is_builtin(path) && path.is_file()
}

/// The way from a folder to a file; both are absolute. The file's own path where they have nothing in common, as on two drives.
fn relative(file: &Path, folder: &Path) -> PathBuf {
    let (file_parts, folder_parts): (Vec<Component>, Vec<Component>) =
        (file.components().collect(), folder.components().collect());
    let common = file_parts.iter().zip(&folder_parts).take_while(|(a, b)| a == b).count();
    if common == 0 {
        return file.to_owned();
    }
    let up = folder_parts[common..].iter().map(|_| Component::ParentDir);
    up.chain(file_parts[common..].iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_from_the_scene_files_folder() {
        let way = |file: &str, folder: &str| relative(Path::new(file), Path::new(folder));
        assert_eq!(way("/a/b/c.obj", "/a/b"), Path::new("c.obj"));
        assert_eq!(way("/a/m/c.obj", "/a/b/d"), Path::new("../../m/c.obj"));
    }
}
