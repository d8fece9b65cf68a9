//! Fresnel's equations and Snell's law for smooth dielectrics.

use glam::DVec3;

/// Share of unpolarised light that a dielectric boundary reflects. `cos_incident` is that of the angle with the normal on the
/// incident side, `eta` the index of refraction of the other side over the incident side's. Exactly 1 in total internal reflection.
pub fn dielectric_reflectance(cos_incident: f64, eta: f64) -> f64 {
    let sin_squared_transmitted = (1.0 - cos_incident * cos_incident) / (eta * eta);
    if sin_squared_transmitted >= 1.0 {
        return 1.0;
    }
    let cos_transmitted = (1.0 - sin_squared_transmitted).sqrt();
    let parallel = (eta * cos_incident - cos_transmitted) / (eta * cos_incident + cos_transmitted);
    let perpendicular = (cos_incident - eta * cos_transmitted) / (cos_incident + eta * cos_transmitted);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

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
