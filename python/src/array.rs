//! Numbers that numpy reads where they are.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Numbers of one type.
pub enum Numbers {
    Single(Vec<f32>),
    Whole(Vec<u32>),
}

/// Rows and columns of numbers, or of a few numbers each. `numpy.asarray` makes a read-only array of it that shares its memory and keeps it alive.
#[pyclass(frozen, module = "gpt_pathtracer._native")]
pub struct Array {
    pub numbers: Numbers,
    pub shape: Vec<usize>,
}

#[pymethods]
impl Array {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        match &self.numbers {
            Numbers::Single(numbers) => interface(py, "f4", numbers.as_ptr() as usize, &self.shape),
            Numbers::Whole(numbers) => interface(py, "u4", numbers.as_ptr() as usize, &self.shape),
        }
    }
}

/// numpy's array interface, version 3, of numbers that neither move nor change as long as the object that gives them is there.
pub fn interface<'py>(py: Python<'py>, number: &str, address: usize, shape: &[usize]) -> PyResult<Bound<'py, PyDict>> {
    let order = if cfg!(target_endian = "little") { '<' } else { '>' };
    let dictionary = PyDict::new(py);
    dictionary.set_item("version", 3)?;
    dictionary.set_item("typestr", format!("{order}{number}"))?;
    dictionary.set_item("shape", PyTuple::new(py, shape)?)?;
    // True: nothing may be written there.
    dictionary.set_item("data", (address, true))?;
    Ok(dictionary)
}
