//! Causes of a difference, by the pictures that they lead to.

use super::judge::{Outcome, Seeds, judge};
use super::picture::{TruthPicture, linear_to_srgb, srgb_value_to_linear};
use super::replay::{ReplayError, by_reference};
use super::test::{Test, VariantPicture};

/// Samples of a picture of a mistake, in each of its parts.
const SAMPLES_OF_MISTAKE: u32 = 16;

/// A picture that a mistake leads to.
pub struct Suspect {
    pub cause: String,
    pub picture: TruthPicture,
}

/// Mistakes that any test may show: factors, codes, axes and places of the picture.
pub fn general_suspects(truth: &TruthPicture) -> Vec<Suspect> {
    use std::f64::consts::PI;
    let factors = [
        ("a factor of π too much", PI),
        ("a factor of π too little", 1.0 / PI),
        ("a factor of 2 too much", 2.0),
        ("a factor of 2 too little", 0.5),
        ("a factor of 4π too much", 4.0 * PI),
        ("a factor of 4π too little", 0.25 / PI),
        ("lumens for watts, 683 times too much", 683.0),
        ("watts for lumens, 683 times too little", 1.0 / 683.0),
    ];
    let by_value = |cause: &str, change: &dyn Fn(f64) -> f64| Suspect {
        cause: cause.to_owned(),
        picture: TruthPicture {
            mean: truth.mean.iter().map(|pixel| pixel.map(|value| change(f64::from(value)) as f32)).collect(),
            standard_errors: slopes(truth, change),
            ..truth.clone()
        },
    };
    let (width, height) = (truth.width as usize, truth.height as usize);
    let by_place = |cause: &str, from: &dyn Fn(usize, usize) -> [usize; 2]| {
        let taken = |pixels: &[[f32; 3]]| {
            let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
            places.map(|(x, y)| from(x, y)).map(|[x, y]| pixels[y * width + x]).collect()
        };
        Suspect {
            cause: cause.to_owned(),
            picture: TruthPicture { mean: taken(&truth.mean), standard_errors: taken(&truth.standard_errors), ..truth.clone() },
        }
    };
    let swapped = |pixels: &[[f32; 3]]| pixels.iter().map(|&[r, g, b]| [b, g, r]).collect();
    let mut suspects: Vec<Suspect> = factors.iter().map(|&(cause, factor)| by_value(cause, &|value| value * factor)).collect();
    suspects.extend([
        by_value("sRGB codes in place of linear values", &linear_to_srgb),
        by_value("values that are decoded once too often", &srgb_value_to_linear),
        by_value("values that are cut off at 1", &|value| value.min(1.0)),
        by_value("a tone curve, x/(1 + x)", &|value| value / (1.0 + value)),
        by_value("a black picture", &|_| 0.0),
        by_place("a picture whose left is its right", &|x, y| [width - 1 - x, y]),
        by_place("a picture that stands upside down", &|x, y| [x, height - 1 - y]),
        by_place("a picture that is turned by half", &|x, y| [width - 1 - x, height - 1 - y]),
        by_place("a picture that lies one pixel to the right", &|x, y| [x.saturating_sub(1), y]),
        by_place("a picture that lies one pixel to the left", &|x, y| [(x + 1).min(width - 1), y]),
        by_place("a picture that lies one pixel too low", &|x, y| [x, y.saturating_sub(1)]),
        by_place("a picture that lies one pixel too high", &|x, y| [x, (y + 1).min(height - 1)]),
        Suspect {
            cause: "exchanged red and blue".to_owned(),
            picture: TruthPicture {
                mean: swapped(&truth.mean),
                standard_errors: swapped(&truth.standard_errors),
                ..truth.clone()
            },
        },
    ]);
    if width == height {
        suspects.push(by_place("a picture whose rows are its columns", &|x, y| [y, x]));
    }
    suspects
}

/// Standard errors of changed values: those of the truth times the slope.
fn slopes(truth: &TruthPicture, change: &dyn Fn(f64) -> f64) -> Vec<[f32; 3]> {
    let slope = |value: f32| {
        let step = 1e-3 * f64::from(value).abs().max(1e-6);
        (change(f64::from(value) + step) - change(f64::from(value))).abs() / step
    };
    let pixels = truth.mean.iter().zip(&truth.standard_errors);
    pixels.map(|(mean, errors)| std::array::from_fn(|i| (slope(mean[i]) * f64::from(errors[i])) as f32)).collect()
}

