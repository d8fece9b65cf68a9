//! The line that a person sees while a large scene is read.

use std::io::{self, IsTerminal};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use gpt::load::ReadingProgress;
use indicatif::{ProgressBar, ProgressStyle};

/// Nothing is shown of a scene that is read faster than this.
const PATIENCE: Duration = Duration::from_millis(400);
/// Time between two looks.
const TICK: Duration = Duration::from_millis(120);

/// Reads something that tells `progress` how far it is, and shows that on a terminal where it takes long.
pub fn shown<T>(quiet: bool, progress: &ReadingProgress, read: impl FnOnce() -> T) -> T {
    if quiet || !io::stderr().is_terminal() {
        return read();
    }
    thread::scope(|scope| {
        // Dropped as this returns, which ends the other thread.
        let (_reading, ended) = channel::<()>();
        let watch = move || {
            let mut bar = None;
            let mut wait = PATIENCE;
            while ended.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
                wait = TICK;
                let [read, known] = progress.files().map(|files| files as u64);
                show(bar.get_or_insert_with(ProgressBar::no_length), read, known);
            }
            bar.iter().for_each(ProgressBar::finish_and_clear);
        };
        // Without a thread to watch in, nothing is shown.
        let _ = thread::Builder::new().spawn_scoped(scope, watch);
        read()
    })
}

/// A bar over the files, where it is known how many there are.
fn show(bar: &ProgressBar, read: u64, known: u64) {
    let template = if known > 1 { "reading the scene [{bar:30}] {pos} of {len} files" } else { "{spinner} reading the scene" };
    // The templates are right.
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    if known > 1 {
        bar.set_length(known);
        bar.set_position(read);
    }
    bar.tick();
}
