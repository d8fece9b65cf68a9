//! The machine and the time of a measurement.

use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

use crate::gpu::list_devices;

/// Everything that figures depend on beside the program.
#[derive(Debug, Clone, Serialize)]
pub struct Machine {
    /// This program's version.
    pub version: &'static str,
    /// UTC.
    pub date: String,
    pub system: String,
    pub processor: String,
    /// Threads that the system runs at once.
    pub threads: usize,
    /// Devices that were used, with their drivers.
    pub devices: Vec<String>,
    /// The command as it was typed.
    pub command: String,
}

impl Machine {
    /// Looks at this machine. `devices` are the names of those that were used, `command` what was typed.
    pub fn here(devices: &[String], command: String) -> Self {
        let adapters = list_devices();
        let with_driver = |name: &String| {
            let adapter = adapters.iter().find(|adapter| adapter.name == *name);
            adapter.map_or_else(|| name.clone(), |found| format!("{name} ({}, driver {})", found.backend, found.driver))
        };
        Self {
            version: env!("CARGO_PKG_VERSION"),
            date: date(SystemTime::now()),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            processor: processor().unwrap_or_else(|| "unknown".to_owned()),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            devices: devices.iter().map(with_driver).collect(),
            command,
        }
    }
}

/// The date and time in UTC, to the minute.
fn date(time: SystemTime) -> String {
    // A clock that stands before 1970 is wrong anyway.
    let minutes = time.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs() / 60);
    let (year, month, day) = civil_from_days(minutes / (24 * 60));
    format!("{year}-{month:02}-{day:02} {:02}:{:02} UTC", minutes / 60 % 24, minutes % 60)
}

/// Year, month and day of a number of days since 1970-01-01 (Howard Hinnant, "chrono-compatible low-level date algorithms"). Years begin
/// in March, so that a leap day is a year's last.
fn civil_from_days(days: u64) -> (u64, u64, u64) {
    const DAYS_OF_400_YEARS: u64 = 146_097;
    // Counted from 0000-03-01.
    let days = days + 719_468;
    let (era, day_of_era) = (days / DAYS_OF_400_YEARS, days % DAYS_OF_400_YEARS);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = 400 * era + year_of_era + u64::from(month <= 2);
    (year, month, day)
}

/// The processor's name where the system tells it (Linux).
fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        let at = |seconds| date(UNIX_EPOCH + Duration::from_secs(seconds));
        // `date -u -d @N '+%F %H:%M UTC'`.
        assert_eq!(at(0), "1970-01-01 00:00 UTC");
        assert_eq!(at(951_782_400), "2000-02-29 00:00 UTC");
        assert_eq!(at(951_868_799), "2000-02-29 23:59 UTC");
        assert_eq!(at(951_868_800), "2000-03-01 00:00 UTC");
        assert_eq!(at(1_767_225_599), "2025-12-31 23:59 UTC");
        assert_eq!(at(4_107_542_400), "2100-03-01 00:00 UTC");
    }
}
