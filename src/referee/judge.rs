//! Judges a renderer's pictures of a scene by the true one. Means of tiles are judged by how pixels scatter about the truth; two pictures, with random
//! numbers of their own, tell faults of single pixels from noise.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use super::picture::TruthPicture;
use super::replay::PARTS;
use crate::compare::{
    Finding, ImageComparison, ImageView, Moments, Region, Scatter, TestResult, TileSettings, compare_measured, sidak,
};

/// Pixels along the side of a tile.
const TILE: u32 = 8;
/// Share of a value that renderers may be off by rounding, in half floats for instance, and by approximations that nobody sees.
pub const MARGIN: f64 = 1e-3;
/// Rounding of a pixel beside bright ones, as a share of the picture's mean.
const ROUNDING: f64 = 1e-6;
/// Probability with which a stated change is found.
pub const POWER: f64 = 0.9;

/// The verdict on a picture.
#[derive(Debug, Clone)]
pub struct Judgement {
    pub outcome: Outcome,
    /// The smallest share by which the whole picture's mean would have to be off to be found with probability [`POWER`]; None of a black picture.
    pub finds: Option<f64>,
    /// The clearest difference, where there is one.
    pub difference: Option<Difference>,
    /// Tile by tile; None of a picture that cannot be judged.
    pub compared: Option<ImageComparison>,
}

/// Agreement or not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    Agrees,
    Differs,
    /// The picture cannot be judged, for this reason.
    Unusable(String),
}

/// A difference that chance does not explain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    pub region: Region,
    /// 0, 1, 2: red, green, blue.
    pub channel: usize,
    pub of: DifferenceOf,
    /// Means over the region.
    pub truth: f64,
    pub found: f64,
    /// The mean, or the root mean square over the pixels, is off by at least this, in radiance, with the confidence of the suite.
    pub at_least: f64,
    pub p_value: f64,
}

/// The thing that differs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DifferenceOf {
    /// The mean of a region.
    Means,
    /// Single pixels, whose deviations cancel each other in means.
    Pixels,
}

impl Difference {
    /// The smallest difference as a share of the truth; None where that is black.
    pub fn at_least_share(&self) -> Option<f64> {
        (self.truth != 0.0).then(|| self.at_least / self.truth.abs())
    }

    /// The channel in a word.
    pub fn channel_name(&self) -> &'static str {
        ["red", "green", "blue"][self.channel]
    }

    /// A clause on how far the picture is off, and where.
    pub fn sentence(&self) -> String {
        let Region { x, y, width, height } = self.region;
        let by = self.at_least_share().map_or_else(|| format!("{:.3e}", self.at_least), percent);
        let channel = self.channel_name();
        match self.of {
            DifferenceOf::Pixels => {
                format!("pixels are off by at least {by} of the mean ({channel}, root mean square); means are right")
            }
            DifferenceOf::Means => format!(
                "off by at least {by} ({channel}, {width}×{height} pixels at {x}, {y}: {:.5e}, and {:.5e} is true)",
                self.found, self.truth
            ),
        }
    }
}

impl DifferenceOf {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Means => "means",
            Self::Pixels => "pixels",
        }
    }
}

/// A share with two digits or so.
pub fn percent(share: f64) -> String {
    let value = 100.0 * share;
    let digits = if value >= 10.0 {
        0
    } else if value >= 1.0 {
        1
    } else {
        2
    };
    format!("{value:.digits$} %")
}

/// How the pictures of a test came to their random numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seeds {
    /// Each picture has its own: pictures that are equal have no noise.
    Known,
    /// Pictures that are equal may have the same.
    Unknown,
}

