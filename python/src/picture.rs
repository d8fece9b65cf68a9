//! Pictures in memory and in files.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use gpt::film::Layer;
use gpt::output::{LayerChannel, LayerPicture, LayerSource, SAMPLE_COUNT};
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

    /// Writes a file; of an EXR file also these channels, with the layers that they belong to, and entries of the header.
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        channels: Vec<Channel>,
        layers: &str,
        notes: Vec<(String, String)>,
    ) -> PyResult<()> {
        process::check()?;
        let names = Layer::from_list(layers).unwrap_or_default();
        let size = [self.0.width(), self.0.height()];
        py.detach(|| {
            let channels = channels.into_iter().map(|channel| layer_channel(size, channel)).collect::<io::Result<_>>()?;
            self.0.save_with(path, (channels, names), notes).map_err(raised)
        })
    }
}

/// A channel's name, its numbers in single precision, row by row from the top, and whether they are whole.
type Channel = (String, Vec<u8>, bool);

fn layer_channel(size: [u32; 2], (name, bytes, is_whole): Channel) -> io::Result<LayerChannel> {
    let numbers = bytes.as_chunks::<4>().0.iter().map(|&bytes| [f32::from_ne_bytes(bytes); 3]);
    let picture = LayerPicture::new(size)?;
    picture.write_rows(0, &numbers.collect::<Vec<_>>())?;
    let picture = Arc::new(picture);
    // Numbers of samples are floating-point numbers in files of `gpt render`.
    let source =
        if is_whole && name != SAMPLE_COUNT { LayerSource::Whole(picture, 0) } else { LayerSource::Component(picture, 0) };
    Ok(LayerChannel::new(name, source))
}

/// How far a picture is from its reference, as JSON.
#[pyfunction]
pub fn compare(py: Python<'_>, picture: &Picture, reference: &Picture) -> PyResult<String> {
    let comparison = py.detach(|| gpt::compare(&picture.0, &reference.0)).map_err(raised)?;
    serde_json::to_string(&comparison).map_err(|error| PyValueError::new_err(error.to_string()))
}
