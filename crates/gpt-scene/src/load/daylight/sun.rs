//! The sun: where it stands, and what of its light comes through the air.

use glam::DVec3;

use super::moment::Moment;
use crate::observer::{Role, integrate, planck};
use crate::spectrum::Spectrum;

/// Temperature of the black body that gives off as much as the sun, K, and the solid angle of the sun's disk, sr.
const TEMPERATURE: f64 = 5778.0;
const SOLID_ANGLE: f64 = 6.794e-5;
/// ∫ ȳ dλ, nm, by which [`integrate`] divides.
const OBSERVER_AREA: f64 = 106.857;

/// The direction to the sun, of length 1, at a moment and a place in degrees north and east: the Astronomical Almanac's formulas of low precision as
/// Michalsky 1988, "The Astronomical Almanac's Algorithm for Approximate Solar Position", has them, right to a hundredth of a degree from 1950 to 2050.
/// Refraction, half a degree at the horizon, is left out.
pub fn direction_to_sun(moment: Moment, latitude: f64, longitude: f64) -> DVec3 {
    let days = moment.days_since_2000();
    let mean_longitude = 280.460 + 0.985_647_4 * days;
    let anomaly = (357.528 + 0.985_600_3 * days).to_radians();
    let ecliptic = (mean_longitude + 1.915 * anomaly.sin() + 0.020 * (2.0 * anomaly).sin()).to_radians();
    let obliquity = (23.439 - 4e-7 * days).to_radians();
    let right_ascension = (obliquity.cos() * ecliptic.sin()).atan2(ecliptic.cos());
    let declination = (obliquity.sin() * ecliptic.sin()).asin();
    let sidereal_hours = 6.697_375 + 0.065_709_824_2 * days + moment.hours();
    let hour_angle = (15.0 * sidereal_hours + longitude).to_radians() - right_ascension;
    let (sin_latitude, cos_latitude) = latitude.to_radians().sin_cos();
    let (sin_declination, cos_declination) = declination.sin_cos();
    let east = -cos_declination * hour_angle.sin();
    let north = sin_declination * cos_latitude - cos_declination * hour_angle.cos() * sin_latitude;
    let up = sin_declination * sin_latitude + cos_declination * hour_angle.cos() * cos_latitude;
    DVec3::new(east, up, -north).normalize()
}

/// On a surface that faces the sun, whose direction has this height y, W·m⁻², linear Rec.709: Planck's law, dimmed by molecules and by haze as Preetham,
/// Shirley and Smits 1999, appendix A.2, have them (Rayleigh, Ångström), through Kasten's air mass. Ozone, water and mixed gases, which take a few
/// percent, are left out.
pub fn irradiance(height: f64, turbidity: f64) -> Spectrum {
    let zenith_degrees = height.clamp(-1.0, 1.0).acos().to_degrees();
    let air_mass = 1.0 / (height + 0.15 * (93.885 - zenith_degrees).powf(-1.253));
    let beta = 0.046_08 * turbidity - 0.045_86;
    let spectrum = |nanometres: f64| {
        let micrometres = 1e-3 * nanometres;
        let depth = 0.008_735 * micrometres.powf(-4.08) + beta * micrometres.powf(-1.3);
        SOLID_ANGLE * planck(nanometres, TEMPERATURE) * (-depth * air_mass).exp()
    };
    (integrate(Role::Light, spectrum) * OBSERVER_AREA).max(Spectrum::BLACK)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time: &str, latitude: f64, longitude: f64) -> [f64; 2] {
        let direction = direction_to_sun(Moment::read(time).expect("a time"), latitude, longitude);
        let azimuth = direction.x.atan2(-direction.z).to_degrees().rem_euclid(360.0);
        [direction.y.asin().to_degrees(), azimuth]
    }

    /// Equinox of March 20, 2000, 07:35 UT, and solstice of June 20, 2024, 20:51 UT: the sun stands over 0 and over 23.436 degrees north, so that at
    /// the north pole that is its height. On November 3 the equation of time is +16 min 26 s: over Greenwich the sun is due south at 11:43:34.
    #[test]
    fn the_sun_stands_where_almanacs_have_it() {
        assert!(at("2000-03-20T07:35:00Z", 90.0, 0.0)[0].abs() < 0.02, "{:?}", at("2000-03-20T07:35:00Z", 90.0, 0.0));
        assert!((at("2024-06-20T20:51:00Z", 90.0, 0.0)[0] - 23.436).abs() < 0.02);
        let [height, azimuth] = at("2024-11-03T11:43:34Z", 51.4779, 0.0);
        assert!((azimuth - 180.0).abs() < 0.1, "{azimuth}");
        assert!((height - (90.0 - 51.4779 - 15.2)).abs() < 0.2, "{height}");
        // The control: an hour later it is not in the south.
        assert!((at("2024-11-03T12:43:34Z", 51.4779, 0.0)[1] - 180.0).abs() > 10.0);
        // In the morning it stands in the east, and one hour of zone is one hour.
        let [_, morning] = at("2024-06-20T06:00:00Z", 51.4779, 0.0);
        assert!((60.0..100.0).contains(&morning), "{morning}");
        assert_eq!(at("2024-06-20T08:00:00+02:00", 40.0, 10.0), at("2024-06-20T06:00:00Z", 40.0, 10.0));
    }

    /// Without air, a sun of 5778 K gives some 1,366 W·m⁻², 127 to 134 klx of it to the eye (the solar illuminance constant).
    #[test]
    fn without_air_the_sun_is_as_bright_as_above_it() {
        let total: f64 = (100..20_000).map(|nanometres| SOLID_ANGLE * planck(f64::from(nanometres), TEMPERATURE)).sum();
        assert!((total - 1366.0).abs() < 15.0, "{total}");
        let sun = integrate(Role::Light, |nanometres| SOLID_ANGLE * planck(nanometres, TEMPERATURE)) * OBSERVER_AREA;
        let lux = 683.0 * sun.luminance();
        assert!((124e3..136e3).contains(&lux), "{lux}");
        assert!(irradiance(1.0, 2.0).luminance() < 0.9 * sun.luminance(), "air takes some of it");
    }
}
