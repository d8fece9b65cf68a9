//! A perspective that a lens distorts.

use glam::{DMat2, DVec2, DVec3, DVec4};

use super::intrinsics::Intrinsics;
use super::model::{CameraModel, Eyes, ViewPlace};
use super::polynomial;
use super::rising::Rising;
use crate::scene::check::Check;

/// A perspective camera with radial and tangential distortion, by OpenCV's formula (calib3d, "Detailed Description"): what a pinhole shows at (x, y) of
/// the plane at distance 1, y down, is shown at (x·d + 2p₁xy + p₂(r² + 2x²), y·d + p₁(r² + 2y²) + 2p₂xy), where
/// d = (1 + k₁r² + k₂r⁴ + k₃r⁶) / (1 + k₄r² + k₅r⁴ + k₆r⁶).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrownConrady {
    pub(crate) intrinsics: Intrinsics,
    /// k₁ to k₆.
    pub(crate) radial: [f64; 6],
    /// p₁ and p₂.
    pub(crate) tangential: [f64; 2],
    /// How far r·d rises.
    rising: Rising,
}

/// Farthest from the axis that is seen, on the plane at distance 1: 89.9 degrees.
const FARTHEST: f64 = 573.0;
/// The part of the way to a pole that is seen.
const BEFORE_POLE: f64 = 1.0 - 1e-5;
/// Newton steps for the tangential part.
const STEPS: usize = 20;
/// How near to the place on the picture its direction must be shown for the place to see it, on the plane at distance 1.
const TOLERANCE: f64 = 2e-6;

impl BrownConrady {
    /// A camera with coefficients k₁ to k₆, and p₁ and p₂.
    pub fn new(intrinsics: Intrinsics, radial: [f64; 6], tangential: [f64; 2]) -> Self {
        let mut camera = Self { intrinsics, radial, tangential, rising: Rising::default() };
        camera.rising = camera.find_rising();
        camera
    }

    /// The lens distorts nothing.
    pub fn is_undistorted(&self) -> bool {
        self.radial == [0.0; 6] && self.tangential == [0.0; 2]
    }

    /// r·d and its derivative by r.
    fn radial(&self, r: f64) -> (f64, f64) {
        let [k1, k2, k3, k4, k5, k6] = self.radial;
        let s = r * r;
        let (over, under) = (1.0 + s * (k1 + s * (k2 + s * k3)), 1.0 + s * (k4 + s * (k5 + s * k6)));
        let (over_slope, under_slope) = (k1 + s * (2.0 * k2 + s * 3.0 * k3), k4 + s * (2.0 * k5 + s * 3.0 * k6));
        let d = over / under;
        (r * d, d + 2.0 * s * (over_slope - d * under_slope) / under)
    }

    /// How far r·d rises: up to the first place where it turns back, or where the fraction has a pole.
    fn find_rising(&self) -> Rising {
        let [k1, k2, k3, k4, k5, k6] = self.radial;
        let (over, under) = ([1.0, k1, k2, k3], [1.0, k4, k5, k6]);
        // The numerator of the derivative, in s = r²: (A + 2sA')B − 2sAB'.
        let widened = |coefficients: [f64; 4]| {
            let slopes: [f64; 4] = std::array::from_fn(|power| 2.0 * power as f64 * coefficients[power]);
            (std::array::from_fn::<f64, 4, _>(|power| coefficients[power] + slopes[power]), slopes)
        };
        let first = polynomial::product(&widened(over).0, &under);
        let second = polynomial::product(&over, &widened(under).1);
        let slope: Vec<f64> = first.iter().zip(&second).map(|(first, second)| first - second).collect();
        let end = FARTHEST * FARTHEST;
        let turns = polynomial::sign_changes(&slope, end);
        let poles = polynomial::sign_changes(&under, end);
        // Before a pole the value rises without end.
        let poles = poles.into_iter().map(|pole| pole * BEFORE_POLE);
        let end = turns.into_iter().chain(poles).fold(end, f64::min).sqrt();
        Rising { end, most: self.radial(end).0 }
    }

