//! Tables of what microfacets and fibres reflect of all light, by the angle at which it arrives. Both devices look them up.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::LazyLock;

use glam::DVec3;

use super::microfacets::{Masking, MicrofacetDistribution};

/// Rows of a table, by roughness, and its columns, by cosine.
pub const ALBEDO_ROWS: usize = 64;
pub const ALBEDO_COLUMNS: usize = 24;
/// Points of the integrals over microfacets, and over directions.
const FACETS: [usize; 2] = [40, 20];
const DIRECTIONS: [usize; 2] = [40, 20];
/// Narrower distributions of fibres are as wide as this: f32 does not resolve their powers, and the fit of their shadowing was made for wider
/// ones.
pub const SMALLEST_SHEEN_ALPHA: f64 = 1e-2;
/// What is added to the roughness of fibres to find the cosine about which most changes.
pub const SHEEN_KNEE: f64 = 0.1;

/// Shares of light at even steps of roughness, and of a place that cosines have: the smoother a surface is, the nearer to a right angle the
/// changes happen.
#[derive(Debug)]
pub struct AlbedoTable {
    shares: [[f32; ALBEDO_COLUMNS]; ALBEDO_ROWS],
    /// The cosine about which most changes, by roughness: it stands half-way.
    knee: fn(f64) -> f64,
}

static SEPARABLE: LazyLock<AlbedoTable> =
    LazyLock::new(|| AlbedoTable::new(facet_knee, |cosine, roughness| facet_albedo(cosine, roughness, Masking::Separable)));
static HEIGHT_CORRELATED: LazyLock<AlbedoTable> = LazyLock::new(|| {
    AlbedoTable::new(facet_knee, |cosine, roughness| facet_albedo(cosine, roughness, Masking::HeightCorrelated))
});
static SHEEN: LazyLock<AlbedoTable> = LazyLock::new(|| AlbedoTable::new(sheen_knee, sheen_albedo));

impl AlbedoTable {
    /// Of GGX microfacets that reflect everything, by the root of their width.
    pub fn of_facets(masking: Masking) -> &'static Self {
        match masking {
            Masking::Separable => &SEPARABLE,
            Masking::HeightCorrelated => &HEIGHT_CORRELATED,
        }
    }

    /// Of white fibres, by the root of the width of their distribution.
    pub fn of_sheen() -> &'static Self {
        &SHEEN
    }

    fn new(knee: fn(f64) -> f64, share: impl Fn(f64, f64) -> f64) -> Self {
        let mut shares = [[0.0_f32; ALBEDO_COLUMNS]; ALBEDO_ROWS];
        for (row, shares) in shares.iter_mut().enumerate() {
            let roughness = row as f64 / (ALBEDO_ROWS - 1) as f64;
            let knee = knee(roughness).max(1e-9);
            for (column, value) in shares.iter_mut().enumerate() {
                // The place of a cosine c is c·(1 + k)/(c + k). Nothing arrives at a right angle: the first entry is for one just above it.
                let place = (column as f64 / (ALBEDO_COLUMNS - 1) as f64).max(1e-3);
                *value = share((knee * place / (1.0 + knee - place)).min(1.0), roughness) as f32;
            }
        }
        Self { shares, knee }
    }

    /// Linear between the entries.
    pub fn at(&self, cosine: f64, roughness: f64) -> f64 {
        let knee = (self.knee)(roughness);
        let place = cosine * (1.0 + knee) / (cosine + knee).max(1e-6);
        let step = |share: f64, count: usize| {
            let place = share.clamp(0.0, 1.0) * (count - 1) as f64;
            let before = (place as usize).min(count - 2);
            (before, place - before as f64)
        };
        let ((row, down), (column, right)) = (step(roughness, ALBEDO_ROWS), step(place, ALBEDO_COLUMNS));
        let along = |row: usize| {
            let [low, high] = [self.shares[row][column], self.shares[row][column + 1]].map(f64::from);
            low + (high - low) * right
        };
        along(row) + (along(row + 1) - along(row)) * down
    }

    /// All entries, by roughness and then by place.
    pub fn shares(&self) -> impl Iterator<Item = f32> {
        self.shares.iter().flatten().copied()
    }
}

fn facet_knee(roughness: f64) -> f64 {
    roughness
}

fn sheen_knee(roughness: f64) -> f64 {
    roughness + SHEEN_KNEE
}

/// The middles of so many equal parts of [0, 1].
fn midpoints(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |part| (part as f64 + 0.5) / count as f64)
}

