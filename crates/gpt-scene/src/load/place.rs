//! Places at which mistakes are reported: in the text of a scene file, or in an imported file.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::error::SceneError;

/// The place of a value or of a whole entry.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// Bytes of the scene file's text, which has fewer than 2³² of them.
    Text { start: u32, end: u32 },
    /// A part of an imported file.
    Imported(Arc<Origin>),
}

/// A part of an imported file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Origin {
    /// The file as the user named it.
    pub file: String,
    /// The line, counted from 1; None in files that have no lines.
    pub line: Option<usize>,
    /// The element's name in the file, as `materials[3]`.
    pub key: String,
}

impl Place {
    /// Bytes of the text; none for what an importer has made.
    pub fn span(&self) -> Range<usize> {
        match self {
            Self::Text { start, end } => *start as usize..*end as usize,
            Self::Imported(_) => 0..0,
        }
    }
}

impl Default for Place {
    fn default() -> Self {
        Self::Text { start: 0, end: 0 }
    }
}

impl From<Range<usize>> for Place {
    fn from(span: Range<usize>) -> Self {
        let byte = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        Self::Text { start: byte(span.start), end: byte(span.end) }
    }
}

impl From<Origin> for Place {
    fn from(origin: Origin) -> Self {
        Self::Imported(Arc::new(origin))
    }
}

impl Origin {
    /// An error about this part of the file.
    pub fn error(&self, message: impl Into<String>) -> SceneError {
        let error = match self.line {
            Some(line) => SceneError::in_line(&self.file, line, message),
            None => SceneError::in_file(&self.file, message),
        };
        error.with_key(&self.key)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text { .. } => Ok(()),
            Self::Imported(origin) => origin.fmt(f),
        }
    }
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        if !self.key.is_empty() {
            write!(f, ": {}", self.key)?;
        }
        Ok(())
    }
}
