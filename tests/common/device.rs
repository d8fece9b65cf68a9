//! The graphics adapter that tests run on.

use std::sync::LazyLock;

use gpt::gpu::Device;
use gpt::renderer::DeviceChoice;

/// Opened once a test program. None where tests are told to do without.
pub static DEVICE: LazyLock<Option<Device>> = LazyLock::new(|| match std::env::var("GPT_TEST_GPU").as_deref() {
    Ok("skip") => None,
    _ => Some(Device::open(&DeviceChoice::Gpu).expect("a graphics adapter; GPT_TEST_GPU=skip tests the CPU alone")),
});

/// The same device as if it had lower limits: what it lacks, plans do without.
pub fn with_limits(lower: impl FnOnce(&mut gpt::plan::DeviceLimits)) -> Option<Device> {
    let mut device = DEVICE.as_ref()?.clone();
    lower(&mut device.limits);
    Some(device)
}
