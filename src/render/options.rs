//! The options of a render beside the scene.

use std::borrow::Cow;
use std::time::Duration;

use super::progressive::STREAMS;
use crate::confidence::options::FEWEST_SAMPLES;
use crate::confidence::{IntervalBasis, IntervalOptions};
use crate::error::Error;
use crate::plan::PlanOptions;
use crate::reference::sample_bound::sample_bound;
use crate::renderer::DeviceChoice;
use crate::scene::Scene;
use crate::scene::settings::MOST_SAMPLES;

/// Why some pictures cannot be rendered in parts.
pub const PARTS_OF_STRATA: &str = "the samplers `stratified` and `hammersley` lay out points for all samples of a picture, so parts of them would not add \
     up to the whole; the other samplers' do";

/// How a scene is rendered. The default renders what the scene says on the best device there is.
///
/// How light is estimated is part of the scene: see [`Scene::render`](crate::Scene#structfield.render).
///
/// A render that ends after ten seconds at most, sooner if its relative mean squared error is below 0.001:
///
/// ```no_run
/// use std::time::Duration;
///
/// use gpt::Render;
///
/// let options = gpt::RenderOptions {
///     size: Some([640, 480]),
///     samples: Some(4096),
///     time_limit: Some(Duration::from_secs(10)),
///     target_error: Some(0.001),
///     ..Default::default()
/// };
/// let image = gpt::Scene::load("cornell")?.render(&options)?;
/// let outcome = image.outcome().expect("it was rendered");
/// println!("ended by {:?}, {:?}", outcome.stop, outcome.error);
/// # Ok::<(), gpt::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct RenderOptions {
    /// Which device renders.
    pub device: DeviceChoice,
    /// Samples per pixel, in place of the scene's; with `target_error`, at most so many.
    pub samples: Option<u32>,
    /// Absolute index of the first sample. Samples 0 to 127 and 128 to 255 together are those of one render with 256.
    pub first_sample: u32,
    /// The region of the picture that is rendered: first column and row, width and height. Its pixels are those of the whole picture.
    pub crop: Option<[u32; 4]>,
    /// Width and height in pixels, in place of the scene's.
    pub size: Option<[u32; 2]>,
    /// Key of every random number, in place of the scene's.
    pub seed: Option<u32>,
    /// No work begins that would end later than this after the render's start. The picture is whole, with fewer samples.
    pub time_limit: Option<Duration>,
    /// The render ends once the picture's relative mean squared error, as what was sampled shows it and with a margin for chance, is below this.
    pub target_error: Option<f64>,
    /// Noisy pixels get more samples and calm ones fewer, the given number on average. The estimate stays unbiased.
    pub adaptive: bool,
    /// Intervals that hold the truth, and how narrow they are to become. Samples are independent of each other then.
    pub interval: Option<IntervalOptions>,
    /// Choices that are made in place of the plan.
    #[doc(hidden)]
    pub plan: PlanOptions,
}

impl RenderOptions {
    /// The options of the plan.
    pub(super) fn plan_options(&self) -> PlanOptions {
        // A region of some columns leaves pixels out.
        let pixel_list = self.adaptive || self.crop.is_some();
        PlanOptions { pixel_list, most_film_pixels: self.most_film_pixels(), time_limit: self.time_limit, ..self.plan.clone() }
    }

    /// How many pixels of the film are kept at a time, where that is bounded: of a region about as many as it has, or so few that they do not matter. A
    /// narrow one is rendered in bands, lest whole rows of a wide film be kept for it.
    #[doc(hidden)]
    pub fn most_film_pixels(&self) -> Option<u64> {
        const FEW: u64 = 1 << 20;
        self.crop.map(|[_, _, width, height]| (u64::from(width) * u64::from(height)).max(FEW))
    }

