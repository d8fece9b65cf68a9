//! A mistake in a scene file as people see it: the message with the lines around the mistake.

use std::fmt;

use gpt::load::SceneError;
use miette::{Diagnostic, LabeledSpan, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

/// A [`SceneError`] that miette can draw.
#[derive(Debug, thiserror::Error)]
#[error("{error}")]
pub struct SceneDiagnostic {
    error: SceneError,
    /// What else is wrong with the file.
    others: Vec<SceneDiagnostic>,
}

impl From<SceneError> for SceneDiagnostic {
    fn from(error: SceneError) -> Self {
        let others = error.others().iter().cloned().map(Self::from).collect();
        Self { error, others }
    }
}

/// Reads the excerpt that an error carries, with the name, lines and columns of the file.
impl SourceCode for SceneDiagnostic {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let excerpt = self.error.excerpt().ok_or(MietteError::OutOfBounds)?;
        let found = excerpt.text.as_str().read_span(span, lines_before, lines_after)?;
        let line = found.line() + excerpt.first_line - 1;
        // A line that is cut says where its mistake stands all the same.
        let column = match self.error.column() {
            Some(column) if self.error.line() == Some(line + 1) && found.column() > 0 => column - 1,
            _ => found.column(),
        };
        let contents = MietteSpanContents::new_named(
            self.error.file().to_owned(),
            found.data(),
            *found.span(),
            line,
            column,
            found.line_count(),
        );
        Ok(Box::new(contents.with_language("toml")))
    }
}

impl Diagnostic for SceneDiagnostic {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.error.help_text().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn Diagnostic> + 'a>> {
        if self.others.is_empty() {
            return None;
        }
        Some(Box::new(self.others.iter().map(|other| other as &dyn Diagnostic)))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.error.excerpt().map(|_| self as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.error.excerpt()?.span.clone();
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

    #[test]
    fn a_mistake_far_along_a_line_is_shown_in_few_words() {
        let long = "[0, 0, 0], ".repeat(20_000);
        let text = format!(
            "[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\nvfov = 40\n[[shape]]\ntype = \"mesh\"\npositions = [{long}[0, 0, \"\x1b[2J\"], {long}]\n"
        );
        let error = gpt::load::load_toml_str(&text, "test.toml", Path::new("")).err().map(SceneDiagnostic::from).unwrap();
        let mut report = String::new();
        let handler = miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor());
        handler.render_report(&mut report, &error).unwrap();
        assert!(report.contains("test.toml:7:220022") && report.contains("␛[2J") && report.contains('…'), "{report}");
        assert!(report.len() < 3000 && !report.contains('\x1b'), "{report}");
    }
}
