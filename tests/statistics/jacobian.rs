//! A test that a sampling map stretches the unit square as its density says.
//!
//! A map x(u₁, u₂) of uniform numbers onto a surface has the density 1/|∂x/∂u₁ × ∂x/∂u₂| per unit of area; on the unit sphere that is
//! the density per solid angle.

use glam::DVec3;

/// Step of the differences: small against the maps' features, large against the rounding of f64.
const STEP: f64 = 1e-4;

/// Density of `map` at `u`, by fourth-order central differences. `u` must keep a distance of 2·10⁻⁴ from the square's edge.
/// Infinite where the map is constant, as delta lobes are.
pub fn density_by_differences(map: impl Fn([f64; 2]) -> DVec3, u: [f64; 2]) -> f64 {
    let derivative = |axis: usize| {
        let at = |steps: f64| {
            let mut moved = u;
            moved[axis] += steps * STEP;
            map(moved)
        };
        (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * STEP)
    };
    derivative(0).cross(derivative(1)).length().recip()
}

/// The place where a stated density is furthest from the map's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JacobianDeviation {
    pub u: [f64; 2],
    pub by_differences: f64,
    pub stated: f64,
    /// |stated − by differences| / by differences.
    pub relative: f64,
}

/// Compares the density a sampler states with the one its map has, at the centres of a `resolution` × `resolution` grid over the
/// unit square, and returns the worst place. A number that is none counts as infinitely far off. `resolution` must not be 0.
pub fn worst_jacobian_deviation(
    map: impl Fn([f64; 2]) -> DVec3,
    density: impl Fn(DVec3) -> f64,
    resolution: u32,
) -> JacobianDeviation {
    let centre = |index: u32| (f64::from(index) + 0.5) / f64::from(resolution);
    let mut worst =
        JacobianDeviation { u: [f64::NAN; 2], by_differences: f64::NAN, stated: f64::NAN, relative: f64::NEG_INFINITY };
    for i in 0..resolution {
        for j in 0..resolution {
            let u = [centre(i), centre(j)];
            let (stated, by_differences) = (density(map(u)), density_by_differences(&map, u));
            let deviation = ((stated - by_differences) / by_differences).abs();
            let relative = if deviation.is_nan() { f64::INFINITY } else { deviation };
            if relative > worst.relative {
                worst = JacobianDeviation { u, by_differences, stated, relative };
            }
        }
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn spherical(cosine: f64, azimuth: f64) -> DVec3 {
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine)
    }

    /// Maps and densities of the textbook (Pharr, Jakob and Humphreys, appendix A.5).
    #[test]
    fn textbook_maps() {
        let cosine = worst_jacobian_deviation(|[a, b]| spherical((1.0 - a).sqrt(), TAU * b), |w| w.z / PI, 16);
        let hemisphere = worst_jacobian_deviation(|[a, b]| spherical(a, TAU * b), |_| 1.0 / TAU, 16);
        let phong =
            worst_jacobian_deviation(|[a, b]| spherical(a.powf(1.0 / 101.0), TAU * b), |w| 101.0 / TAU * w.z.powi(100), 16);
        let disk = worst_jacobian_deviation(
            |[a, b]| 3.0 * a.sqrt() * DVec3::from((glam::DVec2::from_angle(TAU * b), 0.0)),
            |_| 1.0 / (9.0 * PI),
            16,
        );
        for (name, worst) in [("cosine", cosine), ("hemisphere", hemisphere), ("Phong", phong), ("disk", disk)] {
            assert!(worst.relative < 1e-6, "{name}: {worst:?}");
        }
    }

    /// One source writes θ = acos(ξ) for the cosine lobe, which is the uniform hemisphere; and an energy error of 1 %.
    #[test]
    fn wrong_densities_are_found() {
        let slip = worst_jacobian_deviation(|[a, b]| spherical(a, TAU * b), |w| w.z / PI, 16);
        assert!(slip.relative > 0.5, "{slip:?}");
        let energy = worst_jacobian_deviation(|[a, b]| spherical((1.0 - a).sqrt(), TAU * b), |w| 1.01 * w.z / PI, 16);
        assert!((energy.relative - 0.01).abs() < 1e-6, "{energy:?}");
        assert_eq!(worst_jacobian_deviation(|_| DVec3::NAN, |_| 1.0, 2).relative, f64::INFINITY);
    }
}
