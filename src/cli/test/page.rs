//! The page that shows what a test found.

use super::report::{SceneReport, TestOutcome};
use crate::cli::bench::command;
use crate::cli::difference_page::{self, PicturePair, Section, Tone};
use crate::cli::test_arguments::TestArguments;

/// Scenes that differ first.
pub fn page(arguments: &TestArguments, reports: &[SceneReport]) -> String {
    let mut sorted: Vec<&SceneReport> = reports.iter().collect();
    sorted.sort_by_key(|report| match report.verdict {
        TestOutcome::Differs => 0,
        TestOutcome::Failed => 1,
        TestOutcome::Made | TestOutcome::Agrees => 2,
    });
    let sections: Vec<Section> = sorted.into_iter().map(section).collect();
    let share = |share: f64| format!("{} %", 100.0 * share);
    let method = format!(
        "A change of {} of the energy of a tile of {}×{} pixels is found with a probability of {}; a run finds a difference where there is \
         none with a probability of {} at most.",
        share(arguments.change),
        arguments.tile,
        arguments.tile,
        share(arguments.power),
        share(arguments.false_alarms)
    );
    difference_page::page("gpt test", &command(), &method, &sections)
}

fn section(report: &SceneReport) -> Section<'_> {
    let (verdict, is_red) = match report.verdict {
        TestOutcome::Agrees => ("agrees", false),
        TestOutcome::Differs => ("differs", true),
        TestOutcome::Made => ("golden picture made", false),
        TestOutcome::Failed => ("could not be tested", true),
    };
    let mut facts = report.facts();
    facts.extend(report.device.clone());
    facts.extend(report.message.clone());
    Section {
        title: report.scene.clone(),
        verdict: verdict.to_owned(),
        tone: Tone::of(is_red),
        facts,
        findings: report.differences.iter().map(|difference| (difference.region, difference.sentence())).collect(),
        commands: report.commands.clone(),
        shown: report.pictures.as_ref().map(|pictures| PicturePair {
            labels: ["golden", "now"],
            images: [&pictures.golden, &pictures.now],
            tiles: &pictures.tiles,
            flip: &pictures.flip,
        }),
    }
}
