//! Dielectrics.

use super::Writer;
use super::directive::{Directive, Number};
use crate::scene::Dispersion;
use crate::scene::material::dispersion::WAVELENGTHS;

/// Nanometres of a written spectrum: over all that pbrt renders.
const SPECTRUM: [f64; 2] = [360.0, 830.0];
const STEPS: u32 = 47;

/// A dielectric without its microfacets.
#[derive(Debug, Clone, Copy)]
pub struct Glass {
    pub ior: f64,
    pub thin: bool,
    /// A film makes light interfere.
    pub film: bool,
    pub dispersion: Option<Dispersion>,
}

impl Writer<'_> {
    /// A dielectric, with the widths of its microfacets if it has some.
    pub fn glass(&mut self, glass: Glass, alphas: Option<[Number; 2]>, place: &str) -> Box<dyn FnOnce(Directive) -> Directive> {
        let Glass { ior, thin, film, dispersion } = glass;
        if film {
            self.drop("thin film", place, "there is no film");
        }
        let is_smooth = |alpha: &Number| *alpha == Number::Constant(0.0);
        let alphas = alphas.filter(|alphas| !alphas.iter().all(is_smooth));
        if thin {
            if alphas.is_some() {
                self.approximate("rough glass that is thin", place, "smooth glass is taken");
            }
            return Box::new(move |directive| directive.string("type", "thindielectric").float("eta", ior));
        }
        if dispersion.is_some() {
            let instead = "every wavelength is bent by its own index, and not those of three colours";
            self.approximate("dispersion", place, instead);
        }
        Box::new(move |directive| {
            let directive = directive.string("type", "dielectric");
            let directive = match dispersion {
                Some(dispersion) => directive.spectrum("eta", &indices(dispersion, ior)),
                None => directive.float("eta", ior),
            };
            match &alphas {
                Some(alphas) => directive.rough("", alphas),
                None => directive,
            }
        })
    }
}

/// Wavelengths with their indices of refraction.
fn indices(dispersion: Dispersion, ior: f64) -> Vec<[f64; 2]> {
    let [least, most] = SPECTRUM;
    let step = |index: u32| {
        let wavelength = least + (most - least) * f64::from(index) / f64::from(STEPS);
        let index = dispersion.index(ior, wavelength / 1000.0);
        // A formula may have none far from the colours that it is used for.
        let index = if index.is_finite() { index } else { dispersion.index(ior, WAVELENGTHS[1]) };
        [wavelength, index]
    };
    (0..=STEPS).map(step).collect()
}
