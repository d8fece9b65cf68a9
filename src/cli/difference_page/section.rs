//! The content of a page.

use gpt::compare::flip::FlipMap;
use gpt::compare::{ImageComparison, Region};
use gpt::output::Image;

/// The section of one pair of pictures.
pub struct Section<'a> {
    pub title: String,
    pub verdict: String,
    pub tone: Tone,
    pub facts: Vec<String>,
    /// Regions that differ, each with a sentence.
    pub findings: Vec<(Region, String)>,
    /// Commands that repeat it.
    pub commands: Vec<String>,
    /// None where there are no two pictures.
    pub shown: Option<PicturePair<'a>>,
}

/// The colour of a verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    Green,
    Red,
    /// Nothing was judged.
    Grey,
}

impl Tone {
    /// Red where something is wrong, green elsewhere.
    pub fn of(is_wrong: bool) -> Self {
        if is_wrong { Self::Red } else { Self::Green }
    }
}

/// Two pictures of one size.
pub struct PicturePair<'a> {
    /// The pictures' names; the first is the one that the second is compared with.
    pub labels: [&'static str; 2],
    pub images: [&'a Image; 2],
    pub tiles: &'a ImageComparison,
    pub flip: &'a FlipMap,
}
