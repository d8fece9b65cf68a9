//! The referee's tests, their truths, and what it says of pictures.

use gpt::Image;
use gpt::compare::sidak;
use gpt::referee::causes::causes_of;
use gpt::referee::{Outcome, Seeds, Test, Truth, all_tests, judge, replay, suite};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::json;

use crate::array::{Array, Numbers};
use crate::errors::Error;
use crate::picture::Picture;
use crate::process;
use crate::scene::Scene;

/// A test of the suite.
#[pyclass(frozen, module = "gpt_pathtracer._native")]
pub struct RefereeTest(Test);

/// Every test, in the order of reports.
#[pyfunction]
pub fn referee_tests() -> Vec<RefereeTest> {
    all_tests().into_iter().map(RefereeTest).collect()
}

/// The version of the suite.
#[pyfunction]
pub fn referee_version() -> &'static str {
    suite::VERSION
}

/// The level of each of so many tests.
#[pyfunction]
pub fn level_of_each(false_alarms: f64, tests: usize) -> PyResult<f64> {
    let is_probability = false_alarms > 0.0 && false_alarms < 1.0;
    if is_probability { Ok(sidak(false_alarms, tests)) } else { Err(PyValueError::new_err("false_alarms: above 0 and below 1")) }
}

#[pymethods]
impl RefereeTest {
    #[getter]
    fn name(&self) -> &str {
        self.0.name
    }

    #[getter]
    fn about(&self) -> &str {
        self.0.about
    }

    #[getter]
    fn decides(&self) -> &str {
        self.0.decides
    }

    #[getter]
    fn mistakes(&self) -> Vec<&str> {
        self.0.variants.iter().map(|variant| variant.cause).collect()
    }

    #[getter]
    fn size(&self) -> (u32, u32) {
        self.0.size().into()
    }

    #[getter]
    fn is_formula(&self) -> bool {
        matches!(self.0.truth, Truth::Formula(_))
    }

    #[getter]
    fn text(&self) -> &str {
        &self.0.scene
    }

    /// Names and contents of the files that the text names.
    fn files<'py>(&self, py: Python<'py>) -> Vec<(&str, Bound<'py, PyBytes>)> {
        self.0.files.iter().map(|file| (file.name, PyBytes::new(py, &file.bytes))).collect()
    }

    /// The scene, read.
    fn scene(&self, py: Python<'_>) -> PyResult<Scene> {
        process::check()?;
        let read = || {
            let folder = tempfile::tempdir()?;
            replay::load_scene(self.0.name, &self.0.scene, &self.0.files, folder.path())
        };
        py.detach(read).map(Scene::from).map_err(|error: replay::ReplayError| Error::new_err(error.to_string()))
    }

    /// The true picture, and the standard errors of its pixels.
    fn truth(&self, py: Python<'_>) -> PyResult<(Array, Array)> {
        process::check()?;
        let truth = py.detach(|| self.0.true_picture()).map_err(Error::new_err)?;
        let shape = vec![truth.height as usize, truth.width as usize, 3];
        let array = |pixels: Vec<[f32; 3]>| Array { numbers: Numbers::Single(pixels.into_flattened()), shape: shape.clone() };
        Ok((array(truth.mean), array(truth.standard_errors)))
    }

    /// The verdict on pictures, as JSON. `known_seeds`: each has random numbers of its own, even where they are equal.
    fn judge(&self, py: Python<'_>, pictures: Vec<PyRef<'_, Picture>>, known_seeds: bool, level: f64) -> PyResult<String> {
        process::check()?;
        let images: Vec<&Image> = pictures.iter().map(|picture| &picture.0).collect();
        let (Some(first), true) = (images.first(), level > 0.0 && level < 1.0) else {
            return Err(PyValueError::new_err("there is a picture at least, and a level above 0 and below 1"));
        };
        let width = first.width();
        if let Some(other) = images.iter().find(|image| image.width() != width || image.height() != first.height()) {
            let sizes = [*first, *other].map(|image| format!("{}x{}", image.width(), image.height())).join(" and ");
            return Err(PyValueError::new_err(format!("the pictures of a test have one size, not {sizes}")));
        }
        let views: Vec<&[[f32; 3]]> = images.iter().map(|image| image.pixels()).collect();
        let seeds = if known_seeds { Seeds::Known } else { Seeds::Unknown };
        py.detach(|| judged(&self.0, (width, &views), seeds, level)).map_err(Error::new_err)
    }
}

fn judged(test: &Test, (width, views): (u32, &[&[[f32; 3]]]), seeds: Seeds, level: f64) -> Result<String, String> {
    let truth = test.true_picture()?;
    let judgement = judge(&truth, width, views, seeds, level);
    let (verdict, reason, looks_like) = match &judgement.outcome {
        Outcome::Agrees => ("agrees", None, Vec::new()),
        Outcome::Differs => {
            let causes = causes_of(test, &truth, (width, views), (seeds, level));
            ("differs", None, causes.map_err(|error| error.to_string())?)
        }
        Outcome::Unusable(reason) => ("failed", Some(format!("its picture cannot be judged: {reason}")), Vec::new()),
    };
    let difference = judgement.difference.as_ref().map(|difference| {
        json!({
            "region": difference.region,
            "channel": difference.channel_name(),
            "of": difference.of.name(),
            "truth": difference.truth,
            "found": difference.found,
            "at_least": difference.at_least,
            "p_value": difference.p_value,
            "sentence": difference.sentence(),
        })
    });
    Ok(json!({
        "name": test.name,
        "verdict": verdict,
        "reason": reason,
        "finds": judgement.finds,
        "at_least": judgement.difference.as_ref().and_then(|difference| difference.at_least_share()),
        "difference": difference,
        "looks_like": looks_like,
    })
    .to_string())
}
