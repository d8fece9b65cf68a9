//! The report on a scene.

use std::fmt::Write;

use gpt::compare::flip::FlipMap;
use gpt::compare::{Finding, ImageComparison, Region};
use gpt::output::Image;
use serde::Serialize;

use crate::cli::exit::Exit;

/// The outcome of a scene's test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum TestOutcome {
    Agrees,
    Differs,
    /// Its golden picture was made.
    Made,
    Failed,
}

/// One scene's test. The keys of its JSON stay as they are; new ones may be added.
#[derive(Debug, Serialize)]
pub struct SceneReport {
    pub scene: String,
    pub file: String,
    pub golden: String,
    pub verdict: TestOutcome,
    /// Sentences beside the verdict.
    pub message: Option<String>,
    pub device: Option<String>,
    pub width: u32,
    pub height: u32,
    /// Samples per pixel of the render, and of the golden picture.
    pub spp: Option<u32>,
    pub golden_spp: Option<u32>,
    /// The seed of the render; `gpt render --seed` makes the same picture.
    pub seed: Option<u32>,
    /// The change that is found in 95 of 100 tiles, and the share of tiles in which the one that was asked for is.
    pub detectable_change: Option<f64>,
    pub share_of_tiles: Option<f64>,
    /// Tiles and wholes that the first look rejected.
    pub suspects: usize,
    /// The tiles that differ.
    pub differences: Vec<Difference>,
    pub flip: Option<f64>,
    /// ꟻLIP that the noise of a render makes by itself.
    pub flip_of_noise: Option<f64>,
    /// True if the scene is not the one that the golden picture shows.
    pub scene_changed: Option<bool>,
    pub seconds: f64,
    /// Commands that repeat the test, and that make the picture.
    pub commands: Vec<String>,
    #[serde(skip)]
    pub failure: Option<Exit>,
    #[serde(skip)]
    pub pictures: Option<TestPictures>,
}

/// The pictures on the page.
#[derive(Debug)]
pub struct TestPictures {
    pub golden: Image,
    pub now: Image,
    pub tiles: ImageComparison,
    pub flip: FlipMap,
}

/// A region whose energy is another.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Difference {
    pub region: Region,
    pub channel: &'static str,
    pub golden: f64,
    pub now: f64,
    pub standard_error: f64,
    pub p_value: f64,
}

impl From<&Finding> for Difference {
    fn from(finding: &Finding) -> Self {
        Self {
            region: finding.region,
            channel: ["red", "green", "blue"][finding.channel],
            golden: finding.first,
            now: finding.second,
            standard_error: finding.standard_error,
            p_value: finding.test.p_value,
        }
    }
}

impl Difference {
    /// The difference in a sentence for people.
    pub fn sentence(&self) -> String {
        let Region { x, y, width, height } = self.region;
        let change =
            if self.golden == 0.0 { String::new() } else { format!(" ({:+.2} %)", 100.0 * (self.now / self.golden - 1.0)) };
        format!(
            "{width}x{height} pixels at {x},{y}, {}: {:.5} instead of {:.5}{change}, {}",
            self.channel,
            self.now,
            self.golden,
            probability(self.p_value)
        )
    }
}

/// A p-value in words; the smallest are beyond what can be computed.
fn probability(p_value: f64) -> String {
    if p_value < 1e-100 { "p < 1e-100".to_owned() } else { format!("p = {p_value:.1e}") }
}

impl SceneReport {
    /// The exit code of what went wrong.
    pub fn failed_with(&self) -> Option<Exit> {
        self.failure
    }

    /// True if a person asked for the end.
    pub fn is_interrupted(&self) -> bool {
        self.failure == Some(Exit::Interrupted)
    }

    /// The difference that is least likely chance.
    pub fn worst(&self) -> Option<&Difference> {
        self.differences.iter().min_by(|a, b| a.p_value.total_cmp(&b.p_value))
    }

    /// The text at the terminal: a line, and one more where something differs.
    pub fn line(&self) -> String {
        let mut line = match self.verdict {
            TestOutcome::Agrees => format!("{}: agrees", self.scene),
            TestOutcome::Differs => format!("{}: DIFFERS", self.scene),
            TestOutcome::Made => format!("{}: golden picture made", self.scene),
            TestOutcome::Failed => format!("{}: FAILED", self.scene),
        };
        let facts = self.facts();
        if !facts.is_empty() {
            let _ = write!(line, " ({})", facts.join("; "));
        }
        line.push('\n');
        if let Some(worst) = self.worst() {
            let places = self.differences.len();
            let places = if places == 1 { "one place".to_owned() } else { format!("{places} places") };
            let _ = writeln!(line, "  in {places}, most surely {}", worst.sentence());
        }
        if let Some(message) = &self.message {
            let _ = writeln!(line, "  {message}");
        }
        if self.verdict == TestOutcome::Differs {
            for command in &self.commands {
                let _ = writeln!(line, "  {command}");
            }
        }
        line
    }

    /// Numbers in words.
    pub fn facts(&self) -> Vec<String> {
        let mut facts = Vec::new();
        if let Some(spp) = self.spp {
            let golden = self.golden_spp.map_or_else(String::new, |golden| format!(" against {golden}"));
            facts.push(format!("{spp} spp{golden}"));
        }
        if let Some(change) = self.detectable_change {
            facts.push(format!("finds {:.2} % of a tile's energy", 100.0 * change));
        }
        if let Some(flip) = self.flip {
            let noise = self.flip_of_noise.map_or_else(String::new, |noise| format!(", {noise:.4} by noise alone"));
            facts.push(format!("ꟻLIP {flip:.4}{noise}"));
        }
        if self.verdict == TestOutcome::Agrees && self.suspects > 0 {
            facts.push(format!("a second look cleared {} of chance", self.suspects));
        }
        if self.scene_changed == Some(true) {
            facts.push("the scene is another than when the golden picture was made".to_owned());
        }
        facts
    }
}
