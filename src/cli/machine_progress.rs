//! Progress for other programs, line by line on standard output.

use std::io::Write;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use serde::Serialize;

use super::frames::Span;

/// Time between two lines.
const INTERVAL: Duration = Duration::from_secs(1);

/// How progress is printed on standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ProgressFormat {
    /// A line of words with a percentage
    Plain,
    /// JSON objects: `event` is `start`, `progress` or `end`
    Json,
    /// The form of Open Job Description: `openjd_progress: 42.0`
    Openjd,
}

/// Memory that a render needs, in bytes, reported before it is taken.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Needs {
    /// Width and height of the picture in pixels.
    pub width: u32,
    pub height: u32,
    /// The film on the device, and what the host holds of it at a time.
    pub film_bytes: u64,
    /// The host's memory for all of the render, by estimate.
    pub host_bytes: u64,
}

#[derive(Serialize)]
#[serde(tag = "event", rename_all = "lowercase")]
enum Event<'a> {
    Start {
        #[serde(flatten)]
        needs: Needs,
        #[serde(skip_serializing_if = "Option::is_none")]
        frame: Option<u32>,
    },
    Progress {
        percent: f64,
        done: u64,
        total: u64,
        seconds_left: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        frame: Option<u32>,
    },
    /// One of several frames is over.
    Frame {
        frame: u32,
        complete: bool,
        outputs: &'a [String],
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
    span: Option<Span>,
}

impl MachineProgress {
    /// `span`: which of several frames it is; percentages are then of all of them.
    pub fn new(format: ProgressFormat, span: Option<Span>) -> Self {
        Self { format, last: None, span }
    }

    /// The render is about to begin.
    pub fn start(&self, needs: Needs) {
        let [film, host] = [needs.film_bytes, needs.host_bytes].map(|bytes| bytes as f64 / f64::from(1 << 20));
        self.say(&Event::Start { needs, frame: self.frame() }, || match self.format {
            ProgressFormat::Openjd => format!("openjd_status: preparing, {film:.1} MiB for the film, about {host:.0} MiB in all"),
            _ => {
                let [width, height] = [needs.width, needs.height];
                format!("preparing {width}x{height} pixels, {film:.1} MiB for the film, about {host:.0} MiB in all")
            }
        });
    }

    /// `done` of `total` samples are finished.
    pub fn progress(&mut self, done: u64, total: u64, rate: Option<f64>) {
        if self.last.is_some_and(|last| last.elapsed() < INTERVAL) && done < total {
            return;
        }
        self.last = Some(Instant::now());
        let share = done as f64 / (total as f64).max(1.0);
        let (before, count) = self.span.map_or((0.0, 1.0), |span| (span.index as f64, span.count as f64));
        let percent = 100.0 * (before + share) / count;
        let frames_left = count - before - 1.0;
        let seconds_left = rate.map(|rate| (total.saturating_sub(done) as f64 + frames_left * total as f64) / rate);
        self.say(&Event::Progress { percent, done, total, seconds_left, frame: self.frame() }, || match self.format {
            ProgressFormat::Openjd => format!("openjd_progress: {percent:.1}"),
            _ => format!("{percent:.1} %, {done} of {total} samples"),
        });
    }

    fn frame(&self) -> Option<u32> {
        self.span.map(|span| span.frame)
    }

    /// The render is over, or one of several frames.
    pub fn end(&self, complete: bool, outputs: &[String]) {
        if let Some(frame) = self.frame() {
            let what = if complete { "done" } else { "broke off" };
            return self.say(&Event::Frame { frame, complete, outputs }, || match self.format {
                ProgressFormat::Openjd => format!("openjd_status: frame {frame} {what}"),
                _ => format!("frame {frame} {what}: {}", outputs.join(", ")),
            });
        }
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
        let needs = Needs { width: 4, height: 3, film_bytes: 384, host_bytes: 9 };
        let start = r#"{"event":"start","width":4,"height":3,"film_bytes":384,"host_bytes":9}"#;
        assert_eq!(json(&Event::Start { needs, frame: None }), start);
        let progress = Event::Progress { percent: 25.0, done: 1, total: 4, seconds_left: None, frame: None };
        assert_eq!(json(&progress), r#"{"event":"progress","percent":25.0,"done":1,"total":4,"seconds_left":null}"#);
        let outputs = ["a.exr".to_owned()];
        assert_eq!(
            json(&Event::End { complete: true, outputs: &outputs }),
            r#"{"event":"end","complete":true,"outputs":["a.exr"]}"#
        );
    }
}
