//! Renders that Python waits for: Ctrl-C ends them, and a function is told how far they are.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

/// Time between two looks at Python's signals.
pub const INTERVAL: Duration = Duration::from_millis(100);
/// As much as the first thread of a program has.
pub const STACK_BYTES: usize = 8 << 20;

/// What a render and who waits for it know of each other.
#[derive(Default)]
pub struct Watcher {
    ends: AtomicBool,
    is_abandoned: AtomicBool,
    is_waited_for: AtomicBool,
    done: AtomicU64,
    total: AtomicU64,
}

impl gpt::Observer for Watcher {
    fn progress(&self, done: u64, total: u64) {
        self.done.store(done, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
    }

    fn stop_requested(&self) -> bool {
        self.ends.load(Ordering::Relaxed)
    }

    fn is_abandoned(&self) -> bool {
        self.is_abandoned.load(Ordering::Relaxed)
    }
}

impl Watcher {
    /// Ends the render, whose picture nobody wants.
    pub fn abandon(&self) {
        self.is_abandoned.store(true, Ordering::Relaxed);
        self.ends.store(true, Ordering::Relaxed);
    }

    /// Says whether somebody waits for a picture.
    pub fn wait_for(&self, waits: bool) {
        self.is_waited_for.store(waits, Ordering::Relaxed);
    }

    pub fn is_waited_for(&self) -> bool {
        self.is_waited_for.load(Ordering::Relaxed)
    }

    /// Tells Python how far the render is.
    pub fn tell(&self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        let (done, total) = (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed));
        match progress {
            // It may have begun anew between the two.
            Some(function) if total > 0 && done <= total => function.call1(py, (done, total)).map(drop),
            _ => Ok(()),
        }
    }
}

/// Renders in a thread of its own and without Python's lock, so that signals and other threads of Python are seen to meanwhile.
///
/// # Errors
/// What Python raised: the exception of a signal, or what `progress` raised. Either ends the render.
pub fn watched<T: Send>(py: Python<'_>, progress: Option<&Py<PyAny>>, render: impl FnOnce(&Watcher) -> T + Send) -> PyResult<T> {
    let watcher = &Watcher::default();
    let look = || {
        Python::attach(|py| {
            py.check_signals()?;
            watcher.tell(py, progress)
        })
    };
    let waiting = || {
        thread::scope(|scope| {
            let (ended, end) = mpsc::channel::<()>();
            let rendering = move || {
                let outcome = render(watcher);
                drop(ended);
                outcome
            };
            let worker =
                thread::Builder::new().name("render".to_owned()).stack_size(STACK_BYTES).spawn_scoped(scope, rendering)?;
            let mut raised = None;
            while end.recv_timeout(INTERVAL) == Err(RecvTimeoutError::Timeout) {
                if raised.is_none() {
                    raised = look().err();
                    watcher.ends.store(raised.is_some(), Ordering::Relaxed);
                }
            }
            let outcome = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
            match raised {
                Some(raised) => Err(raised),
                None => look().map(|()| outcome),
            }
        })
    };
    py.detach(waiting)
}
