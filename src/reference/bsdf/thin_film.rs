//! Films that are about as thin as the wavelengths of light (Belcour and Barla 2017).

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::lookup::Lookup;
use crate::scene;
use crate::scene::material::thin_film::{LEAST_ORDER, MOST_ORDERS, MOST_REFLECTED_BY_BASE, WAVES};
use crate::spectrum::Spectrum;

/// Smaller cosines count as this one.
const SMALLEST_COSINE: f64 = 1e-6;

/// A film at one hit.
///
/// With the amplitudes r12 and r23 that its outer and its inner boundary reflect (Fresnel's equations, for each polarization), R = |r|² and
/// T = 1 − R12, light of wavelength λ that went to and fro adds up to
///
/// ```text
/// R(λ) = R12 + T²·R23/(1 − R12·R23) − 2·T·(1 − R23)/(1 − R12·R23) · Σₘ Re((−r12·r23)ᵐ·exp(2πi·m·D/λ))
/// ```
///
/// for m = 1, 2, …: the Fourier series of Airy's formula. D = 2·d·√(n² − sin²θ) is the difference of paths. The mean of the exponential over a
/// channel's sensitivity is a sum of closed forms over its [`WAVES`]; indices of refraction are the same for a whole channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThinFilm {
    /// Micrometres.
    thickness: f64,
    ior: f64,
}

impl ThinFilm {
    /// None where its thickness is 0.
    pub fn of(film: Option<&scene::ThinFilm>, lookup: &Lookup) -> Option<Self> {
        let film = film?;
        let thickness = 1e-3 * (lookup.scalar(&film.thickness) + film.offset);
        (thickness > 0.0).then_some(Self { thickness, ior: film.ior })
    }

    /// Share of light that a channel reflects from outside, at an angle of the given cosine; `eta` + i`k` is the index of refraction of the base.
    pub fn reflectance(&self, channel: usize, cosine: f64, eta: f64, k: f64) -> f64 {
        let cosine = cosine.clamp(SMALLEST_COSINE, 1.0);
        let (sine_squared, film) = ((1.0 - cosine) * (1.0 + cosine), self.ior * self.ior);
        // Products of indices and cosines in the film and in the base.
        let within = (film - sine_squared).sqrt();
        let base = DVec2::new((eta - k) * (eta + k), 2.0 * eta * k);
        let below = root(base - DVec2::new(sine_squared, 0.0));
        let polarized = [
            Boundaries::new(cosine, within, DVec2::new(within, 0.0), below),
            Boundaries::new(film * cosine, within, base * within, below * film),
        ];
        let path = 2.0 * self.thickness * within;
        let mut interference = [0.0; 2];
        for wave in WAVES[channel] {
            let narrow = (-2.0 * (PI * wave.deviation * path).powi(2)).exp();
            let turned = DVec2::from_angle(TAU * (wave.wavenumber * path).fract());
            // Each order turns by as much, and the share that is left of it is narrow^(m²).
            let mut left = narrow;
            let mut next = narrow * narrow * narrow;
            let steps = polarized.map(|boundaries| boundaries.to_and_fro.rotate(turned));
            let mut powers = steps;
            for _ in 0..MOST_ORDERS {
                if left * (powers[0].abs().element_sum() + powers[1].abs().element_sum()) < LEAST_ORDER {
                    break;
                }
                for polarization in 0..2 {
                    interference[polarization] += wave.share * left * powers[polarization].x;
                    powers[polarization] = powers[polarization].rotate(steps[polarization]);
                }
                left *= next;
                next *= narrow * narrow;
            }
        }
        let sum: f64 = polarized.iter().zip(interference).map(|(boundaries, sum)| boundaries.mean - boundaries.swing * sum).sum();
        (0.5 * sum).clamp(0.0, 1.0)
    }

