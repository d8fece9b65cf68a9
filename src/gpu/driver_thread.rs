//! The one place where the host hands work to the driver and waits for it.
//!
//! Two things can go wrong there that no error tells of. wgpu panics where it waits for a device that is lost. And a driver may never come back.
//! So a thread of its own submits and waits: its panic is caught, and it is left behind where it hangs.

use std::any::Any;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

/// Name of the thread, whose panics are told as errors and not printed.
const THREAD: &str = "gpt driver";
/// Name of the thread that opens a device, for which the same holds.
pub const OPENING_THREAD: &str = "gpt opens a device";
/// The driver itself is told to wait no longer than the limit, and has so much longer to say so.
const GRACE: Duration = Duration::from_secs(2);

type Job = Box<dyn FnOnce() + Send>;

/// What became of a piece of work.
#[derive(Debug)]
pub enum Fate {
    /// The driver panicked, and said this.
    Panicked(String),
    /// The driver did not come back in time; nothing may be asked of it any more.
    Hangs,
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

    /// What a piece of work may take.
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
            return Err(Fate::Hangs);
        }
        match answered.recv_timeout(self.limit.saturating_add(GRACE)) {
            Ok(outcome) => outcome,
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => Err(Fate::Hangs),
        }
    }
}

/// What a panic said.
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
    fn a_panic_is_told_and_the_thread_goes_on() {
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
        assert!(matches!(fate, Err(Fate::Hangs)));
        drop(hold);
    }
}
