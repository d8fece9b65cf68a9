//! Pictures in memory and in files.

use std::path::PathBuf;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::interface;
use crate::errors::raised;
use crate::process;

/// A picture: linear radiance, rendered, read or made of numbers.
#[pyclass(frozen, module = "gpt_pathtracer._native")]
pub struct Picture(pub gpt::Image);

#[pymethods]
impl Picture {
    /// Reads a file.
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        process::check()?;
        py.detach(|| gpt::Image::open(path)).map(Self).map_err(raised)
    }

    /// Of the bytes of numbers in single precision, row by row from the top.
    #[staticmethod]
    fn from_bytes(width: u32, height: u32, bytes: &[u8]) -> PyResult<Self> {
        let (pixels, rest) = bytes.as_chunks::<12>();
        let number = |pixel: &[u8; 12], channel: usize| {
            f32::from_ne_bytes([pixel[4 * channel], pixel[4 * channel + 1], pixel[4 * channel + 2], pixel[4 * channel + 3]])
        };
        let pixels: Vec<[f32; 3]> = pixels.iter().map(|pixel| [0, 1, 2].map(|channel| number(pixel, channel))).collect();
        let image = if rest.is_empty() { gpt::Image::from_pixels(width, height, pixels) } else { None };
        image.map(Self).ok_or_else(|| PyValueError::new_err("a picture has rows, columns, and three channels"))
    }

    /// Properties of its pixels that the file states and nothing uses.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings().to_vec()
    }

    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let shape = [self.0.height() as usize, self.0.width() as usize, 3];
        interface(py, "f4", self.0.pixels().as_ptr() as usize, &shape)
    }

    /// Writes a file.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        process::check()?;
        py.detach(|| self.0.save(path)).map_err(raised)
    }
}

/// How far a picture is from its reference, as JSON.
#[pyfunction]
pub fn compare(py: Python<'_>, picture: &Picture, reference: &Picture) -> PyResult<String> {
    let comparison = py.detach(|| gpt::compare(&picture.0, &reference.0)).map_err(raised)?;
    serde_json::to_string(&comparison).map_err(|error| PyValueError::new_err(error.to_string()))
}
