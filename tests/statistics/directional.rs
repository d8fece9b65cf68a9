//! A test that a sampler of directions follows the density it states.
//!
//! Directions are counted in bins over (cos θ, φ); the density is integrated over each bin, and Pearson's χ² test compares the two.
//! A sampler may decline to return a direction (a lobe cut by the horizon): its density then integrates to less than 1, and the
//! missing rest is a bin of its own.

use glam::{DMat3, DVec3};

use super::chi_squared::{ChiSquared, chi_squared_test};
use super::quadrature::{Integral, integrate_rectangle};
use super::random::SplitMix64;

/// Bins over the sphere about an axis.
#[derive(Debug, Clone)]
pub struct SphereBins {
    /// Columns: two directions across, and the axis θ is measured from.
    frame: DMat3,
    /// Ascending cosines from −1 to 1.
    cosine_edges: Vec<f64>,
    azimuth_bins: usize,
}

impl SphereBins {
    /// Bins of equal solid angle.
    pub fn uniform(axis: DVec3, cosine_bins: usize, azimuth_bins: usize) -> Self {
        let count = cosine_bins.max(1);
        let inner = (1..count).map(|i| -1.0 + 2.0 * i as f64 / count as f64).collect::<Vec<_>>();
        Self::with_cosine_edges(axis, &inner, azimuth_bins)
    }

    /// Bins with chosen limits of cos θ, ascending and between −1 and 1: for a narrow lobe, dense near 1 with the lobe as the axis.
    pub fn with_cosine_edges(axis: DVec3, inner_edges: &[f64], azimuth_bins: usize) -> Self {
        let axis = axis.normalize();
        let (across, along) = axis.any_orthonormal_pair();
        let mut cosine_edges = vec![-1.0];
        cosine_edges.extend_from_slice(inner_edges);
        cosine_edges.push(1.0);
        Self { frame: DMat3::from_cols(across, along, axis), cosine_edges, azimuth_bins: azimuth_bins.max(1) }
    }

    fn len(&self) -> usize {
        (self.cosine_edges.len() - 1) * self.azimuth_bins
    }

    /// The bin a unit vector falls into.
    fn index(&self, direction: DVec3) -> usize {
        let local = self.frame.transpose() * direction;
        let inner = &self.cosine_edges[1..self.cosine_edges.len() - 1];
        let row = inner.partition_point(|&edge| edge <= local.z);
        let turn = (local.y.atan2(local.x) / std::f64::consts::TAU).rem_euclid(1.0);
        // rem_euclid may round up to 1.
        row * self.azimuth_bins + ((turn * self.azimuth_bins as f64) as usize).min(self.azimuth_bins - 1)
    }

    /// The density's integral over one bin.
    fn integral(&self, bin: usize, density: &impl Fn(DVec3) -> f64, tolerance: f64) -> Integral {
        let (row, column) = (bin / self.azimuth_bins, bin % self.azimuth_bins);
        let azimuth = |edge: usize| std::f64::consts::TAU * edge as f64 / self.azimuth_bins as f64;
        let over_bin = |cosine: f64, azimuth: f64| {
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            density(self.frame * DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine))
        };
        let cosines = [self.cosine_edges[row], self.cosine_edges[row + 1]];
        integrate_rectangle(over_bin, cosines, [azimuth(column), azimuth(column + 1)], tolerance)
    }
}

/// The result of [`test_directional_sampler`].
#[derive(Debug, Clone, Copy)]
pub struct DirectionalReport {
    pub samples: u64,
    /// Samples for which the sampler returned no direction.
    pub declined: u64,
    /// Directions whose stated density is zero or less: they cannot occur.
    pub without_density: u64,
    /// Directions that are not of unit length (within 10⁻⁴) or not finite.
    pub not_unit: u64,
    /// The density's integral over the sphere.
    pub integral: Integral,
    pub chi_squared: ChiSquared,
}