/// Judges pictures, row by row from the top, of this width. `level`: the probability of a false alarm of this test.
pub fn judge(truth: &TruthPicture, width: u32, pictures: &[&[[f32; 3]]], seeds: Seeds, level: f64) -> Judgement {
    let unusable =
        |reason: String| Judgement { outcome: Outcome::Unusable(reason), finds: None, difference: None, compared: None };
    if pictures.is_empty() {
        return unusable("there is none".to_owned());
    }
    for pixels in pictures {
        if width != truth.width || pixels.len() != truth.mean.len() {
            let height = pixels.len() / width.max(1) as usize;
            return unusable(format!("it has {width}×{height} pixels, not {}×{}", truth.width, truth.height));
        }
        let bad = pixels.iter().flatten().filter(|value| !value.is_finite()).count();
        if bad > 0 {
            return unusable(format!("{bad} of its numbers are not finite"));
        }
    }
    let mean = mean_of(pictures);
    let view = |pixels| ImageView { width, pixels };
    let noise = noise_of_tiles(truth, &mean);
    let of_truth: Vec<[f32; 3]> = truth.standard_errors.iter().map(|errors| errors.map(|error| error * error)).collect();
    let in_tile = f64::from(TILE * TILE);
    let scatter = [
        Scatter { variances: view(&noise), degrees_of_freedom: (in_tile - 1.0) / in_tile },
        Scatter { variances: view(&of_truth), degrees_of_freedom: f64::from(PARTS - 1) },
    ];
    // Means are one family of tests, single pixels the other.
    let family_level = sidak(level, 2);
    let settings = TileSettings { tile: TILE, alpha: family_level, relative_margin: MARGIN };
    let compared = match compare_measured([view(&truth.mean), view(&mean)], &scatter, &settings) {
        Ok(compared) => compared,
        Err(error) => return unusable(error.to_string()),
    };
    let difference = clearest(&compared).or_else(|| of_single_pixels(truth, pictures, seeds, &compared, family_level));
    let outcome = if difference.is_some() { Outcome::Differs } else { Outcome::Agrees };
    Judgement { outcome, finds: smallest_found(&compared), difference, compared: Some(compared) }
}

fn mean_of(pictures: &[&[[f32; 3]]]) -> Vec<[f32; 3]> {
    let pixel = |index: usize| {
        let sum = |channel: usize| pictures.iter().map(|picture| f64::from(picture[index][channel])).sum::<f64>();
        std::array::from_fn(|channel| (sum(channel) / pictures.len() as f64) as f32)
    };
    (0..pictures[0].len()).map(pixel).collect()
}

/// Variances of the mean's pixels: how the deviations from the truth scatter about their mean, tile by tile. A fault that varies within a tile counts as
/// noise, so that the tests of means err towards agreement.
fn noise_of_tiles(truth: &TruthPicture, mean: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let (width, height) = (truth.width as usize, truth.height as usize);
    let tile = TILE as usize;
    let floor: [f64; 3] = std::array::from_fn(|channel| {
        let sum: f64 = truth.mean.iter().map(|pixel| f64::from(pixel[channel]).abs()).sum();
        (ROUNDING * sum / truth.mean.len() as f64).powi(2)
    });
    let mut variances = vec![[0.0; 3]; mean.len()];
    for top in (0..height).step_by(tile) {
        for left in (0..width).step_by(tile) {
            let members = || {
                (top..(top + tile).min(height)).flat_map(move |y| (left..(left + tile).min(width)).map(move |x| y * width + x))
            };
            for channel in 0..3 {
                let deviation = |pixel: usize| f64::from(mean[pixel][channel]) - f64::from(truth.mean[pixel][channel]);
                let variance = members().map(deviation).collect::<Moments>().variance();
                for pixel in members() {
                    let variance = if variance.is_finite() { variance } else { 0.0 };
                    variances[pixel][channel] = variance.max(floor[channel]) as f32;
                }
            }
        }
    }
    variances
}

/// Faults that change from pixel to pixel and leave means alone: the deviations of two pictures with random numbers of their own have products whose mean
/// is 0 if there is noise alone, and the mean square of the fault otherwise. The products over all pixels are the sample of a one-sided t-test; a few bright
/// samples are in one picture only and do no harm. None of one picture, and of pictures
/// that may be equal because they have the same random numbers.
fn of_single_pixels(
    truth: &TruthPicture,
    pictures: &[&[[f32; 3]]],
    seeds: Seeds,
    compared: &ImageComparison,
    level: f64,
) -> Option<Difference> {
    let (first, second) = pictures.split_at(pictures.len() / 2);
    let are_equal = pictures.iter().all(|picture| picture == &pictures[0]);
    if first.is_empty() || (are_equal && seeds == Seeds::Unknown) {
        return None;
    }
    let [first, second] = [first, second].map(mean_of);
    let level = sidak(level, 3);
    let of_channel = |channel: usize| {
        let product = |pixel: usize| {
            let truly = f64::from(truth.mean[pixel][channel]);
            let [a, b] = [&first, &second].map(|picture| f64::from(picture[pixel][channel]) - truly);
            // Both share the error of the truth, and may be off by the margin.
            a * b - f64::from(truth.standard_errors[pixel][channel]).powi(2) - (MARGIN * truly).powi(2)
        };
        let products: Moments = (0..truth.mean.len()).map(product).collect();
        let (mean, error, degrees) = (products.mean(), products.standard_error(), products.count() as f64 - 1.0);
        // One side of a two-sided test at twice the level.
        let test = TestResult::from_deviation(mean.max(0.0), error, degrees);
        if mean <= 0.0 || test.p_value >= 2.0 * level {
            return None;
        }
        let whole = &compared.whole[channel];
        let at_least = (mean - critical(2.0 * level, degrees) * error).max(0.0).sqrt();
        let (truth, found) = (whole.first, whole.second);
        Some(Difference {
            region: whole.region,
            channel,
            of: DifferenceOf::Pixels,
            truth,
            found,
            at_least,
            p_value: 0.5 * test.p_value,
        })
    };
    (0..3).filter_map(of_channel).max_by(|a, b| a.at_least.total_cmp(&b.at_least))
}

