//! How far a render is: a bar on a terminal, plain lines elsewhere.

use std::io::{self, IsTerminal};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use gpt::renderer::Observer;
use indicatif::{ProgressBar, ProgressStyle};

use super::frames::Span;
use super::machine_progress::{MachineProgress, Needs, ProgressFormat};
use super::{interrupt, terminal};

/// Time between two plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(5);
/// Preparations are reported in a plain line if they take longer.
const LONG_PREPARATION: Duration = Duration::from_secs(3);
/// The name of the phase before the first samples; the driver's compiler takes most of it.
const PREPARING: &str = "preparing the scene and compiling kernels";
/// Time between two pictures of the hand that turns meanwhile.
const TICK: Duration = Duration::from_millis(120);
/// Widest and narrowest bar, without its ends.
const WIDEST_BAR: usize = 30;
const NARROWEST_BAR: usize = 8;

/// Shows progress to people and to other programs, and passes on the wish to stop.
pub struct Progress {
    shown: ProgressDisplay,
    machine: Option<Mutex<(MachineProgress, Pace)>>,
    span: Option<Span>,
}

/// The display that people see.
enum ProgressDisplay {
    Hidden,
    Bar(ProgressBar, Mutex<Pace>),
    Lines(Mutex<Lines>),
}

/// The state of progress in plain lines.
pub struct Lines {
    last: Instant,
    pace: Pace,
    /// Tells of long preparations, unless this is dropped before.
    preparing: Option<Sender<()>>,
}

/// How fast samples come. What comes before the first of them, the compiler above all, takes no part in it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pace {
    first: Option<(Instant, u64)>,
}

impl Pace {
    /// Samples per second since they were first reported; None at that time.
    fn rate(&mut self, done: u64) -> Option<f64> {
        let (since, before) = *self.first.get_or_insert_with(|| (Instant::now(), done));
        let seconds = since.elapsed().as_secs_f64();
        (done > before && seconds > 0.0).then(|| (done - before) as f64 / seconds)
    }
}

impl Progress {
    /// A bar where stderr is a terminal, else lines; nothing if `quiet`. The scene is being prepared until samples come.
    /// `format`: lines for other programs too.
    /// `span`: which of several frames is rendered.
    pub fn of_frame(quiet: bool, format: Option<ProgressFormat>, span: Option<Span>) -> Self {
        let machine = format.map(|format| Mutex::new((MachineProgress::new(format, span), Pace::default())));
        Self { shown: ProgressDisplay::new(quiet), machine, span }
    }

    /// Says to other programs that the last of several frames is over.
    pub fn end_of_all(format: Option<ProgressFormat>, complete: bool, outputs: &[String]) {
        if let Some(format) = format {
            MachineProgress::new(format, None).end(complete, outputs);
        }
    }

    /// Says to other programs what the render is about to take.
    pub fn start(&self, needs: Needs) {
        if let Some(machine) = &self.machine {
            lock(machine).0.start(needs);
        }
    }

    /// Says to other programs that the render is over.
    pub fn end(&self, complete: bool, outputs: &[String]) {
        if let Some(machine) = &self.machine {
            lock(machine).0.end(complete, outputs);
        }
    }

    /// Takes the bar off the screen.
    pub fn clear(&self) {
        self.shown.clear();
    }
}

impl ProgressDisplay {
    fn new(quiet: bool) -> Self {
        if quiet {
            return Self::Hidden;
        }
        if io::stderr().is_terminal() {
            let bar = ProgressBar::no_length().with_style(style("{spinner} {wide_msg}")).with_message(PREPARING);
            bar.enable_steady_tick(TICK);
            return Self::Bar(bar, Mutex::default());
        }
        Self::Lines(Mutex::new(Lines { last: Instant::now(), pace: Pace::default(), preparing: tell_if_long() }))
    }

    fn clear(&self) {
        match self {
            Self::Hidden => {}
            Self::Bar(bar, _) => bar.finish_and_clear(),
            Self::Lines(lines) => lock(lines).preparing = None,
        }
    }
}

impl ProgressDisplay {
    fn progress(&self, done: u64, total: u64, span: Option<Span>) {
        let of_frame =
            span.map_or_else(String::new, |Span { frame, index, count }| format!("frame {frame} ({} of {count}), ", index + 1));
        match self {
            Self::Hidden => {}
            Self::Bar(bar, pace) => {
                let rate = lock(pace).rate(done);
                bar.disable_steady_tick();
                bar.set_style(style("{wide_msg}"));
                let line = bar_line(done, total, rate, terminal::columns().saturating_sub(of_frame.len()));
                bar.set_message(of_frame + &line);
            }
            Self::Lines(lines) => {
                let mut lines = lock(lines);
                lines.preparing = None;
                let rate = lines.pace.rate(done);
                if lines.last.elapsed() >= LINE_INTERVAL {
                    lines.last = Instant::now();
                    terminal::note(&(of_frame + &line(done, total, rate)));
                }
            }
        }
    }
}

