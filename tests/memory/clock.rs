//! Processor time, which other programs and other tests add nothing to.

use std::time::Duration;

#[cfg(unix)]
fn read(clock: libc::clockid_t) -> Duration {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is to a `timespec` that outlives the call.
    let status = unsafe { libc::clock_gettime(clock, &raw mut time) };
    assert_eq!(status, 0, "every Unix has this clock");
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Processor time that this thread took so far.
#[cfg(unix)]
pub fn of_thread() -> Duration {
    read(libc::CLOCK_THREAD_CPUTIME_ID)
}

/// Processor time that all threads of the program took so far.
#[cfg(unix)]
pub fn of_process() -> Duration {
    read(libc::CLOCK_PROCESS_CPUTIME_ID)
}

/// Time since some moment, where there is no such clock.
#[cfg(not(unix))]
pub fn of_process() -> Duration {
    static START: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed()
}

/// Time since some moment, where threads have no clock of their own.
#[cfg(not(unix))]
pub fn of_thread() -> Duration {
    of_process()
}
