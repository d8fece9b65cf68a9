//! Exit codes and the errors that lead to them.

use std::path::PathBuf;
use std::process::ExitCode;

use gpt::bench::subject::BenchError;
use gpt::compare::SizeMismatch;
use gpt::load::SceneError;
use gpt::merge::MergeError;
use gpt::output::{OutputError, ReadError};
use gpt::render::checkpoint::CheckpointError;
use gpt::renderer::RenderError;

/// The outcome of a run; other programs rely on the numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    Done = 0,
    OtherFailure = 1,
    Usage = 2,
    /// A scene or another input file is wrong.
    Input = 3,
    /// No usable device, or the scene does not fit it.
    Device = 4,
    /// The device was lost, or memory ran out once the render had begun: another try may go on.
    DeviceLost = 5,
    /// Samples that are not finite, with `--strict`.
    NonFinite = 6,
    /// `compare`, `test` or `verify` found a difference.
    Difference = 7,
    /// The run was interrupted, and its samples are saved.
    Interrupted = 130,
}

impl Exit {
    const ALL: [Self; 9] = [
        Self::Done,
        Self::OtherFailure,
        Self::Usage,
        Self::Input,
        Self::Device,
        Self::DeviceLost,
        Self::NonFinite,
        Self::Difference,
        Self::Interrupted,
    ];

    fn meaning(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::OtherFailure => "another failure",
            Self::Usage => "the command line is wrong",
            Self::Input => "the scene or another input file is wrong",
            Self::Device => "there is no usable device, or the scene does not fit it",
            Self::DeviceLost => "the device was lost, or memory ran out midway; what was rendered is saved as far as it could be",
            Self::NonFinite => "samples were not finite, with --strict",
            Self::Difference => "compare, referee, test or verify found a difference",
            Self::Interrupted => "interrupted; what was rendered is saved",
        }
    }

    /// Every number with its meaning, for help.
    pub fn list() -> String {
        let rows = Self::ALL.map(|exit| format!("{:>5}  {}", exit as u8, exit.meaning()));
        format!("Exit codes:\n{}", rows.join("\n"))
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// Everything that ends a command with one error message.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    #[error("{message}")]
    Usage { message: String, help: Option<String> },
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Picture(#[from] ReadError),
    #[error(transparent)]
    Sizes(#[from] SizeMismatch),
    #[error("{0}")]
    BadScene(String),
    #[error(transparent)]
    Render(#[from] RenderError),
    #[error(transparent)]
    Output(#[from] OutputError),
    /// Several files, each with its reason.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Outputs(Vec<OutputError>),
    #[error(transparent)]
    Merge(MergeError),
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    #[error("interrupted before anything could be said; nothing is saved")]
    Interrupted,
    #[error("interrupted; {} has the state, and --resume goes on from it", .0.display())]
    InterruptedWithState(PathBuf),
    #[error("{0}")]
    Other(String),
}

impl Failure {
    /// A usage error without further advice.
    pub fn usage(message: impl Into<String>) -> Self {
        Self::Usage { message: message.into(), help: None }
    }
}

impl From<BenchError> for Failure {
    fn from(error: BenchError) -> Self {
        match error {
            BenchError::Render(error) => Self::Render(error),
            BenchError::Picture(error) => Self::Picture(error),
            BenchError::Sizes(error) => Self::Sizes(error),
            BenchError::Output(error) => Self::Output(error),
            BenchError::Scene(error) => error.into(),
            BenchError::Denoiser(error) => error.into(),
            BenchError::UnsuitableReference(message) => Self::BadScene(message),
            BenchError::Internal(message) => Self::Other(message),
            BenchError::Interrupted => Self::Interrupted,
        }
    }
}

impl From<gpt::Error> for Failure {
    fn from(error: gpt::Error) -> Self {
        match error {
            gpt::Error::Scene(error) => Self::Scene(error),
            gpt::Error::InvalidScene(message) => Self::BadScene(message),
            gpt::Error::Options(message) => Self::usage(message),
            gpt::Error::NoDevice(message) => Self::Render(RenderError::NoDevice(message)),
            gpt::Error::DoesNotFit(message) => Self::Render(RenderError::DoesNotFit(message)),
            gpt::Error::DeviceLost(message) => Self::Render(RenderError::DeviceLost(message)),
            other => Self::Other(other.to_string()),
        }
    }
}

impl From<&Failure> for Exit {
    fn from(failure: &Failure) -> Self {
        match failure {
            Failure::Usage { .. } => Self::Usage,
            Failure::Scene(_)
            | Failure::Picture(_)
            | Failure::Sizes(_)
            | Failure::BadScene(_)
            | Failure::Checkpoint(_)
            | Failure::Merge(_) => Self::Input,
            Failure::Render(RenderError::InvalidScene(_)) => Self::Input,
            Failure::Render(RenderError::NoDevice(_) | RenderError::DoesNotFit(_)) => Self::Device,
            Failure::Render(RenderError::DeviceLost(_)) => Self::DeviceLost,
            Failure::Render(RenderError::Internal(_) | RenderError::Output(_)) => Self::OtherFailure,
            Failure::Output(OutputError::Input { .. }) => Self::Usage,
            Failure::Outputs(all) if all.iter().all(|one| matches!(one, OutputError::Input { .. })) => Self::Usage,
            Failure::Output(_) | Failure::Outputs(_) | Failure::Other(_) => Self::OtherFailure,
            Failure::Interrupted | Failure::InterruptedWithState(_) => Self::Interrupted,
        }
    }
}

#[cfg(test)]
mod tests {
    use gpt::scene::InvalidScene;

    use super::*;

    #[test]
    fn render_errors_have_the_contracts_numbers() {
        let code = |error: RenderError| Exit::from(&Failure::from(error)) as u8;
        assert_eq!(code(RenderError::Internal(String::new())), 1);
        assert_eq!(code(RenderError::Output(std::io::Error::other("full"))), 1);
        let invalid = InvalidScene { part: String::new(), message: String::new() };
        assert_eq!(code(RenderError::InvalidScene(invalid)), 3);
        assert_eq!(code(RenderError::NoDevice(String::new())), 4);
        assert_eq!(code(RenderError::DoesNotFit(String::new())), 4);
        assert_eq!(code(RenderError::DeviceLost(String::new())), 5);
    }

    #[test]
    fn other_errors_have_the_contracts_numbers() {
        assert_eq!(Exit::from(&Failure::usage("x")) as u8, 2);
        assert_eq!(Exit::from(&Failure::from(SizeMismatch { sizes: [[1, 1], [2, 2]] })) as u8, 3);
        assert_eq!(Exit::from(&Failure::BadScene(String::new())) as u8, 3);
        let write = OutputError::BadTarget { path: "a".into(), what: "b" };
        assert_eq!(Exit::from(&Failure::from(write)) as u8, 1);
        assert_eq!(Exit::from(&Failure::from(BenchError::Interrupted)) as u8, 130);
        assert_eq!(Exit::from(&Failure::from(BenchError::UnsuitableReference(String::new()))) as u8, 3);
        let numbers = [Exit::Done, Exit::NonFinite, Exit::Difference, Exit::Interrupted].map(|exit| exit as u8);
        assert_eq!(numbers, [0, 6, 7, 130]);
    }
}
