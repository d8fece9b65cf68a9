//! The change that denoising makes to a picture's energy, tile by tile: denoising without bias leaves means
//! as they are, up to the raw picture's own error.

use serde::Serialize;

use super::raw::Raw;
use crate::compare::image_tests::ComparisonError;
use crate::compare::{Finding, ImageComparison, ImageView, Scatter, TileSettings, compare_measured, compare_paired};
use crate::output::Image;

/// Pixels along a tile's side.
const TILE: u32 = 16;
/// A change of a tile's energy, as a share, that is reported even where noise may be all of it: of a small bright thing few samples know much, so the noise
/// that is expected is as large as what the thing is worth, and would explain that it is gone.
const NOTABLE: f64 = 0.1;

/// By how much a denoised picture differs from the raw one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bias {
    /// Change of the whole picture's energy, as a share, in red, green and blue.
    pub whole: [f64; 3],
    pub tiles: usize,
    /// Tiles whose energy differs, in some channel, by more than the raw picture's noise explains: one picture in a hundred that are not biased
    /// has any.
    pub biased_tiles: usize,
    /// The largest change of a tile's energy beyond noise, as a share; 0 where there is none.
    pub largest: f64,
    /// Other tiles whose energy changed by more than a tenth in some channel: the raw picture's noise is too large there to tell what that is.
    pub undecided_tiles: usize,
    /// The largest change of their energy, as a share; 0 where there is none.
    pub largest_undecided: f64,
    /// True if the noise is that of measured samples; else it is the scatter of a tile's pixels.
    pub noise_is_measured: bool,
}

impl Bias {
    /// The bias of a denoised picture.
    ///
    /// # Errors
    /// Pictures of different sizes.
    pub fn of(raw: &Raw, denoised: &Image) -> Result<Self, ComparisonError> {
        let settings = TileSettings { tile: TILE, ..TileSettings::default() };
        let pictures = [&raw.picture, denoised].map(|image| ImageView { width: image.width, pixels: &image.pixels });
        let compared = match &raw.variances {
            Some(variances) => {
                let variances = ImageView { width: raw.picture.width, pixels: variances };
                compare_measured(pictures, &[Scatter { variances, degrees_of_freedom: f64::INFINITY }], &settings)?
            }
            None => compare_paired(pictures[0], pictures[1], &settings)?,
        };
        Ok(Self::found(&compared, raw.variances.is_some()))
    }

    fn found(compared: &ImageComparison, noise_is_measured: bool) -> Self {
        let change = |finding: &Finding| if finding.first == 0.0 { 0.0 } else { finding.second / finding.first - 1.0 };
        let is_biased = |finding: &&Finding| finding.test.p_value < compared.tile_level;
        let is_notable = |finding: &&Finding| change(finding).abs() > NOTABLE;
        let (biased, others): (Vec<&[Finding]>, Vec<&[Finding]>) =
            compared.tiles.chunks(3).partition(|channels| channels.iter().any(|finding| is_biased(&finding)));
        let undecided: Vec<&[Finding]> =
            others.into_iter().filter(|channels| channels.iter().any(|finding| is_notable(&finding))).collect();
        let larger = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
        Self {
            whole: compared.whole.each_ref().map(change),
            tiles: compared.tiles.len() / 3,
            biased_tiles: biased.len(),
            largest: compared.tiles.iter().filter(is_biased).map(change).fold(0.0, larger),
            undecided_tiles: undecided.len(),
            largest_undecided: undecided.iter().flat_map(|channels| channels.iter()).map(change).fold(0.0, larger),
            noise_is_measured,
        }
    }
}

/// The form in headers and messages.
impl std::fmt::Display for Bias {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [r, g, b] = self.whole.map(|change| 100.0 * change);
        write!(out, "energy {r:+.3} % red, {g:+.3} % green, {b:+.3} % blue; ")?;
        match self.biased_tiles {
            0 => write!(out, "none of {} tiles is changed beyond the raw picture's noise", self.tiles),
            biased => write!(
                out,
                "{biased} of {} tiles are changed beyond the raw picture's noise, by {:+.1} % at most",
                self.tiles,
                100.0 * self.largest
            ),
        }?;
        if self.undecided_tiles == 0 {
            return Ok(());
        }
        let (count, most) = (self.undecided_tiles, 100.0 * self.largest_undecided);
        write!(
            out,
            "; in {count} the change is above {:.0} % ({most:+.1} % at most), and noise too large to tell whether that is bias",
            100.0 * NOTABLE
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::random::SplitMix64;

    const SIDE: u32 = 64;

    /// Noise of a fifth about a grey picture, and that picture with a tile that is brighter by so much.
    fn pictures(brighter: f32, have_variances: bool) -> (Raw, Image) {
        let mut random = SplitMix64::new(3);
        let of = |pixels| Image { width: SIDE, height: SIDE, pixels };
        let count = (SIDE * SIDE) as usize;
        let noisy = (0..count).map(|_| std::array::from_fn(|_| (0.5 + 0.1 * random.normal()) as f32)).collect();
        let tile = |index: usize| index / SIDE as usize >= 48 && index % SIDE as usize >= 48;
        let smooth = (0..count).map(|index| [0.5 * if tile(index) { brighter } else { 1.0 }; 3]).collect();
        let variances = have_variances.then(|| vec![[0.01; 3]; count]);
        (Raw { picture: of(noisy), albedo: None, normal: None, variances, placed: None }, of(smooth))
    }

    /// An emitter of which each of its pixels has a sample or two: noise would explain that it is gone, and that it is gone is reported.
    #[test]
    fn a_small_bright_thing_that_is_gone_is_reported() {
        let (mut raw, denoised) = pictures(1.0, true);
        let emitter = [20 * SIDE as usize + 20, 20 * SIDE as usize + 21];
        for pixel in emitter {
            // One of 16 samples met it, so the deviation of the mean is as large as the mean.
            raw.picture.pixels[pixel] = [500.0; 3];
            raw.variances.as_mut().expect("they are there")[pixel] = [500.0 * 500.0; 3];
        }
        let bias = Bias::of(&raw, &denoised).expect("one size");
        assert_eq!((bias.biased_tiles, bias.undecided_tiles), (0, 1), "{bias}");
        assert!(bias.largest_undecided < -0.8 && bias.to_string().contains("in 1 the change is above 10 % (-8"), "{bias}");
        // The control: without the emitter, nothing is reported.
        let (raw, denoised) = pictures(1.0, true);
        assert!(!Bias::of(&raw, &denoised).expect("one size").to_string().contains("above"));
    }

    #[test]
    fn taking_noise_away_is_no_bias_and_a_changed_tile_is_one() {
        for have_variances in [true, false] {
            let (raw, denoised) = pictures(1.0, have_variances);
            let bias = Bias::of(&raw, &denoised).expect("one size");
            assert_eq!((bias.tiles, bias.biased_tiles, bias.largest), (16, 0, 0.0), "{bias}");
            assert!(bias.whole.iter().all(|change| change.abs() < 0.02), "{bias}");
            let (raw, denoised) = pictures(1.2, have_variances);
            let bias = Bias::of(&raw, &denoised).expect("one size");
            assert_eq!(bias.biased_tiles, 1, "{bias}");
            assert!((bias.largest - 0.2).abs() < 0.06 && bias.to_string().contains("1 of 16 tiles"), "{bias}");
        }
    }
}
