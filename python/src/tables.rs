//! The text of a scene file as Python's dictionaries and lists.

use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use toml::Value;

/// The tables of a text.
#[pyfunction]
pub fn tables<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    let table: toml::Table = text.parse().map_err(|error: toml::de::Error| PyValueError::new_err(error.to_string()))?;
    of(py, &Value::Table(table))
}

fn of<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::String(text) => text.into_bound_py_any(py),
        Value::Integer(number) => number.into_bound_py_any(py),
        Value::Float(number) => number.into_bound_py_any(py),
        Value::Boolean(flag) => flag.into_bound_py_any(py),
        Value::Datetime(date) => date.to_string().into_bound_py_any(py),
        Value::Array(values) => {
            let values = values.iter().map(|value| of(py, value)).collect::<PyResult<Vec<_>>>()?;
            Ok(PyList::new(py, values)?.into_any())
        }
        Value::Table(table) => {
            let dictionary = PyDict::new(py);
            for (key, value) in table {
                dictionary.set_item(key, of(py, value)?)?;
            }
            Ok(dictionary.into_any())
        }
    }
}
