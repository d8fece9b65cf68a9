//! Gradient noise in two dimensions (Perlin 1985, with the smoother interpolation of Perlin 2002).
//!
//! Every lattice point has a gradient, a unit vector in one of eight directions, chosen by the top three bits of
//! [`lattice_bits`]. The noise at a point is the gradients' linear functions at the four corners of its cell, interpolated with the
//! weights 6t⁵ − 15t⁴ + 10t³, times √2: unit gradients reach √½ at most.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use glam::DVec2;

use super::lattice::{cell_of, lattice_bits};

/// By the top three bits: 0 … 7.
const GRADIENTS: [DVec2; 8] = [
    DVec2::new(1.0, 0.0),
    DVec2::new(-1.0, 0.0),
    DVec2::new(0.0, 1.0),
    DVec2::new(0.0, -1.0),
    DVec2::new(FRAC_1_SQRT_2, FRAC_1_SQRT_2),
    DVec2::new(-FRAC_1_SQRT_2, FRAC_1_SQRT_2),
    DVec2::new(FRAC_1_SQRT_2, -FRAC_1_SQRT_2),
    DVec2::new(-FRAC_1_SQRT_2, -FRAC_1_SQRT_2),
];

/// Octaves beyond this are finer than any f64 can tell apart.
const MOST_OCTAVES: u32 = 32;

/// Octaves of noise, each of half the amplitude and twice the frequency of the one before, over the sum of the amplitudes, mapped
/// from [−1, 1] to [0, 1]. All octaves have the same gradients.
pub fn share(point: DVec2, octaves: u32, seed: u32) -> f64 {
    let (mut sum, mut amplitudes, mut amplitude, mut frequency) = (0.0, 0.0, 1.0, 1.0);
    for _ in 0..octaves.clamp(1, MOST_OCTAVES) {
        sum += amplitude * noise(point * frequency, seed);
        amplitudes += amplitude;
        amplitude *= 0.5;
        frequency *= 2.0;
    }
    (0.5 * (sum / amplitudes + 1.0)).clamp(0.0, 1.0)
}

/// How [`share`] changes with the place. Each octave adds as much as the first: it is half as high and twice as fine as the one before.
pub fn gradient(point: DVec2, octaves: u32, seed: u32) -> DVec2 {
    let (mut sum, mut amplitudes, mut amplitude, mut frequency) = (DVec2::ZERO, 0.0, 1.0, 1.0);
    for _ in 0..octaves.clamp(1, MOST_OCTAVES) {
        sum += noise_gradient(point * frequency, seed);
        amplitudes += amplitude;
        amplitude *= 0.5;
        frequency *= 2.0;
    }
    0.5 * sum / amplitudes
}

/// How [`noise`] changes with the place: the gradients at the corners, interpolated, and what the change of the weights makes of the
/// differences between the corners.
fn noise_gradient(point: DVec2, seed: u32) -> DVec2 {
    let ([x, y], place) = cell_of(point);
    let corner = |right: i64, up: i64| {
        let bits = lattice_bits(x.wrapping_add(right), y.wrapping_add(up), seed);
        let gradient = GRADIENTS[(bits >> 29) as usize];
        (gradient, gradient.dot(place - DVec2::new(right as f64, up as f64)))
    };
    let [(g00, h00), (g10, h10), (g01, h01), (g11, h11)] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
    let weight = DVec2::new(fade(place.x), fade(place.y));
    let gradients = g00.lerp(g10, weight.x).lerp(g01.lerp(g11, weight.x), weight.y);
    let differences =
        DVec2::new((h10 - h00) + weight.y * ((h11 - h01) - (h10 - h00)), (h01 - h00) + weight.x * ((h11 - h10) - (h01 - h00)));
    SQRT_2 * (gradients + DVec2::new(fade_slope(place.x), fade_slope(place.y)) * differences)
}

/// In [−1, 1]; 0 at the lattice points.
fn noise(point: DVec2, seed: u32) -> f64 {
    let ([x, y], place) = cell_of(point);
    let corner = |right: i64, up: i64| {
        let bits = lattice_bits(x.wrapping_add(right), y.wrapping_add(up), seed);
        GRADIENTS[(bits >> 29) as usize].dot(place - DVec2::new(right as f64, up as f64))
    };
    let weight = DVec2::new(fade(place.x), fade(place.y));
    let row = |up: i64| {
        let (left, right) = (corner(0, up), corner(1, up));
        left + weight.x * (right - left)
    };
    let (lower, upper) = (row(0), row(1));
    SQRT_2 * (lower + weight.y * (upper - lower))
}

/// 6t⁵ − 15t⁴ + 10t³: from 0 to 1, first and second derivative 0 at both ends.
fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// The derivative of [`fade`]: 30t²(1 − t)².
fn fade_slope(t: f64) -> f64 {
    30.0 * (t * (1.0 - t)).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points() -> impl Iterator<Item = DVec2> {
        (0..20_000).map(|i| DVec2::new(f64::from(i) * 0.618_034 % 17.0 - 8.0, f64::from(i) * 0.414_214 % 13.0 - 6.0))
    }

    #[test]
    fn noise_is_bounded_smooth_and_zero_on_the_lattice() {
        let (mut low, mut high) = (0.0_f64, 0.0_f64);
        for point in points() {
            let value = noise(point, 5);
            (low, high) = (low.min(value), high.max(value));
            let step = DVec2::new(1e-6, -2e-6);
            assert!((noise(point + step, 5) - value).abs() < 2e-5, "{point}");
            assert_eq!(noise(point.round(), 5), 0.0);
        }
        assert!(low > -1.0 && high < 1.0 && low < -0.7 && high > 0.7, "{low} {high}");
    }

    #[test]
    fn octaves_add_detail_within_the_bounds() {
        let roughness = |octaves| {
            let difference = |p: DVec2| share(p + DVec2::new(0.02, 0.0), octaves, 1) - share(p, octaves, 1);
            points().map(|p| difference(p).powi(2)).sum::<f64>()
        };
        assert!(roughness(6) > 1.3 * roughness(1), "{} {}", roughness(6), roughness(1));
        assert!(points().all(|p| (0.0..=1.0).contains(&share(p, 6, 1))));
        assert_ne!(share(DVec2::new(0.3, 0.4), 1, 0), share(DVec2::new(0.3, 0.4), 1, 1));
    }
}
