//! What the Python package is made of. The package itself, with documentation and types, is in `package/`.
//!
//! Long work is done without Python's lock. Arrays are read-only views of this module's memory, by numpy's array interface.

mod array;
mod errors;
mod layers;
mod looks;
mod measuring;
mod opened;
mod picture;
mod pictures;
mod process;
mod referee;
mod regrouping;
mod scene;
mod settings;
mod tables;
mod task;
mod watching;

use pyo3::prelude::*;

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("Error", py.get_type::<errors::Error>())?;
    module.add("SceneError", py.get_type::<errors::SceneError>())?;
    module.add("DeviceError", py.get_type::<errors::DeviceError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<array::Array>()?;
    module.add_class::<picture::Picture>()?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<task::Task>()?;
    module.add_class::<task::Rendered>()?;
    module.add_class::<pictures::Pictures>()?;
    module.add_class::<referee::RefereeTest>()?;
    module.add_function(wrap_pyfunction!(picture::compare, module)?)?;
    module.add_function(wrap_pyfunction!(opened::open_with_layers, module)?)?;
    module.add_function(wrap_pyfunction!(measuring::measured, module)?)?;
    module.add_function(wrap_pyfunction!(regrouping::regroup_file, module)?)?;
    module.add_function(wrap_pyfunction!(regrouping::regroup_channels, module)?)?;
    module.add_function(wrap_pyfunction!(referee::referee_tests, module)?)?;
    module.add_function(wrap_pyfunction!(referee::referee_version, module)?)?;
    module.add_function(wrap_pyfunction!(referee::level_of_each, module)?)?;
    module.add_function(wrap_pyfunction!(task::frame_list, module)?)?;
    module.add_function(wrap_pyfunction!(tables::tables, module)?)?;
    module.add_function(wrap_pyfunction!(scene::verify, module)?)?;
    module.add_function(wrap_pyfunction!(settings::settings, module)?)?;
    module.add_function(wrap_pyfunction!(scene::builtin_scenes, module)?)?;
    Ok(())
}
