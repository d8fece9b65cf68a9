//! How much memory there is.

mod control_groups;

use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The last answer, and when it was given.
static KNOWN: Mutex<Option<(Instant, u64)>> = Mutex::new(None);
/// For so long it is taken for true.
const VALID: Duration = Duration::from_millis(50);
/// The memory that is assumed where nothing says how much there is.
const UNKNOWN: u64 = 16 << 30;

/// Bytes that this process may still take, as far as the system says: what is free, within the limits of the process (`ulimit -v`) and of the control
/// groups that it is in, as containers and batch systems set them.
pub fn available() -> u64 {
    // Who reads a scene of thousands of entries asks for each of them, and the system takes its time to answer.
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    match *known {
        Some((asked, bytes)) if asked.elapsed() < VALID => bytes,
        _ => {
            let bytes = available_under(Path::new("/"));
            *known = Some((Instant::now(), bytes));
            bytes
        }
    }
}

/// Free memory by the files of a system that are in this folder.
fn available_under(root: &Path) -> u64 {
    let read = |path: &str| std::fs::read_to_string(root.join(path)).ok();
    let free = read("proc/meminfo").and_then(|text| kibibytes(&text, "MemAvailable:"));
    let limit = read("proc/self/limits").and_then(|text| {
        let row = text.lines().find_map(|line| line.strip_prefix("Max address space"))?;
        row.split_whitespace().next()?.parse().ok()
    });
    let taken = read("proc/self/status").and_then(|text| kibibytes(&text, "VmSize:"));
    let left = limit.map_or(u64::MAX, |limit: u64| limit.saturating_sub(taken.unwrap_or(0)));
    let of_groups = control_groups::left(root).unwrap_or(u64::MAX);
    free.unwrap_or(UNKNOWN).min(left).min(of_groups)
}

fn kibibytes(text: &str, key: &str) -> Option<u64> {
    let row = text.lines().find_map(|line| line.strip_prefix(key))?;
    row.split_whitespace().next()?.parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::control_groups::tests::System;
    use super::*;

    #[test]
    fn rows_of_the_kernels_tables_are_read() {
        let table = "MemTotal:       16384 kB\nMemAvailable:    1024 kB\n";
        assert_eq!(kibibytes(table, "MemAvailable:"), Some(1 << 20));
        assert_eq!(kibibytes(table, "Absent:"), None);
        assert!((1 << 20..1 << 50).contains(&available()));
    }

    /// The least of what is free, of what the process may have, and of what its control groups leave it.
    #[test]
    fn the_tightest_limit_counts() {
        let free = |limit: &str| format!("Limit  Soft  Hard\nMax address space  {limit}  unlimited  bytes\n");
        let system = System::new(&[
            ("proc/meminfo", "MemAvailable: 8388608 kB\n"),
            ("proc/self/status", "VmSize: 1048576 kB\n"),
            ("proc/self/limits", &free("unlimited")),
            ("proc/self/cgroup", "0::/job\n"),
            ("proc/self/mountinfo", "30 20 0:26 / /sys/fs/cgroup rw - cgroup2 cgroup2 rw\n"),
            ("sys/fs/cgroup/job/memory.current", "1073741824\n"),
        ]);
        assert_eq!(available_under(system.root()), 8 << 30);
        system.write("proc/self/limits", &free("5368709120"));
        assert_eq!(available_under(system.root()), 4 << 30);
        system.write("sys/fs/cgroup/job/memory.max", "3221225472\n");
        assert_eq!(available_under(system.root()), 2 << 30);
        // A system that says nothing.
        assert_eq!(available_under(System::new(&[]).root()), UNKNOWN);
    }
}
