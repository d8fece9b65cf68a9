//! The boundary of a dielectric that does not treat all channels alike.

use super::fresnel::dielectric_reflectance;
use super::lookup::Lookup;
use super::thin_film::ThinFilm;
use super::view::View;
use crate::scene::{self, ColorInput};
use crate::spectrum::Spectrum;

/// A dielectric's boundary whose channels have indices of refraction of their own, or that a film lies on.
///
/// A reflected direction is that of all channels. Refracted ones differ, so one channel is chosen, by what the path carries of each and what
/// comes through: Fresnel's R, the colours ρ and τ, and q, the channel's share of the path's throughput, make
/// P = Σ q·ρ·R of the reflection and q·τ·(1 − R) of the refraction by each channel, over the sum of these four. A direction that several
/// channels have, be it because their indices are equal or because a rough boundary scatters, counts for all of them, over the density with
/// which any of them draws it. So the mean is that of all channels, and a path that carries one channel alone never draws for another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectralDielectric {
    /// Indices of refraction inside over outside.
    pub iors: Spectrum,
    pub reflectance: Spectrum,
    pub transmittance: Spectrum,
    pub film: Option<ThinFilm>,
}

/// The shares of light that a facet sends each way, before tints, and the probabilities of its ways.
#[derive(Debug, Clone, Copy)]
pub struct Ways {
    pub reflected: Spectrum,
    pub reflection: f64,
    pub transmission: [f64; 3],
}

impl SpectralDielectric {
    pub fn new(
        iors: Spectrum,
        [reflectance, transmittance]: [&ColorInput; 2],
        film: Option<&scene::ThinFilm>,
        lookup: &Lookup,
    ) -> Self {
        let film = ThinFilm::of(film, lookup);
        Self { iors, reflectance: lookup.color(reflectance), transmittance: lookup.color(transmittance), film }
    }

    /// The larger of what it reflects and what it transmits.
    pub fn sampling_weight(&self) -> f64 {
        self.reflectance.max(self.transmittance).max_component()
    }

    /// Indices of refraction on the far side over that on wo's side.
    pub fn etas(&self, view: &View) -> Spectrum {
        if view.front { self.iors } else { self.iors.map(|ior| 1.0 / ior) }
    }

    /// Share of light that a channel reflects at an angle of the given cosine on wo's side.
    pub fn reflected(&self, channel: usize, cosine: f64, front: bool) -> f64 {
        let ior = self.iors.to_rgb()[channel];
        let Some(film) = self.film else { return dielectric_reflectance(cosine, if front { ior } else { 1.0 / ior }) };
        // The film is seen from outside: light takes the same way from within.
        let outside = if front { cosine * cosine } else { 1.0 - (1.0 - cosine * cosine) * ior * ior };
        if outside <= 0.0 { 1.0 } else { film.reflectance(channel, outside.sqrt(), ior, 0.0) }
    }

    /// None where no light is scattered.
    pub fn ways(&self, view: &View, cosine: f64) -> Option<Ways> {
        let [r, g, b] = [0, 1, 2].map(|channel| self.reflected(channel, cosine, view.front));
        let reflected = Spectrum::new(r, g, b);
        let shares = view.carried_shares();
        let reflection = (shares * self.reflectance * reflected).sum();
        let transmission = shares * self.transmittance * (Spectrum::WHITE - reflected);
        let sum = reflection + transmission.sum();
        let transmission = (transmission / sum).to_rgb();
        (sum > 0.0).then(|| Ways { reflected, reflection: reflection / sum, transmission })
    }
}
