//! The wavefront renderer on wgpu.

pub mod adapters;

pub use adapters::{AdapterSummary, list_devices, select_adapter};
