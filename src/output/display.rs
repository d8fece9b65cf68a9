//! From linear radiance to a picture for the eye: exposure, white balance, a tone curve, sRGB.
//!
//! Pictures for the eye are previews. Files of floating-point numbers keep the radiance as it is.

use std::fmt;

use glam::{DMat3, DVec3};

use crate::black_body::tristimulus;
use crate::choice::{Choice, choices};
use crate::spectrum::Spectrum;

/// How radiance is shown.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Display {
    pub exposure: Exposure,
    /// Temperature in kelvin of the light that shall look white; None: radiance with equal channels does.
    pub white_kelvin: Option<f64>,
    pub tone_curve: ToneCurve,
}

impl Display {
    /// The picture's own values, up to 1: for differences and measurements.
    pub const CLIP: Self = Self { exposure: Exposure::Stops(0.0), white_kelvin: None, tone_curve: ToneCurve::Clip };
}

/// By how much radiance is multiplied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Exposure {
    /// The exposure that suits the picture: see [`Meter`].
    Auto,
    /// By 2 to the power of so many stops.
    Stops(f32),
}

/// The form that headers have.
impl fmt::Display for Display {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "exposure={}; tonemap={}", self.exposure, self.tone_curve.name())?;
        self.white_kelvin.map_or(Ok(()), |kelvin| write!(out, "; whiteBalance={kelvin}"))
    }
}

impl Default for Exposure {
    fn default() -> Self {
        Self::Stops(0.0)
    }
}

impl fmt::Display for Exposure {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => out.write_str("auto"),
            Self::Stops(stops) => write!(out, "{stops}"),
        }
    }
}

choices! {
    /// How radiance beyond what a screen shows is brought into its range.
    pub enum ToneCurve {
        /// Cut off at 1: the values of the picture where they are below.
        Clip = "clip",
        /// Hable's filmic curve: highlights roll off, shadows get a toe.
        Filmic = "filmic",
        /// Sobotka's AgX: as filmic, and bright colours fade to white as film does.
        Agx = "agx",
    }
}

#[allow(clippy::derivable_impls, reason = "the table above derives no default")]
impl Default for ToneCurve {
    fn default() -> Self {
        Self::Agx
    }
}

/// Luminance that automatic exposure makes of the geometric mean: the middle grey of photography.
const MIDDLE_GREY: f64 = 0.18;
/// Automatic exposure changes nothing by more stops than this.
const MOST_STOPS: f64 = 20.0;

/// Measures a picture, pixel by pixel, for automatic exposure: the geometric mean of luminance becomes middle grey (Reinhard et al. 2002,
/// "Photographic Tone Reproduction for Digital Images", equation 1). Black pixels, of which backgrounds often are, do not count.
#[derive(Debug, Default)]
pub struct Meter {
    sum_of_logarithms: f64,
    pixels: u64,
}

impl Meter {
    pub fn add(&mut self, pixels: &[[f32; 3]]) {
        for pixel in pixels {
            let luminance = Spectrum::from_f32(*pixel).luminance();
            if luminance.is_finite() && luminance > 1e-12 {
                self.sum_of_logarithms += luminance.log2();
                self.pixels += 1;
            }
        }
    }

    /// Stops by which the picture is to be brightened; 0 for a black one.
    pub fn stops(&self) -> f64 {
        if self.pixels == 0 {
            return 0.0;
        }
        (MIDDLE_GREY.log2() - self.sum_of_logarithms / self.pixels as f64).clamp(-MOST_STOPS, MOST_STOPS)
    }
}

/// A display whose numbers are known: it maps one pixel at a time.
#[derive(Debug, Clone)]
pub struct Developer {
    /// Exposure and white balance together.
    matrix: DMat3,
    /// The factor of a developer that only multiplies.
    factor: Option<f32>,
    curve: ToneCurve,
    agx: Agx,
}

impl Developer {
    /// `meter` has seen the picture if exposure is automatic.
    pub fn new(display: &Display, meter: &Meter) -> Self {
        let stops = match display.exposure {
            Exposure::Auto => meter.stops(),
            Exposure::Stops(stops) => f64::from(stops),
        };
        let balance = display.white_kelvin.map(white_balance);
        let matrix = stops.exp2() * balance.unwrap_or(DMat3::IDENTITY);
        let factor = balance.is_none().then(|| (stops as f32).exp2());
        Self { matrix, factor, curve: display.tone_curve, agx: Agx::new() }
    }

