//! Shares of light that smooth surfaces reflect, by the cosine between the normal and the direction.

/// Unpolarized reflectance of a smooth dielectric (Born and Wolf, Principles of Optics, section 1.5.2); `eta` is the index of the far side over that
/// of the near side. 1 where all light is reflected.
pub fn dielectric(cosine: f64, eta: f64) -> f64 {
    let sine2 = (1.0 - cosine * cosine) / (eta * eta);
    if sine2 >= 1.0 {
        return 1.0;
    }
    let refracted = (1.0 - sine2).sqrt();
    let parallel = (eta * cosine - refracted) / (eta * cosine + refracted);
    let perpendicular = (cosine - eta * refracted) / (cosine + eta * refracted);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

/// Reflectance of a plate of a dielectric, all reflections between its sides summed: 2R/(1 + R).
pub fn plate(cosine: f64, eta: f64) -> f64 {
    let once = dielectric(cosine, eta);
    2.0 * once / (1.0 + once)
}

/// Unpolarized reflectance of a smooth metal of index eta + i·k, seen from a vacuum (Born and Wolf, section 14.2).
pub fn conductor(cosine: f64, eta: f64, k: f64) -> f64 {
    let (cosine2, sine2) = (cosine * cosine, 1.0 - cosine * cosine);
    let (eta2, k2) = (eta * eta, k * k);
    let t0 = eta2 - k2 - sine2;
    let sum = (t0 * t0 + 4.0 * eta2 * k2).sqrt();
    let a = (0.5 * (sum + t0)).max(0.0).sqrt();
    let (t1, t2) = (sum + cosine2, 2.0 * a * cosine);
    let perpendicular = (t1 - t2) / (t1 + t2);
    let (t3, t4) = (cosine2 * sum + sine2 * sine2, t2 * sine2);
    perpendicular * (0.5 * (1.0 + (t3 - t4) / (t3 + t4)))
}

/// Schlick's approximation (1994), from the reflectance along the normal.
pub fn schlick(cosine: f64, along_normal: f64) -> f64 {
    along_normal + (1.0 - along_normal) * (1.0 - cosine).powi(5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_are_met() {
        assert!((dielectric(1.0, 1.5) - 0.04).abs() < 1e-15);
        assert!((dielectric(1.0, 1.0 / 1.5) - 0.04).abs() < 1e-15);
        // Brewster's angle: what is polarized in the plane is let through.
        let brewster = 1.5f64.atan().cos();
        let perpendicular = ((1.5f64 * 1.5 - 1.0) / (1.5 * 1.5 + 1.0)).powi(2);
        assert!((dielectric(brewster, 1.5) - 0.5 * perpendicular).abs() < 1e-14);
        assert_eq!(dielectric(0.1, 1.0 / 1.5), 1.0);
        // A metal without absorption is a dielectric; along the normal ((n − 1)² + k²)/((n + 1)² + k²).
        assert!((conductor(0.6, 1.5, 0.0) - dielectric(0.6, 1.5)).abs() < 1e-14);
        assert!((conductor(1.0, 0.2, 3.0) - (0.64 + 9.0) / (1.44 + 9.0)).abs() < 1e-14);
    }
}
