//! A render that Python watches: Ctrl-C ends it, and a function is told how far it is.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// Time between two looks at Python's signals.
const INTERVAL: Duration = Duration::from_millis(100);

/// Tells Python of a render, and the render of Python.
pub struct Watcher {
    progress: Option<Py<PyAny>>,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    looked: Option<Instant>,
    /// What Python raised; the render ends.
    raised: Option<PyErr>,
    done: u64,
    total: u64,
}

impl Watcher {
    pub fn new(progress: Option<Py<PyAny>>) -> Self {
        Self { progress, state: Mutex::default() }
    }

    /// What Python raised meanwhile.
    ///
    /// # Errors
    /// That.
    pub fn result(self) -> PyResult<()> {
        let state = self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        state.raised.map_or(Ok(()), Err)
    }
}

impl gpt::Observer for Watcher {
    fn progress(&self, done: u64, total: u64) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        (state.done, state.total) = (done, total);
    }

    fn stop_requested(&self) -> bool {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.raised.is_some() || state.looked.is_some_and(|looked| looked.elapsed() < INTERVAL) {
            return state.raised.is_some();
        }
        let (done, total) = (state.done, state.total);
        // What comes first is told at once.
        state.looked = (total > 0).then(Instant::now);
        drop(state);
        let outcome = Python::attach(|py| {
            py.check_signals()?;
            match &self.progress {
                Some(function) if total > 0 => function.call1(py, (done, total)).map(drop),
                _ => Ok(()),
            }
        });
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.looked = (total > 0).then(Instant::now);
        state.raised = outcome.err();
        state.raised.is_some()
    }
}
