//! The graphics adapter that tests of ray queries run on.

use std::sync::LazyLock;

use gpt::gpu::Device;
use gpt::plan::{PlanOptions, TraversalChoice};
use gpt::renderer::{DeviceChoice, RenderError};

/// As `--traversal ray-query` has it.
pub fn by_ray_queries() -> PlanOptions {
    PlanOptions { traversal: TraversalChoice::RayQuery, ..PlanOptions::default() }
}

/// Opened once a test program, with ray queries. None where tests are told to do without a device, or it has none: that is said.
pub static RAY_QUERY_DEVICE: LazyLock<Option<Device>> = LazyLock::new(|| {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return None;
    }
    match Device::open_for(&DeviceChoice::Gpu, &by_ray_queries()) {
        Err(RenderError::DoesNotFit(why)) => {
            println!("skipped: {why}");
            None
        }
        opened => Some(opened.expect("a graphics adapter; GPT_TEST_GPU=skip tests the CPU alone")),
    }
});
