//! The outcome as JUnit XML, as CI services read it.

use std::fmt::Write;

use super::report::{TestReport, Verdict};
use crate::cli::xml::escaped;

/// The outcome of all tests of a renderer.
pub fn xml(renderer: &str, reports: &[TestReport], seconds: f64) -> String {
    let count = |verdict: Verdict| reports.iter().filter(|report| report.verdict == verdict).count();
    let counts = format!(
        "tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{seconds:.3}\"",
        reports.len(),
        count(Verdict::Differs),
        count(Verdict::Failed),
        count(Verdict::NotSupported) + count(Verdict::Excepted)
    );
    let suite = escaped(renderer);
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(xml, "<testsuites name=\"gpt referee\" {counts}>");
    let _ = writeln!(xml, "  <testsuite name=\"{suite}\" {counts}>");
    for report in reports {
        let (family, name) = report.name.split_once('/').unwrap_or(("", report.name));
        let _ = writeln!(xml, "    <testcase name=\"{name}\" classname=\"{suite}.{family}\" time=\"{:.3}\">", report.seconds);
        let element = match report.verdict {
            Verdict::Differs => Some("failure"),
            Verdict::Failed => Some("error"),
            Verdict::NotSupported | Verdict::Excepted => Some("skipped"),
            Verdict::Agrees => None,
        };
        if let Some(element) = element {
            let text = format!("{}\n{}\nDecides: {}", report.detail(), report.about, report.decides);
            let _ = writeln!(xml, "      <{element} message=\"{}\">{}</{element}>", escaped(&report.detail()), escaped(&text));
        }
        xml.push_str("    </testcase>\n");
    }
    xml.push_str("  </testsuite>\n</testsuites>\n");
    xml
}
