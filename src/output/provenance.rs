//! Where a picture comes from: what a file's header says so that the picture can be made again.

use crate::scene::{Filter, RenderSettings, setting_name};

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

impl Provenance {
    /// The header's entries, for a file in which every pixel received at least `samples`.
    pub(super) fn entries(&self, samples: u32) -> Vec<(&'static str, Entry)> {
        let settings = &self.settings;
        let text = |text: &str| Entry::Text(text.to_owned());
        let mut entries = vec![
            ("gpt:version", text(env!("CARGO_PKG_VERSION"))),
            ("gpt:scene", text(&self.scene)),
            ("gpt:sceneHash", text(&self.scene_hash)),
            ("gpt:device", text(&self.device)),
            ("gpt:filter", text(&self.filter.to_string())),
            ("gpt:sampler", text(&setting_name(settings.sampler))),
            ("gpt:pixelSampler", text(&settings.pixel_sampler.name(settings.sampler))),
            ("gpt:estimator", text(&setting_name(settings.estimator))),
            ("gpt:heuristic", text(&setting_name(settings.heuristic))),
            ("gpt:hemisphere", text(&setting_name(settings.hemisphere))),
            ("gpt:lightSamples", Entry::Number(settings.light_samples)),
            ("gpt:lightSamplesDepth", Entry::Number(settings.light_samples_depth)),
            // As text, because a seed may need all 32 bits and the header's integers are signed.
            ("gpt:seed", Entry::Text(settings.seed.to_string())),
            ("gpt:maxDepth", Entry::Number(settings.max_depth)),
            ("gpt:rouletteDepth", Entry::Number(settings.roulette_depth)),
            ("gpt:firstSample", Entry::Number(self.first_sample)),
            ("gpt:samplesWanted", Entry::Number(settings.spp)),
            (SAMPLES_KEY, Entry::Number(samples)),
            (COMPLETE_KEY, Entry::Number(u32::from(samples >= settings.spp))),
            ("gpt:adaptive", Entry::Number(u32::from(self.adaptive))),
        ];
        entries.extend(self.target_error.map(|target| ("gpt:targetError", Entry::Text(target.to_string()))));
        entries
    }
}