    /// The 8-bit sRGB codes of a pixel.
    pub fn bytes(&self, pixel: [f32; 3]) -> [u8; 3] {
        if let (Some(factor), ToneCurve::Clip) = (self.factor, self.curve) {
            return pixel.map(|radiance| srgb_byte(radiance * factor));
        }
        // A value that is not a number, or is negative because of a filter, is black.
        let possible = |value: f64| if value > 0.0 { value.min(1e30) } else { 0.0 };
        let scene = self.matrix * DVec3::from_array(pixel.map(|value| possible(f64::from(value))));
        let shown = match self.curve {
            ToneCurve::Clip => scene,
            ToneCurve::Filmic => scene.map(filmic),
            ToneCurve::Agx => self.agx.develop(scene.map(possible)),
        };
        shown.to_array().map(|value| srgb_byte(value as f32))
    }
}

/// Hable's curve (Hable 2010, "Uncharted 2: HDR Lighting", GDC), with the constants and the exposure bias of 2 published with it; 11.2 becomes
/// white.
fn filmic(radiance: f64) -> f64 {
    const SHOULDER: f64 = 0.15;
    const LINEAR: f64 = 0.50;
    const LINEAR_ANGLE: f64 = 0.10;
    const TOE: f64 = 0.20;
    const TOE_NUMERATOR: f64 = 0.02;
    const TOE_DENOMINATOR: f64 = 0.30;
    const WHITE: f64 = 11.2;
    const BIAS: f64 = 2.0;
    let curve = |x: f64| {
        (x * (SHOULDER * x + LINEAR_ANGLE * LINEAR) + TOE * TOE_NUMERATOR) / (x * (SHOULDER * x + LINEAR) + TOE * TOE_DENOMINATOR)
            - TOE_NUMERATOR / TOE_DENOMINATOR
    };
    curve((BIAS * radiance).max(0.0)) / curve(WHITE)
}

/// AgX as Sobotka's configuration defines it (github.com/sobotka/AgX, 2022): colours are drawn towards grey by a matrix, brought to a scale of
/// stops from 10 below to 6.5 above middle grey, and put through a sigmoid of slope 2 whose two arms have the powers 3 and 3.25. The
/// matrix is undone behind it, which brings back the saturation that the display can show.
#[derive(Debug, Clone)]
struct Agx {
    inset: DMat3,
    outset: DMat3,
    toe: Arm,
    shoulder: Arm,
}

/// One arm of the sigmoid. The lower one runs backwards.
#[derive(Debug, Clone)]
struct Arm {
    power: f64,
    /// Makes the arm meet its end of the curve.
    scale: f64,
}

impl Arm {
    /// An arm that rises by `rise` over `run`.
    fn new(run: f64, rise: f64, power: f64) -> Self {
        let unbent = Agx::SLOPE * run;
        let scale = (unbent.powf(-power) * ((unbent / rise).powf(power) - 1.0)).powf(-1.0 / power);
        Self { power, scale }
    }

    /// How far it has risen so far from the pivot.
    fn at(&self, along: f64) -> f64 {
        let term = Agx::SLOPE * along / self.scale;
        self.scale * term / (1.0 + term.powf(self.power)).powf(1.0 / self.power)
    }
}

impl Agx {
    const STOPS_BELOW: f64 = 10.0;
    const STOPS_ABOVE: f64 = 6.5;
    const SLOPE: f64 = 2.0;
    const TOE_POWER: f64 = 3.0;
    const SHOULDER_POWER: f64 = 3.25;
    /// The place of middle grey on the scale of stops, and the value that it becomes.
    const PIVOT: [f64; 2] = [Self::STOPS_BELOW / (Self::STOPS_BELOW + Self::STOPS_ABOVE), 0.5];
    /// The power that encodes the result of the sigmoid.
    const ENCODING: f64 = 2.2;

    fn new() -> Self {
        let inset = DMat3::from_cols_array(&[
            0.842_479_062_253_094,
            0.042_328_242_261_012_3,
            0.042_375_654_905_705_1,
            0.078_433_599_999_999_2,
            0.878_468_636_469_772,
            0.078_433_6,
            0.079_223_745_147_764_3,
            0.079_166_127_460_543_4,
            0.879_142_973_793_104,
        ]);
        let [pivot_x, pivot_y] = Self::PIVOT;
        let toe = Arm::new(pivot_x, pivot_y, Self::TOE_POWER);
        let shoulder = Arm::new(1.0 - pivot_x, 1.0 - pivot_y, Self::SHOULDER_POWER);
        Self { inset, outset: inset.inverse(), toe, shoulder }
    }

