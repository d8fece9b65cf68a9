//! The smooth dielectric: a reflected and a refracted direction.

use glam::DVec3;

use super::mirror::reflect;
use super::{BsdfSample, Density, View, dielectric_reflectance, refract};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Glass {
    /// Index of refraction inside over outside.
    pub ior: f64,
    pub reflectance: DVec3,
    pub transmittance: DVec3,
}

impl Glass {
    /// Chooses reflection with a probability P in proportion to the light each direction carries, Fresnel's F for equal tints:
    /// P = F·max ρ / (F·max ρ + (1−F)·max τ). Reflection then has weight Fρ/P; refraction (1−F)τ/(1−P), over eta² because light
    /// that enters the denser side is squeezed into a smaller cone (Veach 1997, section 5.2).
    pub fn sample(&self, view: &View, u_lobe: f64) -> Option<BsdfSample> {
        let eta = if view.front { self.ior } else { 1.0 / self.ior };
        let fresnel = dielectric_reflectance(view.wo.dot(view.normal()), eta);
        let reflected = fresnel * self.reflectance.max_element();
        let transmitted = (1.0 - fresnel) * self.transmittance.max_element();
        if reflected + transmitted <= 0.0 {
            return None;
        }
        let choose_reflection = reflected / (reflected + transmitted);
        if u_lobe < choose_reflection {
            let wi = reflect(view);
            let weight = self.reflectance * (fresnel / choose_reflection);
            return view.reflects(wi).then_some(BsdfSample { wi, weight, density: Density::Delta, eta: 1.0 });
        }
        let wi = refract(view.wo, view.normal(), eta)?;
        let weight = self.transmittance * ((1.0 - fresnel) / (1.0 - choose_reflection) / (eta * eta));
        // An interpolated normal may refract to the side the light came from, where there is nothing to enter.
        (wi.dot(view.geometric_normal) < 0.0).then_some(BsdfSample { wi, weight, density: Density::Delta, eta })
    }
}
