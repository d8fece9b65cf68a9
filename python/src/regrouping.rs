//! Light groups of pictures in files and in memory, weighed anew.

use std::path::PathBuf;

use gpt::choice::Choice;
use gpt::output::{Channels, LAYERS_KEY};
use gpt::regroup::{GroupWeight, GroupedPicture, RegroupError};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use serde_json::json;

use crate::process;
use crate::task::{Finished, Rendered};

/// A channel's name and its numbers in single precision, row by row from the top.
type Channel = (String, Vec<u8>);

/// The picture of a file with its groups weighed so.
#[pyfunction]
pub fn regroup_file(py: Python<'_>, path: PathBuf, weights: Vec<String>) -> PyResult<Rendered> {
    process::check()?;
    let regrouped = py.detach(|| weighed(|| GroupedPicture::read(&path), &weights));
    regrouped.map_err(|error| failure(&format!("{}: ", path.display()), error))?.rendered(py)
}

/// A picture in memory with its groups weighed so: its size, its channels, the layers that they belong to, and what its header says.
#[pyfunction]
pub fn regroup_channels(
    py: Python<'_>,
    size: (u32, u32),
    channels: Vec<Channel>,
    layers: String,
    notes: Vec<(String, String)>,
    weights: Vec<String>,
) -> PyResult<Rendered> {
    let numbers = |bytes: Vec<u8>| bytes.as_chunks::<4>().0.iter().map(|&bytes| f32::from_ne_bytes(bytes)).collect();
    let channels = channels.into_iter().map(|(name, bytes)| (name, numbers(bytes)));
    let header = notes.into_iter().chain([(LAYERS_KEY.to_owned(), layers)]);
    let channels = Channels::of_memory([size.0, size.1], channels, header);
    let channels = channels.ok_or_else(|| PyValueError::new_err("layers have the size of their picture"))?;
    py.detach(|| weighed(|| GroupedPicture::of_memory(channels), &weights)).map_err(|error| failure("", error))?.rendered(py)
}

enum Failure {
    /// A weight that cannot be read.
    Weight(String),
    Regroup(RegroupError),
}

fn weighed(picture: impl FnOnce() -> Result<GroupedPicture, RegroupError>, weights: &[String]) -> Result<Finished, Failure> {
    let weights: Vec<GroupWeight> = weights.iter().map(|text| text.parse()).collect::<Result<_, _>>().map_err(Failure::Weight)?;
    let grouped = picture().map_err(Failure::Regroup)?;
    let regrouped = grouped.weighed(&weights).map_err(Failure::Regroup)?;
    let of_group = |GroupWeight { group, weight }: &GroupWeight| (group.clone(), json!(weight));
    let by: serde_json::Map<String, serde_json::Value> = weights.iter().map(of_group).collect();
    let left_out: Vec<&str> = regrouped.dropped.iter().map(|layer| layer.name()).collect();
    let stats = json!({ "regrouped": by, "left_out": left_out });
    let gpt::output::Image { width, height, pixels } = regrouped.picture;
    let no_pixel = || Failure::Weight("the picture has no pixel".to_owned());
    Ok(Finished {
        image: gpt::Image::from_pixels(width, height, pixels).ok_or_else(no_pixel)?,
        channels: regrouped.layers,
        layers: regrouped.layer_names,
        groups: grouped.names_of_groups().to_vec(),
        notes: regrouped.header,
        stats: Ok(stats.to_string()),
    })
}

fn failure(place: &str, failure: Failure) -> PyErr {
    match failure {
        Failure::Weight(what) => PyValueError::new_err(what),
        Failure::Regroup(error @ (RegroupError::Read(_) | RegroupError::Temporary(_))) => PyOSError::new_err(error.to_string()),
        Failure::Regroup(error) => PyValueError::new_err(format!("{place}{error}")),
    }
}