    /// The scene as these options want it.
    ///
    /// # Errors
    /// [`Error::Options`] where they are out of range or contradict each other.
    pub(super) fn applied<'a>(&self, scene: &'a Scene) -> Result<Cow<'a, Scene>, Error> {
        let mut scene = Cow::Borrowed(scene);
        if let Some(size) = self.size {
            scene.to_mut().film.size = size;
        }
        if let Some(samples) = self.samples {
            scene.to_mut().render.spp = samples;
        }
        if let Some(seed) = self.seed {
            scene.to_mut().render.seed = seed;
        }
        if let Some(interval) = &self.interval {
            interval.apply(&mut scene.to_mut().render);
        }
        match self.contradiction(&scene) {
            Some(message) => Err(Error::Options(message)),
            None => Ok(scene),
        }
    }

    /// A contradiction between the options, in a sentence.
    #[doc(hidden)]
    pub fn contradiction(&self, scene: &Scene) -> Option<String> {
        if let Err(bad) = scene.film.check() {
            return Some(bad.to_string());
        }
        let samples = scene.render.spp;
        if samples == 0 || self.first_sample.checked_add(samples).is_none_or(|end| end > MOST_SAMPLES) {
            return Some(format!(
                "{samples} samples per pixel from sample {} on cannot be rendered: there is at least one, and all indices are below \
                 {MOST_SAMPLES}",
                self.first_sample
            ));
        }
        if self.first_sample > 0 && (self.adaptive || self.target_error.is_some()) {
            return Some("first_sample belongs to renders with a fixed number of samples".to_owned());
        }
        if self.first_sample > 0 && scene.render.uses_strata() {
            return Some(PARTS_OF_STRATA.to_owned());
        }
        if let Some(crop) = self.crop {
            if self.adaptive || self.target_error.is_some() || self.time_limit.is_some() {
                return Some("crop belongs to renders with a fixed number of samples".to_owned());
            }
            if !fits(crop, scene.film.size) {
                let ([x, y, columns, rows], [width, height]) = (crop, scene.film.size);
                return Some(format!(
                    "the region {x},{y},{columns},{rows} does not lie within the picture of {width}x{height} pixels"
                ));
            }
        }
        if let Some(interval) = &self.interval
            && let Some(message) = self.contradiction_of_interval(interval, scene)
        {
            return Some(message);
        }
        let target = self.target_error?;
        if !(target.is_finite() && target > 0.0) {
            return Some(format!("target_error is a number above 0, not {target}"));
        }
        let least = 2 * STREAMS;
        (samples < least).then(|| format!("target_error needs at least {least} samples per pixel; {samples} are allowed"))
    }

    /// A contradiction between intervals and the rest, in a sentence.
    fn contradiction_of_interval(&self, interval: &IntervalOptions, scene: &Scene) -> Option<String> {
        if self.first_sample > 0 || self.crop.is_some() || self.adaptive || self.target_error.is_some() {
            return Some("intervals belong to renders of the whole picture by one number of samples".to_owned());
        }
        if scene.render.spp < FEWEST_SAMPLES {
            return Some(format!("intervals need at least {FEWEST_SAMPLES} samples per pixel; {} are allowed", scene.render.spp));
        }
        let bound = (interval.by == Some(IntervalBasis::Bound)).then(|| sample_bound(scene));
        let unbounded = bound.and_then(Result::err).map(|why| format!("intervals by a bound: samples have none, because {why}"));
        interval.mistake().or(unbounded)
    }
}

/// True if a region has pixels, all of them in the picture.
#[doc(hidden)]
pub fn fits([x, y, columns, rows]: [u32; 4], [width, height]: [u32; 2]) -> bool {
    let ends_within = |start: u32, length: u32, end: u32| length > 0 && start.checked_add(length).is_some_and(|last| last <= end);
    ends_within(x, columns, width) && ends_within(y, rows, height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SamplerKind;

    #[test]
    fn options_replace_what_the_scene_says() {
        let scene = Scene::default();
        let options = RenderOptions { samples: Some(7), size: Some([3, 4]), seed: Some(5), ..RenderOptions::default() };
        let applied = options.applied(&scene).unwrap();
        assert_eq!((applied.render.spp, applied.film.size, applied.render.seed), (7, [3, 4], 5));
        let applied = RenderOptions::default();
        let untouched = applied.applied(&scene).unwrap();
        assert!(matches!(untouched, Cow::Borrowed(_)));
    }

    #[test]
    fn contradictions_are_refused() {
        let default = RenderOptions::default;
        let bad = [
            RenderOptions { samples: Some(0), ..default() },
            RenderOptions { size: Some([0, 5]), ..default() },
            RenderOptions { size: Some([100_000, 1]), ..default() },
            RenderOptions { first_sample: MOST_SAMPLES, ..default() },
            RenderOptions { first_sample: 1, adaptive: true, ..default() },
            RenderOptions { first_sample: 1, target_error: Some(0.1), ..default() },
            RenderOptions { target_error: Some(0.0), ..default() },
            RenderOptions { crop: Some([0, 0, 0, 5]), ..default() },
            RenderOptions { crop: Some([500, 0, 13, 5]), ..default() },
            RenderOptions { crop: Some([u32::MAX, 0, 2, 5]), ..default() },
            RenderOptions { crop: Some([0, 0, 5, 5]), adaptive: true, ..default() },
            RenderOptions { target_error: Some(f64::NAN), ..default() },
            RenderOptions { target_error: Some(0.1), samples: Some(2 * STREAMS - 1), ..default() },
        ];
        for options in bad {
            assert!(matches!(options.applied(&Scene::default()), Err(Error::Options(_))), "{options:?}");
        }
        let good = RenderOptions { target_error: Some(0.1), samples: Some(2 * STREAMS), ..default() };
        assert!(good.applied(&Scene::default()).is_ok());
        let mut strata = Scene::default();
        strata.render.sampler = SamplerKind::Stratified;
        assert!(RenderOptions { first_sample: 1, ..default() }.applied(&strata).is_err());
        assert!(
            default().applied(&strata).is_ok()
                && RenderOptions { first_sample: 1, ..default() }.applied(&Scene::default()).is_ok()
        );
    }
}
