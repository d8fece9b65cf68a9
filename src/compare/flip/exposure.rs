//! The exposures at which a picture of high dynamic range is looked at (Andersson et al. 2021, section 3).

use crate::math::luminance_f32;
use crate::output::Image;

/// Narkowicz' fit to the ACES curve (2015), without the exposure of 0.6 that it was fitted with: (ax² + bx) / (cx² + dx + e).
const CURVE: [f64; 5] = [2.51 * 0.36, 0.03 * 0.6, 2.43 * 0.36, 0.59 * 0.6, 0.14];
/// The value of the brightest pixel at the first exposure, and of the median one at the last.
const SHOWN: f64 = 0.85;
/// More exposures than any picture of single-precision numbers needs; a bound where its values are absurd.
const MOST_EXPOSURES: f64 = 64.0;

/// The value that a display shows of a radiance: 0 to 1.
pub(super) fn tone_mapped(radiance: f64) -> f64 {
    let [a, b, c, d, e] = CURVE;
    let x = radiance.clamp(0.0, 1e15);
    ((a * x * x + b * x) / (c * x * x + d * x + e)).clamp(0.0, 1.0)
}

/// Stops from where the brightest pixel of the reference is not yet white to where its median one is bright; two at least.
pub(super) fn exposures(reference: &Image) -> Vec<f64> {
    let mut luminances: Vec<f32> =
        reference.pixels.iter().map(|pixel| luminance_f32(*pixel)).filter(|value| value.is_finite()).collect();
    luminances.sort_unstable_by(f32::total_cmp);
    let Some(&brightest) = luminances.last() else { return vec![0.0] };
    // Half of the pixels may be black: then the darkest that is not.
    let first_positive = luminances.partition_point(|value| *value <= 0.0);
    let median = luminances[(luminances.len() / 2).max(first_positive).min(luminances.len() - 1)];
    if brightest <= 0.0 {
        return vec![0.0];
    }
    let [a, b, c, d, e] = CURVE;
    let (square, linear, constant) = (a - SHOWN * c, b - SHOWN * d, -SHOWN * e);
    let bright = (-linear + (linear * linear - 4.0 * square * constant).sqrt()) / (2.0 * square);
    let (first, last) = ((bright / f64::from(brightest)).log2(), (bright / f64::from(median)).log2());
    let count = (last - first).ceil().clamp(2.0, MOST_EXPOSURES);
    (0..count as u32).map(|index| first + f64::from(index) * (last - first) / (count - 1.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposures_go_from_the_brightest_to_the_median() {
        let grey =
            |values: &[f32]| Image { width: values.len() as u32, height: 1, pixels: values.iter().map(|v| [*v; 3]).collect() };
        let stops = exposures(&grey(&[0.1, 0.1, 0.1, 6.4]));
        assert_eq!(stops.len(), 6);
        assert!((tone_mapped(6.4 * stops[0].exp2()) - SHOWN).abs() < 1e-6);
        assert!((tone_mapped(0.1 * stops[5].exp2()) - SHOWN).abs() < 1e-6);
        assert_eq!(exposures(&grey(&[0.0; 3])), [0.0]);
        assert!(exposures(&grey(&[0.0, 0.0, 0.0, 1.0])).iter().all(|stop| stop.is_finite()));
        assert_eq!(exposures(&grey(&[f32::NAN])), [0.0]);
    }
}
