//! A test whether two pictures show the same: one per tile and colour channel, and one of the whole picture
//! per channel.
//!
//! Three situations, three tests:
//!
//! - [`compare_paired`]: both pictures were made from the **same random numbers**, as by the GPU and the CPU. Pixel values differ only
//!   by rounding and by the few paths that took another turn, so the pixels' differences are the sample and Student's t the test. It is by far
//!   the sharpest. Treating such pictures as independent would count their common noise twice and find next to nothing.
//! - [`compare_independent`]: the pictures share **no** random numbers, and each pixel's variance is known. A z-test. It presumes that
//!   pixels are independent of each other, and so are their samples (the `independent` sampler). For stratified points
//!   such as Halton's the samples' variance overstates the error: the test then errs towards agreement.
//! - [`compare_replications`]: several renders of each picture, every one with a seed of its own. Welch's t on each tile's
//!   means. Right for every sampler and every correlation between pixels, at the price of rendering k times; with few
//!   replications t has heavy tails, so take at least 8 of each.
//! - [`compare_measured`]: as the second, with variances of the pixels' means that were measured, each from few replications. Student's t,
//!   with Satterthwaite's degrees of freedom over the pixels of a tile; a tile whose noise is that of one pixel has that pixel's few.
//!
//! All levels are corrected by Šidák: tiles and channels are one family, the channels of the whole picture another, and the two share α evenly.

use super::hypothesis::TestResult;
use super::hypothesis::{sidak, welch_t_test};
use super::moments::Moments;

/// A picture's pixels, row by row from the top: linear RGB.
#[derive(Debug, Clone, Copy)]
pub struct ImageView<'a> {
    pub width: u32,
    pub pixels: &'a [[f32; 3]],
}

/// How finely and how strictly to test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileSettings {
    /// About this many pixels along a tile's side; tiles are made equal in size as far as possible.
    pub tile: u32,
    /// Probability of rejecting two pictures that agree.
    pub alpha: f64,
    /// Differences of means up to this share of the larger one are not judged: rounding, which is systematic.
    pub relative_margin: f64,
}

impl Default for TileSettings {
    /// 32-pixel tiles, α = 0.01, and a margin of 10⁻⁴: a hundredth of the energy error the tests must find.
    fn default() -> Self {
        Self { tile: 32, alpha: 0.01, relative_margin: 1e-4 }
    }
}

/// A rectangle of pixels, counted from the top left.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Region {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

/// The result of the test of one region and channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finding {
    pub region: Region,
    /// 0, 1, 2: red, green, blue.
    pub channel: usize,
    /// Means over the region.
    pub first: f64,
    pub second: f64,
    /// Standard error of the means' difference.
    pub standard_error: f64,
    pub test: TestResult,
}

/// Why two pictures cannot be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ComparisonError {
    #[error("the pictures differ in size or are empty")]
    Sizes,
    #[error("at least two replications of each picture are needed, to know their scatter")]
    Replications,
}

/// The verdict on two pictures.
#[derive(Debug, Clone)]
pub struct ImageComparison {
    /// Every tile in every channel.
    pub tiles: Vec<Finding>,
    /// The whole picture, per channel.
    pub whole: [Finding; 3],
    /// The p-value below which a tile is rejected.
    pub tile_level: f64,
    /// The p-value below which the whole picture is.
    pub whole_level: f64,
}

impl ImageComparison {
    /// No tile and no channel is rejected.
    pub fn agrees(&self) -> bool {
        self.rejected().next().is_none()
    }

    /// The findings no chance explains: first of the whole picture, then of its tiles.
    pub fn rejected(&self) -> impl Iterator<Item = &Finding> {
        let whole = self.whole.iter().filter(|finding| finding.test.p_value < self.whole_level);
        whole.chain(self.tiles.iter().filter(|finding| finding.test.p_value < self.tile_level))
    }

    /// The least likely of the tiles.
    pub fn worst_tile(&self) -> Option<&Finding> {
        self.tiles.iter().min_by(|a, b| a.test.p_value.total_cmp(&b.test.p_value))
    }
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Region { x, y, width, height } = self.region;
        let channel = ["red", "green", "blue"][self.channel];
        write!(
            f,
            "{width}×{height} pixels at ({x}, {y}), {channel}: {:.6e} against {:.6e}, standard error of the difference {:.1e}, p = {:.1e}",
            self.first, self.second, self.standard_error, self.test.p_value
        )
    }
}

