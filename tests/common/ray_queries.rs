//! The graphics adapter that tests of ray queries run on.

use std::sync::LazyLock;

use super::effort::announce;
use gpt::gpu::Device;
use gpt::plan::{PlanOptions, TraversalChoice};
use gpt::renderer::{DeviceChoice, RenderError};

/// The plan of `--traversal ray-query`.
pub fn by_ray_queries() -> PlanOptions {
    PlanOptions { traversal: TraversalChoice::RayQuery, ..PlanOptions::default() }
}

/// Opened once a test program, with ray queries. None where tests are told to do without a device, or it has none: a line says so. With
/// `GPT_TEST_RAY_QUERIES=require`, for machines known to have them, a device without them fails the tests.
pub static RAY_QUERY_DEVICE: LazyLock<Option<Device>> = LazyLock::new(|| {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return None;
    }
    match Device::open_for(&DeviceChoice::Gpu, &by_ray_queries()) {
        Err(RenderError::DoesNotFit(why)) => {
            let required = std::env::var("GPT_TEST_RAY_QUERIES").as_deref() == Ok("require");
            assert!(!required, "GPT_TEST_RAY_QUERIES=require: {why}");
            announce(&format!("left out: what tests of ray queries render, since {why}"));
            None
        }
        opened => Some(opened.expect("a graphics adapter; GPT_TEST_GPU=skip tests the CPU alone")),
    }
});
