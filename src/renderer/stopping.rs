//! When a render ends before its last sample.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

use super::observer::Observer;

/// Iterations and steps are planned to end within this share of the time that is left.
pub const CAUTION: f64 = 0.95;
/// A render that was asked to stop goes on for so long, if some pixels have no sample yet.
const PATIENCE: Duration = Duration::from_secs(5);
/// An iteration that was expected to end in time goes on for so long after it.
const LATENESS: Duration = Duration::from_millis(500);
/// Paths that still run on so long after the end was due are given up.
const LONGEST_PATH: Duration = Duration::from_secs(1);

/// Why a render ended early.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// The observer asked for it.
    Interrupted,
    /// The time was up.
    OutOfTime,
}

/// The conditions that a renderer checks between two pieces of its work.
pub struct Stopping<'a> {
    observer: &'a dyn Observer,
    deadline: Option<Instant>,
    /// When the observer was first seen to ask for the end.
    asked: OnceLock<Instant>,
}

impl<'a> Stopping<'a> {
    pub fn new(observer: &'a dyn Observer, deadline: Option<Instant>) -> Self {
        Self { observer, deadline, asked: OnceLock::new() }
    }

    /// The reason to end after a pass, if there is one. `is_whole` says that every pixel has its first
    /// sample. The observer waits a little for that, unless it wants no picture any more; a time limit waits as long as it takes.
    pub fn after_pass(&self, is_whole: bool) -> Option<Ending> {
        match self.asked_since() {
            Some(since) if is_whole || since > PATIENCE || self.observer.is_abandoned() => return Some(Ending::Interrupted),
            _ => {}
        }
        self.late_by(LATENESS).filter(|late| *late && is_whole).map(|_| Ending::OutOfTime)
    }

    /// The reason to end after a band whose samples are done, or after a batch, where nobody waits for the
    /// rest.
    pub fn between_bands(&self) -> Option<Ending> {
        self.asked_since().map(|_| Ending::Interrupted)
    }

    /// The reason to give up paths that do not end, if there is one.
    pub fn gives_up_paths(&self) -> Option<Ending> {
        if self.asked_since().is_some_and(|since| since > LONGEST_PATH || self.observer.is_abandoned()) {
            return Some(Ending::Interrupted);
        }
        self.late_by(LONGEST_PATH).filter(|late| *late).map(|_| Ending::OutOfTime)
    }

    /// Time until the deadline; None where there is none.
    pub fn time_left(&self) -> Option<Duration> {
        self.deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()))
    }

    fn asked_since(&self) -> Option<Duration> {
        self.observer.stop_requested().then(|| self.asked.get_or_init(Instant::now).elapsed())
    }

    fn late_by(&self, tolerance: Duration) -> Option<bool> {
        self.deadline.map(|deadline| deadline.elapsed() > tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::renderer::Silent;

    struct Stop {
        is_abandoned: bool,
    }

    impl Observer for Stop {
        fn progress(&self, _done: u64, _total: u64) {}
        fn stop_requested(&self) -> bool {
            true
        }
        fn is_abandoned(&self) -> bool {
            self.is_abandoned
        }
    }

    #[test]
    fn an_observer_that_wants_no_picture_waits_for_nothing() {
        let stopping = Stopping::new(&Stop { is_abandoned: true }, None);
        assert_eq!(stopping.after_pass(false), Some(Ending::Interrupted));
        assert_eq!(stopping.gives_up_paths(), Some(Ending::Interrupted));
    }

    #[test]
    fn an_observer_that_asks_waits_for_the_first_samples_only() {
        let stopping = Stopping::new(&Stop { is_abandoned: false }, None);
        assert_eq!(stopping.after_pass(true), Some(Ending::Interrupted));
        assert_eq!((stopping.after_pass(false), stopping.gives_up_paths()), (None, None));
        std::thread::sleep(LONGEST_PATH + Duration::from_millis(50));
        assert_eq!((stopping.after_pass(false), stopping.gives_up_paths()), (None, Some(Ending::Interrupted)));
        let silent = Stopping::new(&Silent, None);
        assert_eq!((silent.after_pass(true), silent.gives_up_paths(), silent.time_left()), (None, None, None));
    }

    #[test]
    fn a_deadline_is_kept_to_a_little() {
        let past = Instant::now().checked_sub(Duration::from_secs(60)).expect("the clock runs longer than a minute");
        let stopping = Stopping::new(&Silent, Some(past));
        assert_eq!(stopping.after_pass(true), Some(Ending::OutOfTime));
        assert_eq!((stopping.after_pass(false), stopping.gives_up_paths()), (None, Some(Ending::OutOfTime)));
        assert_eq!(stopping.time_left(), Some(Duration::ZERO));
        let just_now = Stopping::new(&Silent, Some(Instant::now()));
        assert_eq!((just_now.after_pass(true), just_now.gives_up_paths()), (None, None));
    }
}