/// Means of a region in both pictures, and how sure their difference is.
struct Estimate {
    first: f64,
    second: f64,
    standard_error: f64,
    degrees_of_freedom: f64,
}

/// Compares two pictures made from the same random numbers. The pixels of a region are the sample, so a region of a single pixel is
/// judged by the margin alone.
pub fn compare_paired(first: ImageView, second: ImageView, settings: &TileSettings) -> Result<ImageComparison, ComparisonError> {
    paired(first, second, None, settings)
}

/// Compares as [`compare_paired`] does, where the pixels' differences scatter by these variances at least: those of a tile may be alike because hardly
/// any sample has found its light.
///
/// # Errors
/// Pictures of different sizes.
pub fn compare_paired_above(
    [first, second]: [ImageView; 2],
    least: ImageView,
    settings: &TileSettings,
) -> Result<ImageComparison, ComparisonError> {
    Layout::of(&[first, second, least])?;
    paired(first, second, Some(least), settings)
}

fn paired(
    first: ImageView,
    second: ImageView,
    least: Option<ImageView>,
    settings: &TileSettings,
) -> Result<ImageComparison, ComparisonError> {
    let layout = Layout::of(&[first, second])?;
    Ok(layout.judge(settings, |region, channel| {
        let pairs = || layout.pixels(region).map(|i| (f64::from(first.pixels[i][channel]), f64::from(second.pixels[i][channel])));
        let differences: Moments = pairs().map(|(a, b)| a - b).collect();
        let lone = differences.count() == 1;
        let scatter = if lone { 0.0 } else { differences.standard_error() };
        let least = least.map_or(0.0, |least| {
            let variance: f64 = layout.pixels(region).map(|i| f64::from(least.pixels[i][channel])).sum();
            variance.sqrt() / differences.count() as f64
        });
        Estimate {
            first: pairs().map(|pair| pair.0).collect::<Moments>().mean(),
            second: pairs().map(|pair| pair.1).collect::<Moments>().mean(),
            standard_error: scatter.max(least),
            degrees_of_freedom: differences.count() as f64 - 1.0,
        }
    }))
}

/// Compares two pictures made from independent random numbers. Beside each come the variances of its pixels' means (the variance of a
/// sample over the number of samples), in the same order.
pub fn compare_independent(
    [first, first_variances]: [ImageView; 2],
    [second, second_variances]: [ImageView; 2],
    settings: &TileSettings,
) -> Result<ImageComparison, ComparisonError> {
    let layout = Layout::of(&[first, first_variances, second, second_variances])?;
    Ok(layout.judge(settings, |region, channel| {
        let mean =
            |picture: ImageView| layout.pixels(region).map(|i| f64::from(picture.pixels[i][channel])).collect::<Moments>().mean();
        let variance = (mean(first_variances) + mean(second_variances)) / f64::from(region.width * region.height);
        Estimate { first: mean(first), second: mean(second), standard_error: variance.sqrt(), degrees_of_freedom: f64::INFINITY }
    }))
}

/// Variances of the means of a picture's pixels, in the order of its pixels, and how many degrees of freedom each of them has.
#[derive(Debug, Clone, Copy)]
pub struct Scatter<'a> {
    pub variances: ImageView<'a>,
    pub degrees_of_freedom: f64,
}

/// Compares two pictures made from independent random numbers. The variances of their pixels' differences are the sums of all `scatter`.
pub fn compare_measured(
    [first, second]: [ImageView; 2],
    scatter: &[Scatter],
    settings: &TileSettings,
) -> Result<ImageComparison, ComparisonError> {
    let pictures: Vec<ImageView> = [first, second].into_iter().chain(scatter.iter().map(|one| one.variances)).collect();
    let layout = Layout::of(&pictures)?;
    Ok(layout.judge(settings, |region, channel| {
        let mean =
            |picture: ImageView| layout.pixels(region).map(|i| f64::from(picture.pixels[i][channel])).collect::<Moments>().mean();
        let (mut variance, mut spread) = (0.0, 0.0);
        for one in scatter {
            for pixel in layout.pixels(region) {
                let value = f64::from(one.variances.pixels[pixel][channel]);
                variance += value;
                spread += value * value / one.degrees_of_freedom;
            }
        }
        // Satterthwaite 1946. Without any scatter the number of degrees is 0/0, and no test needs it.
        let degrees_of_freedom = if spread == 0.0 { f64::INFINITY } else { variance * variance / spread };
        let pixels = f64::from(region.width) * f64::from(region.height);
        Estimate { first: mean(first), second: mean(second), standard_error: variance.sqrt() / pixels, degrees_of_freedom }
    }))
}

