//! JUnit XML, as CI services read it (the schema of Apache Ant's JUnit task).

use std::fmt::Write;
use std::path::Path;

use super::report::{SceneReport, TestOutcome};
use crate::cli::xml::escaped;

/// The outcome of all scenes.
pub fn xml(folder: &Path, reports: &[SceneReport], seconds: f64) -> String {
    let count = |verdict: TestOutcome| reports.iter().filter(|report| report.verdict == verdict).count();
    let counts = format!(
        "tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{seconds:.3}\"",
        reports.len(),
        count(TestOutcome::Differs),
        count(TestOutcome::Failed)
    );
    let suite = escaped(&folder.display().to_string());
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(xml, "<testsuites name=\"gpt test\" {counts}>");
    let _ = writeln!(xml, "  <testsuite name=\"{suite}\" {counts}>");
    for report in reports {
        let name = escaped(&report.scene);
        let _ = writeln!(xml, "    <testcase name=\"{name}\" classname=\"{suite}\" time=\"{:.3}\">", report.seconds);
        let element = match report.verdict {
            TestOutcome::Differs => Some("failure"),
            TestOutcome::Failed => Some("error"),
            TestOutcome::Agrees | TestOutcome::Made => None,
        };
        if let Some(element) = element {
            let _ = writeln!(
                xml,
                "      <{element} message=\"{}\">{}</{element}>",
                escaped(&headline(report)),
                escaped(&details(report))
            );
        }
        let _ = writeln!(xml, "      <system-out>{}</system-out>", escaped(&report.line()));
        xml.push_str("    </testcase>\n");
    }
    xml.push_str("  </testsuite>\n</testsuites>\n");
    xml
}

fn headline(report: &SceneReport) -> String {
    let worst = report.worst().map(|worst| worst.sentence());
    worst.or_else(|| report.message.clone()).unwrap_or_else(|| "the picture differs".to_owned())
}

/// Every difference, up to a screen of them, and the commands.
fn details(report: &SceneReport) -> String {
    const MOST: usize = 40;
    let mut lines: Vec<String> = report.differences.iter().take(MOST).map(|difference| difference.sentence()).collect();
    if report.differences.len() > MOST {
        lines.push(format!("and {} more", report.differences.len() - MOST));
    }
    lines.extend(report.message.clone());
    lines.extend(report.commands.iter().cloned());
    lines.join("\n")
}