/// The truth times the factor by which the picture is nearest to it, by least squares.
pub fn scaled_suspect(truth: &TruthPicture, pixels: &[[f32; 3]]) -> Option<Suspect> {
    let (mut both, mut square) = (0.0, 0.0);
    for (mean, pixel) in truth.mean.iter().zip(pixels) {
        for channel in 0..3 {
            both += f64::from(mean[channel]) * f64::from(pixel[channel]);
            square += f64::from(mean[channel]).powi(2);
        }
    }
    let factor = both / square;
    (factor.is_finite() && factor > 0.0).then(|| Suspect {
        cause: format!("everything times {factor:.4}"),
        picture: TruthPicture {
            mean: truth.mean.iter().map(|pixel| pixel.map(|value| (factor * f64::from(value)) as f32)).collect(),
            standard_errors: truth
                .standard_errors
                .iter()
                .map(|errors| errors.map(|error| (factor * f64::from(error)) as f32))
                .collect(),
            ..truth.clone()
        },
    })
}

/// The suspects whose picture these are, up to chance; the nearest first.
pub fn explained_by<'s>(suspects: &'s [Suspect], width: u32, pictures: &[&[[f32; 3]]], seeds: Seeds, level: f64) -> Vec<&'s str> {
    let distance = |suspect: &Suspect| -> f64 {
        let values = pictures.iter().flat_map(|pixels| suspect.picture.mean.iter().flatten().zip(pixels.iter().flatten()));
        values.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum()
    };
    let agrees = |suspect: &&Suspect| judge(&suspect.picture, width, pictures, seeds, level).outcome == Outcome::Agrees;
    let mut found: Vec<_> = suspects.iter().filter(agrees).map(|suspect| (distance(suspect), suspect.cause.as_str())).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, cause)| cause).collect()
}

/// Causes of the difference of pictures of a test, the nearest first: mistakes of the test and those that any test may show, or else a factor.
///
/// # Errors
/// Errors of the reference, which renders the pictures of mistakes that no formula tells.
pub fn causes_of(
    test: &Test,
    truth: &TruthPicture,
    (width, pictures): (u32, &[&[[f32; 3]]]),
    (seeds, level): (Seeds, f64),
) -> Result<Vec<String>, ReplayError> {
    let mut suspects = Vec::new();
    for variant in &test.variants {
        let picture = match &variant.picture {
            VariantPicture::Formula(formula) => formula.picture(test.size()),
            VariantPicture::Scene(scene) => by_reference(test.name, scene, &test.files, SAMPLES_OF_MISTAKE)?,
        };
        suspects.push(Suspect { cause: variant.cause.to_owned(), picture });
    }
    suspects.extend(general_suspects(truth));
    let explained = |suspects: &[Suspect]| -> Vec<String> {
        explained_by(suspects, width, pictures, seeds, level).into_iter().map(str::to_owned).collect()
    };
    let found = explained(&suspects);
    if !found.is_empty() {
        return Ok(found);
    }
    let scaled: Vec<Suspect> = pictures.first().and_then(|pixels| scaled_suspect(truth, pixels)).into_iter().collect();
    Ok(explained(&scaled))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture that no change of places keeps, bright enough for tone curves.
    fn truth() -> TruthPicture {
        let value = |x: u32, y: u32| [0.3 + (x * x) as f32 / 900.0, 0.2 + (y * x + y) as f32 / 700.0, 1.5];
        let mean: Vec<_> = (0..32 * 32).map(|index| value(index % 32, index / 32)).collect();
        TruthPicture { width: 32, height: 32, standard_errors: vec![[0.0; 3]; mean.len()], mean }
    }

    #[test]
    fn every_general_mistake_is_told_from_the_others() {
        let truth = truth();
        let suspects = general_suspects(&truth);
        for suspect in &suspects {
            let judged = judge(&truth, 32, &[&suspect.picture.mean], Seeds::Unknown, 0.01);
            assert_eq!(judged.outcome, Outcome::Differs, "{}", suspect.cause);
            assert_eq!(explained_by(&suspects, 32, &[&suspect.picture.mean], Seeds::Unknown, 0.01), [suspect.cause.as_str()]);
        }
        // The control: the truth is none of them.
        assert_eq!(explained_by(&suspects, 32, &[&truth.mean], Seeds::Unknown, 0.01), Vec::<&str>::new());
    }

    #[test]
    fn a_factor_is_measured() {
        let truth = truth();
        let pixels: Vec<_> = truth.mean.iter().map(|pixel| pixel.map(|value| 1.25 * value)).collect();
        assert_eq!(scaled_suspect(&truth, &pixels).expect("there is a factor").cause, "everything times 1.2500");
        assert!(scaled_suspect(&truth, &vec![[0.0; 3]; pixels.len()]).is_none());
    }
}
