//! How much memory there is.

/// Where nothing says how much there is.
const UNKNOWN: u64 = 16 << 30;

/// Bytes that this process may still take, as far as the system says: what is free, within the limit of the process (`ulimit -v`).
pub fn available() -> u64 {
    let free = std::fs::read_to_string("/proc/meminfo").ok().and_then(|text| kibibytes(&text, "MemAvailable:"));
    let limit = std::fs::read_to_string("/proc/self/limits").ok().and_then(|text| {
        let row = text.lines().find_map(|line| line.strip_prefix("Max address space"))?;
        row.split_whitespace().next()?.parse().ok()
    });
    let taken = std::fs::read_to_string("/proc/self/status").ok().and_then(|text| kibibytes(&text, "VmSize:"));
    let left = limit.map_or(u64::MAX, |limit: u64| limit.saturating_sub(taken.unwrap_or(0)));
    free.unwrap_or(UNKNOWN).min(left)
}

fn kibibytes(text: &str, key: &str) -> Option<u64> {
    let row = text.lines().find_map(|line| line.strip_prefix(key))?;
    row.split_whitespace().next()?.parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_the_kernels_tables_are_read() {
        let table = "MemTotal:       16384 kB\nMemAvailable:    1024 kB\n";
        assert_eq!(kibibytes(table, "MemAvailable:"), Some(1 << 20));
        assert_eq!(kibibytes(table, "Absent:"), None);
        assert!((1 << 20..1 << 50).contains(&available()));
    }
}
