//! Reasons why there is no plan.

use crate::renderer::RenderError;

/// A scene that cannot be planned for a device.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// Needs and limits are part of the message.
    #[error("{0}")]
    DoesNotFit(String),
    /// The request contradicts itself: a fault of this program.
    #[error("{0}")]
    Internal(String),
}

impl From<PlanError> for RenderError {
    fn from(error: PlanError) -> Self {
        match error {
            PlanError::DoesNotFit(message) => Self::DoesNotFit(message),
            PlanError::Internal(message) => Self::Internal(message),
        }
    }
}
