//! The graphics adapter that tests run on.

use std::ops::Deref;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use gpt::gpu::Device;
use gpt::renderer::DeviceChoice;

/// A device does one thing after another: with two of them, one compiles kernels while the other renders.
const DEVICES: usize = 2;

static OPENED: LazyLock<[Option<Device>; DEVICES]> = LazyLock::new(|| match std::env::var("GPT_TEST_GPU").as_deref() {
    Ok("skip") => [const { None }; DEVICES],
    _ => std::array::from_fn(|_| {
        Some(Device::open(&DeviceChoice::Gpu).expect("a graphics adapter; GPT_TEST_GPU=skip tests the CPU alone"))
    }),
});

/// The device of this thread, one of a few that are opened once a test program. None where tests are told to do without.
pub static DEVICE: OfThisThread = OfThisThread;

pub struct OfThisThread;

impl Deref for OfThisThread {
    type Target = Option<Device>;

    fn deref(&self) -> &Option<Device> {
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        thread_local! {
            static MINE: usize = NEXT.fetch_add(1, Ordering::Relaxed) % DEVICES;
        }
        &OPENED[MINE.with(|mine| *mine)]
    }
}

/// The device with lower limits: plans do without what it lacks.
pub fn with_limits(lower: impl FnOnce(&mut gpt::plan::DeviceLimits)) -> Option<Device> {
    let mut device = DEVICE.as_ref()?.clone();
    lower(&mut device.limits);
    Some(device)
}
