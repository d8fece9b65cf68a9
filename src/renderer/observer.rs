//! Whoever watches a render.

use crate::confidence::IntervalEstimate;
use crate::film::Band;

/// Is told how far a render is, and says whether it should go on. Called from the rendering thread, several times a second.
///
/// ```no_run
/// struct Percent;
///
/// impl gpt::Observer for Percent {
///     fn progress(&self, done: u64, total: u64) {
///         eprintln!("{} %", 100 * done / total.max(1));
///     }
///
///     fn stop_requested(&self) -> bool {
///         false
///     }
/// }
///
/// let scene = gpt::Scene::load("cornell")?;
/// let image = gpt::Renderer::new(&scene, &gpt::RenderOptions::default())?.image(&Percent)?;
/// # Ok::<(), gpt::Error>(())
/// ```
pub trait Observer: Sync {
    /// `done` of `total` samples (pixels × spp) are finished.
    fn progress(&self, done: u64, total: u64);
    /// True: stop soon, deliver what is done.
    fn stop_requested(&self) -> bool;

    /// True where nobody wants the picture any more: a render that is asked to stop then stops at once, though pixels have no sample yet. Asked while
    /// paths are followed, so the answer must be quick.
    fn is_abandoned(&self) -> bool {
        false
    }

    /// True if [`Observer::rows_so_far`] shall be called now. Asked after each pass, so the answer must be
    /// quick.
    fn wants_rows(&self) -> bool {
        false
    }

    /// Rows as they are now; the render goes on with them when this returns. Pixels without samples are counted in [`Band::counts`].
    fn rows_so_far(&self, rows: Band) {
        drop(rows);
    }

    /// The relative mean squared error that the picture has now: what is expected, and that with a margin for chance. Known of renders
    /// with an error to reach.
    fn error_so_far(&self, expected: f64, upper: f64) {
        let _ = (expected, upper);
    }

    /// The intervals that the picture has now. Known of renders that state some.
    fn interval_so_far(&self, interval: &IntervalEstimate) {
        let _ = interval;
    }
}

/// An observer that shows nothing and never stops.
pub struct Silent;

impl Observer for Silent {
    fn progress(&self, _done: u64, _total: u64) {}
    fn stop_requested(&self) -> bool {
        false
    }
}
