//! Tables of what microfacets and fibres reflect of all light, by the angle at which it arrives. Both devices look them up.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::LazyLock;

use glam::DVec3;

use super::microfacets::{Masking, MicrofacetDistribution};

/// Rows of a table, by roughness, and its columns, by cosine.
pub const ALBEDO_ROWS: usize = 64;
pub const ALBEDO_COLUMNS: usize = 24;
/// Points of the integrals over microfacets, and over directions.
const FACETS: [usize; 2] = [64, 12];
const DIRECTIONS: [usize; 2] = [40, 20];
/// Over the width of microfacets, the cosine about which most changes.
pub const FACET_KNEE: f64 = 2.0;
/// Smoother fibres are as rough as this: f32 does not resolve their powers, and the fit of their shadowing was made for rougher ones.
pub const SMALLEST_SHEEN_ROUGHNESS: f64 = 0.1;
/// Added to the roughness of fibres, it gives the cosine about which most changes.
pub const SHEEN_KNEE: f64 = 0.1;

/// Shares of light at even steps of roughness, and of a place that cosines have: the smoother a surface is, the nearer to a right angle the
/// changes happen.
#[derive(Debug)]
pub struct AlbedoTable {
    shares: [[f32; ALBEDO_COLUMNS]; ALBEDO_ROWS],
    layout: Layout,
}

/// Which angles and roughnesses a table has.
#[derive(Debug, Clone, Copy)]
struct Layout {
    /// The cosine about which most changes, by roughness.
    knee: fn(f64) -> f64,
    /// Nothing arrives at a right angle: the first column is for this place.
    first_place: f64,
    /// The rows of smoother surfaces are for this roughness.
    least_roughness: f64,
}

/// The albedo of narrow facets depends on the cosine over their width alone, so on the place alone: any of them serve for the first row.
const OF_FACETS: Layout =
    Layout { knee: |roughness| FACET_KNEE * roughness * roughness, first_place: 1e-3, least_roughness: 1e-2 };
/// Nearer to a right angle the fit of the shadowing gives ever more. One row lies below the smallest roughness: it is looked up as well.
const OF_SHEEN: Layout = Layout {
    knee: |roughness| roughness + SHEEN_KNEE,
    first_place: 1e-2,
    least_roughness: SMALLEST_SHEEN_ROUGHNESS - 1.0 / (ALBEDO_ROWS - 1) as f64,
};

static SEPARABLE: LazyLock<AlbedoTable> =
    LazyLock::new(|| AlbedoTable::new(OF_FACETS, |cosine, roughness| facet_albedo(cosine, roughness, Masking::Separable)));
static HEIGHT_CORRELATED: LazyLock<AlbedoTable> =
    LazyLock::new(|| AlbedoTable::new(OF_FACETS, |cosine, roughness| facet_albedo(cosine, roughness, Masking::HeightCorrelated)));
static SHEEN: LazyLock<AlbedoTable> = LazyLock::new(|| AlbedoTable::new(OF_SHEEN, sheen_albedo));

impl Layout {
    /// The place of a cosine c is √(c·(1 + k)/(c + k)) with the knee k. The root spreads what lies near a
    /// right angle.
    fn place(&self, cosine: f64, roughness: f64) -> f64 {
        let knee = (self.knee)(roughness);
        (cosine * (1.0 + knee) / (cosine + knee).max(1e-6)).clamp(0.0, 1.0).sqrt()
    }

    /// The cosine that has this place.
    fn cosine(&self, place: f64, roughness: f64) -> f64 {
        let (knee, squared) = ((self.knee)(roughness), place * place);
        (knee * squared / (1.0 + knee - squared)).min(1.0)
    }
}

impl AlbedoTable {
    /// The table of GGX microfacets that reflect everything, by the root of their width.
    pub fn of_facets(masking: Masking) -> &'static Self {
        match masking {
            Masking::Separable => &SEPARABLE,
            Masking::HeightCorrelated => &HEIGHT_CORRELATED,
        }
    }

    /// The table of white fibres, by the root of the width of their distribution.
    pub fn of_sheen() -> &'static Self {
        &SHEEN
    }

    fn new(layout: Layout, share: impl Fn(f64, f64) -> f64) -> Self {
        let mut shares = [[0.0_f32; ALBEDO_COLUMNS]; ALBEDO_ROWS];
        for (row, shares) in shares.iter_mut().enumerate() {
            let roughness = (row as f64 / (ALBEDO_ROWS - 1) as f64).max(layout.least_roughness);
            for (column, value) in shares.iter_mut().enumerate() {
                let place = (column as f64 / (ALBEDO_COLUMNS - 1) as f64).max(layout.first_place);
                *value = share(layout.cosine(place, roughness), roughness) as f32;
            }
        }
        Self { shares, layout }
    }

    /// Linear between the entries. Of fibres, from their smallest roughness on.
    pub fn at(&self, cosine: f64, roughness: f64) -> f64 {
        let place = self.layout.place(cosine, roughness);
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

/// The middles of so many equal parts of [0, 1].
fn midpoints(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |part| (part as f64 + 0.5) / count as f64)
}

/// The mean of G2/G1 over the microfacets that are seen (Heitz 2018), each as often as it is large.
fn facet_albedo(cosine: f64, roughness: f64, masking: Masking) -> f64 {
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
    let alpha = roughness * roughness;
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
mod tests;
