//! What a measurement was made on, and when.

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
    /// As it was typed.
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
            date: jiff::Timestamp::now().strftime("%Y-%m-%d %H:%M UTC").to_string(),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            processor: processor().unwrap_or_else(|| "unknown".to_owned()),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            devices: devices.iter().map(with_driver).collect(),
            command,
        }
    }
}

/// The processor's name where the system tells it (Linux).
fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}
