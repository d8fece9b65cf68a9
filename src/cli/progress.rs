//! How far a render is: a bar on a terminal, plain lines elsewhere.

use std::fmt::Write as _;
use std::io::{self, IsTerminal};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use gpt::renderer::Observer;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use super::{interrupt, terminal};

/// Time between two plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(5);

/// Shows progress and passes on the wish to stop.
pub enum Progress {
    Hidden,
    Bar(ProgressBar),
    Lines(Mutex<Lines>),
}

/// What plain lines need to remember.
pub struct Lines {
    started: Instant,
    last: Instant,
}

impl Progress {
    /// A bar where stderr is a terminal, else lines; nothing if `quiet`.
    pub fn new(quiet: bool) -> Self {
        if quiet {
            return Self::Hidden;
        }
        if io::stderr().is_terminal() {
            return Self::Bar(ProgressBar::new(0).with_style(bar_style()));
        }
        let now = Instant::now();
        Self::Lines(Mutex::new(Lines { started: now, last: now }))
    }

    /// Takes the bar off the screen.
    pub fn clear(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

impl Observer for Progress {
    fn progress(&self, done: u64, total: u64) {
        match self {
            Self::Hidden => {}
            Self::Bar(bar) => {
                bar.set_length(total);
                bar.set_position(done);
            }
            Self::Lines(lines) => {
                let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
                if lines.last.elapsed() >= LINE_INTERVAL {
                    lines.last = Instant::now();
                    terminal::note(&line(done, total, lines.started.elapsed().as_secs_f64()));
                }
            }
        }
    }

    fn stop_requested(&self) -> bool {
        interrupt::requested()
    }
}

fn bar_style() -> ProgressStyle {
    let samples = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let [done, total] = [state.pos(), state.len().unwrap_or(0)].map(|count| terminal::with_unit(count as f64, ""));
        let _ = write!(out, "{done} of {total} samples");
    };
    let rate = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let _ = write!(out, "{}", terminal::with_unit(state.per_sec(), "sample/s"));
    };
    // The template is a constant; the fallback is only there because the compiler cannot read it.
    ProgressStyle::with_template("{percent:>3} % [{bar:30}] {samples}, {rate}, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("samples", samples)
        .with_key("rate", rate)
        .progress_chars("=> ")
}

fn line(done: u64, total: u64, seconds: f64) -> String {
    let [done, total] = [done as f64, total as f64];
    let rate = done / seconds.max(1e-9);
    let mut line = format!(
        "{:>3.0} %, {} of {} samples, {}",
        100.0 * done / total.max(1.0),
        terminal::with_unit(done, ""),
        terminal::with_unit(total, ""),
        terminal::with_unit(rate, "sample/s")
    );
    if rate > 0.0 {
        let _ = write!(line, ", {:.0} s left", (total - done) / rate);
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tells_share_speed_and_time_left() {
        assert_eq!(line(2_500_000, 10_000_000, 5.0), " 25 %, 2.50 M of 10.00 M samples, 500.00 ksample/s, 15 s left");
        assert_eq!(line(0, 100, 5.0), "  0 %, 0 of 100 samples, 0 sample/s");
    }
}
