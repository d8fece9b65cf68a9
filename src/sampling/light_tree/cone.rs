//! Cones around the directions that lights emit in.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

/// Directions in which a cluster of lights emits: within `reach` of directions that lie within `spread` of
/// the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    pub axis: DVec3,
    /// In radians, from 0 to π.
    pub spread: f64,
    pub reach: f64,
    /// Each light emits opposite to these directions as well.
    pub two_sided: bool,
}

impl Cone {
    /// The directions of both, as narrow as that can be.
    pub fn union(self, other: Self) -> Self {
        let (wide, mut narrow) = if self.spread >= other.spread { (self, other) } else { (other, self) };
        let (reach, two_sided) = (wide.reach.max(narrow.reach), wide.two_sided || narrow.two_sided);
        let cone = |axis, spread| Self { axis, spread, reach, two_sided };
        if wide.two_sided && narrow.two_sided && wide.axis.dot(narrow.axis) < 0.0 {
            narrow.axis = -narrow.axis;
        }
        let cosine = wide.axis.dot(narrow.axis).clamp(-1.0, 1.0);
        let between = cosine.acos();
        if (between + narrow.spread).min(PI) <= wide.spread {
            return cone(wide.axis, wide.spread);
        }
        let spread = 0.5 * (wide.spread + between + narrow.spread);
        let aside = (narrow.axis - wide.axis * cosine).try_normalize();
        let Some(aside) = aside.filter(|_| spread < PI) else { return cone(wide.axis, PI) };
        let (sine, cosine) = (spread - wide.spread).sin_cos();
        cone((wide.axis * cosine + aside * sine).normalize(), spread)
    }

    /// How much of all directions it takes: ∫ of the cosine to the nearest direction within the spread, over those within spread and
    /// reach, or a right angle beyond the spread (Conty Estévez and Kulla 2018).
    pub fn measure(self) -> f64 {
        let (spread, end) = (self.spread, (self.spread + self.reach.min(FRAC_PI_2)).min(PI));
        let (sine, cosine) = spread.sin_cos();
        let around = 2.0 * end * sine - (spread - 2.0 * end).cos() - 2.0 * spread * sine + cosine;
        let measure = 2.0 * PI * (1.0 - cosine) + FRAC_PI_2 * around;
        if self.two_sided { 2.0 * measure } else { measure }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cone(axis: DVec3, spread: f64) -> Cone {
        Cone { axis: axis.normalize(), spread, reach: FRAC_PI_2, two_sided: false }
    }

    #[test]
    fn a_union_holds_both_and_is_no_wider_than_they_need() {
        let (a, b) = (cone(DVec3::new(1.0, 0.2, 0.0), 0.1), cone(DVec3::new(0.3, -0.4, 1.0), 0.4));
        let both = a.union(b);
        for part in [a, b] {
            let farthest = both.axis.dot(part.axis).acos() + part.spread;
            assert!((farthest - both.spread).abs() < 1e-9, "{farthest} {both:?}");
        }
        assert_eq!(cone(DVec3::X, 1.0).union(cone(DVec3::new(1.0, 0.1, 0.0), 0.2)), cone(DVec3::X, 1.0));
        assert_eq!(cone(DVec3::X, 0.0).union(cone(DVec3::NEG_X, 0.0)).spread, PI);
        let two_sided = |axis| Cone { two_sided: true, ..cone(axis, 0.0) };
        assert_eq!(two_sided(DVec3::X).union(two_sided(DVec3::NEG_X)), two_sided(DVec3::X));
    }

    /// By the midpoint rule over all directions.
    #[test]
    fn the_measure_is_the_integral_that_it_is_said_to_be() {
        for (spread, reach) in [(0.0, FRAC_PI_2), (0.7, FRAC_PI_2), (0.3, 0.5), (PI, FRAC_PI_2), (2.0, 0.8)] {
            let steps = 100_000;
            let integrand = |angle: f64| {
                let beyond = (angle - spread).max(0.0);
                if beyond > reach { 0.0 } else { 2.0 * PI * angle.sin() * beyond.cos() }
            };
            let sum: f64 = (0..steps).map(|i| integrand((f64::from(i) + 0.5) * PI / f64::from(steps))).sum();
            let (expected, found) = (sum * PI / f64::from(steps), Cone { spread, reach, ..cone(DVec3::X, 0.0) }.measure());
            assert!((found / expected - 1.0).abs() < 1e-3, "{spread} {reach}: {found} {expected}");
        }
    }
}
