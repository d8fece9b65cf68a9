//! The colours of spectra: what the CIE's standard observer of 1931 sees, of a light as it is, of a surface under the daylight D65.

use glam::{DMat3, DVec3};

use crate::spectrum::Spectrum;

/// The quantity that a spectrum describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    Light,
    Surface,
}

const FIRST_WAVELENGTH: f64 = 380.0;
const STEP: f64 = 10.0;

/// Every 10 nm from 380 nm: x̄, ȳ, z̄ of the CIE 1931 standard observer and the relative power of the illuminant D65 (CIE 15:2004).
const OBSERVER: [[f64; 4]; 41] = [
    [0.001368, 0.000039, 0.006450, 49.9755],
    [0.004243, 0.000120, 0.020050, 54.6482],
    [0.014310, 0.000396, 0.067850, 82.7549],
    [0.043510, 0.001210, 0.207400, 91.4860],
    [0.134380, 0.004000, 0.645600, 93.4318],
    [0.283900, 0.011600, 1.385600, 86.6823],
    [0.348280, 0.023000, 1.747060, 104.865],
    [0.336200, 0.038000, 1.772110, 117.008],
    [0.290800, 0.060000, 1.669200, 117.812],
    [0.195360, 0.090980, 1.287640, 114.861],
    [0.095640, 0.139020, 0.812950, 115.923],
    [0.032010, 0.208020, 0.465180, 108.811],
    [0.004900, 0.323000, 0.272000, 109.354],
    [0.009300, 0.503000, 0.158200, 107.802],
    [0.063270, 0.710000, 0.078250, 104.790],
    [0.165500, 0.862000, 0.042160, 107.689],
    [0.290400, 0.954000, 0.020300, 104.405],
    [0.433450, 0.994950, 0.008750, 104.046],
    [0.594500, 0.995000, 0.003900, 100.000],
    [0.762100, 0.952000, 0.002100, 96.3342],
    [0.916300, 0.870000, 0.001650, 95.7880],
    [1.026300, 0.757000, 0.001100, 88.6856],
    [1.062200, 0.631000, 0.000800, 90.0062],
    [1.002600, 0.503000, 0.000340, 89.5991],
    [0.854450, 0.381000, 0.000190, 87.6987],
    [0.642400, 0.265000, 0.000050, 83.2886],
    [0.447900, 0.175000, 0.000020, 83.6992],
    [0.283500, 0.107000, 0.000000, 80.0268],
    [0.164900, 0.061000, 0.000000, 80.2146],
    [0.087400, 0.032000, 0.000000, 82.2778],
    [0.046770, 0.017000, 0.000000, 78.2842],
    [0.022700, 0.008210, 0.000000, 69.7213],
    [0.011359, 0.004102, 0.000000, 71.6091],
    [0.005790, 0.002091, 0.000000, 74.3490],
    [0.002899, 0.001047, 0.000000, 61.6040],
    [0.001440, 0.000520, 0.000000, 69.8856],
    [0.000690, 0.000249, 0.000000, 75.0870],
    [0.000332, 0.000120, 0.000000, 63.5927],
    [0.000166, 0.000060, 0.000000, 46.4182],
    [0.000083, 0.000030, 0.000000, 66.8054],
    [0.000042, 0.000015, 0.000000, 63.3828],
];

/// Linear Rec.709 of CIE XYZ.
pub fn from_xyz(xyz: DVec3) -> Spectrum {
    let columns = [[3.240479, -0.969256, 0.055648], [-1.537150, 1.875991, -0.204043], [-0.498535, 0.041556, 1.057311]];
    Spectrum::from_rgb((DMat3::from_cols_array_2d(&columns) * xyz).to_array())
}

/// The table between its rows, at any wavelength within it.
fn observer(wavelength: f64) -> [f64; 4] {
    let place = ((wavelength - FIRST_WAVELENGTH) / STEP).clamp(0.0, (OBSERVER.len() - 1) as f64);
    let row = (place as usize).min(OBSERVER.len() - 2);
    let part = place - row as f64;
    std::array::from_fn(|column| OBSERVER[row][column] * (1.0 - part) + OBSERVER[row + 1][column] * part)
}

/// Straight lines between samples, each a wavelength and a value, 0 outside of them.
pub fn between(samples: &[(f64, f64)], wavelength: f64) -> f64 {
    let after = samples.partition_point(|(at, _)| *at < wavelength);
    match (after.checked_sub(1).map(|before| samples[before]), samples.get(after)) {
        (_, Some((at, value))) if *at == wavelength => *value,
        (Some((from, low)), Some((to, high))) => low + (high - low) * (wavelength - from) / (to - from),
        _ => 0.0,
    }
}

/// Radiance of a black body in W·sr⁻¹·m⁻²·nm⁻¹.
pub fn planck(nanometres: f64, kelvin: f64) -> f64 {
    const PLANCK: f64 = 6.626_070_15e-34;
    const LIGHT: f64 = 299_792_458.0;
    const BOLTZMANN: f64 = 1.380_649e-23;
    let wavelength = nanometres * 1e-9;
    let exponent = PLANCK * LIGHT / (wavelength * BOLTZMANN * kelvin.max(1.0));
    2e-9 * PLANCK * LIGHT * LIGHT / wavelength.powi(5) / exponent.exp_m1()
}

/// The colour of a spectrum that gives so much at each wavelength in nanometres. A surface that reflects everything is white to the last digit:
/// the tables' own white is off by 0.2 % in blue.
pub fn integrate(role: Role, spectrum: impl Fn(f64) -> f64) -> Spectrum {
    let (mut sum, mut white) = (DVec3::ZERO, DVec3::ZERO);
    for step in 0..=((OBSERVER.len() - 1) * STEP as usize) {
        let wavelength = FIRST_WAVELENGTH + step as f64;
        let [x, y, z, daylight] = observer(wavelength);
        let light = if role == Role::Surface { daylight } else { 1.0 };
        sum += DVec3::new(x, y, z) * light * spectrum(wavelength);
        white += DVec3::new(x, y, z) * light;
    }
    let colour = from_xyz(sum / white.y);
    if role == Role::Surface { colour / from_xyz(white / white.y) } else { colour }
}
