//! A mistake in a scene file as people see it: the message with the lines around the mistake.

use std::fmt;

use gpt::load::SceneError;
use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};

/// A [`SceneError`] that miette can draw.
#[derive(Debug, thiserror::Error)]
#[error("{error}")]
pub struct SceneDiagnostic {
    error: SceneError,
    /// The text with its name, where there is one to show.
    source_code: Option<NamedSource<String>>,
}

impl From<SceneError> for SceneDiagnostic {
    fn from(error: SceneError) -> Self {
        let named = |(text, _): (&str, _)| NamedSource::new(error.file(), text.to_owned()).with_language("toml");
        Self { source_code: error.snippet().map(named), error }
    }
}

impl Diagnostic for SceneDiagnostic {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.error.help_text().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source_code.as_ref().map(|source| source as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let (_, span) = self.error.snippet()?;
        Some(Box::new(std::iter::once(LabeledSpan::new_with_span(Some("here".to_owned()), span))))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn the_line_of_the_mistake_is_shown() {
        let text = "[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\nvfov = -1\n";
        let error = gpt::load::load_toml_str(text, "test.toml", Path::new("")).err().map(SceneDiagnostic::from).unwrap();
        let mut report = String::new();
        let handler = miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor());
        handler.render_report(&mut report, &error).unwrap();
        assert!(report.contains("vfov = -1") && report.contains("test.toml:4:8") && report.contains("here"), "{report}");
    }
}