impl DirectionalReport {
    /// The density integrates to at most 1, every direction can occur, and the counts are explained by chance at level `alpha`
    /// (corrected by the caller with [`super::sidak`] where many samplers are tested).
    pub fn passes(&self, alpha: f64) -> bool {
        self.without_density == 0
            && self.not_unit == 0
            && self.integral.value <= 1.0 + self.slack()
            && self.chi_squared.p_value >= alpha
    }

    /// How far from 1 the integral may be by the quadrature's own error.
    fn slack(&self) -> f64 {
        slack(self.integral)
    }
}

fn slack(integral: Integral) -> f64 {
    integral.error + 1e-6
}

/// Draws `samples` directions and tests them against `density` (per solid angle, smooth part only; delta lobes have none).
/// `sample` maps three uniform numbers from [0, 1) to a direction or to nothing; they depend on `seed` alone.
pub fn test_directional_sampler(
    bins: &SphereBins,
    samples: u64,
    seed: u64,
    sample: impl Fn([f64; 3]) -> Option<DVec3>,
    density: impl Fn(DVec3) -> f64,
) -> DirectionalReport {
    let mut counts = Counts { observed: vec![0; bins.len() + 1], without_density: 0, not_unit: 0 };
    let mut random = SplitMix64::new(seed);
    for _ in 0..samples {
        let direction = sample([random.uniform(), random.uniform(), random.uniform()]);
        counts.take(bins, direction, &density);
    }

    // An error of a twentieth of a count per bin is far below the counts' own scatter.
    let tolerance = 0.05 / samples.max(1) as f64;
    let mut expected = Vec::with_capacity(bins.len() + 1);
    let mut integral = Integral::default();
    for bin in 0..bins.len() {
        let part = bins.integral(bin, &density, tolerance);
        expected.push(part.value);
        integral += part;
    }
    // An integral that is 1 within the quadrature's error counts as 1: no sample is then expected to be
    // declined.
    let normalised = (1.0 - integral.value).abs() <= slack(integral);
    let scale = samples as f64 / if normalised { integral.value } else { 1.0 };
    expected.iter_mut().for_each(|part| *part *= scale);
    expected.push(if normalised { 0.0 } else { scale * (1.0 - integral.value).max(0.0) });

    DirectionalReport {
        samples,
        declined: counts.observed[bins.len()],
        without_density: counts.without_density,
        not_unit: counts.not_unit,
        integral,
        chi_squared: chi_squared_test(&counts.observed, &expected),
    }
}

struct Counts {
    /// One per bin, and last those without a direction.
    observed: Vec<u64>,
    without_density: u64,
    not_unit: u64,
}

impl Counts {
    fn take(&mut self, bins: &SphereBins, direction: Option<DVec3>, density: &impl Fn(DVec3) -> f64) {
        let Some(direction) = direction else {
            self.observed[bins.len()] += 1;
            return;
        };
        let unit = (direction.length() - 1.0).abs() < 1e-4;
        if !unit {
            self.not_unit += 1;
            self.observed[bins.len()] += 1;
            return;
        }
        // NaN is no density either.
        let possible = density(direction) > 0.0;
        self.without_density += u64::from(!possible);
        self.observed[bins.index(direction)] += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    const SAMPLES: u64 = 200_000;

    fn spherical(cosine: f64, azimuth: f64) -> DVec3 {
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine)
    }

    fn cosine_sample([a, b, _]: [f64; 3]) -> Option<DVec3> {
        Some(spherical((1.0 - a).sqrt(), TAU * b))
    }

    fn cosine_density(direction: DVec3) -> f64 {
        direction.z.max(0.0) / PI
    }

    /// A cosine-power lobe about a tilted axis; what falls below the horizon is declined.
    struct Lobe {
        frame: DMat3,
        exponent: f64,
    }

    impl Lobe {
        fn new(tilt_degrees: f64, exponent: f64) -> Self {
            Self { frame: DMat3::from_rotation_y(tilt_degrees.to_radians()), exponent }
        }
        fn sample(&self, [a, b, _]: [f64; 3]) -> Option<DVec3> {
            let direction = self.frame * spherical(a.powf(1.0 / (self.exponent + 1.0)), TAU * b);
            (direction.z > 0.0).then_some(direction)
        }
        fn density(&self, direction: DVec3) -> f64 {
            let cosine = self.frame.z_axis.dot(direction).max(0.0);
            if direction.z > 0.0 { (self.exponent + 1.0) / TAU * cosine.powf(self.exponent) } else { 0.0 }
        }
    }

