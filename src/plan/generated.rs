//! The WGSL files that are made from Rust's tables: the same for every scene.

use super::{camera_models, layout, lights, lobes, shapes, thin_film};

/// The name under which kernels import each, and its text.
pub fn files() -> Vec<(&'static str, String)> {
    vec![
        (layout::FILE, layout::wgsl()),
        (camera_models::FILE, camera_models::wgsl()),
        (lobes::FILE, lobes::wgsl()),
        (lobes::PARAMETERS_FILE, lobes::parameters_wgsl()),
        (thin_film::FILE, thin_film::wgsl()),
        (lights::DELTA_FILE, lights::delta_wgsl()),
        (lights::OUTSIDE_FILE, lights::outside_wgsl()),
        (shapes::GEOMETRY_FILE, shapes::geometry_wgsl()),
        (shapes::SHADING_FILE, shapes::shading_wgsl()),
    ]
}
