//! Progress for other programs, line by line on standard output.

use std::io::Write;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use serde::Serialize;

/// Time between two lines.
const INTERVAL: Duration = Duration::from_secs(1);

/// How progress is told on standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ProgressFormat {
    /// A line of words with a percentage
    Plain,
    /// JSON objects: `event` is `start`, `progress` or `end`
    Json,
    /// As Open Job Description has it: `openjd_progress: 42.0`
    Openjd,
}

/// What a render needs, told before it takes it; in bytes.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Needs {
    /// Width and height of the picture in pixels.
    pub width: u32,
    pub height: u32,
    /// The film on the device, and what the host holds of it at a time.
    pub film_bytes: u64,
}

#[derive(Serialize)]
#[serde(tag = "event", rename_all = "lowercase")]
enum Event<'a> {
    Start {
        #[serde(flatten)]
        needs: Needs,
    },
    Progress {
        percent: f64,
        done: u64,
        total: u64,
        seconds_left: Option<f64>,
    },
    End {
        complete: bool,
        outputs: &'a [String],
    },
}

/// Tells of progress once a second, and at the end.
#[derive(Debug)]
pub struct MachineProgress {
    format: ProgressFormat,
    last: Option<Instant>,
}

impl MachineProgress {
    pub fn new(format: ProgressFormat) -> Self {
        Self { format, last: None }
    }

    /// The render is about to begin.
    pub fn start(&self, needs: Needs) {
        let film = needs.film_bytes as f64 / f64::from(1 << 20);
        self.say(&Event::Start { needs }, || match self.format {
            ProgressFormat::Openjd => format!("openjd_status: preparing, {film:.1} MiB for the film"),
            _ => format!("preparing {}x{} pixels, {film:.1} MiB for the film", needs.width, needs.height),
        });
    }

    /// `done` of `total` samples are finished.
    pub fn progress(&mut self, done: u64, total: u64, rate: Option<f64>) {
        if self.last.is_some_and(|last| last.elapsed() < INTERVAL) && done < total {
            return;
        }
        self.last = Some(Instant::now());
        let percent = 100.0 * done as f64 / (total as f64).max(1.0);
        let seconds_left = rate.map(|rate| total.saturating_sub(done) as f64 / rate);
        self.say(&Event::Progress { percent, done, total, seconds_left }, || match self.format {
            ProgressFormat::Openjd => format!("openjd_progress: {percent:.1}"),
            _ => format!("{percent:.1} %, {done} of {total} samples"),
        });
    }

    /// The render is over.
    pub fn end(&self, complete: bool, outputs: &[String]) {
        self.say(&Event::End { complete, outputs }, || match (self.format, complete) {
            (ProgressFormat::Openjd, true) => "openjd_progress: 100.0\nopenjd_status: done".to_owned(),
            (ProgressFormat::Openjd, false) => "openjd_status: broke off".to_owned(),
            (_, true) => format!("done: {}", outputs.join(", ")),
            (_, false) => format!("broke off: {}", outputs.join(", ")),
        });
    }

    /// A reader that is gone needs no lines.
    fn say(&self, event: &Event<'_>, words: impl FnOnce() -> String) {
        let line = match self.format {
            ProgressFormat::Json => serde_json::to_string(event).unwrap_or_default(),
            _ => words(),
        };
        let mut stdout = std::io::stdout().lock();
        let _ = writeln!(stdout, "{line}").and_then(|()| stdout.flush());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_keep_their_keys() {
        let json = |event: &Event<'_>| serde_json::to_string(event).expect("JSON");
        let needs = Needs { width: 4, height: 3, film_bytes: 384 };
        assert_eq!(json(&Event::Start { needs }), r#"{"event":"start","width":4,"height":3,"film_bytes":384}"#);
        let progress = Event::Progress { percent: 25.0, done: 1, total: 4, seconds_left: None };
        assert_eq!(json(&progress), r#"{"event":"progress","percent":25.0,"done":1,"total":4,"seconds_left":null}"#);
        let outputs = ["a.exr".to_owned()];
        assert_eq!(
            json(&Event::End { complete: true, outputs: &outputs }),
            r#"{"event":"end","complete":true,"outputs":["a.exr"]}"#
        );
    }
}