/// Quantile of the two-sided test at this level.
fn critical(level: f64, degrees_of_freedom: f64) -> f64 {
    let share = 1.0 - 0.5 * level;
    if degrees_of_freedom.is_finite()
        && let Ok(distribution) = StudentsT::new(0.0, 1.0, degrees_of_freedom)
    {
        return distribution.inverse_cdf(share);
    }
    Normal::standard().inverse_cdf(share)
}

/// The rejected finding whose difference is certainly largest, as a share of the truth.
fn clearest(compared: &ImageComparison) -> Option<Difference> {
    let of = |finding: &Finding| {
        let is_whole = compared.whole.iter().any(|whole| whole.region == finding.region);
        let level = if is_whole { compared.whole_level } else { compared.tile_level };
        let noise = if finding.standard_error > 0.0 {
            critical(level, finding.test.degrees_of_freedom) * finding.standard_error
        } else {
            0.0
        };
        Difference {
            region: finding.region,
            channel: finding.channel,
            of: DifferenceOf::Means,
            truth: finding.first,
            found: finding.second,
            at_least: ((finding.second - finding.first).abs() - noise).max(0.0),
            p_value: finding.test.p_value,
        }
    };
    let share = |difference: &Difference| difference.at_least_share().unwrap_or(f64::INFINITY);
    compared.rejected().map(of).max_by(|a, b| share(a).total_cmp(&share(b)).then(a.at_least.total_cmp(&b.at_least)))
}

