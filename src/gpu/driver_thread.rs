//! The one place where the host hands work to the driver and waits for it.
//!
//! Two things can go wrong there that no error tells of. wgpu panics where it waits for a device that is lost. And a driver may never come back.
//! So a thread of its own submits and waits: its panic is caught, and it is left behind where it hangs.

use std::any::Any;
use std::panic::{self, AssertUnwindSafe};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Once, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

/// Name of the thread, whose panics are reported as errors and not printed.
const THREAD: &str = "gpt driver";
/// Name of the thread that opens a device, for which the same holds.
pub const OPENING_THREAD: &str = "gpt opens a device";
/// The driver itself is told to wait no longer than the limit, and has so much longer to say so.
const GRACE: Duration = Duration::from_secs(2);
/// How long a driver is waited for once the program is to end, which has ten seconds for all that it does.
const LAST_WAIT: Duration = Duration::from_secs(5);
/// Time between two looks at whether it is.
const LOOK: Duration = Duration::from_millis(250);

/// Since when the program is to end.
static ENDING: OnceLock<Instant> = OnceLock::new();

/// From now on a driver that does not answer is waited for a few seconds at most: the program is to end, and has something to save.
pub fn end_soon() {
    ENDING.get_or_init(Instant::now);
}

type Job = Box<dyn FnOnce() + Send>;

/// The fate of a piece of work.
#[derive(Debug)]
pub enum Fate {
    /// The driver panicked, and said this.
    Panicked(String),
    /// The driver did not come back in this time; nothing may be asked of it any more.
    Hangs(Duration),
}

/// The thread. Work is done in the order in which it comes.
pub struct DriverThread {
    /// None where the system starts no more threads: then the caller's does the work.
    jobs: Option<Sender<Job>>,
    limit: Duration,
}

impl DriverThread {
    /// `limit`: what a piece of work may take.
    pub fn start(limit: Duration) -> Self {
        keep_panics_quiet();
        let (sender, receiver) = channel::<Job>();
        let work = move || receiver.iter().for_each(|job| job());
        let started = thread::Builder::new().name(THREAD.to_owned()).spawn(work);
        Self { jobs: started.ok().map(|_| sender), limit }
    }

    /// The time that a piece of work may take.
    pub fn limit(&self) -> Duration {
        self.limit
    }

    /// Has the thread do the work, and waits for what it brings.
    pub fn run<T: Send + 'static>(&self, work: impl FnOnce() -> T + Send + 'static) -> Result<T, Fate> {
        let caught = move || panic::catch_unwind(AssertUnwindSafe(work)).map_err(|payload| Fate::Panicked(message(&*payload)));
        let Some(jobs) = &self.jobs else { return caught() };
        let (answer, answered) = channel();
        let job = move || {
            // Nobody waits any more for what came too late.
            let _ = answer.send(caught());
        };
        if jobs.send(Box::new(job)).is_err() {
            return Err(Fate::Hangs(Duration::ZERO));
        }
        let begun = Instant::now();
        let limit = self.limit.saturating_add(GRACE);
        loop {
            let waited = begun.elapsed();
            match answered.recv_timeout(LOOK.min(limit.saturating_sub(waited))) {
                Ok(outcome) => return outcome,
                Err(RecvTimeoutError::Disconnected) => return Err(Fate::Hangs(waited)),
                Err(RecvTimeoutError::Timeout) if waited >= limit => return Err(Fate::Hangs(self.limit)),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if ENDING.get().is_some_and(|since| since.elapsed() >= LAST_WAIT) {
                return Err(Fate::Hangs(begun.elapsed()));
            }
        }
    }
}

/// The message of a panic.
pub fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().map(String::as_str).or_else(|| payload.downcast_ref::<&str>().copied());
    text.unwrap_or("no reason was given").to_owned()
}

/// Panics of these threads become errors; printed as well, they would only frighten.
pub fn keep_panics_quiet() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let others = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !matches!(thread::current().name(), Some(THREAD | OPENING_THREAD)) {
                others(info);
            }
        }));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_brings_what_it_returns() {
        let thread = DriverThread::start(Duration::from_secs(60));
        assert_eq!(thread.run(|| 6 * 7).expect("it ends"), 42);
    }

    #[test]
    fn a_panic_is_reported_and_the_thread_goes_on() {
        let thread = DriverThread::start(Duration::from_secs(60));
        let fate = thread.run(|| panic!("Error in Device::poll: {}", "lost")).map(|()| 0);
        assert!(matches!(fate, Err(Fate::Panicked(message)) if message == "Error in Device::poll: lost"));
        assert_eq!(thread.run(|| 1).expect("it ends"), 1);
    }

    #[test]
    fn what_hangs_is_left_behind() {
        let thread = DriverThread::start(Duration::ZERO);
        let (hold, held) = channel::<()>();
        let fate = thread.run(move || held.recv().is_ok());
        assert!(matches!(fate, Err(Fate::Hangs(_))));
        drop(hold);
    }
}
