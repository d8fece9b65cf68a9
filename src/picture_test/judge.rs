//! Is a scene's picture what its golden picture is?

use super::bless::REPLICATIONS;
use super::error::PictureTestError;
use super::golden::Golden;
use super::power::{Detection, NoiseOfTiles};
use super::replications::{Purpose, Replications, seed_of};
use super::settings::TestSettings;
use crate::compare::{Finding, ImageComparison, ImageView, Region, Scatter, TestResult, TileSettings, compare_measured, sidak};
use crate::output::Image;
use crate::renderer::{Observer, Renderer};

/// The result of a test.
pub struct Judgement {
    /// The change that the render of the first look is able to find.
    pub detection: Detection,
    /// Seed of the first look.
    pub seed: u32,
    /// The first look at every tile.
    pub first_look: ImageComparison,
    /// Findings that both looks rejected: the differences. Regions of whole pictures come first.
    pub differences: Vec<Finding>,
    /// Number of findings that the first look rejected.
    pub suspects: usize,
    /// The best picture of the scene as it renders now.
    pub picture: Image,
    /// Seconds that all renders took.
    pub seconds: f64,
    /// Samples that were not finite.
    pub non_finite_samples: u64,
    /// The device as people call it.
    pub device: String,
}

/// Renders the scene and holds it against its golden picture, which has its size.
///
/// # Errors
/// Errors of the device; a golden picture of another size; [`PictureTestError::Interrupted`].
pub fn judge(
    renderer: &mut dyn Renderer,
    golden: &Golden,
    seed: u32,
    settings: &TestSettings,
    observer: &dyn Observer,
) -> Result<Judgement, PictureTestError> {
    let Image { width, height, .. } = golden.mean;
    let (samples, detection) = samples_of_test(golden, settings);
    let seed_of_look = seed_of(seed, Purpose::Screening, 0);
    let mut render = Replications::new(width, 0..height, samples);
    render.render(renderer, seed_of_look, observer)?;
    let mut picture = render.mean();
    let first_look = screen(golden, &picture, samples, settings)?;
    let rejected: Vec<Finding> = first_look.rejected().copied().collect();
    let (mut differences, mut seconds, mut non_finite_samples) = (Vec::new(), render.seconds, render.non_finite_samples);
    if !rejected.is_empty() {
        let rows = rows_of(&rejected);
        let mut again = Replications::new(width, rows.clone(), samples);
        for number in 0..REPLICATIONS {
            again.render(renderer, seed_of(seed, Purpose::Confirmation, number), observer)?;
        }
        differences = confirm(golden, &again, &rejected, settings);
        seconds += again.seconds;
        non_finite_samples += again.non_finite_samples;
        let start = rows.start as usize * width as usize;
        let better = again.mean().pixels;
        picture.pixels[start..start + better.len()].copy_from_slice(&better);
    }
    let device = render.device;
    let suspects = rejected.len();
    Ok(Judgement {
        detection,
        seed: seed_of_look,
        first_look,
        differences,
        suspects,
        picture,
        seconds,
        non_finite_samples,
        device,
    })
}

/// Samples per pixel of the first look, and what they find: as many as each render of the golden picture had, or more where a smaller change
/// is to be found than it was made for.
pub fn samples_of_test(golden: &Golden, settings: &TestSettings) -> (u32, Detection) {
    let noise = NoiseOfTiles::new(&golden.mean, &golden.variances, settings);
    let least = golden.samples_of_one().unwrap_or(1);
    let needed = noise.fewest_samples(settings.change, golden.samples).unwrap_or(f64::from(settings.most_samples));
    let power_of_two = (needed.ceil().min(f64::from(settings.most_samples)) as u32).next_power_of_two();
    let found_by_least = noise.detection(least, golden.samples, settings.change).change <= settings.change;
    let samples = if found_by_least { least } else { power_of_two.min(settings.most_samples).max(least) };
    (samples, noise.detection(samples, golden.samples, settings.change))
}

/// The first look: tiles and the whole of a render against the golden picture, whose noise is that of the render too.
///
/// # Errors
/// Pictures of different sizes.
pub fn screen(
    golden: &Golden,
    picture: &Image,
    samples: u32,
    settings: &TestSettings,
) -> Result<ImageComparison, PictureTestError> {
    let variances = golden.variances_against(samples);
    let scatter = [Scatter { variances: of_pixels(&variances, picture), degrees_of_freedom: golden.degrees_of_freedom() }];
    compare_measured([of_image(&golden.mean), of_image(picture)], &scatter, &tile_settings(settings))
        .map_err(|error| PictureTestError::Unsuitable(format!("the golden picture: {error}")))
}

/// The second look, at what the first rejected: renders whose own noise is measured, whatever it is. The level is corrected for as many tests as
/// there are left.
fn confirm(golden: &Golden, again: &Replications, rejected: &[Finding], settings: &TestSettings) -> Vec<Finding> {
    let level = sidak(settings.false_alarms, rejected.len());
    let (own, theirs) = (golden.own_variances(), again.variances());
    let (mean, degrees) = (again.mean(), f64::from(again.count() - 1));
    let width = golden.mean.width as usize;
    let before = again.rows.start as usize * width;
    let judged = rejected.iter().map(|finding| {
        let Finding { region, channel, .. } = *finding;
        let (mut first, mut second, mut variance, mut spread, mut count) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for pixel in pixels_of(region, width) {
            let (a, b) = (f64::from(own[pixel][channel]), f64::from(theirs[pixel - before][channel]));
            first += f64::from(golden.mean.pixels[pixel][channel]);
            second += f64::from(mean.pixels[pixel - before][channel]);
            variance += a + b;
            spread += a * a / golden.degrees_of_freedom() + b * b / degrees;
            count += 1.0;
        }
        (first, second) = (first / count, second / count);
        let standard_error = variance.sqrt() / count;
        // Welch and Satterthwaite, over the pixels of the region.
        let degrees_of_freedom = if spread == 0.0 { f64::INFINITY } else { variance * variance / spread };
        let margin = tile_settings(settings).relative_margin * first.abs().max(second.abs());
        let test = TestResult::beyond_margin(first - second, margin, standard_error, degrees_of_freedom);
        Finding { region, channel, first, second, standard_error, test }
    });
    judged.filter(|finding| finding.test.p_value < level).collect()
}

/// How tiles are tested.
pub fn tile_settings(settings: &TestSettings) -> TileSettings {
    TileSettings { tile: settings.tile, alpha: settings.false_alarms, ..TileSettings::default() }
}

fn of_image(image: &Image) -> ImageView<'_> {
    of_pixels(&image.pixels, image)
}

fn of_pixels<'a>(pixels: &'a [[f32; 3]], image: &Image) -> ImageView<'a> {
    ImageView { width: image.width, pixels }
}

/// The rows that findings are about.
fn rows_of(findings: &[Finding]) -> std::ops::Range<u32> {
    let start = findings.iter().map(|finding| finding.region.y).min().unwrap_or(0);
    let end = findings.iter().map(|finding| finding.region.y + finding.region.height).max().unwrap_or(0);
    start..end
}

fn pixels_of(region: Region, width: usize) -> impl Iterator<Item = usize> {
    let columns = region.x as usize..(region.x + region.width) as usize;
    (region.y as usize..(region.y + region.height) as usize).flat_map(move |y| columns.clone().map(move |x| y * width + x))
}