/// The mean of G2/G1 over the microfacets that are seen (Heitz 2018), each as often as it is large.
fn facet_albedo(cosine: f64, roughness: f64, masking: Masking) -> f64 {
    if roughness == 0.0 {
        return 1.0;
    }
    let alpha = roughness * roughness;
    let wo = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    let lambda = |cosine: f64| {
        let tan_squared = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
        MicrofacetDistribution::Ggx.lambda(alpha * alpha * tan_squared)
    };
    let lambda_o = lambda(cosine);
    let seen = DVec3::new(alpha * wo.x, 0.0, wo.z).normalize();
    let upward = DVec3::new(-seen.z, 0.0, seen.x);
    let share = 0.5 * (1.0 + seen.z);
    let mut sum = 0.0;
    for s in midpoints(FACETS[0]) {
        // By the root of the share above: the few that are steepest lose most light.
        let (u, weight) = (1.0 - s * s, 2.0 * s);
        for v in midpoints(FACETS[1]) {
            // One half: the other is its mirror image.
            let (sine, across) = (PI * v - FRAC_PI_2).sin_cos();
            let (across, along) = (u.sqrt() * across, u.sqrt() * sine);
            let along = (1.0 - share) * (1.0 - across * across).max(0.0).sqrt() + share * along;
            let normal = across * DVec3::Y + along * upward + (1.0 - across * across - along * along).max(0.0).sqrt() * seen;
            let m = DVec3::new(alpha * normal.x, alpha * normal.y, normal.z.max(1e-9)).normalize();
            let leaving = 2.0 * wo.dot(m) * m.z - cosine;
            if leaving > 0.0 {
                sum += weight * masking.shadowing(lambda_o, lambda(leaving.min(1.0))) * (1.0 + lambda_o);
            }
        }
    }
    sum / (FACETS[0] * FACETS[1]) as f64
}

/// Density of fibres' normals whose sine from the surface's normal has this square (Estevez and Kulla 2017): (2 + 1/α)·sin(θ)^(1/α)/2π.
pub fn sheen_distribution(alpha: f64, sine_squared: f64) -> f64 {
    (2.0 + 1.0 / alpha) * sine_squared.powf(0.5 / alpha) / TAU
}

/// Λ of the fibres' shadowing, by its fit there.
pub fn sheen_lambda(alpha: f64, cosine: f64) -> f64 {
    let share = (1.0 - alpha).powi(2);
    let between = |wide: f64, narrow: f64| wide + (narrow - wide) * share;
    let fit = |x: f64| {
        let (a, b, c) = (between(21.5473, 25.3245), between(3.82987, 3.32435), between(0.19823, 0.16801));
        a / (1.0 + b * x.powf(c)) + between(-1.97760, -1.27393) * x + between(-4.32054, -4.85967)
    };
    if cosine < 0.5 { fit(cosine).exp() } else { (2.0 * fit(0.5) - fit((1.0 - cosine).max(0.0))).exp() }
}

/// More than 1 where the fit overestimates what narrow fibres show of themselves: ∫ D·cosθi/((1 + Λo + Λi)·4·cosθo·cosθi) dωi.
fn sheen_albedo(cosine: f64, roughness: f64) -> f64 {
    let alpha = (roughness * roughness).max(SMALLEST_SHEEN_ALPHA);
    let wo = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    let lambda_o = sheen_lambda(alpha, cosine);
    let mut sum = 0.0;
    for u in midpoints(DIRECTIONS[0]) {
        // Narrow distributions send light from near a right angle to near one.
        let (leaving, weight) = (u * u * u, 3.0 * u * u);
        let sine = (1.0 - leaving * leaving).max(0.0).sqrt();
        let visible = 1.0 / ((1.0 + lambda_o + sheen_lambda(alpha, leaving)) * 4.0 * cosine);
        for v in midpoints(DIRECTIONS[1]) {
            // Backward, the half vector is nearest to the horizon: points crowd there.
            let (turn, stretch) = (PI * v * v, 2.0 * v);
            let m = (wo + DVec3::new(sine * turn.cos(), sine * turn.sin(), leaving)).normalize_or(DVec3::Z);
            sum += weight * stretch * visible * sheen_distribution(alpha, m.x * m.x + m.y * m.y);
        }
    }
    TAU * sum / (DIRECTIONS[0] * DIRECTIONS[1]) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 − ln 2 at normal incidence where the width is 1 and heights are correlated.
    #[test]
    fn facets_reflect_what_is_known_in_closed_form() {
        let table = AlbedoTable::of_facets(Masking::HeightCorrelated);
        assert!((table.at(1.0, 1.0) - (1.0 - std::f64::consts::LN_2)).abs() < 3e-4, "{}", table.at(1.0, 1.0));
        // Smooth microfacets reflect everything.
        assert!((table.at(0.5, 0.0) - 1.0).abs() < 1e-6);
    }

    /// What lies between the entries is as it would be if it were computed there.
    #[test]
    fn tables_are_dense_enough() {
        type Share = fn(f64, f64) -> f64;
        let separable: Share = |cosine, roughness| facet_albedo(cosine, roughness, Masking::Separable);
        let height_correlated: Share = |cosine, roughness| facet_albedo(cosine, roughness, Masking::HeightCorrelated);
        for (table, share, most) in [
            (AlbedoTable::of_facets(Masking::Separable), separable, 2e-3),
            (AlbedoTable::of_facets(Masking::HeightCorrelated), height_correlated, 2e-3),
            // Fibres shine suddenly within a degree of the horizon.
            (AlbedoTable::of_sheen(), sheen_albedo, 2.5e-2),
        ] {
            let mut worst = 0.0_f64;
            for (index, roughness) in midpoints(24).enumerate() {
                for cosine in midpoints(23 + index % 3) {
                    let [table, exact] = [table.at(cosine, roughness), share(cosine, roughness)];
                    worst = worst.max((table - exact).abs() / exact.max(1.0));
                }
            }
            println!("off by {worst:.1e}");
            assert!(worst < most, "{worst}");
        }
    }
}
