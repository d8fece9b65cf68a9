//! `gpt devices`.

use std::fmt::Write;

use gpt::gpu::{AdapterSummary, list_devices};
use gpt::plan::VerifiedDrivers;
use serde::Serialize;

use super::arguments::DevicesArguments;
use super::exit::{Exit, Failure};
use super::{terminal, verified_drivers};

/// A device, and what was found out about it.
#[derive(Serialize)]
struct Listed {
    #[serde(flatten)]
    summary: AdapterSummary,
    /// `gpt verify --traversal ray-query` passed with this driver.
    ray_queries_verified: bool,
}

impl Listed {
    fn new(summary: AdapterSummary, verified: &VerifiedDrivers) -> Self {
        Self { ray_queries_verified: verified.contains(&summary.identity), summary }
    }
}

/// Lists what can render here. A machine without an adapter still has the CPU, so an empty list is no failure.
pub fn run(arguments: &DevicesArguments) -> Result<Exit, Failure> {
    let verified = verified_drivers::known();
    let devices: Vec<Listed> = list_devices().into_iter().map(|summary| Listed::new(summary, &verified)).collect();
    if arguments.json {
        terminal::answer_json(&devices)?;
    } else {
        terminal::answer(&text(&devices))?;
    }
    Ok(Exit::Done)
}

fn text(devices: &[Listed]) -> String {
    let mut text = String::new();
    for device in devices {
        describe(&mut text, device);
    }
    let auto = if devices.iter().any(|device| device.summary.chosen_by_auto) { "" } else { "   <- auto" };
    let _ = writeln!(text, "CPU reference (--device cpu){auto}");
    text
}

fn describe(text: &mut String, Listed { summary: device, ray_queries_verified }: &Listed) {
    let auto = if device.chosen_by_auto { "   <- auto" } else { "" };
    let yes_no = |yes: bool| if yes { "yes" } else { "no" };
    let _ = writeln!(text, "{}{auto}", device.name);
    let _ = writeln!(text, "  {}, {}, driver {}", device.kind.label(), device.backend, device.driver);
    if let Some(reason) = &device.unusable {
        let _ = writeln!(text, "  cannot be used: it {reason}");
    }
    if let Some(advice) = device.advice {
        let _ = writeln!(text, "  {advice}");
    }
    let _ = writeln!(
        text,
        "  storage binding {}, uniform binding {}, buffer {}, storage buffers a stage {}",
        bytes(device.max_storage_binding),
        bytes(device.max_uniform_binding),
        bytes(device.max_buffer),
        device.max_storage_buffers_per_stage
    );
    let _ = writeln!(
        text,
        "  texture side {}, workgroups a dimension {}, workgroup memory {}, immediates {}",
        device.max_texture_side,
        device.max_workgroups_per_dimension,
        bytes(device.max_workgroup_memory.into()),
        bytes(device.max_immediates.into())
    );
    let [least, most] = device.subgroup_sizes;
    let _ = writeln!(
        text,
        "  rgba32float read and write {}, timestamps {}, ray queries {}, subgroups of {least} to {most}",
        yes_no(device.read_write_rgba32float),
        yes_no(device.timestamps),
        if *ray_queries_verified { "verified" } else { yes_no(device.ray_queries) }
    );
}

/// A size with a binary prefix where it is a whole number of them.
fn bytes(size: u64) -> String {
    match size {
        size if size >= 1 << 30 => format!("{:.1} GiB", size as f64 / f64::from(1 << 30)),
        size if size >= 1 << 20 => format!("{} MiB", size >> 20),
        size if size >= 1 << 10 => format!("{} KiB", size >> 10),
        size => format!("{size} B"),
    }
}