impl Observer for Progress {
    fn progress(&self, done: u64, total: u64) {
        interrupt::something_is_rendered();
        self.shown.progress(done, total, self.span);
        if let Some(machine) = &self.machine {
            let (machine, pace) = &mut *lock(machine);
            let rate = pace.rate(done);
            machine.progress(done, total, rate);
        }
    }

    fn stop_requested(&self) -> bool {
        interrupt::requested()
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    // The display is whole whatever panicked while holding it.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Says after a while what takes so long, unless what it returns is dropped. Without a thread to wait in, nothing is said.
fn tell_if_long() -> Option<Sender<()>> {
    let (sender, receiver) = channel();
    let wait = move || {
        if receiver.recv_timeout(LONG_PREPARATION) == Err(RecvTimeoutError::Timeout) {
            terminal::note(PREPARING);
        }
    };
    std::thread::Builder::new().name("preparing".to_owned()).spawn(wait).ok().map(|_| sender)
}

fn style(template: &str) -> ProgressStyle {
    // Templates are constants; the fallback is only there because the compiler cannot read them.
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// Time left, where the pace is known.
fn time_left(done: u64, total: u64, rate: Option<f64>) -> Option<String> {
    let seconds = total.saturating_sub(done) as f64 / rate?;
    Some(match seconds {
        seconds if seconds < 100.0 => format!("{seconds:.0} s left"),
        seconds if seconds < 100.0 * 60.0 => format!("{:.0} min left", seconds / 60.0),
        seconds => format!("{:.0} h left", seconds / 3600.0),
    })
}

fn percent(done: u64, total: u64) -> f64 {
    100.0 * done as f64 / (total as f64).max(1.0)
}

/// One line that fits so many columns: as much as there is room for, the most important first.
fn bar_line(done: u64, total: u64, rate: Option<f64>, columns: usize) -> String {
    let percent = percent(done, total);
    let mut right = time_left(done, total, rate).unwrap_or_default();
    let room = |right: &str| columns.saturating_sub("100 % [] ".len() + right.len() + 1);
    let samples = |count: u64| terminal::with_unit(count as f64, "");
    let more = [
        rate.map(|rate| terminal::with_unit(rate, "sample/s")),
        Some(format!("{} of {} samples", samples(done), samples(total))),
    ];
    for part in more.into_iter().flatten() {
        let wider = if right.is_empty() { part } else { format!("{part}, {right}") };
        if room(&wider) < NARROWEST_BAR {
            break;
        }
        right = wider;
    }
    let width = room(&right).min(WIDEST_BAR);
    let full = (width as f64 * percent / 100.0) as usize;
    let bar = match width {
        0 => String::new(),
        width => format!("[{:<width$}] ", format!("{}{}", "=".repeat(full), if full < width { ">" } else { "" })),
    };
    format!("{percent:>3.0} % {bar}{right}").trim_end().to_owned()
}

fn line(done: u64, total: u64, rate: Option<f64>) -> String {
    let [done_text, total_text] = [done, total].map(|count| terminal::with_unit(count as f64, ""));
    let mut line = format!("{:>3.0} %, {done_text} of {total_text} samples", percent(done, total));
    if let Some(rate) = rate {
        line += &format!(", {}", terminal::with_unit(rate, "sample/s"));
    }
    if let Some(left) = time_left(done, total, rate) {
        line += &format!(", {left}");
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tells_share_speed_and_time_left() {
        let line = |done, total, rate| line(done, total, rate);
        assert_eq!(line(2_500_000, 10_000_000, Some(5e5)), " 25 %, 2.50 M of 10.00 M samples, 500.00 ksample/s, 15 s left");
        assert_eq!(line(0, 100, None), "  0 %, 0 of 100 samples");
        assert_eq!(line(1, 1_000_000, Some(1.0)), "  0 %, 1 of 1.00 M samples, 1 sample/s, 278 h left");
    }

    #[test]
    fn a_bar_fits_its_terminal() {
        assert_eq!(
            bar_line(2_500_000, 10_000_000, Some(5e5), 100),
            " 25 % [=======>                      ] 2.50 M of 10.00 M samples, 500.00 ksample/s, 15 s left"
        );
        assert_eq!(bar_line(2_500_000, 10_000_000, Some(5e5), 40), " 25 % [=====>               ] 15 s left");
        for columns in 0..200 {
            for (done, rate) in [(0, None), (1, Some(1e-3)), (123_456_789, Some(4.5e8)), (10_000_000_000, Some(1e9))] {
                let line = bar_line(done, 10_000_000_000, rate, columns);
                assert!(line.len() < columns.max(24), "{columns} columns: {line}");
            }
        }
    }

    /// A minute of compiling is no part of the pace.
    #[test]
    fn the_pace_begins_with_the_first_samples() {
        let mut pace = Pace::default();
        assert_eq!(pace.rate(32_768), None);
        pace.first = Instant::now().checked_sub(Duration::from_secs(2)).map(|then| (then, 32_768));
        let rate = pace.rate(32_768 + 200_000).expect("samples came");
        assert!((90_000.0..=100_000.0).contains(&rate), "{rate}");
    }
}
