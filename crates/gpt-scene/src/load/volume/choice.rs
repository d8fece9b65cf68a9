//! The grid of a file that is meant, or the reason why there is none.

use std::fmt;

/// The grid that is read of a file with several, where none is named: most programs call a medium's density so.
const USUAL_NAME: &str = "density";

/// The reason why a file gives no grid.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum VolumeError {
    /// A sentence about what is wrong with the file.
    Unreadable(String),
    /// The name that was asked for, and those that the file has.
    NoSuchGrid { wanted: String, names: Vec<String> },
    /// The names of its grids, none of which was asked for.
    WhichGrid { names: Vec<String> },
}

impl From<String> for VolumeError {
    fn from(sentence: String) -> Self {
        Self::Unreadable(sentence)
    }
}

impl fmt::Display for VolumeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(sentence) => f.write_str(sentence),
            Self::NoSuchGrid { wanted, .. } => write!(f, "it has no grid named `{wanted}`"),
            Self::WhichGrid { names } => write!(f, "it has {} grids, and the key `grid` does not say which", names.len()),
        }
    }
}

/// The place of the grid to read among the names of a file's.
pub fn choose(names: &[String], wanted: Option<&str>) -> Result<usize, VolumeError> {
    if names.is_empty() {
        return Err("it has no grids".to_owned().into());
    }
    let named = |wanted: &str| names.iter().position(|name| name == wanted);
    match wanted {
        Some(wanted) => named(wanted).ok_or_else(|| VolumeError::NoSuchGrid { wanted: wanted.to_owned(), names: names.to_vec() }),
        None if names.len() == 1 => Ok(0),
        None => named(USUAL_NAME).ok_or_else(|| VolumeError::WhichGrid { names: names.to_vec() }),
    }
}

/// The complaint about values that no medium has, with what is likely the cause.
pub fn with_cause(reason: String, is_level_set: bool) -> VolumeError {
    if is_level_set {
        let cause = "its grid is a level set, of distances from a surface, and not a density; the program that made it can turn it into a fog volume";
        return format!("{reason}: {cause}").into();
    }
    reason.into()
}