    /// From scene to display, linear both.
    fn develop(&self, scene: DVec3) -> DVec3 {
        let encoded = (self.inset * scene).map(|value| {
            let stops = (value.max(1e-10) / MIDDLE_GREY).log2();
            self.sigmoid(((stops + Self::STOPS_BELOW) / (Self::STOPS_BELOW + Self::STOPS_ABOVE)).clamp(0.0, 1.0))
        });
        (self.outset * encoded).map(|value| value.clamp(0.0, 1.0).powf(Self::ENCODING))
    }

    /// Through the pivot with the slope; (0, 0) and (1, 1) are its ends.
    fn sigmoid(&self, x: f64) -> f64 {
        let [pivot_x, pivot_y] = Self::PIVOT;
        if x >= pivot_x { pivot_y + self.shoulder.at(x - pivot_x) } else { pivot_y - self.toe.at(pivot_x - x) }
    }
}

/// Maps linear Rec.709 so that the light of a black body becomes white: von Kries' adaptation in the cone space of Bradford (Lam 1985).
fn white_balance(kelvin: f64) -> DMat3 {
    // Rows of the published matrices, as columns of their transposes.
    let rows = |rows: [[f64; 3]; 3]| DMat3::from_cols_array_2d(&rows).transpose();
    let bradford = rows([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]);
    let to_xyz = rows([
        [0.412_390_799_265_959, 0.357_584_339_383_878, 0.180_480_788_401_834],
        [0.212_639_005_871_51, 0.715_168_678_767_756, 0.072_192_315_360_734],
        [0.019_330_818_715_592, 0.119_194_779_794_626, 0.950_532_152_249_661],
    ]);
    let of_body = tristimulus(kelvin);
    let cones = bradford * to_xyz;
    let (white, body) = (cones * DVec3::ONE, bradford * (of_body / of_body.y));
    cones.inverse() * DMat3::from_diagonal(white / body) * cones
}