fn smallest_found(compared: &ImageComparison) -> Option<f64> {
    let of = |finding: &Finding| {
        let reach = critical(compared.whole_level, finding.test.degrees_of_freedom) + Normal::standard().inverse_cdf(POWER);
        MARGIN + reach * finding.standard_error / finding.first.abs()
    };
    let known = compared.whole.iter().filter(|finding| finding.first != 0.0);
    known.map(of).min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::random::SplitMix64;

    fn truth() -> TruthPicture {
        let mean: Vec<_> = (0..64 * 64).map(|index| [0.2 + (index % 64) as f32 / 64.0, 0.5, 1.0]).collect();
        TruthPicture { width: 64, height: 64, standard_errors: vec![[0.0; 3]; mean.len()], mean }
    }

    fn noisy(truth: &TruthPicture, factor: f32, random: &mut SplitMix64) -> Vec<[f32; 3]> {
        let mut noise = || (0..4).map(|_| random.uniform() as f32 - 0.5).sum::<f32>() * 0.05;
        truth.mean.iter().map(|pixel| pixel.map(|value| factor * value + noise())).collect()
    }

    /// Two pictures with noise of their own.
    fn two(truth: &TruthPicture, factor: f32, random: &mut SplitMix64) -> [Vec<[f32; 3]>; 2] {
        [(); 2].map(|()| noisy(truth, factor, random))
    }

    #[test]
    fn pictures_with_noise_alone_agree_and_one_percent_is_found() {
        let (truth, mut random) = (truth(), SplitMix64::new(5));
        for count in [1, 2] {
            let right = two(&truth, 1.0, &mut random);
            let right: Vec<&[_]> = right[..count].iter().map(Vec::as_slice).collect();
            let judged = judge(&truth, 64, &right, Seeds::Unknown, 1e-3);
            assert_eq!(judged.outcome, Outcome::Agrees, "{judged:?}");
            let found = judged.finds.expect("it is not black");
            assert!(found < 0.01, "{found}");
            let bright = two(&truth, 1.01, &mut random);
            let bright: Vec<&[_]> = bright[..count].iter().map(Vec::as_slice).collect();
            let difference = judge(&truth, 64, &bright, Seeds::Unknown, 1e-3).difference.expect("one percent is found");
            let share = difference.at_least_share().expect("it is not black");
            assert!(share > 0.0 && share < 0.03, "{difference:?}");
        }
    }

    #[test]
    fn false_alarms_are_as_rare_as_stated() {
        let (truth, mut random) = (truth(), SplitMix64::new(6));
        for count in [1, 2] {
            let alarms = (0..400).filter(|_| {
                let pictures = two(&truth, 1.0, &mut random);
                let pictures: Vec<&[_]> = pictures[..count].iter().map(Vec::as_slice).collect();
                judge(&truth, 64, &pictures, Seeds::Unknown, 0.05).outcome != Outcome::Agrees
            });
            let alarms = alarms.count();
            // Binomial(400, 0.05) is above 37 with probability 1e-4. The margin makes alarms rarer still.
            assert!(alarms <= 37, "{alarms} of 400");
        }
    }

    /// Edges that lie one pixel off and leave the means of tiles alone: one picture takes that for noise, two tell it apart.
    #[test]
    fn two_pictures_tell_a_fault_of_pixels_from_noise() {
        let (mut truth, mut random) = (truth(), SplitMix64::new(7));
        let mut wrong = truth.clone();
        for index in 0..64 * 64 {
            let bright = |x: usize| if x % 8 < 4 { 1.0 } else { 0.0 };
            (truth.mean[index], wrong.mean[index]) = ([bright(index); 3], [bright(index + 1); 3]);
        }
        let pictures = two(&wrong, 1.0, &mut random);
        assert_eq!(judge(&truth, 64, &[&pictures[0]], Seeds::Unknown, 1e-6).outcome, Outcome::Agrees);
        let difference = judge(&truth, 64, &[&pictures[0], &pictures[1]], Seeds::Unknown, 1e-6).difference.expect("it differs");
        // A quarter of the pixels is off by 1.
        assert!(
            difference.of == DifferenceOf::Pixels && difference.at_least > 0.4 && difference.at_least < 0.5,
            "{difference:?}"
        );
        // Pictures without noise, of which two are equal.
        let exact = [wrong.mean.as_slice(); 2];
        assert_eq!(judge(&truth, 64, &exact, Seeds::Unknown, 1e-6).outcome, Outcome::Agrees);
        assert_eq!(judge(&truth, 64, &exact, Seeds::Known, 1e-6).outcome, Outcome::Differs);
        assert_eq!(judge(&truth, 64, &[truth.mean.as_slice(); 2], Seeds::Known, 1e-6).outcome, Outcome::Agrees);
        // The control: the right picture.
        let pictures = two(&truth, 1.0, &mut random);
        assert_eq!(judge(&truth, 64, &[&pictures[0], &pictures[1]], Seeds::Unknown, 1e-3).outcome, Outcome::Agrees);
    }

    #[test]
    fn what_cannot_be_judged_is_said() {
        let truth = truth();
        let mut pixels = truth.mean.clone();
        pixels[7][1] = f32::NAN;
        assert!(
            matches!(judge(&truth, 64, &[&pixels], Seeds::Unknown, 0.01).outcome, Outcome::Unusable(reason) if reason.contains("finite"))
        );
        assert!(
            matches!(judge(&truth, 32, &[&truth.mean], Seeds::Unknown, 0.01).outcome, Outcome::Unusable(reason) if reason.contains("32×128"))
        );
        assert!(matches!(judge(&truth, 0, &[&[]], Seeds::Unknown, 0.01).outcome, Outcome::Unusable(_)));
        assert!(matches!(judge(&truth, 64, &[], Seeds::Unknown, 0.01).outcome, Outcome::Unusable(_)));
    }

    #[test]
    fn an_exact_picture_agrees_and_finds_the_margin() {
        let truth = truth();
        let judged = judge(&truth, 64, &[&truth.mean, &truth.mean], Seeds::Unknown, 0.01);
        let found = judged.finds.expect("it is not black");
        assert!(judged.outcome == Outcome::Agrees && (MARGIN..1.01 * MARGIN).contains(&found), "{found}");
    }
}
