//! Makes golden pictures.

use super::error::PictureTestError;
use super::golden::Golden;
use super::power::{Detection, NoiseOfTiles};
use super::replications::{Purpose, Replications, seed_of};
use super::settings::TestSettings;
use crate::compare::flip::{PIXELS_PER_DEGREE, flip};
use crate::output::Image;
use crate::renderer::{Observer, Renderer};

/// Renders whose mean a golden picture is. So many tell a pixel's variance to a half, and that of a tile of 64 pixels to a fifteenth; the
/// golden picture then adds an eighth to the variance of a test.
pub const REPLICATIONS: u32 = 8;
/// Samples per pixel of the first attempt.
const FIRST_SAMPLES: u32 = 4;

/// A golden picture, and what is found by it.
pub struct Blessed {
    pub golden: Golden,
    pub detection: Detection,
    /// Seconds that all renders took.
    pub seconds: f64,
    /// Samples that were not finite.
    pub non_finite_samples: u64,
}

/// Renders a golden picture: with twice the samples again and again, until the change is found that is to be. Powers of two, because points
/// that fill space evenly are best there.
///
/// # Errors
/// Errors of the device; [`PictureTestError::Interrupted`].
pub fn bless(
    renderer: &mut dyn Renderer,
    [width, height]: [u32; 2],
    (scene_hash, seed): (&str, u32),
    settings: &TestSettings,
    observer: &dyn Observer,
) -> Result<Blessed, PictureTestError> {
    let mut samples = FIRST_SAMPLES.min(settings.most_samples);
    let mut seconds = 0.0;
    loop {
        let mut renders = Replications::new(width, 0..height, samples);
        let mut first: Option<Image> = None;
        for number in 0..REPLICATIONS {
            renders.render(renderer, seed_of(seed, Purpose::Golden, number), observer)?;
            first.get_or_insert_with(|| renders.mean());
        }
        seconds += renders.seconds;
        let mean = renders.mean();
        let noise = NoiseOfTiles::new(&mean, &renders.variances_of_a_sample(), settings);
        let detection = noise.detection(samples, samples * REPLICATIONS, settings.change);
        if detection.change <= settings.change || samples >= settings.most_samples {
            // The first render is an eighth of what it is compared with, which hardly counts.
            let of_noise = first.and_then(|first| flip(&first, &mean, PIXELS_PER_DEGREE).ok()).map_or(0.0, |map| map.mean());
            let golden = Golden::of(&renders, of_noise, scene_hash.to_owned());
            return Ok(Blessed { golden, detection, seconds, non_finite_samples: renders.non_finite_samples });
        }
        samples = (2 * samples).min(settings.most_samples);
    }
}
