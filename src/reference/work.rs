//! Counted work of paths: what they take, whatever the machine.
//!
//! Before the first sample, trial runs and training trace paths whose number is fixed. What one of them takes is not: where thousands of surfaces lie in
//! one place, a ray meets them all. So work is counted, in tests of nodes and primitives and what takes as long, and what would take too much is
//! done with fewer paths, or not at all ([`crate::learn::work_of_path`]). Counts are those of the reference, so every device and every machine decides alike.

use std::cell::Cell;

/// Work of about a second on one core, in tests.
pub const SECOND: u64 = 1 << 26;
/// A surface that lets light through is looked at, not only tested.
pub const TRANSLUCENT_SURFACE: u64 = 16;
/// A part of a blend, or one of several lobes.
pub const PART: u64 = 8;
/// An event on a way through a stack of layers.
pub const LAYER_EVENT: u64 = 32;
thread_local! {
    static DONE: Cell<u64> = const { Cell::new(0) };
}

/// Counts work that this thread does.
#[inline]
pub fn add(work: u64) {
    DONE.with(|done| done.set(done.get().wrapping_add(work)));
}

/// The count of this thread so far, which begins again where a word has no more room: differences count.
pub fn so_far() -> u64 {
    DONE.with(Cell::get)
}

/// The result of a piece of work on this thread, and its count.
pub fn of<T>(piece: impl FnOnce() -> T) -> (T, u64) {
    let before = so_far();
    let done = piece();
    (done, so_far().wrapping_sub(before))
}
