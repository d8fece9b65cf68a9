//! Numbers that numpy reads where they are.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Rows, columns and channels of numbers in single precision. `numpy.asarray` makes a read-only array of it that shares its memory and keeps it alive.
#[pyclass(frozen, module = "gpt_pathtracer")]
pub struct Array {
    pub numbers: Vec<f32>,
    pub shape: Vec<usize>,
}

#[pymethods]
impl Array {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        interface(py, self.numbers.as_ptr(), &self.shape)
    }
}

/// numpy's array interface, version 3, of numbers that neither move nor change as long as the object that gives them is there.
pub fn interface<'py>(py: Python<'py>, first: *const f32, shape: &[usize]) -> PyResult<Bound<'py, PyDict>> {
    let dictionary = PyDict::new(py);
    dictionary.set_item("version", 3)?;
    dictionary.set_item("typestr", if cfg!(target_endian = "little") { "<f4" } else { ">f4" })?;
    dictionary.set_item("shape", PyTuple::new(py, shape)?)?;
    // True: nothing may be written there.
    dictionary.set_item("data", (first as usize, true))?;
    Ok(dictionary)
}
