//! The page that shows true pictures beside a renderer's.

use gpt::compare::flip::{FlipMap, PIXELS_PER_DEGREE, flip};

use super::report::{TestReport, Verdict, counts};
use crate::cli::bench::command;
use crate::cli::difference_page::{self, PicturePair, Section, Tone};

/// Tests that differ first.
pub fn page(renderer: &str, reports: &[TestReport], false_alarms: f64) -> String {
    let mut sorted: Vec<&TestReport> = reports.iter().collect();
    sorted.sort_by_key(|report| match report.verdict {
        Verdict::Differs => 0,
        Verdict::Failed => 1,
        Verdict::Excepted => 2,
        Verdict::Agrees => 3,
        Verdict::NotSupported => 4,
    });
    let maps: Vec<Option<FlipMap>> = sorted
        .iter()
        .map(|report| report.shown.as_ref().and_then(|shown| flip(&shown.found, &shown.truth, PIXELS_PER_DEGREE).ok()))
        .collect();
    let sections: Vec<Section> = sorted.iter().zip(&maps).map(|(report, map)| section(report, map.as_ref())).collect();
    let method = format!(
        "{}. A right renderer is said to differ in any test with a probability of {} at most; the share that would have been found is \
         found with a probability of 90 %. Suite {}.",
        counts(reports),
        false_alarms,
        gpt::referee::suite::VERSION
    );
    difference_page::page(&format!("gpt referee: {renderer}"), &command(), &method, &sections)
}

fn section<'a>(report: &'a TestReport, map: Option<&'a FlipMap>) -> Section<'a> {
    let mut facts = vec![report.about.to_owned(), format!("Decides: {}", report.decides)];
    facts.extend(Some(report.detail()).filter(|detail| !detail.is_empty()));
    facts.extend(report.looks_like.iter().skip(1).map(|cause| format!("It also looks like {cause}")));
    let findings = report.difference.iter().map(|difference| (difference.region, difference.sentence().to_owned())).collect();
    Section {
        title: report.name.to_owned(),
        verdict: report.verdict.words().to_owned(),
        tone: if report.verdict == Verdict::NotSupported { Tone::Grey } else { Tone::of(report.verdict.is_wrong()) },
        facts,
        findings,
        commands: Vec::new(),
        shown: report.shown.as_ref().zip(map).map(|(shown, flip)| PicturePair {
            labels: ["truth", "found"],
            images: [&shown.truth, &shown.found],
            tiles: &shown.tiles,
            flip,
        }),
    }
}
