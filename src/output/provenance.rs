//! The origin of a picture, which a file's header states so that the picture can be made again.

use super::rows::Completeness;
use crate::choice::Choice;
use crate::confidence::IntervalOptions;
use crate::scene::settings::{Setting, Value, Values};
use crate::scene::{Filter, RenderSettings};

/// Everything that decides a picture's pixels, and what they were made on.
#[derive(Debug, Clone, PartialEq)]
pub struct Provenance {
    pub scene: String,
    /// Digest of the scene's content; equal for equal scenes.
    pub scene_hash: String,
    pub settings: RenderSettings,
    pub filter: Filter,
    /// Absolute index of the first sample; `settings.spp` tells how many were wanted.
    pub first_sample: u32,
    /// The relative mean squared error that was to be reached.
    pub target_error: Option<f64>,
    /// Pixels have more or fewer samples as their noise asked; numbers of samples are averages.
    pub adaptive: bool,
    /// The intervals that were stated, and what they stand on.
    pub interval: Option<IntervalOptions>,
    pub device: String,
}

/// A header entry: text, or a number that may be corrected once the render is over.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Entry {
    Text(String),
    Number(u32),
}

/// Key of the samples that the least finished pixel received.
pub(super) const SAMPLES_KEY: &str = "gpt:samples";
/// Key of 1 where every pixel received all wanted samples, else 0.
pub(super) const COMPLETE_KEY: &str = "gpt:complete";

/// Key of the region of the whole picture that a part shows: first column and row, width and height.
pub const CROP_KEY: &str = "gpt:crop";

/// Key of the layers that an EXR file has beside the picture, as they were asked for.
pub const LAYERS_KEY: &str = "gpt:layers";

/// Key of the light groups that an EXR file has as layers, in their order, with commas between them.
pub const LIGHT_GROUPS_KEY: &str = "gpt:lightGroups";

/// Key of 1 where the render was interrupted or its device lost, else 0: a time limit, say, leaves a finished picture.
pub(super) const BROKEN_OFF_KEY: &str = "gpt:brokenOff";

/// Key of the probability that all intervals of pixels hold.
pub const CONFIDENCE_KEY: &str = "gpt:confidence";
/// Keys of the ends of the interval of the picture's mean: red, green and blue.
pub const PICTURE_LOW_KEY: &str = "gpt:pictureLow";
pub const PICTURE_HIGH_KEY: &str = "gpt:pictureHigh";
/// Key of the assumption that they stand on.
pub const BASIS_KEY: &str = "gpt:intervalBy";

impl Provenance {
    /// The header's entries, for a file in which every pixel received at least `samples`.
    pub(super) fn entries(&self, samples: u32, completeness: Completeness) -> Vec<(&'static str, Entry)> {
        let settings = &self.settings;
        let text = |text: &str| Entry::Text(text.to_owned());
        let mut entries = vec![
            ("gpt:version", text(env!("CARGO_PKG_VERSION"))),
            ("gpt:scene", text(&self.scene)),
            ("gpt:sceneHash", text(&self.scene_hash)),
            ("gpt:device", text(&self.device)),
            ("gpt:filter", text(&self.filter.to_string())),
            ("gpt:firstSample", Entry::Number(self.first_sample)),
            (SAMPLES_KEY, Entry::Number(samples)),
            (COMPLETE_KEY, Entry::Number(u32::from(samples >= settings.spp))),
            (BROKEN_OFF_KEY, Entry::Number(u32::from(completeness == Completeness::BrokenOff))),
            ("gpt:adaptive", Entry::Number(u32::from(self.adaptive))),
        ];
        entries.extend(settings.values().map(|(setting, value)| (setting.header, entry(setting, value))));
        entries.extend(self.target_error.map(|target| ("gpt:targetError", Entry::Text(target.to_string()))));
        if let Some(IntervalOptions { target, confidence, of, by, .. }) = self.interval {
            entries.push((CONFIDENCE_KEY, Entry::Text(confidence.to_string())));
            entries.extend(by.map(|by| (BASIS_KEY, Entry::Text(by.name().to_owned()))));
            if let Some(target) = target {
                entries.push(("gpt:targetInterval", Entry::Text(target.to_string())));
                entries.push(("gpt:intervalOf", Entry::Text(of.name().to_owned())));
            }
        }
        entries
    }
}

/// Numbers that may need all 32 bits, as a seed may, are text, because the header's integers are signed.
fn entry(setting: &Setting, value: Value) -> Entry {
    match (setting.values, value) {
        (Values::Whole(_, most) | Values::WholeOr(_, most, _), Value::Number(number)) if i32::try_from(most).is_ok() => {
            Entry::Number(number)
        }
        _ => Entry::Text(value.to_string()),
    }
}
