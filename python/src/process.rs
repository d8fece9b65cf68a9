//! The process that this module works in.

use std::process::id;
use std::sync::atomic::{AtomicU32, Ordering};

use pyo3::prelude::*;

use crate::errors::Error;

/// The process in which the first work was done; 0: none was.
static FIRST: AtomicU32 = AtomicU32::new(0);

/// Refuses to work in a process that was forked from one that has worked: threads that it would wait for are not in it, and it would wait for ever.
///
/// # Errors
/// Another process worked before.
pub fn check() -> PyResult<()> {
    match FIRST.compare_exchange(0, id(), Ordering::SeqCst, Ordering::SeqCst) {
        Err(first) if first != id() => Err(Error::new_err(
            "this process was forked from one that had used gpt_pathtracer, whose threads are not in it; start it by \
             multiprocessing.get_context(\"spawn\"), or use gpt_pathtracer in the forked processes alone",
        )),
        _ => Ok(()),
    }
}