/// One linear value as the nearest 8-bit sRGB code (IEC 61966-2-1); clamped to 0..1, NaN becomes 0.
pub fn srgb_byte(linear: f32) -> u8 {
    let clamped = if linear > 0.0 { linear.min(1.0) } else { 0.0 };
    let encoded = if clamped <= 0.003_130_8 { 12.92 * clamped } else { 1.055 * clamped.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::black_body::black_body;

    fn developer(display: Display) -> Developer {
        Developer::new(&display, &Meter::default())
    }

    #[test]
    fn the_srgb_curve_meets_its_known_points() {
        assert_eq!(srgb_byte(0.0), 0);
        assert_eq!(srgb_byte(1.0), 255);
        // Middle grey: 18 % is code 118, half the radiance is code 188.
        assert_eq!(srgb_byte(0.18), 118);
        assert_eq!(srgb_byte(0.5), 188);
        // In the curve's linear part: 0.002 × 12.92 × 255 = 6.6.
        assert_eq!(srgb_byte(0.002), 7);
    }

    #[test]
    fn values_outside_the_range_are_clamped() {
        assert_eq!(srgb_byte(-1.0), 0);
        assert_eq!(srgb_byte(7.0), 255);
        assert_eq!(srgb_byte(f32::INFINITY), 255);
        assert_eq!(srgb_byte(f32::NAN), 0);
        for curve in ToneCurve::ALL {
            let show = developer(Display { tone_curve: curve, white_kelvin: Some(3000.0), ..Display::default() });
            assert_eq!(show.bytes([f32::NAN, -1.0, 0.0]), [0; 3], "{curve:?}");
            assert_eq!(show.bytes([f32::INFINITY; 3])[0], 255, "{curve:?}");
        }
    }

    #[test]
    fn codes_rise_with_radiance() {
        for curve in ToneCurve::ALL {
            let show = developer(Display { tone_curve: curve, ..Display::default() });
            let codes: Vec<[u8; 3]> = (0..=4096).map(|step| show.bytes([step as f32 / 512.0; 3])).collect();
            assert!(codes.is_sorted(), "{curve:?}");
            assert_eq!(codes[0], [0; 3], "{curve:?}");
            // The rows of the published matrix add up to 1 within 1e-4.
            assert!(codes.iter().all(|code| code[0].abs_diff(code[2]) <= 1), "grey stays grey: {curve:?}");
        }
    }

    /// Values that Hable published: 0 stays 0, 11.2 with the bias undone is white.
    #[test]
    fn the_filmic_curve_meets_its_ends() {
        assert!(filmic(0.0).abs() < 1e-15);
        approx::assert_relative_eq!(filmic(5.6), 1.0, max_relative = 1e-12);
        // By hand, x = 1: (0.15 + 0.05 + 0.004) / (0.15 + 0.5 + 0.06) − 1/15 = 0.220657, at x = 11.2: 0.725130.
        approx::assert_relative_eq!(filmic(0.5), 0.220_657 / 0.725_130, max_relative = 1e-5);
    }

    #[test]
    fn agx_meets_its_pivot_and_ends_with_its_slope() {
        let agx = Agx::new();
        let [x, y] = Agx::PIVOT;
        approx::assert_relative_eq!(agx.sigmoid(x), y, max_relative = 1e-12);
        approx::assert_relative_eq!(agx.sigmoid(1.0), 1.0, max_relative = 1e-9);
        assert!(agx.sigmoid(0.0).abs() < 1e-9);
        for side in [-1e-6, 1e-6] {
            approx::assert_relative_eq!((agx.sigmoid(x + side) - y) / side, Agx::SLOPE, max_relative = 1e-4);
        }
        // Middle grey keeps its hue and becomes 0.5 to the power of 2.2.
        let grey = agx.develop(DVec3::splat(MIDDLE_GREY));
        approx::assert_relative_eq!(grey.x, 0.5_f64.powf(2.2), max_relative = 1e-3);
        // Sixth-order fit of Wrensch 2023 ("Minimal AgX Implementation") to the same curve, good to 4e-3.
        let fit = |x: f64| {
            15.5 * x.powi(6) - 40.14 * x.powi(5) + 31.96 * x.powi(4) - 6.868 * x.powi(3) + 0.4298 * x * x + 0.1191 * x - 0.00232
        };
        for step in 0..=20 {
            let x = f64::from(step) / 20.0;
            assert!((agx.sigmoid(x) - fit(x)).abs() < 8e-3, "{x}: {} {}", agx.sigmoid(x), fit(x));
        }
        // Bright red fades, where clipping keeps it.
        let fades = |curve| developer(Display { tone_curve: curve, ..Display::default() }).bytes([50.0, 0.5, 0.5])[1];
        assert!(fades(ToneCurve::Agx) > fades(ToneCurve::Clip), "{} {}", fades(ToneCurve::Agx), fades(ToneCurve::Clip));
    }

    #[test]
    fn automatic_exposure_brings_the_mean_to_middle_grey() {
        let mut meter = Meter::default();
        meter.add(&[[0.01; 3], [0.04; 3], [0.0; 3], [f32::NAN; 3]]);
        approx::assert_relative_eq!(meter.stops(), (0.18_f64 / 0.02).log2(), max_relative = 1e-6);
        let auto = Display { exposure: Exposure::Auto, tone_curve: ToneCurve::Clip, ..Display::default() };
        assert_eq!(Developer::new(&auto, &meter).bytes([0.02; 3]), [118; 3]);
        // Negative control: not without it.
        assert_ne!(
            Developer::new(&Display { tone_curve: ToneCurve::Clip, ..Display::default() }, &meter).bytes([0.02; 3]),
            [118; 3]
        );
        assert_eq!(Meter::default().stops(), 0.0);
    }

    #[test]
    fn the_light_of_the_chosen_temperature_becomes_white() {
        for kelvin in [2700.0, 4000.0, 9000.0] {
            let white = white_balance(kelvin) * black_body(kelvin).to_vector();
            assert!((white / white.y - DVec3::ONE).abs().max_element() < 2e-3, "{kelvin}: {white}");
            let other = white_balance(kelvin) * DVec3::ONE;
            assert!((other / other.y - DVec3::ONE).abs().max_element() > 0.05, "{kelvin}: {other}");
        }
    }

    #[test]
    fn curves_have_names() {
        assert_eq!(ToneCurve::NAMES.iter().map(|name| name.name).collect::<Vec<_>>(), ["clip", "filmic", "agx"]);
        assert_eq!([Exposure::Auto, Exposure::Stops(-1.5)].map(|exposure| exposure.to_string()), ["auto", "-1.5"]);
    }
}
