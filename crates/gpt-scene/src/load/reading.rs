//! How far reading a scene is, for whoever waits for it.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How many of a scene's files were read. Clones count together.
#[derive(Debug, Clone, Default)]
pub struct ReadingProgress(Arc<Counts>);

/// Meshes and pictures that a scene is known to have, and how many of them were read.
#[derive(Debug, Default)]
struct Counts {
    known: AtomicUsize,
    read: AtomicUsize,
}

impl ReadingProgress {
    /// So many more files are about to be read.
    pub(super) fn expect(&self, files: usize) {
        self.0.known.fetch_add(files, Ordering::Relaxed);
    }

    /// One of them was.
    pub(super) fn one_was_read(&self) {
        self.0.read.fetch_add(1, Ordering::Relaxed);
    }

    /// How many meshes and pictures were read, of how many that are known so far.
    pub fn files(&self) -> [usize; 2] {
        [self.0.read.load(Ordering::Relaxed), self.0.known.load(Ordering::Relaxed)]
    }
}

#[cfg(test)]
mod tests {
    use crate::load::{LoadOptions, load_with};

    #[test]
    fn the_files_of_one_scene_are_counted() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for name in ["a.png", "b.png"] {
            image::RgbImage::new(1, 1).save(folder.path().join(name)).expect("a picture");
        }
        let texture = |name: &str| format!("[[texture]]\nname = \"{name}\"\ntype = \"image\"\nfile = \"{name}.png\"\n");
        let camera = "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 40\n";
        let light = "[[light]]\ntype = \"environment\"\nradiance = 1\n";
        let text = format!("{camera}{}{}{light}", texture("a"), texture("b"));
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, text).expect("the scene file");
        let [options, others] = [(); 2].map(|()| LoadOptions::default());
        load_with(Some(path.as_os_str()), &options).expect("it is a scene");
        assert_eq!((options.progress.files(), others.progress.files()), ([2, 2], [0, 0]));
    }
}
