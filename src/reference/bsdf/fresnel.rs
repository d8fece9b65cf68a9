//! Fresnel's equations, their approximation by Schlick, and Snell's law.

use glam::DVec3;

use crate::spectrum::Spectrum;

pub use crate::math::dielectric_reflectance;

/// The direction into which light seen from `wo` was refracted; `normal` is on wo's side, `eta` as above. None in total internal
/// reflection.
pub fn refract(wo: DVec3, normal: DVec3, eta: f64) -> Option<DVec3> {
    let cos_incident = wo.dot(normal);
    let sin_squared_transmitted = (1.0 - cos_incident * cos_incident).max(0.0) / (eta * eta);
    if sin_squared_transmitted >= 1.0 {
        return None;
    }
    let cos_transmitted = (1.0 - sin_squared_transmitted).sqrt();
    Some((normal * (cos_incident / eta - cos_transmitted) - wo / eta).normalize())
}

/// Share of unpolarised light that a metal of complex index of refraction eta + ik reflects, per channel (Born and Wolf 1999,
/// section 14.2; written as in Pharr, Jakob and Humphreys 2016, section 8.2). `cos_incident` as above, not negative.
pub fn conductor_reflectance(cos_incident: f64, eta: Spectrum, k: Spectrum) -> Spectrum {
    let cos_squared = cos_incident * cos_incident;
    let sin_squared = 1.0 - cos_squared;
    let (eta_squared, k_squared) = (eta * eta, k * k);
    let difference = eta_squared - k_squared - Spectrum::grey(sin_squared);
    let a_squared_plus_b_squared = (difference * difference + 4.0 * eta_squared * k_squared).sqrt();
    let a = (0.5 * (a_squared_plus_b_squared + difference)).max(Spectrum::BLACK).sqrt();
    let (sum, product) = (a_squared_plus_b_squared + Spectrum::grey(cos_squared), 2.0 * cos_incident * a);
    let perpendicular = (sum - product) / (sum + product);
    let (sum, product) =
        (cos_squared * a_squared_plus_b_squared + Spectrum::grey(sin_squared * sin_squared), product * sin_squared);
    let parallel = perpendicular * (sum - product) / (sum + product);
    0.5 * (parallel + perpendicular)
}

/// Schlick's approximation (1994): from `normal_incidence` at normal incidence to 1 at a grazing angle.
pub fn schlick_reflectance(cos_incident: f64, normal_incidence: Spectrum) -> Spectrum {
    normal_incidence + (Spectrum::WHITE - normal_incidence) * (1.0 - cos_incident).max(0.0).powi(5)
}

/// Share that a dielectric reflects at normal incidence: ((n − 1)/(n + 1))².
pub fn normal_incidence_reflectance(ior: f64) -> f64 {
    ((ior - 1.0) / (ior + 1.0)).powi(2)
}
