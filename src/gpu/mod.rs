//! Rendering on graphics devices, through wgpu.

#[cfg_attr(not(feature = "ray-query"), path = "no_acceleration.rs")]
pub mod acceleration;
pub mod adapters;
mod band;
pub mod buffers;
mod compiled;
pub mod device;
mod driver_thread;
mod film;
mod film_memory;
mod fitting;
mod iterations;
pub mod kernels;
mod limits;
pub mod passes;
pub mod pipeline;
pub mod profile;
pub mod renderer;
mod snapshot;
mod software_drivers;
pub mod trace;

pub use adapters::{AdapterSummary, list_devices, select_adapter};
pub use device::{Device, OpeningDevice};
pub use driver_thread::end_soon;
pub use fitting::Fitting;
pub use limits::{driver_identity, limits_for_plans};
pub use renderer::GpuRenderer;
