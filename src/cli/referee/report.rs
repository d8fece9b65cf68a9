//! The report of each test.

use gpt::compare::ImageComparison;
use gpt::output::Image;
use gpt::referee::judge::percent;
use gpt::referee::{Difference, Judgement, Outcome, Test};
use serde::Serialize;

/// The verdict on one test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    Agrees,
    Differs,
    /// The renderer gave no picture that can be judged.
    Failed,
    /// The form of the scene cannot say what is tested.
    NotSupported,
    /// A difference or a failure that is known and meant.
    Excepted,
}

impl Verdict {
    pub const ALL: [Self; 5] = [Self::Agrees, Self::Differs, Self::Failed, Self::NotSupported, Self::Excepted];

    pub fn words(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Differs => "differs",
            Self::Failed => "failed",
            Self::NotSupported => "not supported",
            Self::Excepted => "excepted",
        }
    }

    /// The renderer is wrong.
    pub fn is_wrong(self) -> bool {
        matches!(self, Self::Differs | Self::Failed)
    }
}

/// The report of one test.
#[derive(Serialize)]
pub struct TestReport {
    pub name: &'static str,
    pub about: &'static str,
    pub decides: &'static str,
    pub verdict: Verdict,
    /// Why it failed, is not supported or is excepted.
    pub reason: Option<String>,
    /// The smallest change of the picture's mean that would have been found with a probability of 90 %, as a share.
    pub finds: Option<f64>,
    /// The renderer is off by at least this share somewhere.
    pub at_least: Option<f64>,
    pub difference: Option<DifferenceReport>,
    /// Mistakes whose picture is the renderer's, the nearest first.
    pub looks_like: Vec<String>,
    pub seconds: f64,
    #[serde(skip)]
    pub shown: Option<Shown>,
}

/// The clearest difference.
#[derive(Serialize)]
pub struct DifferenceReport {
    pub region: gpt::compare::Region,
    pub channel: &'static str,
    /// `means` of the region, or single `pixels`.
    pub of: &'static str,
    pub truth: f64,
    pub found: f64,
    /// In radiance.
    pub at_least: f64,
    pub p_value: f64,
    #[serde(skip)]
    sentence: String,
}

/// Pictures for a page.
pub struct Shown {
    pub truth: Image,
    pub found: Image,
    pub tiles: ImageComparison,
}

impl TestReport {
    pub fn new(test: &Test) -> Self {
        Self {
            name: test.name,
            about: test.about,
            decides: test.decides,
            verdict: Verdict::Failed,
            reason: None,
            finds: None,
            at_least: None,
            difference: None,
            looks_like: Vec::new(),
            seconds: 0.0,
            shown: None,
        }
    }

    /// Takes in what the judge says.
    pub fn judged(&mut self, judgement: &Judgement) {
        self.finds = judgement.finds;
        self.verdict = match &judgement.outcome {
            Outcome::Agrees => Verdict::Agrees,
            Outcome::Differs => Verdict::Differs,
            Outcome::Unusable(reason) => {
                self.reason = Some(format!("its picture cannot be judged: {reason}"));
                Verdict::Failed
            }
        };
        self.at_least = judgement.difference.as_ref().and_then(Difference::at_least_share);
        self.difference = judgement.difference.as_ref().map(|difference| DifferenceReport {
            region: difference.region,
            channel: difference.channel_name(),
            of: difference.of.name(),
            truth: difference.truth,
            found: difference.found,
            at_least: difference.at_least,
            p_value: difference.p_value,
            sentence: difference.sentence(),
        });
    }

    /// One line.
    pub fn line(&self) -> String {
        let mut line = format!("{:<14} {}", self.verdict.words(), self.name);
        let detail = self.detail();
        if !detail.is_empty() {
            line += ": ";
            line += &detail;
        }
        line
    }

    /// The rest of the line, beyond the verdict.
    pub fn detail(&self) -> String {
        let mut parts = Vec::new();
        match (self.verdict, self.finds) {
            (Verdict::Agrees, Some(finds)) => parts.push(format!("{} off would have been found", percent(finds))),
            (Verdict::Agrees, None) => parts.push("black, as it should be".to_owned()),
            _ => {}
        }
        if let Some(difference) = &self.difference {
            parts.push(difference.sentence().to_owned());
        }
        if let Some(cause) = self.looks_like.first() {
            parts.push(format!("looks like {cause}"));
        }
        parts.extend(self.reason.clone());
        parts.join("; ")
    }
}

impl DifferenceReport {
    pub fn sentence(&self) -> &str {
        &self.sentence
    }
}

/// How many tests have each verdict, in words.
pub fn counts(reports: &[TestReport]) -> String {
    let of = |verdict: Verdict| reports.iter().filter(|report| report.verdict == verdict).count();
    let parts = Verdict::ALL.iter().filter(|&&verdict| of(verdict) > 0);
    parts.map(|&verdict| format!("{} {}", of(verdict), plural(verdict, of(verdict)))).collect::<Vec<_>>().join(", ")
}

fn plural(verdict: Verdict, count: usize) -> &'static str {
    match (verdict, count) {
        (Verdict::Agrees, 2..) => "agree",
        (Verdict::Differs, 2..) => "differ",
        _ => verdict.words(),
    }
}
