//! Pictures of other programs against golden ones.

use super::error::PictureTestError;
use super::golden::{Candidate, Golden};
use super::judge::tile_settings;
use super::settings::TestSettings;
use crate::compare::{ImageComparison, ImageView, Scatter, compare_measured, compare_paired};

/// Holds a picture against the golden one. Where it says how its samples vary, that counts; else its noise is what the differences of a tile's
/// pixels scatter by, by Student's t. There is nothing to look at a second time.
///
/// # Errors
/// Pictures of different sizes.
pub fn judge_candidate(
    golden: &Golden,
    candidate: &Candidate,
    settings: &TestSettings,
) -> Result<ImageComparison, PictureTestError> {
    let pictures = [&golden.mean, &candidate.mean].map(|image| ImageView { width: image.width, pixels: &image.pixels });
    let own = golden.own_variances();
    let of_golden = ImageView { width: golden.mean.width, pixels: &own };
    let compared = match (&candidate.variances, candidate.samples) {
        (Some(variances), Some(samples)) => {
            let variances = ImageView { width: candidate.mean.width, pixels: variances };
            let scatter = [
                Scatter { variances: of_golden, degrees_of_freedom: golden.degrees_of_freedom() },
                Scatter { variances, degrees_of_freedom: f64::from(samples - 1) },
            ];
            compare_measured(pictures, &scatter, &tile_settings(settings))
        }
        _ => compare_paired(pictures[0], pictures[1], &tile_settings(settings)),
    };
    compared.map_err(|_| {
        let [a, b] = [&candidate.mean, &golden.mean].map(|image| format!("{}x{}", image.width, image.height));
        PictureTestError::Unsuitable(format!("the picture has {a} pixels, and its golden picture {b}"))
    })
}
