//! Whoever watches a render.

/// Is told how far a render is, and says whether it should go on. Called from the rendering thread, several times a second.
pub trait Observer: Sync {
    /// `done` of `total` samples (pixels × spp) are finished.
    fn progress(&self, done: u64, total: u64);
    /// True: stop soon, deliver what is done.
    fn stop_requested(&self) -> bool;
}

/// An observer that shows nothing and never stops.
pub struct Silent;

impl Observer for Silent {
    fn progress(&self, _done: u64, _total: u64) {}
    fn stop_requested(&self) -> bool {
        false
    }
}
