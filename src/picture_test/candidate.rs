//! Pictures of other programs against golden ones.

use super::error::PictureTestError;
use super::golden::{Candidate, Golden};
use super::judge::tile_settings;
use super::settings::TestSettings;
use super::unseen::{noise_of_samples, share_of_noise};
use crate::compare::{ImageComparison, ImageView, Scatter, compare_measured, compare_paired_above};

/// Holds a picture against the golden one. Where it says how its samples vary, that counts; else its noise is what the differences of a tile's
/// pixels scatter by, by Student's t. A picture of few samples may have found none of the light of a dark tile, and then shows no noise there: the noise
/// that the golden picture knows of samples is the least that counts. There is nothing to look at a second time.
///
/// # Errors
/// Pictures of different sizes.
pub fn judge_candidate(
    golden: &Golden,
    candidate: &Candidate,
    settings: &TestSettings,
) -> Result<ImageComparison, PictureTestError> {
    let sizes = [&candidate.mean, &golden.mean].map(|image| [image.width, image.height]);
    if sizes[0] != sizes[1] {
        let [a, b] = sizes.map(|[width, height]| format!("{width}x{height}"));
        return Err(PictureTestError::Unsuitable(format!("the picture has {a} pixels, and its golden picture {b}")));
    }
    let pictures = [&golden.mean, &candidate.mean].map(|image| ImageView { width: image.width, pixels: &image.pixels });
    let view = |pixels| ImageView { width: golden.mean.width, pixels };
    let (own, of_samples) = (golden.own_variances(), noise_of_samples(golden));
    let compared = match (&candidate.variances, candidate.samples) {
        (Some(variances), Some(samples)) => {
            let share = 1.0 / f64::from(samples);
            let pixels = variances.iter().zip(scaled(&of_samples, share));
            let variances: Vec<[f32; 3]> =
                pixels.map(|(said, least)| std::array::from_fn(|channel| at_least(said[channel], least[channel]))).collect();
            let scatter = [
                Scatter { variances: view(&own), degrees_of_freedom: golden.degrees_of_freedom() },
                Scatter { variances: view(&variances), degrees_of_freedom: f64::from(samples - 1) },
            ];
            compare_measured(pictures, &scatter, &tile_settings(settings))
        }
        _ => {
            let least: Vec<[f32; 3]> =
                scaled(&of_samples, share_of_noise(golden, &of_samples, &candidate.mean, settings.tile)).collect();
            compare_paired_above(pictures, view(&least), &tile_settings(settings))
        }
    };
    compared.map_err(|error| PictureTestError::Unsuitable(error.to_string()))
}

/// The larger one; what is not a number stays so, and is judged to differ.
fn at_least(said: f32, least: f32) -> f32 {
    if said < least { least } else { said }
}

fn scaled(variances: &[[f32; 3]], factor: f64) -> impl Iterator<Item = [f32; 3]> + '_ {
    variances.iter().map(move |pixel| pixel.map(|variance| (f64::from(variance) * factor) as f32))
}
