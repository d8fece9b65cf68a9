//! Numbers as they are written.

use super::plugin::error_at;
use crate::load::error::SceneError;
use crate::load::place::Origin;

/// A finite number.
pub fn parse_number(place: &Origin, text: &str) -> Result<f64, SceneError> {
    let number: Option<f64> = text.trim().trim_end_matches('f').parse().ok();
    number.filter(|number| number.is_finite()).ok_or_else(|| error_at(place, format!("expected a number, found `{text}`")))
}
