//! Indices of refraction that depend on the wavelength.

use crate::spectrum::Spectrum;

/// Wavelengths that stand for the channels, in micrometres: the dominant ones of Rec.709's primaries beside its white.
pub const WAVELENGTHS: [f64; 3] = [0.6114, 0.5491, 0.4642];
/// Fraunhofer's lines C, d and F, in micrometres, by which Abbe's number is defined.
const LINES: [f64; 3] = [0.6563, 0.5876, 0.4861];

/// How an index of refraction falls towards longer wavelengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Dispersion {
    /// Abbe's number (n_d − 1)/(n_F − n_C); the index at the line d is that of the material, and others follow by Cauchy's formula of two terms, as
    /// in KHR_materials_dispersion.
    Abbe(f64),
    /// Cauchy's formula A + B/λ² + C/λ⁴, λ in micrometres.
    Cauchy([f64; 3]),
    /// Sellmeier's formula n² = 1 + Σ bᵢ·λ²/(λ² − cᵢ), λ in micrometres and c in their squares.
    Sellmeier { b: [f64; 3], c: [f64; 3] },
}

impl Dispersion {
    /// The index at a wavelength in micrometres, given that at the line d. Not a number where Sellmeier's formula has none.
    pub fn index(&self, central: f64, wavelength: f64) -> f64 {
        let inverse_square = |wavelength: f64| wavelength.powi(-2);
        match *self {
            Self::Abbe(number) => {
                let [red, middle, blue] = LINES.map(inverse_square);
                let index = central + (central - 1.0) / number * (inverse_square(wavelength) - middle) / (blue - red);
                if central >= 1.0 { index.max(1.0) } else { index }
            }
            Self::Cauchy([a, b, c]) => a + b * inverse_square(wavelength) + c * inverse_square(wavelength).powi(2),
            Self::Sellmeier { b, c } => {
                let square = wavelength * wavelength;
                let terms = b.iter().zip(c).map(|(b, c)| b * square / (square - c));
                (1.0 + terms.sum::<f64>()).sqrt()
            }
        }
    }

    /// The indices of the channels, given that at the line d.
    pub fn channels(&self, central: f64) -> Spectrum {
        Spectrum::from_rgb(WAVELENGTHS.map(|wavelength| self.index(central, wavelength)))
    }

    /// The index at the line d, where a formula says it.
    pub fn central(&self) -> Option<f64> {
        match self {
            Self::Abbe(_) => None,
            formula => Some(formula.index(1.0, LINES[1])),
        }
    }
}

/// The indices of refraction of the channels.
pub fn iors(ior: f64, dispersion: Option<Dispersion>) -> Spectrum {
    dispersion.map_or(Spectrum::grey(ior), |dispersion| dispersion.channels(ior))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// N-BK7 of Schott's catalogue: n_d = 1.51680, an Abbe number of 64.17, and n_F = 1.52238, n_C = 1.51432.
    const BK7: Dispersion = Dispersion::Sellmeier {
        b: [1.039_612_12, 0.231_792_344, 1.010_469_45],
        c: [0.006_000_698_67, 0.020_017_914_4, 103.560_653],
    };

    #[test]
    fn sellmeier_is_that_of_the_catalogue() {
        for (line, expected) in LINES.into_iter().zip([1.51432, 1.51680, 1.52238]) {
            assert!((BK7.index(1.0, line) - expected).abs() < 2e-5, "{line}");
        }
        assert!((BK7.central().expect("it says so") - 1.5168).abs() < 2e-5);
    }

    #[test]
    fn abbe_numbers_are_what_they_are_defined_by() {
        let glass = Dispersion::Abbe(64.17);
        let [red, middle, blue] = LINES.map(|line| glass.index(1.5168, line));
        assert!(((middle - 1.0) / (blue - red) - 64.17).abs() < 1e-9 && (middle - 1.5168).abs() < 1e-12);
        // The channels are nearly those of the formula with all its terms.
        let (by_number, by_formula) = (glass.channels(1.5168), BK7.channels(1.0));
        assert!(by_number.distance(by_formula) < 5e-4, "{by_number} {by_formula}");
        assert!(by_number.b() > by_number.g() && by_number.g() > by_number.r());
    }

    #[test]
    fn cauchy_is_a_sum() {
        let channels = Dispersion::Cauchy([1.5, 0.004, 0.0001]).channels(1.0);
        assert!((channels.r() - (1.5 + 0.004 / 0.6114_f64.powi(2) + 0.0001 / 0.6114_f64.powi(4))).abs() < 1e-12);
    }
}
