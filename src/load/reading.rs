//! How far reading a scene is, for whoever waits for it.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Meshes and pictures that scenes of this process are known to have, and how many of them were read.
static KNOWN: AtomicUsize = AtomicUsize::new(0);
static READ: AtomicUsize = AtomicUsize::new(0);

/// So many more files are about to be read.
pub fn expect(files: usize) {
    KNOWN.fetch_add(files, Ordering::Relaxed);
}

/// One of them was.
pub fn one_was_read() {
    READ.fetch_add(1, Ordering::Relaxed);
}

/// How many meshes and pictures were read, of how many that are known so far, by all scenes of this process.
pub fn files_read() -> [usize; 2] {
    [READ.load(Ordering::Relaxed), KNOWN.load(Ordering::Relaxed)]
}