    /// The place at which a point of the plane at distance 1 is shown on it, and the derivative of that.
    fn distorted(&self, point: DVec2) -> (DVec2, DMat2) {
        let [p1, p2] = self.tangential;
        let DVec2 { x, y } = point;
        let r = point.length();
        let (shown, slope) = if r > 0.0 { self.radial(r) } else { (0.0, 1.0) };
        let d = if r > 0.0 { shown / r } else { 1.0 };
        let at = DVec2::new(
            x * d + 2.0 * p1 * x * y + p2 * (r * r + 2.0 * x * x),
            y * d + p1 * (r * r + 2.0 * y * y) + 2.0 * p2 * x * y,
        );
        // Along the radius the slope, across it d.
        let towards = if r > 0.0 { point / r } else { DVec2::X };
        let bend = slope - d;
        let mixed = bend * towards.x * towards.y + 2.0 * p1 * x + 2.0 * p2 * y;
        let derivative = DMat2::from_cols(
            DVec2::new(d + bend * towards.x * towards.x + 2.0 * p1 * y + 6.0 * p2 * x, mixed),
            DVec2::new(mixed, d + bend * towards.y * towards.y + 6.0 * p1 * y + 2.0 * p2 * x),
        );
        (at, derivative)
    }

    /// The point of the plane at distance 1 that is shown at another one; None where none is. First without the tangential part, along the
    /// radius; from there by Newton's method, which stays where the radial part rises.
    fn undistorted(&self, shown: DVec2) -> Option<DVec2> {
        let rising = self.rising;
        let distance = shown.length();
        let towards = if distance > 0.0 { shown / distance } else { DVec2::X };
        let without = rising.inverse(distance, |r| self.radial(r));
        if self.tangential == [0.0; 2] {
            return Some(without? * towards);
        }
        let mut point = without.unwrap_or(rising.end) * towards;
        for _ in 0..STEPS {
            let (found, derivative) = self.distorted(point);
            if derivative.determinant() <= 0.0 {
                return None;
            }
            let next = (point - derivative.inverse() * (found - shown)).clamp_length_max(rising.end);
            if (next - point).length() <= f64::EPSILON * next.length() {
                break;
            }
            point = next;
        }
        let (found, derivative) = self.distorted(point);
        let is_shown = (found - shown).length() <= TOLERANCE * (1.0 + distance) && derivative.determinant() > 0.0;
        is_shown.then_some(point)
    }
}

impl CameraModel for BrownConrady {
    fn check(&self) -> Check {
        self.intrinsics.check()?;
        if !self.radial.iter().chain(&self.tangential).all(|coefficient| coefficient.is_finite()) {
            return Err("the coefficients of its distortion must be finite".into());
        }
        Ok(())
    }

    fn check_view(&self, size: DVec2) -> Check {
        super::blind::sees_something(self, size, self.intrinsics.axis_in(size))
    }

    fn direction(&self, place: &ViewPlace) -> Option<DVec3> {
        let point = self.undistorted(self.intrinsics.on_plane(place))?;
        Some(DVec3::new(point.x, -point.y, -1.0))
    }

    /// Factor and summand of places; k₁ to k₄; k₅, k₆, p₁, p₂; up to where r·d rises, and its value there.
    fn words(&self, size: DVec2) -> [DVec4; 4] {
        let ([k1, k2, k3, k4, k5, k6], [p1, p2]) = (self.radial, self.tangential);
        let Rising { end, most } = self.rising;
        [self.intrinsics.words(size), DVec4::new(k1, k2, k3, k4), DVec4::new(k5, k6, p1, p2), DVec4::new(end, most, 0.0, 0.0)]
    }

    fn eyes(&self) -> Eyes {
        Eyes::Pair
    }

    fn has_plane(&self) -> bool {
        true
    }
}