    fn bins() -> SphereBins {
        SphereBins::uniform(DVec3::Z, 16, 32)
    }

    #[test]
    fn right_samplers_pass_at_the_stated_rate() {
        let rejected = (0..40)
            .filter(|&seed| {
                let report = test_directional_sampler(&bins(), 20_000, seed << 32, cosine_sample, cosine_density);
                assert!((report.integral.value - 1.0).abs() < 1e-6, "{report:?}");
                !report.passes(0.1)
            })
            .count();
        // Binomial(40, 0.1): more than 12 has a probability of 3·10⁻⁵, none at all one of 1.5 %.
        assert!((1..=12).contains(&rejected), "{rejected} of 40 rejected at level 0.1");
    }

    #[test]
    fn cut_lobe_and_narrow_cone_pass() {
        let lobe = Lobe::new(70.0, 20.0);
        let report = test_directional_sampler(&bins(), SAMPLES, 1, |u| lobe.sample(u), |w| lobe.density(w));
        assert!(report.passes(0.001) && report.declined > 1000 && report.integral.value < 0.99, "{report:?}");

        // Uniform in a cone whose edge crosses the bins: the density jumps.
        let edge = 8.0f64.to_radians().cos();
        let frame = DMat3::from_rotation_y(0.7);
        let cone = |[a, b, _]: [f64; 3]| Some(frame * spherical(1.0 - a + a * edge, TAU * b));
        let density = |w: DVec3| if frame.z_axis.dot(w) >= edge { 1.0 / (TAU * (1.0 - edge)) } else { 0.0 };
        let report = test_directional_sampler(&bins(), SAMPLES, 2, cone, density);
        assert!(report.passes(0.001) && (report.integral.value - 1.0).abs() < 1e-3, "{report:?}");
    }

    #[test]
    fn chosen_edges_resolve_a_sharp_lobe() {
        let lobe = Lobe::new(30.0, 2000.0);
        let edges: Vec<f64> = (1..40).map(|i| 1.0 - 2e-4 * f64::from(40 - i)).collect();
        let bins = SphereBins::with_cosine_edges(lobe.frame.z_axis, &edges, 8);
        let report = test_directional_sampler(&bins, SAMPLES, 3, |u| lobe.sample(u), |w| lobe.density(w));
        assert!(report.passes(0.001) && report.chi_squared.degrees_of_freedom > 50, "{report:?}");
        // An exponent 3 % too large in the density is found.
        let other = Lobe::new(30.0, 2060.0);
        let report = test_directional_sampler(&bins, SAMPLES, 3, |u| lobe.sample(u), |w| other.density(w));
        assert!(!report.passes(0.001), "{report:?}");
    }

    #[test]
    fn wrong_samplers_fail() {
        let uniform = |[a, b, _]: [f64; 3]| Some(spherical(a, TAU * b));
        assert!(!test_directional_sampler(&bins(), SAMPLES, 4, uniform, cosine_density).passes(0.001));
        for scale in [0.99, 1.01] {
            let report = test_directional_sampler(&bins(), SAMPLES, 5, cosine_sample, |w| scale * cosine_density(w));
            assert!(!report.passes(0.001), "a density {scale} times the right one passes: {report:?}");
        }
        let long = |u| cosine_sample(u).map(|w| 1.01 * w);
        assert!(!test_directional_sampler(&bins(), 1000, 6, long, cosine_density).passes(0.001));
        let nowhere = |u| cosine_sample(u).map(|w| -w);
        let report = test_directional_sampler(&bins(), 1000, 7, nowhere, cosine_density);
        assert_eq!(report.without_density, 1000);
        assert!(!report.passes(0.001));
    }
}
