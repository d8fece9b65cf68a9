//! Commands as a shell reads them.

use std::path::Path;

/// An argument in quotation marks where it needs them.
pub fn quoted(argument: &str) -> String {
    let plain = !argument.is_empty() && argument.chars().all(|c| c.is_alphanumeric() || "-_./,=:".contains(c));
    if plain { argument.to_owned() } else { format!("'{}'", argument.replace('\'', "'\\''")) }
}

/// As [`quoted`], of a path.
pub fn quoted_path(path: &Path) -> String {
    quoted(&path.to_string_lossy())
}
