//! The library's errors as Python's.

use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyOSError, PyValueError};
use pyo3::prelude::*;

create_exception!(gpt_pathtracer, Error, PyException, "What went wrong, in a sentence.");
create_exception!(gpt_pathtracer, SceneError, Error, "A scene, or a file that it names, is wrong; the message says where.");
create_exception!(gpt_pathtracer, DeviceError, Error, "There is no such device, it is too small for the scene, or it was lost.");

/// The exception that stands for an error.
pub fn raised(error: gpt::Error) -> PyErr {
    let message = error.to_string();
    match error {
        gpt::Error::Scene(error) => SceneError::new_err(match error.help_text() {
            Some(help) => format!("{message}; {help}"),
            None => message,
        }),
        gpt::Error::InvalidScene(_) => SceneError::new_err(message),
        gpt::Error::NoDevice(_) | gpt::Error::DoesNotFit(_) | gpt::Error::DeviceLost(_) => DeviceError::new_err(message),
        gpt::Error::Options(_) | gpt::Error::Sizes(_) => PyValueError::new_err(message),
        gpt::Error::Read { .. } | gpt::Error::Write(_) | gpt::Error::Receiver(_) => PyOSError::new_err(message),
        _ => Error::new_err(message),
    }
}
