//! The smooth dielectric whose channels are not refracted or reflected alike.

use glam::DVec3;

use super::channels::choose_channel;
use super::fresnel::refract;
use super::lookup::Lookup;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::spectral_dielectric::SpectralDielectric;
use super::view::View;
use crate::scene::MaterialKind;
use crate::scene::material::iors;
use crate::spectrum::Spectrum;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectralGlass {
    pub dielectric: SpectralDielectric,
}

impl SpectralGlass {
    /// Does the same as [`super::dielectric::Dielectric::sample_delta`], by channel.
    pub fn sample_delta(dielectric: &SpectralDielectric, view: &View, u_lobe: f64) -> Option<BsdfSample> {
        let ways = dielectric.ways(view, view.wo.dot(view.normal()))?;
        if u_lobe < ways.reflection {
            let wi = view.mirrored();
            let weight = dielectric.reflectance * ways.reflected / ways.reflection;
            return view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, Density::Delta) });
        }
        let etas = dielectric.etas(view).to_rgb();
        let eta = etas[choose_channel(ways.transmission, u_lobe - ways.reflection)?.0];
        let wi = refract(view.wo, view.normal(), eta)?;
        // The channels that are refracted alike.
        let [r, g, b] = etas.map(|other| if other == eta { 1.0 } else { 0.0 });
        let alike = Spectrum::new(r, g, b);
        let probability = (alike * Spectrum::from_rgb(ways.transmission)).sum();
        let weight = alike * dielectric.transmittance * (Spectrum::WHITE - ways.reflected) / (probability * eta * eta);
        view.transmits(wi).then_some(BsdfSample { wi, weight, density: Density::Delta, eta, is_null: false })
    }
}

impl Scatter for SpectralGlass {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Glass { ior, reflectance, transmittance, film, dispersion, .. } = kind else { return None };
        let is_spectral = film.is_some() || dispersion.is_some();
        let iors = iors(*ior, *dispersion);
        let dielectric = || SpectralDielectric::new(iors, [reflectance, transmittance], film.as_ref(), lookup);
        is_spectral.then(|| Self { dielectric: dielectric() })
    }

    fn sampling_weight(&self) -> f64 {
        self.dielectric.sampling_weight()
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn evaluate(&self, _view: &View, _wi: DVec3) -> Evaluation {
        Evaluation::default()
    }

    fn sample(&self, view: &View, u_lobe: f64, _u1: f64, _u2: f64) -> Option<BsdfSample> {
        Self::sample_delta(&self.dielectric, view, u_lobe)
    }
}
