//! The cases of `tests/stress` at full length: `cargo bench --bench stress [-- scale|range|…]`.
//!
//! Writes the tables of docs/stress.md in place; all of them, or those that are named. `GPT_STRESS_COUNT` says how many random scenes.
//! Ends with an error where a case complains.

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/statistics/mod.rs"]
mod statistics;

use std::fmt::Write as _;
use std::path::Path;

#[path = "../tests/stress/accumulation.rs"]
mod accumulation;
#[path = "../tests/stress/checked_shaders.rs"]
mod checked_shaders;
#[path = "../tests/stress/grazing.rs"]
mod grazing;
#[path = "../tests/stress/intersections.rs"]
mod intersections;
#[path = "../tests/stress/media.rs"]
mod media;
#[path = "../tests/stress/not_finite.rs"]
mod not_finite;
#[path = "../tests/stress/random_scenes.rs"]
mod random_scenes;
#[path = "../tests/stress/range.rs"]
mod range;
#[path = "../tests/stress/scale.rs"]
mod scale;
#[path = "../tests/stress/self_intersection.rs"]
mod self_intersection;
#[path = "../tests/stress/support.rs"]
mod support;

use support::{Effort, Finding};

type Findings = fn(Effort) -> Vec<Finding>;

/// By the names of their tables on the page.
const SECTIONS: [(&str, Findings); 10] = [
    ("scale", scale::findings),
    ("intersections", intersections::findings),
    ("self-intersection", self_intersection::findings),
    ("range", range::findings),
    ("grazing", grazing::findings),
    ("media", media::findings),
    ("accumulation", accumulation::findings),
    ("not-finite", not_finite::findings),
    ("checked-shaders", checked_shaders::findings),
    ("random-scenes", random_scenes::findings),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/stress.md");
    let mut complaints = Vec::new();
    for (name, findings) in SECTIONS {
        if !wanted.is_empty() && !wanted.iter().any(|other| other == name) {
            continue;
        }
        let findings = findings(Effort::Full);
        let table = tables(&findings);
        println!("{name}\n\n{table}");
        let text = std::fs::read_to_string(&page)?;
        std::fs::write(&page, with_table(&text, name, &table)?)?;
        complaints.extend(findings.into_iter().filter_map(|finding| Some(format!("{}: {}", finding.case, finding.complaint?))));
    }
    if complaints.is_empty() { Ok(()) } else { Err(complaints.join("\n").into()) }
}

/// One table for every run of findings with the same measures.
fn tables(findings: &[Finding]) -> String {
    let names = |finding: &Finding| finding.measures.iter().map(|(name, _)| *name).collect::<Vec<_>>();
    let mut text = String::new();
    for run in findings.chunk_by(|a, b| names(a) == names(b)) {
        if !text.is_empty() {
            text.push('\n');
        }
        let columns = names(&run[0]);
        let _ = writeln!(text, "| case | {} |", columns.join(" | "));
        let _ = writeln!(text, "| --- |{}", " --- |".repeat(columns.len()));
        for finding in run {
            let values: Vec<&str> = finding.measures.iter().map(|(_, value)| value.as_str()).collect();
            let mark = if finding.complaint.is_some() { " **fails**" } else { "" };
            let _ = writeln!(text, "| {}{mark} | {} |", finding.case, values.join(" | "));
        }
    }
    text
}

/// The page with what stands between a section's two marks replaced.
fn with_table(page: &str, name: &str, table: &str) -> Result<String, String> {
    let (start, end) = (format!("<!-- {name} -->\n"), format!("<!-- end of {name} -->"));
    let missing = || format!("docs/stress.md has no marks of {name}");
    let from = page.find(&start).ok_or_else(missing)? + start.len();
    let to = from + page[from..].find(&end).ok_or_else(missing)?;
    Ok(format!("{}\n{table}\n{}", &page[..from], &page[to..]))
}
