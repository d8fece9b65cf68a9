//! Signals: the first that asks for an end has the render stop and save, the second ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use super::exit::{Exit, Failure};
use super::terminal;

static STOP: AtomicBool = AtomicBool::new(false);
/// Nothing is left to be saved.
static OVER: AtomicBool = AtomicBool::new(false);
/// A render is being made ready, and nothing of it is there to be saved.
static PREPARING: AtomicBool = AtomicBool::new(false);

/// Schedulers kill ten seconds after they ask. What makes a render ready (reading, building, compiling) looks at no signals.
const PREPARATION: Duration = Duration::from_secs(8);

/// Takes over the signals by which a person or a system asks the program to end (on Unix SIGINT, SIGTERM, SIGHUP and SIGXCPU; not SIGHUP where
/// it is ignored, as `nohup` has it). Those that end it at once remove temporary files before.
///
/// # Errors
/// The system refused.
pub fn install() -> Result<(), Failure> {
    platform::install().map_err(|error| Failure::Other(format!("cannot watch for Ctrl-C: {error}")))
}

/// True if the user asked to stop.
pub fn requested() -> bool {
    STOP.load(Ordering::SeqCst)
}

/// Begins a phase that takes its time and makes nothing that could be saved, until [`something_is_rendered`].
pub fn preparation_begins() {
    PREPARING.store(true, Ordering::SeqCst);
}

/// The first samples are there.
pub fn something_is_rendered() {
    PREPARING.store(false, Ordering::SeqCst);
}

/// Marks the samples as saved: the program only waits for its end now.
pub fn render_is_over() {
    OVER.store(true, Ordering::SeqCst);
}

/// The first time asks to stop, the second time stops.
fn ask_to_stop(why: &str) {
    if STOP.swap(true, Ordering::SeqCst) {
        gpt::output::remove_unfinished();
        std::process::exit(Exit::Interrupted as i32);
    }
    if OVER.load(Ordering::SeqCst) {
        return;
    }
    gpt::gpu::end_soon();
    terminal::note(&format!("{why}; what is rendered will be saved (once more to quit at once)"));
    let quit_unless_rendered = || {
        thread::sleep(PREPARATION);
        if PREPARING.load(Ordering::SeqCst) && !OVER.load(Ordering::SeqCst) {
            terminal::note("nothing is rendered yet, so nothing is saved");
            gpt::output::remove_unfinished();
            std::process::exit(Exit::Interrupted as i32);
        }
    };
    // Without a thread it takes as long as it takes.
    let _ = thread::Builder::new().name("end".to_owned()).spawn(quit_unless_rendered);
}

#[cfg(unix)]
mod platform {
    use std::io;
    use std::thread;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGXFSZ};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    pub fn install() -> io::Result<()> {
        // A file that may not grow any further then is an error like a full disk, and no sudden end.
        // SAFETY: ignoring a signal runs no code.
        unsafe { libc::signal(SIGXFSZ, libc::SIG_IGN) };
        let mut wanted = vec![SIGINT, SIGTERM, SIGXCPU, SIGQUIT];
        if !is_ignored(SIGHUP) {
            wanted.push(SIGHUP);
        }
        let mut signals = Signals::new(wanted)?;
        let (started, has_started) = std::sync::mpsc::channel();
        let watch = move || {
            let _ = started.send(());
            signals.forever().for_each(handle);
        };
        thread::Builder::new().name("signals".to_owned()).spawn(watch)?;
        // A thread takes memory as it starts, and ends the process where it finds none: it is to have it before anything else takes it.
        let _ = has_started.recv();
        Ok(())
    }

    fn handle(signal: i32) {
        match signal {
            SIGQUIT => {
                gpt::output::remove_unfinished();
                // The signal acts as if nothing had been taken over.
                let _ = emulate_default_handler(signal);
            }
            SIGXCPU => super::ask_to_stop("the limit of processor time is reached: stopping"),
            _ => super::ask_to_stop("stopping"),
        }
    }

    fn is_ignored(signal: i32) -> bool {
        // SAFETY: with no new action, the one that there is is written to `action`, which is large enough and may be all zeros.
        unsafe {
            let mut action: libc::sigaction = std::mem::zeroed();
            libc::sigaction(signal, std::ptr::null(), &mut action) == 0 && action.sa_sigaction == libc::SIG_IGN
        }
    }
}

#[cfg(not(unix))]
mod platform {
    pub fn install() -> Result<(), ctrlc::Error> {
        ctrlc::set_handler(|| super::ask_to_stop("stopping"))
    }
}
