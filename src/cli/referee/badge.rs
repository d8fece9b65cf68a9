//! A badge: how many tests a renderer agrees with.

use super::report::{TestReport, Verdict};
use crate::cli::xml::escaped;

/// Width of a character of the badge's font, about.
const CHARACTER: usize = 7;

/// An SVG of one line.
pub fn svg(reports: &[TestReport]) -> String {
    let agree = reports.iter().filter(|report| report.verdict == Verdict::Agrees).count();
    let judged = reports.iter().filter(|report| report.verdict != Verdict::NotSupported).count();
    let is_wrong = reports.iter().any(|report| report.verdict.is_wrong());
    let (left, right) = ("gpt referee".to_owned(), format!("{agree} of {judged} agree"));
    let colour = match (is_wrong, 10 * agree >= 9 * judged) {
        (false, _) => "#2e7d32",
        (true, true) => "#b58900",
        (true, false) => "#b3261e",
    };
    let widths = [&left, &right].map(|text| text.chars().count() * CHARACTER + 12);
    let total = widths[0] + widths[1];
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{total}\" height=\"20\" role=\"img\" aria-label=\"{left}: {right}\">\n\
         <rect width=\"{total}\" height=\"20\" rx=\"3\" fill=\"{colour}\"/>\n\
         <path d=\"M3 0h{}v20H3a3 3 0 0 1-3-3V3a3 3 0 0 1 3-3z\" fill=\"#444\"/>\n\
         <g fill=\"#fff\" text-anchor=\"middle\" font-family=\"Verdana, DejaVu Sans, sans-serif\" font-size=\"11\">\n\
         <text x=\"{}\" y=\"14\">{}</text>\n<text x=\"{}\" y=\"14\">{}</text>\n</g>\n</svg>\n",
        widths[0] - 3,
        widths[0] / 2,
        escaped(&left),
        widths[0] + widths[1] / 2,
        escaped(&right)
    )
}