    /// The reflectance over a base by what each channel of it reflects along the normal without a film.
    pub fn reflectance_over(&self, cosine: f64, normal_incidence: Spectrum) -> Spectrum {
        let of = |channel: usize, normal_incidence: f64| {
            let root = normal_incidence.min(MOST_REFLECTED_BY_BASE).sqrt();
            self.reflectance(channel, cosine, (1.0 + root) / (1.0 - root), 0.0)
        };
        let [r, g, b] = normal_incidence.to_rgb();
        Spectrum::new(of(0, r), of(1, g), of(2, b))
    }
}

/// The two boundaries of a film for one polarization.
#[derive(Debug, Clone, Copy)]
struct Boundaries {
    /// The mean over all wavelengths, and twice the largest part that interference takes from it or adds.
    mean: f64,
    swing: f64,
    /// −r12·r23: what light changes by that goes to and fro once.
    to_and_fro: DVec2,
}

impl Boundaries {
    /// r12 = (a − b)/(a + b), r23 = (c − d)/(c + d).
    fn new(a: f64, b: f64, c: DVec2, d: DVec2) -> Self {
        let outer = (a - b) / (a + b);
        let (reflected, transmitted) = (outer * outer, 4.0 * a * b / ((a + b) * (a + b)));
        let sum = c + d;
        let inner = quotient(c - d, sum);
        let passed = (4.0 * c.dot(d) / sum.length_squared()).max(0.0);
        // 1 − R12·R23, with all its digits where both are near 1.
        let escaping = (transmitted + reflected * passed).max(f64::MIN_POSITIVE);
        let mean = reflected + transmitted * transmitted * inner.length_squared() / escaping;
        Self { mean, swing: 2.0 * transmitted * passed / escaping, to_and_fro: inner * -outer }
    }
}

/// The root with parts that are not negative, of a number whose imaginary part is not.
fn root(z: DVec2) -> DVec2 {
    let larger = (0.5 * (z.length() + z.x.abs())).sqrt();
    let smaller = if larger > 0.0 { 0.5 * z.y / larger } else { 0.0 };
    if z.x >= 0.0 { DVec2::new(larger, smaller) } else { DVec2::new(smaller, larger) }
}

fn quotient(a: DVec2, b: DVec2) -> DVec2 {
    DVec2::new(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y) / b.length_squared()
}

#[cfg(test)]
mod tests {
    use gpt_scene::observer::{Role, integrate};

    use super::*;
    use crate::reference::bsdf::fresnel::{conductor_reflectance, dielectric_reflectance};

    /// Airy's formula at one wavelength, by amplitudes that go to and fro.
    fn airy(film: &ThinFilm, cosine: f64, [eta, k]: [f64; 2], wavelength: f64) -> f64 {
        let sine_squared = 1.0 - cosine * cosine;
        let (square, within) = (film.ior * film.ior, (film.ior * film.ior - sine_squared).sqrt());
        let base = DVec2::new(eta, k).rotate(DVec2::new(eta, k));
        let below = root(base - DVec2::new(sine_squared, 0.0));
        let phase = DVec2::from_angle(TAU * 2e3 * film.thickness * within / wavelength);
        let of = |outer: f64, inner: DVec2| {
            let back = inner.rotate(phase);
            quotient(DVec2::new(outer, 0.0) + back, DVec2::X + back * outer).length_squared()
        };
        let perpendicular =
            of((cosine - within) / (cosine + within), quotient(DVec2::new(within, 0.0) - below, DVec2::new(within, 0.0) + below));
        let (through, under) = (base * within, below * square);
        let parallel = of((square * cosine - within) / (square * cosine + within), quotient(through - under, through + under));
        0.5 * (perpendicular + parallel)
    }

    const BASES: [[f64; 2]; 6] = [[1.5, 0.0], [2.4, 0.0], [0.18, 3.42], [1.37, 1.77], [1.5, 7.6], [5.8, 0.0]];
    const FILMS: [f64; 5] = [1.2, 1.33, 1.5, 1.8, 2.4];
    const THICKNESSES: [f64; 10] = [1.0, 10.0, 50.0, 100.0, 200.0, 300.0, 400.0, 550.0, 1000.0, 2500.0];

