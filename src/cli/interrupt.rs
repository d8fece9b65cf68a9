//! Ctrl-C: the first asks the render to stop and save, the second ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

use super::exit::{Exit, Failure};
use super::terminal;

static STOP: AtomicBool = AtomicBool::new(false);

/// Takes over SIGINT, SIGTERM and SIGHUP (or the platform's like).
///
/// # Errors
/// The system refused the handler.
pub fn install() -> Result<(), Failure> {
    ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::SeqCst) {
            gpt::output::remove_unfinished();
            std::process::exit(Exit::Interrupted as i32);
        }
        terminal::note("stopping; what is rendered will be saved (once more to quit at once)");
    })
    .map_err(|error| Failure::Other(format!("cannot watch for Ctrl-C: {error}")))
}

/// Whether the user asked to stop.
pub fn requested() -> bool {
    STOP.load(Ordering::SeqCst)
}
