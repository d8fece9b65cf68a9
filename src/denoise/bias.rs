//! What denoising did to a picture's energy, tile by tile: noise that is taken away leaves means as they are, up to the raw picture's own error.

use serde::Serialize;

use super::raw::Raw;
use crate::compare::image_tests::ComparisonError;
use crate::compare::{Finding, ImageComparison, Picture, Scatter, TileSettings, compare_measured, compare_paired};
use crate::output::Image;

/// Pixels along a tile's side.
const TILE: u32 = 16;

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
    /// Whether the noise is that of measured samples; else it is what a tile's pixels scatter by.
    pub noise_is_measured: bool,
}

impl Bias {
    /// Of a denoised picture.
    ///
    /// # Errors
    /// Pictures of different sizes.
    pub fn of(raw: &Raw, denoised: &Image) -> Result<Self, ComparisonError> {
        let settings = TileSettings { tile: TILE, ..TileSettings::default() };
        let pictures = [&raw.picture, denoised].map(|image| Picture { width: image.width, pixels: &image.pixels });
        let compared = match &raw.variances {
            Some(variances) => {
                let variances = Picture { width: raw.picture.width, pixels: variances };
                compare_measured(pictures, &[Scatter { variances, degrees_of_freedom: f64::INFINITY }], &settings)?
            }
            None => compare_paired(pictures[0], pictures[1], &settings)?,
        };
        Ok(Self::found(&compared, raw.variances.is_some()))
    }

    fn found(compared: &ImageComparison, noise_is_measured: bool) -> Self {
        let change = |finding: &Finding| if finding.first == 0.0 { 0.0 } else { finding.second / finding.first - 1.0 };
        let is_biased = |finding: &&Finding| finding.test.p_value < compared.tile_level;
        let biased = compared.tiles.chunks(3).filter(|channels| channels.iter().any(|finding| is_biased(&finding)));
        let changes = compared.tiles.iter().filter(is_biased).map(change);
        Self {
            whole: compared.whole.each_ref().map(change),
            tiles: compared.tiles.len() / 3,
            biased_tiles: biased.count(),
            largest: changes.fold(0.0, |largest: f64, change| if change.abs() > largest.abs() { change } else { largest }),
            noise_is_measured,
        }
    }
}

/// As headers and people have it.
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
        }
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