    /// The channels are those of the spectrum under D65, by the tables of the CIE. The error stated in docs/materials.md is that of this test.
    #[test]
    fn channels_are_integrals_over_the_spectrum() {
        let mut worst = [0.0_f64; 2];
        let mut off = 0.0_f64;
        for [eta, k] in BASES {
            for (ior, thickness) in FILMS.into_iter().flat_map(|ior| THICKNESSES.map(|thickness| (ior, thickness))) {
                let film = ThinFilm { thickness: 1e-3 * thickness, ior };
                for cosine in [1.0, 0.9, 0.7, 0.5, 0.3, 0.15, 0.05] {
                    let exact = integrate(Role::Surface, |wavelength| airy(&film, cosine, [eta, k], wavelength));
                    let exact = exact.clamp(Spectrum::BLACK, Spectrum::WHITE).to_rgb();
                    for (channel, exact) in exact.into_iter().enumerate() {
                        let error = (film.reflectance(channel, cosine, eta, k) - exact).abs();
                        let grazing = usize::from(cosine < 0.3);
                        worst[grazing] = worst[grazing].max(error);
                        // The control: of a film that is a tenth thicker.
                        let thicker = ThinFilm { thickness: 1.1e-3 * thickness, ior };
                        off = off.max((thicker.reflectance(channel, cosine, eta, k) - exact).abs());
                    }
                }
            }
        }
        println!("off by {worst:?}, and by {off} with a film a tenth thicker");
        assert!(worst[0] < 0.004 && worst[1] < 0.01, "{worst:?}");
        assert!(off > 0.1, "{off}");
    }

    /// A film of the index of the base, or of that outside, or next to no film, leaves the base as it is.
    #[test]
    fn a_film_that_is_not_there_changes_nothing() {
        for cosine in [1.0, 0.6, 0.2, 0.05] {
            for (thickness, ior, tolerance) in [(0.3, 1.5, 1e-9), (0.3, 1.0, 1e-9), (1e-5, 1.3, 2e-3)] {
                let film = ThinFilm { thickness, ior };
                for channel in 0..3 {
                    let found = film.reflectance(channel, cosine, 1.5, 0.0);
                    assert!((found - dielectric_reflectance(cosine, 1.5)).abs() < tolerance, "{film:?} {cosine}: {found}");
                }
            }
            let film = ThinFilm { thickness: 0.3, ior: 1.0 };
            let [eta, k] = [Spectrum::grey(1.37), Spectrum::grey(1.77)];
            let (found, plain) = (film.reflectance(1, cosine, 1.37, 1.77), conductor_reflectance(cosine, eta, k).g());
            assert!((found - plain).abs() < 1e-9, "{cosine}: {found} {plain}");
        }
    }

    /// By hand: a quarter of a wave of index √1.5 on glass of 1.5 reflects nothing along the normal where the wavelength is four times its
    /// path; the channels see little of the rest. A film of the index 1.5 · 1.5 of as thick a path reflects most.
    #[test]
    fn quarters_of_waves_reflect_least_and_most() {
        let of = |ior: f64| ThinFilm { thickness: 0.55 / (4.0 * ior), ior }.reflectance(1, 1.0, 1.5, 0.0);
        let plain = dielectric_reflectance(1.0, 1.5);
        assert!(of(1.5_f64.sqrt()) < 0.05 * plain, "{}", of(1.5_f64.sqrt()));
        assert!(of(2.25) > 3.0 * plain, "{}", of(2.25));
    }

    /// Light that cannot leave a denser base is all reflected; a base that takes nothing and reflects all does so with a film.
    #[test]
    fn total_reflection_stays_total() {
        let film = ThinFilm { thickness: 0.4, ior: 1.3 };
        assert!((film.reflectance(1, 0.3, 0.7, 0.0) - 1.0).abs() < 1e-9);
        assert!(film.reflectance(1, 0.9, 0.7, 0.0) < 0.5);
    }
}