/// Compares two sets of replications, each picture rendered with a seed of its own.
pub fn compare_replications(
    first: &[ImageView],
    second: &[ImageView],
    settings: &TileSettings,
) -> Result<ImageComparison, ComparisonError> {
    if first.len() < 2 || second.len() < 2 {
        return Err(ComparisonError::Replications);
    }
    let layout = Layout::of(&[first, second].concat())?;
    Ok(layout.judge(settings, |region, channel| {
        let means = |pictures: &[ImageView]| -> Moments {
            let mean = |picture: &ImageView| {
                layout.pixels(region).map(|i| f64::from(picture.pixels[i][channel])).collect::<Moments>().mean()
            };
            pictures.iter().map(mean).collect()
        };
        let (first, second) = (means(first), means(second));
        let standard_error = first.standard_error().hypot(second.standard_error());
        let degrees_of_freedom = welch_t_test(&first, &second).degrees_of_freedom;
        Estimate { first: first.mean(), second: second.mean(), standard_error, degrees_of_freedom }
    }))
}

/// The size that all pictures of a comparison have.
pub(crate) struct Layout {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl Layout {
    fn of(pictures: &[ImageView]) -> Result<Self, ComparisonError> {
        let [first, ..] = pictures else { return Err(ComparisonError::Sizes) };
        let height = first.pixels.len() / first.width.max(1) as usize;
        let same = |picture: &ImageView| picture.width == first.width && picture.pixels.len() == first.width as usize * height;
        match u32::try_from(height) {
            Ok(height) if height > 0 && pictures.iter().all(same) => Ok(Self { width: first.width, height }),
            _ => Err(ComparisonError::Sizes),
        }
    }

    /// Indices of a region's pixels.
    pub(crate) fn pixels(&self, region: Region) -> impl Iterator<Item = usize> {
        let (width, columns) = (self.width as usize, region.x as usize..(region.x + region.width) as usize);
        (region.y as usize..(region.y + region.height) as usize).flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }

    /// Tiles of nearly equal size, each about `side` pixels wide and high.
    pub(crate) fn tiles(&self, side: u32) -> Vec<Region> {
        let cuts = |length: u32| {
            let parts = (length / side.max(1)).max(1);
            let edge = move |i: u32| (u64::from(length) * u64::from(i) / u64::from(parts)) as u32;
            (0..parts).map(move |i| (edge(i), edge(i + 1) - edge(i)))
        };
        cuts(self.height).flat_map(|(y, height)| cuts(self.width).map(move |(x, width)| Region { x, y, width, height })).collect()
    }

    fn judge(&self, settings: &TileSettings, estimate: impl Fn(Region, usize) -> Estimate) -> ImageComparison {
        let finding = |region: Region, channel: usize| {
            let Estimate { first, second, standard_error, degrees_of_freedom } = estimate(region, channel);
            let margin = settings.relative_margin * first.abs().max(second.abs());
            let test = TestResult::beyond_margin(first - second, margin, standard_error, degrees_of_freedom);
            Finding { region, channel, first, second, standard_error, test }
        };
        let tiles: Vec<Finding> = self
            .tiles(settings.tile)
            .into_iter()
            .flat_map(|region| (0..3).map(move |channel| (region, channel)))
            .map(|(region, channel)| finding(region, channel))
            .collect();
        let everything = Region { x: 0, y: 0, width: self.width, height: self.height };
        let family_level = sidak(settings.alpha, 2);
        ImageComparison {
            tile_level: sidak(family_level, tiles.len()),
            whole_level: sidak(family_level, 3),
            whole: std::array::from_fn(|channel| finding(everything, channel)),
            tiles,
        }
    }
}

#[cfg(test)]
mod tests;
